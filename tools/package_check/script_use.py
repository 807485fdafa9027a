"""Which programs and Python modules the scripts of a source tree call and import."""
import ast
import re
import sys

from .shell_commands import Script


# The scripts below these folders of `root`: {path in it: text}.
def scripts(root, folders=("tools", "tests")):
    found = {}
    for folder in folders:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".sh", ".py") or path.is_file() and not path.suffix and path.read_bytes()[:2] == b"#!":
                found[path.relative_to(root)] = path.read_text()
    return found


def is_python(path, text):
    return path.suffix == ".py" or "python" in text.split("\n")[0]


# {program: what for}, of what is called by name.
def programs_called(scripts):
    called, functions = {}, set()
    for path, text in scripts.items():
        names = set(re.findall(r"\A#!/usr/bin/env (\S+)", text))
        if is_python(path, text):
            names |= programs_of_python(text)
        else:
            script = Script(text)
            functions |= script.functions  # those of setup.sh are called by all
            names |= script.programs()
        for name in names:
            called.setdefault(name, f"program, called by {path}")
    return {name: what for name, what in called.items() if name not in functions}


def programs_of_python(text):
    names = set()
    for call in (node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Call)):
        function = ast.unparse(call.func)
        lists = [k.value for k in call.keywords if k.arg == "wrap"]
        if function.startswith("subprocess.") or function == "shutil.which":
            lists += call.args[:1]
        for value in lists:
            first = value.elts[0] if isinstance(value, (ast.List, ast.Tuple)) and value.elts else value
            if isinstance(first, ast.Constant) and isinstance(first.value, str):
                names.add(first.value)
    return names


# {module: what for}, of what is neither Python's own nor ours.
def modules_imported(scripts):
    imported, own = {}, set()
    for path, text in scripts.items():
        own |= {path.stem, path.parent.name}
        for node in ast.walk(ast.parse(text)) if is_python(path, text) else ():
            names = []
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                names = [node.module]
            for name in names:
                imported.setdefault(name.split(".")[0], f"module, imported by {path}")
    return {name: what for name, what in imported.items() if name not in own and name not in sys.stdlib_module_names}
