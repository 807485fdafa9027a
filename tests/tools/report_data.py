"""Files as `vkvol bench`, the tools for other renderers and tools/scaling.py write them, made from a model of what is measured:
seconds = cost x samples, relMSE = floor + variance / samples, with the scatter of a shared machine."""
import json
import math
import random
import tempfile
import unittest
from pathlib import Path


class Folder(unittest.TestCase):
    """Tests with a folder of their own."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)


def interval(value, spread):
    """95 % of a relative spread, None for no interval."""
    return {"value": value, "low": None if spread is None else value / (1 + spread),
            "high": None if spread is None else value * (1 + spread)}


def points(rng, cost, variance, floor, largest, runs):
    found, samples = [], 1
    while samples <= largest:
        seconds = sorted(cost * samples * math.exp(rng.gauss(0, 0.02)) for _ in range(runs))
        relmse = (floor + variance / samples) * math.exp(rng.gauss(0, 0.02))
        found.append({"samples": samples, "runs": runs, "seconds": seconds[runs // 2], "secondsLow": seconds[0],
                      "secondsHigh": seconds[-1], "relMse": relmse, "relMseError": 0.03 * relmse,
                      "relMseFromVariance": variance / samples})
        samples *= 2
    return found


def estimator(name, cost=0.05, variance=0.2, floor=0.0, biased="", default=False, spread=0.08, largest=256, runs=5, seed=1, **others):
    efficiency = 1 / (cost * variance)
    low_floor = floor / 1.2 if floor else -1e-5
    return {"integrator": name, "isDefault": default, "biased": biased,
            "setupSeconds": {"load": 0.69, "upload": 0.24, "pipeline": 0.35},
            "points": points(random.Random(f"{name}{seed}"), cost, variance, floor, largest, runs),
            "slope": {"value": -1.003, "low": -1.02, "high": -0.985},
            "biasFloor": {"value": floor, "low": low_floor, "high": max(floor * 1.2, 1e-5)},
            "efficiency": interval(efficiency, spread),
            "judged": spread is not None, "sameAs": [], "noise": math.sqrt(variance / largest),
            "secondsToOnePercent": 1e4 / efficiency,
            "perPath": {"realCollisions": 8.4, "nullCollisions": 40.1, "lookups": 48.5, "majorantCells": 15.9, "shadowRays": 8.4},
            "laneUse": {"track": 0.81},
            "passSeconds": {"sky": 0.02 * cost * largest, "generate": 0.03 * cost * largest, "track": 0.92 * cost * largest},
            "samplesPerSecond": 32400 / cost, "image": None, **others}


def bench(estimators, scene="scenes/cumulus.xml", reference_error=1e-6, ratio_spread=0.1, **others):
    default = next((e for e in estimators if e["isDefault"]), None)
    base = default["efficiency"]["value"] if default else 1
    return {"format": "vkvol-bench", "version": 1, "scene": scene, "sceneHash": "b2ddcc860ddda3fb",
            "command": f"vkvol bench {scene} --time 60s", "program": "vkvol 0.1.0", "date": "2026-01-01T12:00:00Z",
            "device": {"name": "llvmpipe (LLVM 15.0.6, 256 bits)", "driver": "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)", "api": "1.3.230"},
            "machine": {"processor": "AMD EPYC", "cores": 2, "load": [0.3, 2.1]},
            "image": {"width": 240, "height": 135}, "budgetSeconds": 60.0, "seed": 0,
            "reference": {"file": None, "integrator": "regularTracking", "samples": 4096, "seconds": 120.0, "cached": True,
                          "relMse": reference_error},
            "estimators": estimators,
            "ranking": [{"integrator": e["integrator"], "efficiencyRatioToDefault":
                         interval(e["efficiency"]["value"] / base, None if e["efficiency"]["low"] is None else ratio_spread)}
                        for e in estimators if default], **others}


def cloud(**others):
    """What a scene with a clear winner and a biased march looks like."""
    return bench([estimator("ratioTracking", default=True), estimator("residualRatioTracking", 0.03, 0.11),
                  estimator("deltaTrackingNEE", 0.04, 0.9), estimator("weightedTracking", 0.055, 0.19),
                  estimator("rayMarching", 0.2, 0.2, 2e-3, "takes the density of one point for that of a whole step")], **others)


def peer(scene="scenes/cumulus.xml", same=True, ratio=0.0667, spread=0.1):
    """vkvol and one other renderer."""
    both = [{**estimator("", default=True), "renderer": "vkvol 0.1.0 ratioTracking", "agreement": None},
            {**estimator("", 0.5, 0.3), "renderer": "mitsuba 3.9.1 llvm_ad_rgb", "agreement":
             {"meanRatio": [1.001, 0.999, 1.0], "z": [0.8, -0.4, 0.1], "same": same, "reason": "noise explains the difference"}}]
    return {**bench([]), "format": "vkvol-peer", "scene": scene, "estimators": both, "ranking": [
        {"renderer": e["renderer"], "efficiencyRatioToDefault": interval(1.0 if e["isDefault"] else ratio, spread)} for e in both]}


def scaling():
    def series(name, unit, values, seconds):
        return {"name": name, "unit": unit, "scene": "scenes/cumulus.xml", "command": "tools/scaling.py scenes/cumulus.xml",
                "points": [{"x": x, "seconds": seconds(x), "secondsLow": 0.97 * seconds(x), "secondsHigh": 1.04 * seconds(x),
                            "samples": 8} for x in values]}
    wiggle = {1: 1.01, 2: 0.99, 4: 1.0, 8: 1.01, 16: 0.99}
    return {"format": "vkvol-scaling", "version": 1, "series": [
        series("samples per pixel", "samples", (1, 2, 4, 8, 16), lambda x: 0.2 * x * wiggle[x]),
        series("optical depth", "", (1, 4, 16, 64, 256), lambda x: 0.3 + 0.01 * x),
        series("threads", "threads", (1, 2), lambda x: 4 / x**0.9)]}


def write(directory, name, data):
    path = Path(directory) / name
    path.write_text(json.dumps(data))
    return str(path)
