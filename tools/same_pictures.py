#!/usr/bin/env python3
"""Pictures of two builds of vkvol, side by side: whether they have the same bits, and how long rendering took.

    tools/same_pictures.py OLD_VKVOL [NEW_VKVOL] [--only WORD] [--runs 1] [--width 64] [--spp 8]

Renders every scene of scenes/, every integrator in a cloud and in a homogeneous ball, a crop, and a render that is resumed
from a checkpoint, by both builds with the same seed. Where bits differ, `vkvol compare` judges another seed of the new
build, so that the two are independent, and its verdict is printed; the reason for such a difference is for people to find.
Seconds are medians of --runs, in alternation. Fields: tools/all_scenes.sh makes them. Exit code 1: a picture differs by
more than noise, or was not rendered."""
import argparse
import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CLOUD = ["scenes/bench/cloud.xml"]
BALL = ["scenes/bench/sphere.xml"]
RESUMED = "a checkpoint, resumed"


def cases(vkvol):
    """Name and arguments of every picture."""
    listed = [(path.relative_to(ROOT / "scenes").with_suffix("").as_posix(), [path.relative_to(ROOT)])
              for path in sorted((ROOT / "scenes").rglob("*.xml")) if path.stem != "large_grid"]
    for row in json.loads(subprocess.run([vkvol, "integrators", "--json"], capture_output=True, check=True).stdout):
        for scene in (CLOUD, BALL):
            listed.append((f"{Path(scene[0]).stem}, {row['name']}", [*scene, "--integrator", row["name"]]))
    listed += [("a crop", [*CLOUD, "--crop", "7,40,3,31"]), (RESUMED, CLOUD)]
    return listed


class Build:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def render(self, arguments, seed=1):
        """The picture, and the seconds that rendering took; why there is none, if there is none."""
        picture, report = self.folder / "picture.exr", self.folder / "report.json"
        done = subprocess.run([self.program, *arguments, "--seed", str(seed), "-q", "-o", picture, "--report", report],
                              cwd=ROOT, capture_output=True, text=True)
        if done.returncode:
            return None, done.stderr.strip().splitlines()[-1]
        return picture, json.loads(report.read_text())["seconds"]["render"]

    def resumed(self, arguments):
        """The same in two parts, the first ended by time with a checkpoint."""
        first, why = self.render([*arguments, "--checkpoint", "3600s", "--time", "0.05s"])
        return self.render([*arguments, "--resume"]) if first else (first, why)


def judge(vkvol, a, b):
    done = subprocess.run([vkvol, "compare", a, b, "--json"], capture_output=True, text=True)
    return done.returncode, json.loads(done.stdout) if done.stdout else {}


def same_bits(vkvol, a, b):
    done = subprocess.run([vkvol, "compare", a, b], capture_output=True, text=True)
    return "identical" in done.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path, nargs="?", default=ROOT / "build" / "vkvol")
    parser.add_argument("--only", default="")
    parser.add_argument("--runs", type=int, default=1)
    parser.add_argument("--width", default="64")
    parser.add_argument("--spp", default="8")
    options = parser.parse_args()
    size = ["--width", options.width, "--spp", options.spp]
    failed = 0
    print(f"{'picture':44} {'bits':10} old/new seconds")
    with tempfile.TemporaryDirectory() as work:
        builds = []
        for name, program in (("old", options.old), ("new", options.new)):
            (Path(work) / name).mkdir()
            builds.append(Build(program.resolve(), Path(work) / name))
        old, new = builds
        for name, arguments in cases(new.program):
            if options.only not in name:
                continue
            failed += not compare(name, [*arguments, *size], old, new, options.runs)
    return 1 if failed else 0


def compare(name, arguments, old, new, runs):
    seconds = {old: [], new: []}
    pictures = {}
    for run in range(runs):
        for build in (old, new) if run % 2 else (new, old):
            pictures[build], took = (build.resumed if name == RESUMED else build.render)(arguments)
            seconds[build].append(took)
    if not pictures[old] or not pictures[new]:
        both = not pictures[old] and not pictures[new]
        print(f"{name:44} {'none' if both else 'ONE ONLY':10} {seconds[old][0]} | {seconds[new][0]}"[:180], flush=True)
        return both
    ratio = statistics.median(seconds[old]) / max(statistics.median(seconds[new]), 1e-9)
    verdict, fine = "same", True
    if not same_bits(new.program, pictures[old], pictures[new]):
        other, _ = new.render(arguments, seed=2)
        code, _ = judge(new.program, pictures[old], other)
        fine = code == 0
        verdict = "by noise" if fine else "DIFFERENT"
    print(f"{name:44} {verdict:10} {ratio:.3f}", flush=True)
    return fine


if __name__ == "__main__":
    sys.exit(main())
