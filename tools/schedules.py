#!/usr/bin/env python3
"""Fused against staged, and against another build: seconds of rendering in alternation, by pass, with queue occupancy.

    tools/schedules.py [--old OLD_VKVOL] [--runs 5] [--build build] [--scenes cloud,smoke,...]

`x` is the median of the first column's seconds over this one's: above 1 is faster. `start` is the seconds of the whole command
that are not rendering, without a pipeline cache. Occupancy is the part of the slots that was in a pass's queue when it began.
Builds may run by different numbers of lanes on Mesa's software driver: LP_NATIVE_VECTOR_WIDTH=256 gives all of them eight.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile
import time

from table_runs import commit_of

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENES = {
    "cloud": ["scenes/bench/cloud.xml", "--width", "128", "--spp", "64"],
    "smoke": ["scenes/bench/smoke.xml", "--width", "128", "--spp", "256"],
    "sphere": ["scenes/bench/sphere.xml", "--width", "256", "--spp", "384"],
    "cumulus": ["scenes/cumulus.xml", "--width", "160", "--spp", "96"],
    "explosion": ["scenes/explosion.xml", "--width", "160", "--spp", "96"],
}


def render(command, scene, folder):
    report = folder / "report.json"
    begun = time.monotonic()
    subprocess.run([*command, *scene, "-q", "--no-cache", "-o", folder / "a.exr", "--report", report], cwd=ROOT, check=True)
    seconds = time.monotonic() - begun
    figures = json.loads(report.read_text())
    return figures | {"start": seconds - figures["seconds"]["render"]}


def shares(report):
    passes = report["seconds"]["passes"]
    occupancy = report.get("occupancy", {})
    return ", ".join(f"{name} {seconds:.2f} s" + (f" ({100 * occupancy[name]:.0f} %)" if name in occupancy else "")
                     for name, seconds in passes.items())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--old")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--build", default=ROOT / "build")
    parser.add_argument("--scenes", default=",".join(SCENES))
    options = parser.parse_args()
    options.old = options.old and str(pathlib.Path(options.old).resolve())
    vkvol = str(pathlib.Path(options.build).resolve() / "vkvol")
    columns = {"old": [options.old]} if options.old else {}
    columns |= {schedule: [vkvol, "--schedule", schedule] for schedule in ("fused", "staged")}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for scene in options.scenes.split(","):
            reports = {column: [] for column in columns}
            for _ in range(options.runs):
                for column, command in columns.items():
                    reports[column].append(render(command, SCENES[scene], folder))
            if scene == options.scenes.split(",")[0]:
                device = {column: f"{list_of[0]['device']['name']}, {list_of[0]['device']['driver']}" for column, list_of in reports.items()}
                print(f"medians of {options.runs}, in alternation")
                print((f"old: {commit_of(options.old)}, {device['old']}; " if options.old else "") + f"new: {commit_of(vkvol)}, {device['fused']}")
                print(f"{'scene':10} {'':7} {'seconds':>8} {'x':>6} {'start':>6} {'lanes':>6}  seconds by pass of the last run (occupancy)")
            first = None
            for column, list_of in reports.items():
                seconds = statistics.median(r["seconds"]["render"] for r in list_of)
                start = statistics.median(r["start"] for r in list_of)
                first = first or seconds
                print(f"{scene:10} {column:7} {seconds:8.3f} {first / seconds:6.3f} {start:6.3f} "
                      f"{100 * list_of[-1]['laneUse']['track']:4.0f} %  {shares(list_of[-1])}", flush=True)


if __name__ == "__main__":
    main()
