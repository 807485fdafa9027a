#!/usr/bin/env python3
"""Particles from the lights, and paths and particles together, against paths from the camera: efficiency, 1 / (error x seconds), over theirs.

    tools/particles_table.py [--build build] [--spp 64] [--runs 3] [--reference 1024] > tools/results/particles.txt

All render for as long: at equal samples paths from the camera would miss what they seldom find, and be off by no more than that.
Errors are relMSE, of a picture's mean squared where that is dark, against a render of many samples by both together, less that
render's own. The scenes are those of scenes/gallery, 64 pixels wide. Needs NumPy.
"""

import argparse
import pathlib
import sys
import tempfile

import numpy as np

import table_runs

ROOT = table_runs.ROOT
sys.path.insert(0, str(ROOT / "tools/peers"))
import exr  # noqa: E402

SIZE = ("--width", "64")
SCENES = ("lantern", "room", "materials", "nebula", "lamps_in_fog")
CAMERA, LIGHT, BOTH = "ratioTracking", "lightTracing", "bidirectional"
SMOOTH = ("room", "materials")  # of which particles alone miss what mirrors and glass show


def error(picture, reference):
    mean, _, _ = exr.read_rgb(picture)
    right, variance, _ = exr.read_rgb(reference)
    return float(np.mean(((mean - right) ** 2 - variance) / (right**2 + 0.01 * np.mean(right) ** 2)))


def main():
    options = table_runs.options(__doc__, spp=64, runs=3, reference=1024)
    with tempfile.TemporaryDirectory() as name:
        picture, reference = pathlib.Path(name) / "a.exr", pathlib.Path(name) / "reference.exr"
        for number, scene in enumerate(SCENES):
            path = ROOT / f"scenes/gallery/{scene}.xml"
            report = table_runs.render(options.vkvol, path, BOTH, 1000, options.reference, reference, *SIZE)
            if number == 0:
                print(f"{report['device']['name']}, {report['device']['driver']}; as long as {options.spp} samples of {BOTH} take; means "
                      f"of {options.runs} errors, medians of as many seconds, in alternation")
                print(f"{'':16} {LIGHT:>28} {BOTH:>28}   over {CAMERA}")
                print(f"{'':16} {'error':>10} {'time':>6} {'efficiency':>10} {'error':>10} {'time':>6} {'efficiency':>10}")
            ways = {way: way for way in (CAMERA, LIGHT, BOTH) if way != LIGHT or scene not in SMOOTH}
            usual = table_runs.render(options.vkvol, path, BOTH, 999, options.spp, picture, *SIZE)["seconds"]["render"]
            timed = argparse.Namespace(**{**vars(options), "spp": 1_000_000})
            means = table_runs.in_alternation(timed, path, ways, picture, lambda made: error(made, reference), *SIZE,
                                              "--time", f"{usual}s")
            columns = table_runs.against(means, CAMERA)
            print(f"{scene:16}{columns(LIGHT)}{columns(BOTH)}", flush=True)


if __name__ == "__main__":
    main()
