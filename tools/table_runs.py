"""What the tables of one way of rendering over another have in common: their options, and one render."""

import argparse
import json
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent


def commit_of(program):
    """Of the sources that a program lies among, built in a folder of theirs; with a + if these were changed."""
    found = subprocess.run(["git", "describe", "--always", "--dirty=+", "--exclude=*"], cwd=pathlib.Path(program).resolve().parent,
                           capture_output=True, text=True)
    return found.stdout.strip() or "of no known commit"


def driver_of(vkvol):
    found = json.loads(subprocess.run([pathlib.Path(vkvol).resolve(), "devices", "--json"], check=True, capture_output=True).stdout)
    return next((device["driver"] for device in found if device["usable"]), "no device")


def options(description, scenes=(), **defaults):
    """--build, and an integer for each of `defaults`. `vkvol` is the program. Where there are `scenes`, some of them may be named."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=ROOT / "build")
    for name, value in defaults.items():
        parser.add_argument(f"--{name}", type=int, default=value)
    if scenes:
        parser.add_argument("scenes", nargs="*", default=list(scenes), metavar="SCENE")
    found = parser.parse_args()
    found.vkvol = str(pathlib.Path(found.build).resolve() / "vkvol")
    return found


def render(vkvol, scene, integrator, seed, spp, picture, *more):
    """Writes `picture` (.exr); what --report says."""
    report = picture.with_suffix(".json")
    subprocess.run([vkvol, scene, "--integrator", integrator, "--seed", str(seed), "--spp", str(spp), "-q", "-o", picture,
                    "--report", report, *more], check=True, capture_output=True)
    return json.loads(report.read_text())
