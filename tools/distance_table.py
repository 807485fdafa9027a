#!/usr/bin/env python3
"""Looks from along flights against free flights alone: errors and seconds of `distance="mixed"` over those of `flights`.

    tools/distance_table.py [--build build] [--spp 256] [--runs 3] [--reference 8192] > tools/results/distance.txt

Errors are relMSE against a render of many samples by `mixed`: what free flights find near a light has no variance that an
estimate could be trusted with, and a few pixels may decide. Read them as orders of magnitude.
"""

import json
import pathlib
import subprocess
import tempfile

import table_runs

WAYS = {way: f"ratioTracking:distance={way}" for way in ("flights", "mixed")}
FOG = """<options><box width="20" height="20" depth="20"/>{noise}<sigma_a>0</sigma_a><sigma_s>{sigma}</sigma_s>
<camera z="30" fov="35"/><lights><point x="1" y="1.5" multiplier="10"/></lights><maxDepth>{depth}</maxDepth>
<width>64</width><height>64</height></options>"""
NOISE = '<noise frequency="0.3" octaves="3"/>'
CASES = {
    "single, depth 0.2": {"sigma": 0.01, "depth": 1, "noise": ""},
    "single, depth 2": {"sigma": 0.1, "depth": 1, "noise": ""},
    "single, depth 10": {"sigma": 0.5, "depth": 1, "noise": ""},
    "all, depth 2": {"sigma": 0.1, "depth": 100, "noise": ""},
    "all, depth 10": {"sigma": 0.5, "depth": 100, "noise": ""},
    "noise, single, depth 2": {"sigma": 0.2, "depth": 1, "noise": NOISE},
    "noise, all, depth 2": {"sigma": 0.2, "depth": 100, "noise": NOISE},
}


def error(vkvol, picture, reference):
    compared = subprocess.run([vkvol, "compare", picture, reference, "--json"], capture_output=True, text=True)
    return json.loads(compared.stdout)["relMSE"]


def main():
    options = table_runs.options(__doc__, spp=256, runs=3, reference=8192)
    vkvol = options.vkvol
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        scene, picture, reference = folder / "scene.xml", folder / "a.exr", folder / "reference.exr"
        for number, (case, values) in enumerate(CASES.items()):
            scene.write_text(FOG.format(**values))
            report = table_runs.render(vkvol, scene, WAYS["mixed"], 1000, options.reference, reference)
            if number == 0:
                device = report["device"]
                print(f"{device['name']}, {device['driver']}; a point light in fog, {options.spp} samples; means of "
                      f"{options.runs} errors, medians of as many seconds, in alternation")
                print(f"{'':24} {'error':>10} {'seconds':>6} {'efficiency':>10}   mixed over flights")
            means = table_runs.in_alternation(options, scene, WAYS, picture, lambda made: error(vkvol, made, reference))
            print(f"{case:24}{table_runs.against(means, 'flights')('mixed')}", flush=True)


if __name__ == "__main__":
    main()
