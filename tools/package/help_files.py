#!/usr/bin/env python3
"""Man pages, by help2man, and completions of bash, zsh and fish, from what vkvol's --help says.

    tools/package/help_files.py VKVOL FOLDER    writes FOLDER/man/*.1.gz and FOLDER/completions: vkvol.bash, _vkvol (zsh), vkvol.fish
"""
import gzip
import json
import re
import shlex
import subprocess
import sys
from pathlib import Path

FILES = {"image": "exr", "scene": "xml pbrt nvdb vdb", "scene file": "xml pbrt", "pbrt": "pbrt", "grid": "nvdb vdb"}  # endings, by what a command takes
COMMANDS = {"render": "scene", "devices": "", "info": "grid", "integrators": "", "compare": "image", "merge": "image",
            "develop": "image", "convert": "pbrt", "init": "grid", "measure": "scene", "view": "scene", "bench": "scene file", "demo": ""}
CHOICES = {"--tonemap": "srgb aces agx reinhard", "--progress": "auto json none", "--schedule": "auto fused staged",
           "--up": "y z", "--exposure": "auto", "--device": "auto cpu"}
VALUES = {"--integrator": "integrators", "--integrators": "integrators"}  # words that the program itself lists
OF_FILES = {"-o", "--output", "--report", "--grid", "--reference", "--bands"}


class Option:
    """One of --help's: its names, whether a value follows, and what it is for."""

    def __init__(self, names, takes_value, text):
        self.names, self.takes_value, self.text = names, takes_value, text

    @property
    def long(self):
        return self.names[-1]


def options_of(help_text):
    found, lines = [], help_text.splitlines()
    for at, line in enumerate(lines):
        match = re.match(r"  ((?:-\w,)?--[\w-]+|-h,--help)( \S.*?)?(?:\s{2,}(.*))?$", line)
        if not match:
            continue
        text = match[3] or (lines[at + 1].strip() if at + 1 < len(lines) and lines[at + 1].startswith("    ") else "")
        found.append(Option(match[1].split(","), bool(match[2]), re.split(r"[;.] ", text.replace("e.g. ", "e.g.\u00a0"))[0].replace("\u00a0", " ").rstrip(".")))
    return found


def bash(commands, integrators):
    cases = "\n".join(f"    {name}) options='{' '.join(n for o in options for n in o.names)}' endings='{FILES.get(COMMANDS[name], '')}' ;;"
                      for name, options in commands.items())
    values = "\n".join(f"    {name}) COMPREPLY=($(compgen -W '{words}' -- \"$word\")); return ;;"
                       for name, words in {**CHOICES, **{option: " ".join(integrators) for option in VALUES}}.items())
    plain = "|".join(sorted({n for options in commands.values() for o in options for n in o.names
                             if o.takes_value and n not in CHOICES and n not in VALUES and n not in OF_FILES}))
    return f"""# Completion of vkvol's words in bash; made from vkvol --help.
_vkvol() {{
    local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command=render options endings ending
    local -a files
    case "${{COMP_WORDS[1]:-}}" in {'|'.join(commands)}) command=${{COMP_WORDS[1]}} ;; esac
    case $command in
{cases}
    esac
    case $before in
{values}
    {'|'.join(sorted(OF_FILES))}) mapfile -t COMPREPLY < <(compgen -f -- "$word"); return ;;
    {plain}) return ;;
    esac
    if [[ $word == -* ]]; then
        COMPREPLY=($(compgen -W "$options" -- "$word"))
        return
    fi
    for ending in $endings; do
        mapfile -t -O ${{#files[@]}} files < <(compgen -f -X "!*.$ending" -- "$word")
    done
    mapfile -t -O ${{#files[@]}} files < <(compgen -d -- "$word")
    COMPREPLY=("${{files[@]}}")
    [ "$COMP_CWORD" != 1 ] || COMPREPLY+=($(compgen -W '{' '.join(commands)}' -- "$word"))
}}
complete -o filenames -F _vkvol vkvol
"""


