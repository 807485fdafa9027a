#!/usr/bin/env python3
"""Whether a build of vkvol renders with more, or less, efficiency than another: 1 / (error * seconds), scene by scene.

    tools/against.py OLD_VKVOL [NEW_VKVOL] [--rounds 5] [--time 2] [--scenes WORD]

Both render the same scenes with as many samples as take the new one --time seconds, in rounds that begin with either in turn, all
with seeds of their own. The error of a render is its variance over the squared mean of all renders, by pixel; what is printed is the
geometric mean of the ratios of the rounds, new over old, with its interval: all hold together with 95 %. Exit code 1: one of them lies
below 1, or pictures differ by more than noise. Scenes that the old build does not read are left out, and named. See tools/benchmark.sh --against."""

import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

import numpy as np

from table_runs import commit_of

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools/peers"))
import exr  # noqa: E402
from contest import EPSILON, interval  # noqa: E402

SCENES = ["bench/cloud", "bench/smoke", "bench/sphere", "cumulus", "explosion", "gallery/lamps_in_fog", "gallery/fair_weather", "gallery/room"]
WIDTH = 96
SIGNIFICANCE, CONFIDENCE = 0.01, 0.95  # of the whole table


class Render:
    def __init__(self, vkvol, scene, samples, seed, folder):
        self.file, report = folder / f"{seed}.exr", folder / "report.json"
        done = subprocess.run([vkvol, ROOT / "scenes" / f"{scene}.xml", "--width", str(WIDTH), "--spp", str(samples), "--seed", str(seed),
                               "-q", "-o", self.file, "--report", report], capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError((done.stderr.strip().splitlines() or [f"ended with code {done.returncode}"])[-1])
        self.report = json.loads(report.read_text())
        self.seconds = self.report["seconds"]["render"]
        self.mean, self.variance, _ = exr.read_rgb(self.file)


def error(render, expected):
    return float(np.mean(render.variance / (expected ** 2 + EPSILON)))


def samples_for(vkvol, scene, seconds, folder):
    """That take about so long; a first render fills the caches."""
    samples = 1
    Render(vkvol, scene, samples, 1, folder)
    while True:
        taken = Render(vkvol, scene, samples, 1, folder).seconds
        if taken > 0.7 * seconds or samples >= 1 << 20:
            return samples
        samples = max(2 * samples, min(16 * samples, round(samples * seconds / max(taken, 1e-3))))


def ratios(old, new, confidence):
    """Of efficiency and of speed, new over old, each with its interval, and whether the first is a loss."""
    expected = np.mean([render.mean for render in old + new], axis=0)
    speed = [np.log(a.seconds / b.seconds) for a, b in zip(old, new)]
    errors = [np.log(error(a, expected) / error(b, expected)) for a, b in zip(old, new)]
    efficiency = interval([s + e for s, e in zip(speed, errors)], confidence)
    return efficiency, interval(speed, confidence), efficiency["high"] < 1.0


def are_same(vkvol, old, new, significance):
    """By the pictures of two rounds, whose seeds differ."""
    done = subprocess.run([vkvol, "compare", old[0].file, new[1].file, "--json", "--significance", f"{significance:g}"],
                          capture_output=True, text=True)
    if done.returncode not in (0, 4):
        sys.exit(f"vkvol compare failed: {done.stderr.strip()}")
    return done.returncode == 0


def told(value):
    return f"{value['value']:6.3f} [{value['low']:.3f}, {value['high']:.3f}]"


def no_ratio(scene, why, is_well):
    print(f"{scene:22} {why}", flush=True)
    return None, is_well


def measure(scene, builds, options, count, folder):
    """One line of the table, of `count`: the ratio of efficiencies, none of a scene that cannot be rendered, and whether all is well."""
    try:
        samples = samples_for(builds["new"], scene, options.time, folder)
    except RuntimeError as why:
        return no_ratio(scene, f"FAILS: {why}", False)
    try:
        Render(builds["old"], scene, samples, 1, folder)
    except RuntimeError as why:
        return no_ratio(scene, f"left out, as the old build says: {why}", True)
    renders = {"old": [], "new": []}
    for name in renders:
        (folder / name).mkdir(exist_ok=True)
    for turn in range(options.rounds):
        for name, first_seed in (("old", 100), ("new", 1100))[::1 if turn % 2 else -1]:
            renders[name].append(Render(builds[name], scene, samples, first_seed + turn, folder / name))
    efficiency, speed, lost = ratios(renders["old"], renders["new"], CONFIDENCE ** (1 / count))
    same = are_same(builds["new"], renders["old"], renders["new"], SIGNIFICANCE / count)
    seconds = statistics.median(render.seconds for render in renders["new"])
    print(f"{scene:22} {samples:7} {seconds:8.2f}  {told(efficiency)}  {told(speed)}  "
          f"{'LESS' if lost else 'ok':4}  {'same' if same else 'DIFFERENT'}", flush=True)
    return efficiency["value"], same and not lost


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", type=pathlib.Path)
    parser.add_argument("new", type=pathlib.Path, nargs="?", default=ROOT / "build" / "vkvol")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--time", type=float, default=2.0)
    parser.add_argument("--scenes", default="", help="those whose name contains this word")
    options = parser.parse_args()
    if options.rounds < 3:
        sys.exit("--rounds: at least 3 are needed for an interval")
    builds = {"old": options.old.resolve(), "new": options.new.resolve()}
    chosen = [scene for scene in SCENES if options.scenes in scene]
    if not chosen:
        sys.exit(f"no scene's name contains {options.scenes!r}")
    print(f"old: {commit_of(builds['old'])}, new: {commit_of(builds['new'])}; {options.rounds} rounds, {WIDTH} pixels wide")
    print(f"{'scene':22} {'samples':>7} {'seconds':>8}  {'efficiency, new over old':22}  {'speed':22}")
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for scene in chosen:
            found.append(measure(scene, builds, options, len(chosen), pathlib.Path(folder)))
    values = [value for value, _ in found if value is not None]
    if values:
        print(f"geometric mean of {len(values)}: {float(np.exp(np.mean(np.log(values)))):.3f}")
    return 0 if values and all(good for _, good in found) else 1


if __name__ == "__main__":
    sys.exit(main())
