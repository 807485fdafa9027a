"""What a build by ninja used: headers and libraries, by path, and programs, by name."""
import json
import os
import pathlib
import re
import shlex
import tempfile

from .debian import lines_of


# `files` is {path: what for} and `programs` {name: what for}, but for what lies in the source tree `root` or in the build.
class Build:
    def __init__(self, directory, root):
        self.directory = directory
        self.own = (f"{root}/", f"{directory}/")
        self.cache = dict(re.findall(r"^([^/#\s:]+):\w+=(.*)$", (directory / "CMakeCache.txt").read_text(), re.MULTILINE))
        self.compiler = self.cache.get("CMAKE_CXX_COMPILER", "")
        self.files = {}
        self.programs = {"ninja": "program, builds"}
        self.read_headers()
        self.read_commands()
        self.read_tests()

    def use(self, path, what):
        path = os.path.normpath(path)
        if path.startswith("/") and not path.startswith(self.own):
            self.files.setdefault(path, what)

    def call(self, program, what):
        if not os.path.normpath(program).startswith(self.own):
            self.programs.setdefault(os.path.basename(program), f"program, called by {what}")

    def read_headers(self):
        target = ""
        for line in lines_of("ninja", "-C", self.directory, "-t", "deps"):
            if line.startswith(" "):
                self.use(line.strip(), f"header, read for {target}")
            elif line:
                target = line.split(":")[0]

    def read_commands(self):
        for line in lines_of("ninja", "-C", self.directory, "-t", "commands"):
            words = shlex.split(line)
            libraries = [word for word in words if re.search(r"\.(so[.\d]*|a)$", word) or re.match(r"-l\w", word)]
            for word in words:
                if word in libraries:
                    self.use(self.linked_file(word), "library, linked")
                elif word.startswith("/") and os.access(word, os.X_OK) and not os.path.isdir(word) and \
                        os.path.basename(word) not in self.launchers():
                    self.call(word, "the build")
            if libraries and "-o" in words[:-1]:
                self.read_loaded(self.directory / words[words.index("-o") + 1])

    # ccache and the like are the user's choice.
    def launchers(self):
        return {os.path.basename(self.cache.get(f"CMAKE_{language}_COMPILER_LAUNCHER", "")) for language in ("C", "CXX")}

    # What it names itself: what those name in turn is their packages' affair.
    def read_loaded(self, binary):
        needed = re.findall(r"NEEDED +(\S+)", "\n".join(lines_of("objdump", "-p", binary)))
        for name, path in re.findall(r"(\S+) => (/\S+)", "\n".join(lines_of("ldd", binary))):
            if name in needed:
                self.use(path, f"library, loaded by {binary.name}")

    def linked_file(self, word):
        if not word.startswith("-l"):
            return word
        for ending in (".so", ".a"):
            found = lines_of(self.compiler, f"-print-file-name=lib{word[2:]}{ending}")
            if found and found[0].startswith("/"):
                return found[0]
        return word

    def read_tests(self):
        # From elsewhere: it would write its own log over that of the tests that call this.
        with tempfile.TemporaryDirectory() as elsewhere:
            pathlib.Path(elsewhere, "CTestTestfile.cmake").write_text(f"subdirs([[{self.directory.resolve()}]])\n")
            listing = "\n".join(lines_of("ctest", "--test-dir", elsewhere, "--show-only=json-v1"))
        for test in json.loads(listing or '{"tests": []}')["tests"]:
            if test.get("command"):
                self.call(test["command"][0], f"the test {test['name']}")
