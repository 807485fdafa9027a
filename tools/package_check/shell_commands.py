"""Which programs a bash script calls: the words at the places of commands, without running it.

Follows quotes, substitutions, here-documents, `case`, functions, `trap` and `sh -c` with a literal text, programs that run
another (`exec`, `xargs`, `timeout` ...) and arrays that are expanded as a command. A command whose name is computed
(`"$build/vkvol"`) has no name to give and is passed over.
"""
import re

KEYWORDS = {"if", "then", "elif", "else", "while", "until", "do", "!", "{", "time"}
ENDS = {"fi", "done", "}"}
BUILTINS = {
    ".", ":", "[", "alias", "bg", "break", "builtin", "caller", "cd", "command", "compgen", "continue", "declare", "echo",
    "eval", "exec", "exit", "export", "false", "getopts", "hash", "kill", "let", "local", "mapfile", "popd", "printf", "pushd",
    "pwd", "read", "readarray", "readonly", "return", "set", "shift", "shopt", "source", "test", "times", "trap", "true",
    "type", "typeset", "ulimit", "umask", "unset", "wait"}
RUNNERS = {"exec", "command", "env", "nice", "nohup", "timeout", "xargs", "sudo", "setsid"}  # the command follows
SHELLS = {"sh", "bash"}
ASSIGNMENT = re.compile(r"[A-Za-z_]\w*(\[[^]]*\])?\+?=")
ARGUMENT_OF_RUNNER = re.compile(r"-|[0-9.]+[smhd]?$|[A-Za-z_]\w*=")
METACHARACTERS = " \t\n;|&<>()"


class Word:
    def __init__(self):
        self.text = ""
        self.literal = True
        self.quoted = False
        self.array = None  # the word is "${array[@]}"


