#!/usr/bin/env python3
"""Scenes whose features are crossed at random, each by two unlike estimators, which have to show the same.

What fails is not what a scene has, but what it has beside what else: a table of layers in a box that begins above the lowest of
them, a map that glows with particles, a lamp in the plane of a mesh. Of such pairs there are more than anyone writes tests for.
So here a scene takes of every kind of thing some or none: media (shapes, fields, maps, phase functions, places), lights,
surfaces, a sensor, filters, domains. `ratioTracking` renders it, and so do the scalar reference of the tests, which shares no code
with it, particles, which share neither draws nor directions, and one more estimator.

Two pictures differ if they are apart by more standard errors than chance has it once in some hundred scenes, in the mean of a
channel or in a pixel; then both are rendered again, with sixteen times the samples and other seeds, and have to agree in the mean
and, where they were apart, in the pixel. Of what still differs the scene stays, with the two commands. Scenes that an estimator refuses, or for which it says that it is biased
or leaves things to chance, are passed over.

    tools/crossed_scenes.py build/vkvol --scenes 1..200 [--keep FOLDER]
"""

import argparse
import json
import math
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
from crossed_scene import Writer, write_files  # noqa: E402
from peers.exr import read_rgb  # noqa: E402

UNLIKE = ["reference", "lightTracing", "bidirectional"]
OTHERS = ["ratioTracking:distance=flights", "ratioTracking:distance=mixed", "ratioTracking:mis=light",
          "ratioTracking:mis=phase", "ratioTracking:mis=power", "ratioTracking:emission=steps", "ratioTracking:nee=none", "ratioNEE",
          "cachedRatioTracking", "deltaTrackingNEE", "residualRatioTracking", "weightedTracking", "decompositionTracking", "spectralTracking",
          "unbiasedRayMarching", "regularTracking", "ratioTracking:transmittance=jackknife", "deltaTracking",
          "weightedTracking:emission=steps", "decompositionTracking:distance=mixed", "ratioTracking:firstFlight=split",
          "cachedRatioTracking:firstFlight=split", "spectralTracking:firstFlight=split:emission=steps"]
PARTICLES = ["lightTracing:flight=weighted", "lightTracing:flight=spectral", "lightTracing:flight=regular", "lightTracing:flight=decomposition"]
PIXELS, SAMPLES = 8, 1024


class Refused(Exception):
    pass


