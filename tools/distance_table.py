#!/usr/bin/env python3
"""Looks from along flights against free flights alone: `distance="mixed"` over `flights`, lamps in fog.

    tools/distance_table.py [--build build] [--spp 256] [--runs 5] [--reference 16384] > tools/results/distance.txt

Errors are mean relative squares of blocks of 4 x 4 pixels, against a render of many samples by `mixed`, less that one's own variance; of a
point in endless fog that scatters once, against its integral along rays. Geometric means of the runs, in alternation, with the interval of
95 %: what free flights find near a point has no variance, a few pixels may decide, and the interval is of what was seen. Needs NumPy."""

import pathlib
import tempfile

import numpy as np

import block_errors
import table_runs
from block_errors import Truth

WAYS = {way: f"ratioTracking:distance={way}" for way in ("flights", "mixed")}
LIGHTS = {
    "point": '<point x="1" y="1.5" multiplier="10"/>',
    "spot": '<spot x="1" y="4" lookAt="0 -3 0" angle="30" multiplier="60"/>',
    "ball": '<sphere x="1" y="1.5" radius="0.2" multiplier="80"/>',
    "rectangle": '<rectangle x="1" y="3" lookAt="0 -3 0" up="0 0 1" width="0.6" height="0.6" multiplier="60"/>',
}
SCENE = """<options>{shape}{noise}<sigma_a>0</sigma_a><sigma_s>{sigma}</sigma_s>
<camera z="30" fov="{fov}"/><lights>{light}</lights><maxDepth>{depth}</maxDepth><width>64</width><height>64</height></options>"""
FOG = {"shape": '<box width="20" height="20" depth="20"/>', "noise": "", "fov": 35}
NOISE = '<noise frequency="0.3" octaves="3"/>'
MEDIA = {
    "once, depth 0.2": FOG | {"sigma": 0.01, "depth": 1},
    "once, depth 2": FOG | {"sigma": 0.1, "depth": 1},
    "once, depth 10": FOG | {"sigma": 0.5, "depth": 1},
    "depth 2": FOG | {"sigma": 0.1, "depth": 100},
    "depth 10": FOG | {"sigma": 0.5, "depth": 100},
    "noise, once, depth 2": FOG | {"sigma": 0.2, "depth": 1, "noise": NOISE},
    "noise, depth 2": FOG | {"sigma": 0.2, "depth": 100, "noise": NOISE},
}
# The camera's distance from the origin, the point's from it, and its intensity.
ENDLESS = {"sigma": 0.03, "far": 30.0, "intensity": 10.0, "fov": 10.0}


def airlight(pixels=64, across=32, angles=256):
    """Of a point at the origin, in endless fog that scatters once and evenly, seen from `far` away: [row, column, channel] of pixels, by
    midpoints of `across` squared rays of each, and along a ray of the angle at the point, in which its light is even: no pole is left."""
    sigma, far = ENDLESS["sigma"], ENDLESS["far"]
    half = np.tan(np.radians(0.5 * ENDLESS["fov"]))
    places = ((np.arange(pixels * across) + 0.5) / (pixels * across) * 2.0 - 1.0) * half
    off = np.arctan(np.hypot(places[:, None], places[None, :])).ravel()
    least = off - 0.5 * np.pi  # from the foot of the perpendicular, of the ray's beginning; it ends at pi / 2
    radiance = np.zeros_like(off)
    for k in range(angles):
        angle = least + (k + 0.5) / angles * (0.5 * np.pi - least)
        aside = far * np.sin(off)
        along = far * np.cos(off) + aside * np.tan(angle)
        radiance += np.exp(-sigma * (along + aside / np.cos(angle))) * (0.5 * np.pi - least) / (angles * aside)
    radiance *= sigma / (4.0 * np.pi) * ENDLESS["intensity"]
    mean = radiance.reshape(pixels, across, pixels, across).mean(axis=(1, 3))
    return np.repeat(mean[:, :, None], 3, axis=2)


def main():
    options = table_runs.options(__doc__, spp=256, runs=5, reference=16384)
    ways = {way: (options.vkvol, integrator) for way, integrator in WAYS.items()}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        scene, picture, reference = folder / "scene.xml", folder / "a.exr", folder / "reference.exr"

        def row(case, truth):
            found = block_errors.in_alternation(options, scene, ways, picture, truth.relative_error)
            print(f"{case:32}{block_errors.columns(found, 'mixed', 'flights')}", flush=True)

        print(f"{table_runs.driver_of(options.vkvol)}, commit {table_runs.commit_of(options.vkvol)}; {options.spp} samples, {options.runs} "
              f"runs\n{'':32}{block_errors.HEAD}   mixed over flights")
        scene.write_text(SCENE.format(shape="<everywhere/>", noise="", depth=1, sigma=ENDLESS["sigma"], fov=ENDLESS["fov"],
                                      light=f'<point multiplier="{ENDLESS["intensity"]}"/>'))
        row("point in endless fog, once", Truth(block_errors.in_blocks(airlight())))
        for light, xml in LIGHTS.items():
            for medium, values in MEDIA.items():
                scene.write_text(SCENE.format(light=xml, **values))
                table_runs.render(options.vkvol, scene, WAYS["mixed"], 1000, options.reference, reference)
                row(f"{light}, {medium}", Truth.of(reference))


if __name__ == "__main__":
    main()
