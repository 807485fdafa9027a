#!/usr/bin/env python3
"""Pictures of two builds of vkvol, side by side: whether they have the same bits, and how long rendering took.

    tools/same_pictures.py OLD_VKVOL [NEW_VKVOL] [--scenes FOLDER] [--only WORD] [--runs 1] [--width 64] [--spp 8]

Renders every scene of scenes/ (large_grid has windows), or of another folder if the old build does not know all that these have, every integrator
of the old build in a cloud and in a homogeneous ball, a crop, and a render that is resumed from a checkpoint, by both builds with the same seed. Where bits differ, `vkvol compare` judges another seed of the new
build, so that the two are independent, and its verdict is printed; the reason for such a difference is for people to find.
Seconds are medians of --runs, in alternation. Fields: tools/all_scenes.sh makes them. Exit code 1: a picture differs by
more than noise, or was not rendered (closed forms in a cloud are refused, by both builds)."""
import argparse
import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from table_runs import commit_of, driver_of

ROOT = Path(__file__).resolve().parent.parent
CLOUD = ["scenes/bench/cloud.xml"]
BALL = ["scenes/bench/sphere.xml"]
RESUMED = "a checkpoint, resumed"


def cases(vkvol, scenes):
    """Name and arguments of every picture; integrators are those of `vkvol`."""
    listed = [(path.relative_to(scenes).with_suffix("").as_posix(), [path])
              for path in sorted(scenes.rglob("*.xml"))]
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
            return None, (done.stderr.strip().splitlines() or [f"ended with code {done.returncode}"])[-1]
        return picture, json.loads(report.read_text())["seconds"]["render"]

    def resumed(self, arguments):
        """The same in two parts, the first ended by time with a checkpoint."""
        first, why = self.render([*arguments, "--checkpoint", "3600s", "--time", "0.3s"])
        if first and not first.with_suffix(".checkpoint").exists():
            return None, "too fast: no checkpoint was left to resume"
        return self.render([*arguments, "--resume"]) if first else (first, why)


def judge(vkvol, a, b, significance):
    """Exit code and figures of `vkvol compare`."""
    done = subprocess.run([vkvol, "compare", a, b, "--json", "--significance", f"{significance:g}"], capture_output=True, text=True)
    if done.returncode not in (0, 4):
        raise SystemExit(f"vkvol compare failed: {done.stderr.strip()}")
    return done.returncode, json.loads(done.stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path, nargs="?", default=ROOT / "build" / "vkvol")
    parser.add_argument("--scenes", type=Path, default=ROOT / "scenes")
    parser.add_argument("--only", default="")
    parser.add_argument("--runs", type=int, default=1)
    parser.add_argument("--width", default="64")
    parser.add_argument("--spp", default="8")
    options = parser.parse_args()
    failed = 0
    print(f"old: {commit_of(options.old)}, new: {commit_of(options.new)}; {driver_of(options.new)}; {options.width} pixels wide, {options.spp} samples")
    print(f"{'picture':44} {'bits':10} old/new seconds")
    with tempfile.TemporaryDirectory() as work:
        builds = []
        for name, program in (("old", options.old), ("new", options.new)):
            (Path(work) / name).mkdir()
            builds.append(Build(program.resolve(), Path(work) / name))
        old, new = builds
        chosen = [case for case in cases(old.program, options.scenes.resolve()) if options.only in case[0]]
        if not chosen:
            sys.exit(f"no picture's name contains {options.only!r}")
        for name, arguments in chosen:
            size = ["--width", options.width, "--spp", "400" if name == RESUMED else options.spp]
            # The whole table shows a difference by chance once in a hundred times.
            failed += not compare(name, [*arguments, *size], old, new, options.runs, 0.01 / len(chosen))
    return 1 if failed else 0


def compare(name, arguments, old, new, runs, significance):
    seconds = {old: [], new: []}
    pictures = {}
    for run in range(runs):
        for build in (old, new) if run % 2 else (new, old):
            pictures[build], took = (build.resumed if name == RESUMED else build.render)(arguments)
            seconds[build].append(took)
    if not all(isinstance(took, float) for build in seconds for took in seconds[build]):
        both = [took for build in (old, new) for took in seconds[build] if not isinstance(took, float)]
        refused = len(both) == 2 * runs and "constant density" in both[0]
        print(f"{name:44} {'refused' if refused else 'NO PICTURE':10} {both[0]}"[:180], flush=True)
        return refused
    ratio = statistics.median(seconds[old]) / max(statistics.median(seconds[new]), 1e-9)
    verdict = "same"
    _, figures = judge(new.program, pictures[old], pictures[new], significance)
    if figures["identicalPixels"] != figures["pixels"]:
        other, why = new.render(arguments, seed=2)
        if not other:
            raise SystemExit(f"{name}: {why}")
        code, _ = judge(new.program, pictures[old], other, significance)
        verdict = "by noise" if code == 0 else "DIFFERENT"
    print(f"{name:44} {verdict:10} {ratio:.3f}", flush=True)
    return verdict != "DIFFERENT"


if __name__ == "__main__":
    sys.exit(main())
