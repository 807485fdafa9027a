#!/usr/bin/env python3
"""Shadow rays to many kinds of light: none where paths find it by themselves (`mis="phase"`), from every collision, and few,
which correct a cache of transmittances. Efficiency, 1 / (error x seconds), over that of every collision's.

    tools/looks_table.py [--build build] [--spp 64] [--runs 5] [--reference 2048] > tools/results/looks.txt

Errors are mean relative squares of blocks of 4 x 4 pixels against a render of many samples by every collision's shadow rays, less that
render's own variance; geometric means of the runs, in alternation, with the interval of 95 %. `spikes`: pixels of a render that are above the
mean of their eight neighbours by more than 5 standard errors, the median of the neighbours' as the long render knows them for so many samples,
and in the long render by less than half of that. Needs NumPy."""

import pathlib
import re
import statistics
import tempfile

import numpy as np

import block_errors
import table_runs
from block_errors import exr

ROOT = table_runs.ROOT
SIZE = ("--width", "128", "--height", "72")

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


def about(image):
    """[8, row, column] of the neighbours of all but the outermost."""
    rows, columns = image.shape
    return np.stack([image[1 + y:rows - 1 + y, 1 + x:columns - 1 + x] for y in (-1, 0, 1) for x in (-1, 0, 1) if x or y])


def spikes(picture, reference, fewer):
    """How many pixels stick out of their neighbours as those of a long render do not, by the mean of the channels. `fewer`: samples than there."""
    def sticking_out(path):
        mean, variance, _ = exr.read_rgb(path)
        mean, error = mean.mean(axis=2), np.sqrt(variance.mean(axis=2))
        return mean[1:-1, 1:-1] - about(mean).mean(axis=0), np.median(about(error), axis=0)
    out, _ = sticking_out(picture)
    confirmed, error = sticking_out(reference)
    return int(np.sum((out > 5.0 * np.sqrt(fewer) * error) & (confirmed < 0.5 * out)))


def main():
    options = table_runs.options(__doc__, spp=64, runs=5, reference=2048)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        picture, reference = folder / "a.exr", folder / "reference.exr"
        print(f"{table_runs.driver_of(options.vkvol)}, commit {table_runs.commit_of(options.vkvol)}; 128 x 72, {options.spp} samples, "
              f"{options.runs} runs\n{'':30}{'spikes':>7}   way     {block_errors.HEAD}  {'spikes':>7}")
        for case, scene, by_chance in scenes(folder):
            table_runs.render(options.vkvol, scene, WAYS["collisions"], 1000, options.reference, reference, *SIZE)
            truth, found_spikes = block_errors.Truth.of(reference), {way: [] for way in WAYS}
            ways = {way: (options.vkvol, integrator) for way, integrator in WAYS.items() if way != "phase" or by_chance}
            turn = iter(list(ways) * options.runs)  # as in_alternation goes

            def error(made):
                found_spikes[next(turn)].append(spikes(made, reference, options.reference / options.spp))
                return truth.relative_error(made)
            found = block_errors.in_alternation(options, scene, ways, picture, error, *SIZE)
            for way in ways:
                if way != "collisions":
                    print(f"{case:30}{statistics.mean(found_spikes['collisions']):7.1f}   {way:7} "
                          f"{block_errors.columns(found, way, 'collisions')}  {statistics.mean(found_spikes[way]):7.1f}", flush=True)


if __name__ == "__main__":
    main()
