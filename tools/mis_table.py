#!/usr/bin/env python3
"""Looks, flights and their mixtures: 1 / (variance x seconds) of each `mis`, over that of the better of `light` and `phase`.

    tools/mis_table.py [--build build] [--spp 256] [--runs 3] > tools/results/mis.txt

A cloud of noise under one light at a time, by one phase function at a time. Variances are the picture's own estimates; where
a single technique seldom finds what it looks for they are too low, and it looks better than it is.
"""

import pathlib
import statistics
import tempfile

import table_runs

LIGHTS = {
    "sun, 0.53 degrees": '<sun x="0.4" y="1" z="0.5" r="8" g="8" b="8"/>',
    "sun, 10 degrees": '<sun x="0.4" y="1" z="0.5" r="8" g="8" b="8" angle="10"/>',
    "sun, 120 degrees": '<sun x="0.4" y="1" z="0.5" r="8" g="8" b="8" angle="120"/>',
    "daylight": '<daylight x="0.4" y="0.5" z="0.5" multiplier="0.05"/>',
    "ball, far": '<sphere x="8" y="6" z="4" radius="1" multiplier="60"/>',
    "ball, near": '<sphere x="0" y="3.2" z="0.5" radius="0.8" multiplier="10"/>',
    "rectangle": '<rectangle x="0" y="4" z="0" lookAt="0 0 0" up="0 0 1" width="5" height="5" multiplier="3"/>',
}
PHASES = {
    "g 0": "",
    "g 0.6": "<heyneygreenstein_g>0.6</heyneygreenstein_g>",
    "g 0.9": "<heyneygreenstein_g>0.9</heyneygreenstein_g>",
    "droplets 2": '<phase diameter="2">droplets</phase>',
}
SCENE = """<options><sphere radius="2.5"/><noise frequency="0.8" octaves="3"/><sigma_a>0.02</sigma_a><sigma_s>2</sigma_s>{phase}
<camera x="0" y="0" z="12" fov="28"/><lights>{light}</lights><width>48</width><height>48</height></options>"""


def efficiency(vkvol, scene, mis, seed, spp, folder):
    report = table_runs.render(vkvol, scene, f"ratioTracking:distance=flights:mis={mis}", seed, spp, folder / "a.exr")
    noise = report["noise"] or float("inf")  # none is known where no light was found
    return 1 / (noise**2 * report["seconds"]["render"]), report["device"]


def main():
    options = table_runs.options(__doc__, spp=256, runs=3)
    vkvol = options.vkvol
    ways = ["light", "phase", "balance", "power"]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        first = True
        for light, light_xml in LIGHTS.items():
            for phase, phase_xml in PHASES.items():
                scene = folder / "scene.xml"
                scene.write_text(SCENE.format(phase=phase_xml, light=light_xml))
                found = {way: [] for way in ways}
                for run in range(options.runs):
                    for way in ways:
                        value, device = efficiency(vkvol, scene, way, run + 1, options.spp, folder)
                        found[way].append(value)
                if first:
                    print(f"{device['name']}, {device['driver']}; medians of {options.runs}, in alternation; {options.spp} samples")
                    print(f"{'light':20} {'phase function':14} " + " ".join(f"{way:>8}" for way in ways))
                    first = False
                median = {way: statistics.median(values) for way, values in found.items()}
                best = max(median["light"], median["phase"])
                print(f"{light:20} {phase:14} " + " ".join(f"{median[way] / best:8.3f}" for way in ways), flush=True)


if __name__ == "__main__":
    main()
