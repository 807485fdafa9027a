#!/usr/bin/env python3
"""One cloud a thousand times: what a path costs, what is loaded and uploaded, beside the same cloud seen alone.

    tools/instances_table.py [--build build] [--spp 48] [--runs 3] > tools/results/instances.txt

The same camera looks at the same cloud, alone or before the others of a field of ten by ten by ten, through a window of the picture
that lies within the cloud's outline, so that every path meets it ("near"); and at the field from afar, through a window within
its outline, beside a cloud alone that fills the same window ("far"). A haze thirty times as wide as the cloud stands for small
media in wide ones. Clouds differ in size, and are turned and mirrored; they keep their optical depth. Seconds are medians of --runs, in
alternation.
"""

import math
import pathlib
import random
import statistics
import tempfile

import table_runs

ROOT = table_runs.ROOT
EDGE = 10
SPACING = (72.0, 44.0, 66.0)  # world units: the cloud measures 59 x 37 x 41
MIDDLE = (0.0, 18.6, 0.0)  # of the cloud
LIGHT = '<light x="0.74" y="0.5" z="-0.4" r="1" g="0.92" b="0.78" multiplier="6"/><backgroundColor r="0.12" g="0.26" b="0.56"/>'
SIZE = '<width reference="480">480</width><height reference="270">270</height>'
NEAR = '<camera x="0" y="5" z="78" pitch="10" fov="31"/>'
NEAR_WINDOW = "170,310,90,170"
FAR_WINDOW = "140,340,60,210"
HAZE = ('<volume name="haze"><box y="20" width="1800" height="300" depth="1800"/><sigma_a>0</sigma_a><sigma_s>0.0008</sigma_s>'
        "<heyneygreenstein_g>0.7</heyneygreenstein_g></volume>")


def cloud():
    """Coefficients of scenes/cumulus.xml, per voxel, so that copies of any size have its optical depth."""
    voxel = 0.1379
    return (f'<volume name="cloud"><densityField baseDir="{ROOT}/density_fields">cumulus.nvdb</densityField>'
            f"<sigma_a>{0.07 * voxel}</sigma_a><sigma_s>{2.5 * voxel}</sigma_s><heyneygreenstein_g>0.3</heyneygreenstein_g></volume>")


def copies():
    """All but the first, which stands in the middle of the front."""
    draw = random.Random(1)
    for i in range(EDGE):
        for j in range(EDGE):
            for k in range(EDGE):
                place = (i - 5, j - 5, -k)
                if place == (0, 0, 0):
                    continue
                to = [s * p + draw.uniform(-4, 4) for s, p in zip(SPACING, place)]
                size, turn = draw.uniform(0.7, 1.0), draw.uniform(-25, 25) + 180 * draw.randrange(2)
                mirror = draw.choice((-1, 1)) * size
                yield (f'<volume like="cloud"><transform><scale x="{mirror:.3f}" y="{size:.3f}" z="{size:.3f}"/>'
                       f'<rotate y="1" angle="{turn:.1f}"/>'
                       f'<translate x="{to[0]:.2f}" y="{to[1]:.2f}" z="{to[2]:.2f}"/></transform></volume>')


def far_camera(distance, edge):
    """That has `edge` world units about the middle of the field in its height of 270 pixels."""
    middle = (-0.5 * SPACING[0], MIDDLE[1] - 0.5 * SPACING[1], -4.5 * SPACING[2])
    fov = math.degrees(2 * math.atan(0.5 * edge / distance))
    return (f'<camera lookAt="{middle[0]} {middle[1]} {middle[2]}" distance="{distance}" azimuth="25" elevation="20" '
            f'fov="{fov:.4f}"/>')


def scene(folder, name, volumes, camera):
    path = folder / f"{name}.xml"
    path.write_text(f"<options><volumes>{''.join(volumes)}</volumes>{camera}{LIGHT}{SIZE}</options>")
    return path


def cases(folder):
    """(name, scene, window), after each cloud alone what is to be compared with it."""
    field = [cloud(), *copies()]
    yield "near: one cloud", scene(folder, "one", [cloud()], NEAR), NEAR_WINDOW
    yield "near: a thousand", scene(folder, "thousand", field, NEAR), NEAR_WINDOW
    yield "near: one cloud in haze", scene(folder, "haze", [cloud(), HAZE], NEAR), NEAR_WINDOW
    yield "near: a thousand in haze", scene(folder, "thousand_haze", [*field, HAZE], NEAR), NEAR_WINDOW
    alone = '<camera lookAt="0 18.6 0" distance="90" azimuth="25" elevation="20" fov="25"/>'
    yield "far: one cloud", scene(folder, "far_one", [cloud()], alone), FAR_WINDOW
    yield "far: a thousand", scene(folder, "far_thousand", field, far_camera(2600.0, 900.0)), FAR_WINDOW


def main():
    options = table_runs.options(__doc__, spp=48, runs=3)
    print(__doc__.split("\n\n")[0] + "\nPrinted by tools/instances_table.py, which says how it is measured.\n")
    print(f"{'':26} {'k samples/s':>11} {'cost':>6} {'look-ups':>9} {'cells':>7} {'load s':>7} {'upload s':>9} {'host MiB':>9} "
          f"{'device MiB':>11} {'grids':>9} {'cells k':>8} {'listed k':>9}")
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        listed = list(cases(folder))
        for integrator in ("ratioTracking", "cachedRatioTracking"):
            print(f"\n{integrator}")
            reports = {name: [] for name, *_ in listed}
            for run in range(options.runs):
                for name, path, window in listed:
                    reports[name].append(table_runs.render(options.vkvol, path, integrator, run, options.spp,
                                                           folder / "picture.exr", "--crop", window))
            for name, *_ in listed:
                rows = reports[name]
                rate = statistics.median(r["perSecond"]["samples"] for r in rows)
                if "one cloud" in name:
                    alone = rate
                one = rows[0]
                counts, memory, media = one["counts"], one["memory"], one.get("media", {})
                paths = counts["paths"]
                print(f"{name:26} {rate / 1e3:11.1f} {alone / rate:6.2f} {counts['densityLookups'] / paths:9.1f} "
                      f"{counts['majorantCells'] / paths:7.1f} {one['seconds']['load']:7.2f} {one['seconds']['upload']:9.2f} "
                      f"{memory['peakHostBytes'] / 2**20:9.0f} {memory['deviceBytes'] / 2**20:11.1f} "
                      f"{media.get('distinctGrids', 0):>4}/{media.get('grids', 0):<4} {media.get('cells', 0) / 1e3:8.0f} "
                      f"{media.get('listed', 0) / 1e3:9.0f}", flush=True)


if __name__ == "__main__":
    main()
