#!/usr/bin/env python3
"""Shadow rays to many kinds of light: none where paths find it by themselves (`mis="phase"`), from every collision, and few,
which correct a cache of transmittances. Efficiency, 1 / (error x seconds), over that of every collision's.

    tools/looks_table.py [--build build] [--spp 64] [--runs 3] [--reference 1024] > tools/results/looks.txt

Errors are relMSE against a render of many samples by every collision's shadow rays, less that render's own. Needs NumPy.
"""

import pathlib
import re
import sys
import tempfile

import numpy as np

import table_runs

ROOT = table_runs.ROOT
sys.path.insert(0, str(ROOT / "tools/peers"))
import exr  # noqa: E402

SIZE = ("--width", "128")

SUN_TEXEL = (36, 158)  # of 128 x 256
LIT = {
    "map with a sun texel": '<sky>{map}</sky>',
    "daylight": '<daylight x="0.4" y="0.5" z="0.5" multiplier="0.05"/>',
    "two directional": '<directional x="0.74" y="0.5" z="-0.4" multiplier="6"/><directional x="-0.5" y="1" z="0.2" r="1" g="2" b="3"/>',
}
CLOUDS = {"dense cloud": "scenes/bench/cloud.xml", "demo cloud": "scenes/cumulus.xml"}
GALLERY = ["sunset", "nebula", "thousand_lights"]
WAYS = {"collisions": "ratioTracking", "phase": "ratioTracking:mis=phase", "cached": "cachedRatioTracking"}


def write_map(path):
    """A sky, bright at the horizon, with one texel of 1e5 times its radiance."""
    height, width = 128, 256
    up = np.cos((np.arange(height) + 0.5) / height * np.pi)[:, None, None] * np.ones((height, width, 1))
    sky = np.where(up > 0, np.array([0.3, 0.5, 0.9]) * (1 - 0.6 * up), np.array([0.12, 0.11, 0.1]))
    sky[SUN_TEXEL] = 1e5 * np.array([0.3, 0.27, 0.22])
    exr.write(path, sky, np.zeros_like(sky), 1)


def scenes(folder):
    """(name, scene file, whether paths find all of its light by themselves)"""
    write_map(folder / "sky.exr")
    for cloud, path in CLOUDS.items():
        text = re.sub(r"<light .*?/>|<backgroundColor.*?/>", "", (ROOT / path).read_text())
        text = re.sub(r'baseDir="[^"]*"', f'baseDir="{ROOT}/density_fields"', text)
        for light, xml in LIT.items():
            scene = folder / f"{cloud} {light}.xml".replace(" ", "_")
            scene.write_text(text.replace("</options>", f"<lights>{xml.format(map=folder / 'sky.exr')}</lights></options>"))
            yield f"{cloud}, {light}", scene, "directional" not in light
    for name in GALLERY:
        yield name, ROOT / f"scenes/gallery/{name}.xml", False


def error(picture, reference):
    mean, _, _ = exr.read_rgb(picture)
    right, variance, _ = exr.read_rgb(reference)
    return float(np.mean(((mean - right) ** 2 - variance) / (right**2 + 0.01)))


def main():
    options = table_runs.options(__doc__, spp=64, runs=3, reference=1024)
    vkvol = options.vkvol
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        picture, reference = folder / "a.exr", folder / "reference.exr"
        for number, (case, scene, by_chance) in enumerate(scenes(folder)):
            report = table_runs.render(vkvol, scene, WAYS["collisions"], 1000, options.reference, reference, *SIZE)
            if number == 0:
                print(f"{report['device']['name']}, {report['device']['driver']}; width 128, {options.spp} samples; means of "
                      f"{options.runs} errors, medians of as many seconds, in alternation")
                print(f"{'':36} {'phase':>28} {'cached':>28}   over every collision's shadow ray")
                print(f"{'':36} {'error':>10} {'time':>6} {'efficiency':>10} {'error':>10} {'time':>6} {'efficiency':>10}")
            ways = {way: name for way, name in WAYS.items() if way != "phase" or by_chance}
            means = table_runs.in_alternation(options, scene, ways, picture, lambda made: error(made, reference), *SIZE)
            columns = table_runs.against(means, "collisions")
            print(f"{case:36}{columns('phase')}{columns('cached')}", flush=True)


if __name__ == "__main__":
    main()
