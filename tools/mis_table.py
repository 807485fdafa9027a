#!/usr/bin/env python3
"""Looks, flights and their mixtures: the efficiency 1 / (error x seconds) of each `mis` over that of the better of `light` and `phase`.

    tools/mis_table.py [--build build] [--spp 128] [--runs 5] [--lights WORD] > tools/results/mis.txt

A cloud of noise under one light at a time, by one phase function at a time. The error is the mean square against a render of `balance`
of 32 times as many samples, less what that one's own variance adds, over the mean square of that; of blocks of 4 x 4 pixels, so that a
technique that seldom finds its light has an error that tells: it is what is missing. Geometric means of the runs, in alternation, and for
`default`, which is `balance` but for skies that are nearly even, the interval of 95 %. LESS: it is below 0.7, by intervals that all hold together with 95 % (Sidak); `open`:
its mean is, and that may be by chance. Needs NumPy."""

import argparse
import pathlib
import struct
import sys
import tempfile

import numpy as np

import block_errors
import table_runs

LEAST, CONFIDENCE = 0.7, 0.95
LIGHTS = {
    "sun, 0.53 degrees": '<sun x="0.4" y="1" z="0.5" r="8" g="8" b="8"/>',
    "sun, 10 degrees": '<sun x="0.4" y="1" z="0.5" r="8" g="8" b="8" angle="10"/>',
    "sun, 120 degrees": '<sun x="0.4" y="1" z="0.5" r="8" g="8" b="8" angle="120"/>',
    "daylight": '<daylight x="0.4" y="0.5" z="0.5" multiplier="0.05"/>',
    "map, a sun of 1e5": "<sky>sun.hdr</sky>",
    "map, a gradient": "<sky>gradient.hdr</sky>",
    "ball, far": '<sphere x="8" y="6" z="4" radius="1" multiplier="60"/>',
    "ball, near": '<sphere x="0" y="3.2" z="0.5" radius="0.8" multiplier="10"/>',
    "disk": '<disk x="3" y="2" z="1" lookAt="0 0 0" radius="1" multiplier="15"/>',
    "rectangle": '<rectangle x="0" y="4" z="0" lookAt="0 0 0" up="0 0 1" width="5" height="5" multiplier="3"/>',
    "box that shines": '<box x="2.6" y="2.2" z="1" width="1.2" height="0.8" depth="1" r="0" g="0" b="0"><emission multiplier="15"/></box>',
    "tube that shines": '<box y="3.2" width="6" height="0.05" depth="0.05" r="0" g="0" b="0"><emission multiplier="90"/></box>',
}
PHASES = {
    "g 0": "",
    "g 0.6": "<heyneygreenstein_g>0.6</heyneygreenstein_g>",
    "g 0.9": "<heyneygreenstein_g>0.9</heyneygreenstein_g>",
    "g -0.5": "<heyneygreenstein_g>-0.5</heyneygreenstein_g>",
    "double": '<heyneygreenstein_g>0.8</heyneygreenstein_g><phase second="-0.4" share="0.15">doubleHenyeyGreenstein</phase>',
    "Rayleigh": "<phase>rayleigh</phase>",
    "Draine": '<heyneygreenstein_g>0.6</heyneygreenstein_g><phase alpha="1">draine</phase>',
    "droplets 2": '<phase diameter="2">droplets</phase>',
    "droplets 20": '<phase diameter="20">droplets</phase>',
    "table": f'<phase file="{table_runs.ROOT / "scenes/gallery/fogbow.txt"}">table</phase>',
}
SCENE = """<options><sphere radius="2.5"/><noise frequency="0.8" octaves="3"/><sigma_a>0.02</sigma_a><sigma_s>2</sigma_s>{phase}
<camera x="0" y="0" z="12" fov="28"/>{light}<width>48</width><height>48</height></options>"""
WAYS = {way: f"ratioTracking:distance=flights:mis={way}" for way in ("light", "phase", "balance", "power")} | {"default": "ratioTracking:distance=flights"}


def write_map(path, radiance):
    """[row, column] as Radiance's .hdr of 8 bits and a common exponent, grey."""
    rows, columns = radiance.shape
    mantissa, exponent = np.frexp(radiance)
    texels = b"".join(struct.pack("4B", *[int(m * 255)] * 3, 128 + int(e)) for m, e in zip(mantissa.flat, exponent.flat))
    path.write_bytes(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {rows} +X {columns}\n".encode() + texels)


def write_maps(folder):
    sun = np.full((32, 64), 0.2)
    sun[9, 40] = 0.2e5
    write_map(folder / "sun.hdr", sun)
    write_map(folder / "gradient.hdr", np.linspace(2.0, 0.1, 16)[:, None] * np.ones((16, 32)))


def scene_of(light, phase):
    held = f"<surfaces>{light}</surfaces>" if light.startswith("<box") else f"<lights>{light}</lights>"
    return SCENE.format(phase=phase, light=held)


def line_of(found, confidence):
    """Of each way the efficiency over that of the better of `light` and `phase`, and the verdict."""
    best = max(("light", "phase"), key=lambda way: block_errors.ratios(found, way, "balance")[2]["value"])
    over = {way: block_errors.ratios(found, way, best)[2]["value"] for way in WAYS}
    known = block_errors.ratios(found, "default", best)[2]
    most = min(block_errors.ratios(found, "default", way, confidence)[2]["high"] for way in ("light", "phase"))
    verdict = "LESS" if most < LEAST else "ok" if over["default"] >= LEAST else "open"
    return " ".join(f"{over[way]:8.3f}" for way in WAYS) + f"   {known['low']:6.3f} {known['high']:6.3f}  {verdict}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=table_runs.ROOT / "build")
    parser.add_argument("--spp", type=int, default=128)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--lights", default="", help="those whose name contains this word")
    options = parser.parse_args()
    if options.runs < 3:
        sys.exit("--runs: at least 3 are needed for an interval")
    options.vkvol = str(pathlib.Path(options.build).resolve() / "vkvol")
    lights = {name: xml for name, xml in LIGHTS.items() if options.lights in name}
    if not lights:
        parser.error(f"no light's name contains {options.lights}")
    confidence = CONFIDENCE ** (1 / (2 * len(LIGHTS) * len(PHASES)))  # against light and against phase
    ways = {way: (options.vkvol, integrator) for way, integrator in WAYS.items()}
    print(f"{table_runs.driver_of(options.vkvol)}, commit {table_runs.commit_of(options.vkvol)}; geometric means of {options.runs}, in "
          f"alternation; {options.spp} samples\n{'light':20} {'phase function':14} " + " ".join(f"{way:>8}" for way in WAYS)
          + "   default, interval")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_maps(folder)
        scene, picture = folder / "scene.xml", folder / "a.exr"
        for light, light_xml in lights.items():
            for phase, phase_xml in PHASES.items():
                scene.write_text(scene_of(light_xml, phase_xml))
                table_runs.render(options.vkvol, scene, ways["balance"][1], 1000, 32 * options.spp, picture)
                truth = block_errors.Truth.of(picture)
                found = block_errors.in_alternation(options, scene, ways, picture, truth.error)
                print(f"{light:20} {phase:14} {line_of(found, confidence)}", flush=True)


if __name__ == "__main__":
    main()
