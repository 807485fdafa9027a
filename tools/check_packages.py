#!/usr/bin/env python3
"""Holds what a build and the scripts used against the packages that tools/setup.sh installs.

    tools/check_packages.py [BUILD]      default: build

A header, a library, a program or a Python module may be on this machine for other reasons; on a new one it would be missing.
So each must be of a Debian package that is listed in tools/setup.sh, that a listed one depends on, or that no Debian is
without. Looked at are the files that the compiler read, what was linked and is loaded, the programs that the build, the
tests and the scripts of tools/ call, and the modules that Python files import. Programs and modules are looked for where
Debian puts them: what another Python or /usr/local offers does not count.

Exit code 0: all are; 1: some are not, and each is named; 2: there is no build; 77: this cannot be told (no dpkg, no ninja,
or another compiler was chosen than Debian's).
"""
import argparse
import os
import sys
from pathlib import Path

from package_check.build_use import Build
from package_check.debian import Declared, Packages, installed_packages, lines_of, owner
from package_check.script_use import modules_imported, programs_called, scripts

ROOT = Path(__file__).resolve().parent.parent
SKIPPED = 77
PROGRAM_PLACES = [Path(place) for place in ("/usr/bin", "/bin", "/usr/sbin", "/sbin")]
MODULE_PLACES = [Path("/usr/lib/python3/dist-packages")]

# Called by scripts and not installed by any, with the reason.
NOT_INSTALLED = {
    "sudo": "asked for only by users other than root",
    "git": "for those who change the program: they have cloned it",
    "debootstrap": "tools/newcomer.sh says that it needs it",
    "help2man": "tools/package.sh installs it",
    "patchelf": "likewise",
    "mitsuba": "a renderer to compare with, of PyPI: tools/peers/README.md",
    "drjit": "comes with mitsuba",
    "pyoidn": "a denoiser, of PyPI: tools/denoise",
    "snakemake": "of those who use it: tools/farm",
    "slurmctld": "likewise",
    "slurmd": "likewise",
    "sbatch": "likewise",
    "squeue": "likewise",
    "sinfo": "likewise",
    "munged": "likewise",
    "openjd": "likewise, of PyPI",
    "playwright": "drives a browser, of PyPI: tools/view_check.py",
    "chromium": "the browser that tools/view_check.py drives",
    "nanodisort": "discrete ordinates to compare with, of PyPI: tools/truth --slabs",
}


def listed_packages():
    return lines_of("bash", "-c", 'source "$1"; printf "%s\\n" "${packages[@]}"', "bash", str(ROOT / "tools/setup.sh"))


def first_file(places, *patterns):
    return next((str(file) for place in places for pattern in patterns for file in place.glob(pattern)), None)


# (package, file, what for) of what is not declared; without a package if none has it.
def undeclared(build, scripts_read, declared):
    found = list(build.files.items())
    named = {name: what for name, what in {**programs_called(scripts_read), **build.programs}.items() if name not in NOT_INSTALLED}
    found += [(first_file(PROGRAM_PLACES, name) or name, what) for name, what in named.items()]
    for name, what in modules_imported(scripts_read).items():
        if name not in NOT_INSTALLED:
            found.append((first_file(MODULE_PLACES, f"{name}/__init__.py", f"{name}.py", f"{name}.*.so") or name, what))
    return len(found), [(owner(path), path, what) for path, what in found
                        if not declared.has(path) and not declared.has(path.replace("/usr/local/", "/usr/", 1))]


def complaints(missing):
    by_package = {}
    for package, path, what in missing:
        by_package.setdefault(package, []).append(f"{path} ({what})")
    for text in by_package.pop(None, []):
        yield f"{text} is of no package that tools/setup.sh lists, nor of another one here"
    for package, texts in sorted(by_package.items()):
        more = f", and {len(texts) - 1} more" if len(texts) > 1 else ""
        yield f"{package} is not listed in tools/setup.sh, but used: {texts[0]}{more}"


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", type=Path, default=ROOT / "build")
    parser.add_argument("--without", action="append", default=[], metavar="PACKAGE", help="as if it were not listed")
    chosen = parser.parse_args()
    chosen.build = chosen.build.resolve()
    return chosen


def main():
    chosen = options()
    if not any(os.access(os.path.join(place, "dpkg-query"), os.X_OK) for place in PROGRAM_PLACES):
        print("skipped: there is no dpkg here, whose packages tools/setup.sh lists")
        return SKIPPED
    if not (chosen.build / "CMakeCache.txt").is_file():
        print(f"check_packages: {chosen.build} is no build; name one, or make it: cmake --preset release", file=sys.stderr)
        return 2
    if not (chosen.build / "build.ninja").is_file():
        print(f"skipped: {chosen.build} is not built by ninja, which knows what was read")
        return SKIPPED
    declared = Declared(Packages(installed_packages()), [name for name in listed_packages() if name not in chosen.without])
    build = Build(chosen.build, ROOT)
    if not declared.has(build.compiler):
        print(f"skipped: {build.compiler} is not Debian's compiler, so headers may be its own")
        return SKIPPED
    looked_at, missing = undeclared(build, scripts(ROOT), declared)
    for text in complaints(missing):
        print(text)
    print(f"{looked_at} headers, libraries, programs and modules: {len(missing) or 'none'} not of the {len(declared.packages)} packages "
          "that tools/setup.sh brings")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
