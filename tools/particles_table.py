#!/usr/bin/env python3
"""Particles from the lights, and paths and particles together, against paths from the camera: efficiency, 1 / (error x seconds), over theirs.

    tools/particles_table.py [--build build] [--spp 64] [--runs 6] [--reference 1024] [SCENE ...] > tools/results/particles.txt

All render for as long: at equal samples paths from the camera would miss what they seldom find. Errors are mean relative squares of blocks
of 4 x 4 pixels against a render of many samples by both together, less that render's own variance; geometric means of the runs, in
alternation, with the interval of 95 %, and behind them the efficiency of mean errors and mean seconds, which is what it is by
definition: where few runs have most of the error they say more than the middle one, and want many runs. The scenes are those of
scenes/gallery (by default five of them), 64 pixels wide. Needs NumPy.
"""

import pathlib
import tempfile

import block_errors
import table_runs

SIZE = ("--width", "64")
SCENES = ("lantern", "room", "materials", "nebula", "lamps_in_fog")
CAMERA, LIGHT, BOTH = "ratioTracking", "lightTracing", "bidirectional"
SMOOTH = ("room", "materials")  # of which particles alone miss what mirrors and glass show
MOST = 1_000_000  # samples: the time ends them


def main():
    options = table_runs.options(__doc__, scenes=SCENES, spp=64, runs=6, reference=1024)
    print(f"{table_runs.driver_of(options.vkvol)}, commit {table_runs.commit_of(options.vkvol)}; as long as {options.spp} samples of {BOTH} "
          f"take, {options.runs} runs; over {CAMERA}\n{'':16}{'':14}{block_errors.HEAD}  {'of means':>9}  {'interval':>17}")
    with tempfile.TemporaryDirectory() as name:
        picture, reference = pathlib.Path(name) / "a.exr", pathlib.Path(name) / "reference.exr"
        for scene in options.scenes:
            path = table_runs.ROOT / f"scenes/gallery/{scene}.xml"
            table_runs.render(options.vkvol, path, BOTH, 1000, options.reference, reference, *SIZE)
            truth = block_errors.Truth.of(reference)
            usual = table_runs.render(options.vkvol, path, BOTH, 999, options.spp, picture, *SIZE)["seconds"]["render"]
            options.spp, spp = MOST, options.spp
            ways = {way: (options.vkvol, way) for way in (CAMERA, LIGHT, BOTH) if way != LIGHT or scene not in SMOOTH}
            found = block_errors.in_alternation(options, path, ways, picture, truth.relative_error, *SIZE, "--time", f"{usual}s")
            options.spp = spp
            for way in ways:
                if way != CAMERA:
                    print(f"{scene:16}{way:14}{block_errors.columns(found, way, CAMERA)}  "
                          f"{block_errors.of_means(found, way, CAMERA)}", flush=True)


if __name__ == "__main__":
    main()
