#!/usr/bin/env python3
"""Small .pbrt scenes, one for each feature, as vkvol renders them, against what pbrt-v4 made of them.

    python3 tools/peers/pbrt_features.py [--vkvol build/vkvol] [--spp N] [WORD ...]     the table; words choose scenes
    python3 tools/peers/pbrt_features.py --pbrt PBRT [--seeds 4] [WORD ...]             renders pbrt's pictures anew

pbrt's side is kept in tests/pbrt_features/pbrt.json: means of the picture and of 4 x 3 blocks of it, with standard errors
from the differences of pixels between renders of several seeds. A scene agrees if all means do by Sidak's limit, over all
figures of the table together at 1 %, or are within the part by which the two programs differ by what they are (`apart` in
differences.json, with the reason): such are called apart, not the same, and the part is what was seen when the reason was
found, rounded up, so that it guards what is known and proves nothing. By default 1/1000, for rounding. Exit code 1 if one
does not.
"""
import argparse
import json
import math
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import exr

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ROOT / "tests/pbrt_features"
RECORDS = SCENES / "pbrt.json"
BLOCKS = (3, 4)  # rows, columns
USUAL = 1e-3     # of the mean


def blocks(pixels):
    """Means over the picture and over its blocks: [1 + 12, channels]."""
    parts = [block for row in np.array_split(pixels, BLOCKS[0]) for block in np.array_split(row, BLOCKS[1], axis=1)]
    return np.array([part.mean(axis=(0, 1)) for part in [pixels, *parts]])


def pixels_of_blocks(shape):
    return np.array([part.size for part in [np.zeros(shape), *(block for row in np.array_split(np.zeros(shape), BLOCKS[0])
                                                               for block in np.array_split(row, BLOCKS[1], axis=1))]])


def run(command, scene):
    result = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if result.returncode:
        sys.exit(f"{scene.name}: {command[0]} failed: {result.stdout[-500:]}")


def record(pbrt, seeds, scene, folder):
    """What pbrt makes of it."""
    pictures = []
    for seed in range(1, seeds + 1):
        picture = folder / f"{seed}.exr"
        run([pbrt, "--quiet", "--seed", seed, "--outfile", picture, scene], scene)
        pictures.append(exr.read_rgb(picture)[0])
    pictures = np.array(pictures)
    variance = blocks(pictures.var(axis=0, ddof=1)) / seeds / pixels_of_blocks(pictures.shape[1:3])[:, None]

    def numbers(values):
        return [[float(f"{value:.5g}") for value in row] for row in values]
    return {"means": numbers(blocks(pictures.mean(axis=0))), "errors": numbers(np.sqrt(variance))}


def two_sided(z):
    return math.erfc(abs(z) / math.sqrt(2.0))


def judge(vkvol, spp, scene, theirs, folder):
    """Ratio of the means, largest z, and the largest difference of a block in parts of the picture's mean."""
    picture = folder / "vkvol.exr"
    run([vkvol, scene, "-q", "-o", picture, *(["--spp", spp] if spp else [])], scene)
    mean, variance, _ = exr.read_rgb(picture)
    ours = blocks(mean)
    errors = np.sqrt(blocks(variance) / pixels_of_blocks(mean.shape[:2])[:, None] + np.array(theirs["errors"]) ** 2)
    other = np.array(theirs["means"])
    z = (ours - other) / np.maximum(errors, 1e-12)
    apart = np.abs(ours - other) / np.maximum(np.maximum(other, other[0]), 1e-12)
    return ours[0] / np.maximum(other[0], 1e-12), z, apart


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("words", nargs="*", help="of scenes' names; none: all")
    parser.add_argument("--vkvol", default=ROOT / "build/vkvol")
    parser.add_argument("--spp", type=int, help="samples per pixel; by default the scene's")
    parser.add_argument("--pbrt", help="pbrt-v4, to render its pictures anew")
    parser.add_argument("--seeds", type=int, default=4)
    options = parser.parse_args()
    records = json.loads(RECORDS.read_text()) if RECORDS.exists() else {}
    differences = json.loads((SCENES / "differences.json").read_text())
    scenes = [scene for scene in sorted(SCENES.glob("*.pbrt"))
              if not options.words or any(word in scene.stem for word in options.words)]
    if not scenes:
        sys.exit(f"no scene of {SCENES} has any of these words in its name")
    good, expected = True, 0
    count = 3 * (1 + BLOCKS[0] * BLOCKS[1]) * len(scenes)
    limit = 1.0 - (1.0 - 0.01) ** (1.0 / count)
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        if options.pbrt:
            for scene in scenes:
                records[scene.stem] = record(options.pbrt, options.seeds, scene, folder)
                print(scene.stem, flush=True)
            RECORDS.write_text("{\n" + ",\n".join(f'"{name}": {json.dumps(records[name])}' for name in sorted(records)) + "\n}\n")
            return 0
        print(f"{'scene':<28} {'ratio of means (r g b)':<24} {'most z':>6} {'apart':>7}  verdict")
        for scene in scenes:
            ratio, z, apart = judge(options.vkvol, options.spp, scene, records[scene.stem], folder)
            allowed = differences.get(scene.stem, {"apart": USUAL, "why": ""})
            wrong = (np.vectorize(two_sided)(z) < limit) & (apart > allowed["apart"])
            is_apart = bool(allowed["why"]) and (apart > USUAL).any()
            expected += is_apart
            verdict = "DIFFERS" if wrong.any() else f"apart: {allowed['why']}" if is_apart else "same"
            good = good and not wrong.any()
            print(f"{scene.stem:<28} {' '.join(f'{r:.4f}' for r in ratio):<24} {np.abs(z).max():6.1f} {100 * apart.max():6.2f}%  {verdict}",
                  flush=True)
        print(f"{len(scenes)} scenes, of which {expected} are apart for a known reason")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