def quoted(text):
    return text.replace("'", "’").replace("[", "(").replace("]", ")").replace(":", " -")


def zsh(commands, integrators):
    def action(option):
        if option.long in CHOICES:
            return f":value:({CHOICES[option.long]})"
        if option.long in VALUES:
            return f":value:({' '.join(integrators)})"
        return ":file:_files" if option.long in OF_FILES else ":value: " if option.takes_value else ""

    def arguments(name, options):
        endings = "|".join(FILES.get(COMMANDS[name], "").split())
        specs = [f"'*{n}[{quoted(o.text)}]{action(o)}'" for o in options for n in o.names]
        return " \\\n            ".join(specs + ([f"'*:file:_files -g \"*.({endings})\"'"] if endings else []))

    cases = "\n".join(f"        {name}) _arguments -s {arguments(name, options)} ;;" for name, options in commands.items())
    return f"""#compdef vkvol
# Completion of vkvol's words in zsh; made from vkvol --help.
_vkvol() {{
    local command=render
    (( ${{words[(I){'|'.join(commands)}]}} == 2 )) && command=$words[2]
    [[ $CURRENT == 2 && $words[2] != -* ]] && compadd {' '.join(commands)}
    case $command in
{cases}
    esac
}}
_vkvol "$@"
"""


def fish(commands, integrators):
    lines = ["# Completion of vkvol's words in fish; made from vkvol --help."]
    others = " ".join(name for name in commands if name != "render")
    lines += [f"complete -c vkvol -n __fish_use_subcommand -a {name}" for name in commands]
    for name, options in commands.items():
        when = f"not __fish_seen_subcommand_from {others}" if name == "render" else f"__fish_seen_subcommand_from {name}"
        for option in options:
            names = " ".join(f"-l {n[2:]}" if n.startswith("--") else f"-s {n[1:]}" for n in option.names)
            words = CHOICES.get(option.long) or (" ".join(integrators) if option.long in VALUES else "")
            value = f" -x -a '{words}'" if words else " -r" if option.takes_value else ""
            lines.append(f"complete -c vkvol -n '{when}' {names}{value} -d '{quoted(option.text)}'")
    return "\n".join(lines) + "\n"


def help_of(vkvol, *command):
    return subprocess.run([vkvol, *command, "--help"], check=True, capture_output=True, text=True).stdout


def write_man_pages(vkvol, folder):
    folder.mkdir(parents=True, exist_ok=True)
    version = subprocess.run([vkvol, "--version"], check=True, capture_output=True, text=True).stdout.strip()
    for name in COMMANDS:
        words, page = ([], "vkvol") if name == "render" else ([name], f"vkvol-{name}")
        command = " ".join([shlex.quote(str(vkvol)), *words])  # help2man has a shell run it
        purpose = help_of(vkvol, *words).splitlines()[0].split(". ")[0].rstrip(".")
        text = subprocess.run(["help2man", "--no-info", f"--name={purpose[0].lower()}{purpose[1:]}", f"--version-string={page} {version.split()[-1]}",
                               "--manual=vkvol", f"--source={version}", command], check=True, capture_output=True).stdout
        text = text.replace(str(vkvol).encode(), b"vkvol")
        (folder / f"{page}.1.gz").write_bytes(gzip.compress(text, mtime=0))


def main(vkvol, folder):
    commands = {name: options_of(help_of(vkvol, *([] if name == "render" else [name]))) for name in COMMANDS}
    listed = json.loads(subprocess.run([vkvol, "integrators", "--json"], check=True, capture_output=True, text=True).stdout)
    integrators = [row["name"] for row in listed]
    completions = folder / "completions"
    completions.mkdir(parents=True, exist_ok=True)
    for name, make in (("vkvol.bash", bash), ("_vkvol", zsh), ("vkvol.fish", fish)):
        (completions / name).write_text(make(commands, integrators))
    write_man_pages(vkvol, folder / "man")


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