def reference(vkvol, scene, samples, seed):
    """Of what it knows; slow."""
    report = scene.with_suffix(".json")
    report.unlink(missing_ok=True)
    command = [str(Path(vkvol).resolve().with_name("reference_render")), str(scene), "--integrator", "ratioTracking", *size_of(scene),
               "--spp", str(samples // 4), "--seed", str(seed), "-o", str(scene.with_suffix(".exr")), "--report", str(report)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=samples / 20)
    except subprocess.TimeoutExpired:
        raise Refused("too slow")
    if done.returncode != 0:
        raise Refused(done.stderr.strip())
    return command, with_picture(report, scene), ""


def with_picture(report, scene):
    return {**json.loads(report.read_text()), "picture": read_rgb(scene.with_suffix(".exr"))}


def size_of(scene):
    one_reading_each = "<fluence" in scene.read_text() or "<absorption" in scene.read_text()
    return [] if one_reading_each else ["--width", str(PIXELS), "--height", str(PIXELS)]


def render(vkvol, scene, integrator, samples, seed, schedule):
    report = scene.with_suffix(".json")
    if integrator == "reference":
        return reference(vkvol, scene, samples, seed)
    command = [vkvol, str(scene), "--integrator", integrator, *size_of(scene), "--spp", str(samples), "--seed", str(seed), "--schedule", schedule,
               "-o", str(scene.with_suffix(".exr")), "--report", str(report), "--progress", "none"]
    report.unlink(missing_ok=True)
    done = subprocess.run(command, capture_output=True, text=True, timeout=900)
    if done.returncode == 2:
        raise Refused(done.stderr.strip().splitlines()[0] if done.stderr.strip() else "")
    if done.returncode != 0:
        return command, None, f"ended with {done.returncode}: {done.stderr.strip()[-400:]}"
    return command, with_picture(report, scene), ""


def is_judged(report):
    """All estimators end paths at the same depth. Of mean free paths as short as rounding they know little, each in its way."""
    if any("a mean free path is" in warning for warning in report.get("warnings", [])):
        return False
    return "biased" not in report or not report["biased"] or re.fullmatch(r"[0-9]+ paths ended at maxDepth", report["biased"])


def is_another(integrator, base, other):
    """Whether what it shows tells more than another render of the same would."""
    if integrator == "reference" or not is_judged(other):
        return is_judged(other)
    is_alike = other["integrator"] == base["integrator"] and other["specialization"] == base["specialization"]
    return other["sceneHash"] == base["sceneHash"] and not is_alike


def apart(a, b):
    """The largest z of the three means."""
    largest = 0.0
    for one, other, e, f in zip(a["mean"]["value"], b["mean"]["value"], a["mean"]["standardError"], b["mean"]["standardError"]):
        if None in (one, other, e, f): # not finite
            return math.inf
        # Single precision: some 1e-5 of the values are rounding.
        excess = max(abs(one - other) - 1e-5 * max(abs(one), abs(other)), 0.0)
        largest = max(largest, excess / math.hypot(e, f) if excess else 0.0)
    return largest


def apart_by_pixel(a, b):
    """The z of each pixel and channel. What only one of the two has met goes by that one's error: k samples of it, all alike,
    are sqrt(k) errors from none."""
    (one, e, _), (other, f, _) = a, b
    error = np.sqrt(e + f + (1e-5 * np.maximum(np.abs(one), np.abs(other))) ** 2)
    return np.abs(one - other) / np.maximum(error, 1e-30)


LIMIT = 3.8  # standard errors, of three means: once in some 2000 pairs
PIXEL_LIMIT = 6.0  # of 192 values, whose distributions have tails; again in the same place: chance has it hardly ever


class Comparison:
    """One scene: `bad` says what is wrong, each with two commands that show it."""

    def __init__(self, vkvol, scene, number):
        self.vkvol, self.scene, self.number = vkvol, scene, number
        self.bad, self.pairs, self.unjudged = [], 0, False

    def render(self, integrator, samples, seed, schedule):
        """Of a failure nothing but a row of `bad`."""
        command, report, error = render(self.vkvol, self.scene, integrator, samples, seed, schedule)
        if error:
            self.bad.append((command, command, error))
        return command, report

    def run(self, writer):
        counts = "<absorption" in self.scene.read_text()  # particles alone
        usual, pool = ("lightTracing", PARTICLES[:]) if counts else ("ratioTracking", OTHERS[:])
        writer.r.shuffle(pool)
        _, base = self.render(usual, SAMPLES, 1, "fused")
        if self.bad:
            return
        self.unjudged = not is_judged(base)
        for integrator in [] if self.unjudged else pool if counts else UNLIKE + pool:
            schedule = writer.r.choice(["fused", "staged"])
            try:
                command, other = self.render(integrator, SAMPLES, 2, schedule)
            except Refused:
                continue
            if not self.bad and is_another(integrator, base, other):
                self.pairs += 1
                self.compare(usual, integrator, schedule, base, other, command)
            if self.bad or self.pairs == 4:
                return

    def compare(self, usual, integrator, schedule, base, other, command):
        z, by_pixel = apart(base, other), apart_by_pixel(base["picture"], other["picture"])
        where = by_pixel > PIXEL_LIMIT
        if z <= LIMIT and not where.any():
            return
        try:
            one, base = self.render(usual, 16 * SAMPLES, 3, "fused")
            two, other = self.render(integrator, 16 * SAMPLES, 4, schedule)
        except (Refused, subprocess.TimeoutExpired) as reason:  # they are apart, and that is all that is known
            self.bad.append((command, command, f"{z:.1f} standard errors apart, and no second look: {reason}"))
        if self.bad:
            return
        again = apart(base, other)
        there = float(np.max(np.where(where, apart_by_pixel(base["picture"], other["picture"]), 0.0)))
        print(f"{self.number}: {integrator} {z:.1f} standard errors apart, then {again:.1f} (pixel: {by_pixel.max():.1f}, {there:.1f}): "
              f"{base['mean']['value']} {other['mean']['value']}", flush=True)
        if again > LIMIT or there > PIXEL_LIMIT:
            self.bad.append((one, two, f"{again:.1f} standard errors apart, {there:.1f} in a pixel"))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("vkvol")
    parser.add_argument("--scenes", default="1..20", help="numbers, as 1..20 or 7")
    parser.add_argument("--keep", type=Path, help="where scenes that differ stay")
    arguments = parser.parse_args()
    first, _, last = arguments.scenes.partition("..")
    keep = arguments.keep or Path(tempfile.mkdtemp(prefix="crossed"))
    keep.mkdir(parents=True, exist_ok=True)
    write_files(keep, Path(arguments.vkvol).resolve().with_name("make_field"))
    pairs = failures = refused = unjudged = 0
    for number in range(int(first), int(last or first) + 1):
        scene = keep / f"{number}.xml"
        writer = Writer(number)
        scene.write_text(writer.write())
        comparison = Comparison(arguments.vkvol, scene, number)
        try:
            comparison.run(writer)
        except Refused as reason:
            refused += 1
            print(f"{number}: refused: {reason}")
        pairs += comparison.pairs
        unjudged += comparison.unjudged
        failures += bool(comparison.bad)
        for one, two, why in comparison.bad:
            print(f"{number}: {why}\n    {shlex.join(one)}\n    {shlex.join(two)}", flush=True)
        if not comparison.bad:
            scene.unlink()
    print(f"{pairs} pairs of pictures compared, {failures} scenes differ, {refused} refused, {unjudged} biased")
    return 1 if failures or not pairs else 0


if __name__ == "__main__":
    sys.exit(main())
