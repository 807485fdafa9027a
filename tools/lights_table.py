#!/usr/bin/env python3
"""Many lights in fog: the tree of lights against a choice in which all count alike, and how long it takes to begin.

    tools/lights_table.py --even VKVOL [--build build] [--spp 64] [--runs 5] [--reference 4096] > tools/results/lights.txt

VKVOL: the program built of these sources after `tools/lights_table.py --make-even SOURCES`, which gives all lights of a copy of them the
same power and lets the tree go by it alone. Points of powers over three decades, in a cube of fog; paths of any length. Errors are mean
relative squares of blocks of 4 x 4 pixels against a render of many samples by the tree, less that one's variance; geometric means of the
runs, in alternation, with the interval of 95 %. `begins`: seconds from the file to the device, of one render's report. Needs NumPy."""

import argparse
import pathlib
import sys
import tempfile

import numpy as np

import block_errors
import table_runs

INTEGRATOR = "ratioTracking:distance=mixed"  # by free flights alone what is near a point has no variance
COUNTS = (10, 100, 1000, 10_000, 100_000)
SCENE = """<options><box width="20" height="20" depth="20"/>{noise}<sigma_a>0.005</sigma_a><sigma_s>0.1</sigma_s>
<heyneygreenstein_g>0.5</heyneygreenstein_g><camera z="34" fov="34"/><lights>{lights}</lights><width>64</width><height>64</height></options>"""
MEDIA = {"even fog": "", "noise": '<noise frequency="0.3" octaves="3"/>'}
ALIKE = (
    ("host/device_scene/light_table.cpp", "std::max(power, 1e-30f)", "1.0f"),
    ("host/device_scene/light_table.cpp", "std::max(power * static_cast<float>(entry.by_cone), 1e-30f)", "1.0f"),
    ("shaders/lights/tree.glsl", "if (lit.extent > 0.0)", "if (node.power > 0.0)"),
    ("shaders/lights/tree.glsl", "return node.power_in_matter * gathered(lit, apart, half_square, least);", "return node.power;"),
)


def make_even(sources):
    for name, old, new in ALIKE:
        path = pathlib.Path(sources) / name
        text = path.read_text()
        if text.count(old) != 1:
            sys.exit(f"{path}: '{old}' is not in it just once")
        path.write_text(text.replace(old, new))


def points(count):
    random = np.random.default_rng(1)
    places, powers = random.uniform(-10.0, 10.0, (count, 3)), 10.0 ** random.uniform(0.0, 3.0, count)
    powers *= 300.0 / powers.sum()
    return "".join(f'<point x="{x:.4f}" y="{y:.4f}" z="{z:.4f}" multiplier="{power:.4g}"/>' for (x, y, z), power in zip(places, powers))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--make-even", metavar="SOURCES")
    parser.add_argument("--even", metavar="VKVOL")
    parser.add_argument("--build", default=table_runs.ROOT / "build")
    for name, value in {"spp": 64, "runs": 5, "reference": 4096}.items():
        parser.add_argument(f"--{name}", type=int, default=value)
    options = parser.parse_args()
    if options.make_even:
        return make_even(options.make_even)
    if not options.even:
        parser.error("--even: which program chooses evenly?")
    vkvol = str(pathlib.Path(options.build).resolve() / "vkvol")
    ways = {"tree": (vkvol, INTEGRATOR), "even": (options.even, INTEGRATOR)}
    print(f"{table_runs.driver_of(vkvol)}, commit {table_runs.commit_of(vkvol)}; {options.spp} samples, {options.runs} runs\n"
          f"{'lights':>7}  {'medium':10} {'begins':>7} {block_errors.HEAD}   tree over even")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        scene, picture, reference = folder / "scene.xml", folder / "a.exr", folder / "reference.exr"
        for count in COUNTS:
            for medium, noise in MEDIA.items():
                scene.write_text(SCENE.format(noise=noise, lights=points(count)))
                report = table_runs.render(vkvol, scene, INTEGRATOR, 1000, options.reference, reference)
                begins = report["seconds"]["load"] + report["seconds"]["upload"]
                truth = block_errors.Truth.of(reference)
                found = block_errors.in_alternation(options, scene, ways, picture, truth.relative_error)
                print(f"{count:7}  {medium:10} {begins:7.2f} {block_errors.columns(found, 'tree', 'even')}", flush=True)


if __name__ == "__main__":
    main()