class Script:
    def __init__(self, text):
        self.text = text
        self.at = 0
        self.commands = set()
        self.functions = set()
        self.first_of_array = {}
        self.arrays_run = set()
        self.waiting_documents = []
        self.block("")
        self.commands |= {self.first_of_array[name] for name in self.arrays_run if name in self.first_of_array}

    def programs(self):
        return {c for c in self.commands - self.functions - BUILTINS if re.fullmatch(r"[\w.+-]+", c)}

    def ahead(self, text):
        return self.text.startswith(text, self.at)

    def skip_blanks(self):
        while self.ahead(" ") or self.ahead("\t") or self.ahead("\\\n"):
            self.at += 2 if self.ahead("\\") else 1

    def skip_past(self, text):
        end = self.text.find(text, self.at)
        self.at = len(self.text) if end < 0 else end + len(text)

    # Commands up to `closing`: ")" of a substitution, ";;" of a case, or the end.
    def block(self, closing):
        command = True  # whether the next word is one
        runner = False  # it follows xargs or the like
        shell = None    # of `sh -c TEXT`: the words since
        while self.at < len(self.text):
            self.skip_blanks()
            if closing and self.ahead(closing):
                self.at += len(closing)
                return
            c = self.text[self.at:self.at + 1]
            if c == "#":
                self.at = len(self.text) if "\n" not in self.text[self.at:] else self.text.index("\n", self.at)
            elif c == "\n":
                self.at += 1
                self.skip_documents()
                command, runner, shell = True, False, None
            elif self.ahead("((") and command:
                self.skip_past("))")
                command = False
            elif c in tuple(";|&()"):
                self.at += 1
                if c == "&" and self.ahead(">"):
                    continue
                command, runner, shell = True, False, None
                if c == "(":
                    self.block(")")
                    command = False
            elif c in tuple("<>"):
                self.redirection()
            elif c:
                if closing == ";;" and re.match(r"esac\b", self.text[self.at:]):
                    return
                command, runner, shell = self.take(self.word(), command, runner, shell)

    # What a word does to the place it stands in.
    def take(self, word, command, runner, shell):
        text = word.text
        if self.ahead("(") and text.endswith("="):
            self.array(text)
            return command, runner, shell
        if re.fullmatch(r"\d+", text) and (self.ahead("<") or self.ahead(">")):
            return command, runner, shell
        if shell is not None:
            if shell[-1:] == ["-c"] and word.literal:
                self.inner(text)
            shell.append(text)
        if not command:
            return False, False, shell
        if word.array:
            self.arrays_run.add(word.array)
            return True, True, None
        if not word.literal and not ASSIGNMENT.match(text):
            return False, False, None
        if runner and ARGUMENT_OF_RUNNER.match(text) or ASSIGNMENT.match(text) and not word.quoted:
            return True, runner, None
        return self.named_command(text)

    def named_command(self, text):
        if text in KEYWORDS:
            return True, False, None
        if text in ENDS:
            return False, False, None
        if text == "[[":
            self.skip_past("]]")
        elif text == "case":
            self.case()
        elif text in ("for", "select"):
            self.skip_blanks()
            if not self.ahead("(("):
                self.word()
            else:
                self.skip_past("))")
        elif self.ahead("()"):
            self.functions.add(text)
            self.at += 2
            return True, False, None
        elif text == "trap":
            self.skip_blanks()
            handler = self.word()
            if handler.literal or handler.quoted:
                self.inner(handler.text)
        else:
            self.commands.add(text)
            return text in RUNNERS, text in RUNNERS, [] if text in SHELLS else None
        return False, False, None

    def inner(self, text):
        script = Script(text)
        self.commands |= script.commands
        self.functions |= script.functions

    def case(self):
        self.skip_blanks()
        self.word()
        self.skip_past("in")
        while self.at < len(self.text):
            while self.at < len(self.text) and (self.text[self.at].isspace() or self.ahead("#")):
                self.skip_past("\n" if self.ahead("#") else self.text[self.at])
            if re.match(r"esac\b", self.text[self.at:]):
                self.at += len("esac")
                return
            while self.at < len(self.text) and not self.ahead(")"):  # the pattern
                before = self.at
                self.word()
                if self.at == before:
                    self.at += 1
            self.at += 1
            self.block(";;")

    def array(self, assignment):
        self.at += 1
        name = re.match(r"\w+", assignment).group()
        while self.at < len(self.text):
            self.skip_blanks()
            if self.ahead(")"):
                self.at += 1
                return
            if self.ahead("\n"):
                self.at += 1
            elif self.ahead("#"):
                self.skip_past("\n")
            else:
                word = self.word()
                if word.literal:
                    self.first_of_array.setdefault(name, word.text)

    def redirection(self):
        if self.ahead("<(") or self.ahead(">("):
            self.at += 2
            self.block(")")
            return
        operator = re.compile(r"<<<|<<-?|[<>][>&|]?").match(self.text, self.at).group()
        self.at += len(operator)
        self.skip_blanks()
        target = self.word()
        if operator in ("<<", "<<-"):
            self.waiting_documents.append(target.text)

    def skip_documents(self):
        for end in self.waiting_documents:
            found = re.compile(rf"^\t*{re.escape(end)}$", re.MULTILINE).search(self.text, self.at)
            self.at = found.end() + 1 if found else len(self.text)
        self.waiting_documents = []

    def word(self):
        word = Word()
        start = self.at
        while self.at < len(self.text) and self.text[self.at] not in METACHARACTERS:
            c = self.text[self.at]
            if c == "\\":
                word.text += self.text[self.at + 1:self.at + 2]
                self.at += 2
            elif c == "'":
                begin = self.at + 1
                self.at = begin
                self.skip_past("'")
                word.text += self.text[begin:self.at - 1]
                word.quoted = True
            elif c == '"':
                word.quoted = True
                self.at += 1
                while self.at < len(self.text) and not self.ahead('"'):
                    self.piece(word)
                self.at += 1
            else:
                self.piece(word)
        whole = re.fullmatch(r'"?\$\{(\w+)\[@\]\}"?', self.text[start:self.at])
        word.array = whole and whole.group(1)
        return word

    # One character, or one expansion, in or out of double quotes.
    def piece(self, word):
        if self.ahead("$(("):
            self.skip_past("))")
        elif self.ahead("$("):
            self.at += 2
            self.block(")")
        elif self.ahead("${"):
            self.at += 2
            while self.at < len(self.text) and not self.ahead("}"):
                self.piece(Word())
            self.at += 1
        elif self.ahead("`"):
            begin = self.at + 1
            self.at = begin
            self.skip_past("`")
            self.inner(self.text[begin:self.at - 1])
        elif self.ahead("$"):
            self.at = re.compile(r"\$(\w+|.)?").match(self.text, self.at).end()
        else:
            if self.ahead("\\"):
                self.at += 1
            word.text += self.text[self.at:self.at + 1]
            self.at += 1
            return
        word.literal = False
