"""What a figure of given precision costs, beside other programs on the same machine: the step cloud's R in 32 columns beside Mitsuba 3, and
the fluxes of a slab beside discrete ordinates. Each is an optional peer: what is not installed is left out.

    python3 tools/truth/beside.py [--seconds 30] [--variant llvm_ad_rgb]

Monte Carlo programs have about so many seconds, starting up and compiling aside; what a thousandth would take is that times the square of
their standard error over it. Mitsuba knows no domain that repeats: it has a row of tiles, and the middle one is read."""

import argparse
import json
import math
import pathlib
import statistics
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))  # where this is run as a folder

from truth import i3rc, nanodisort_case, reading, scenes
from truth.i3rc import COLUMNS, DEPTHS, HEIGHT, WIDTH

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TILES = 41  # 20 km; light has left the cloud, of albedo 1, long before
WANTED = 1e-3
PASSES = 8


def share(rows):
    """Standard error over reading, a root mean square over the columns."""
    return math.sqrt(statistics.mean((error / mean) ** 2 for mean, error in rows))


def mean(rows):
    return sum(value for value, _ in rows) / len(rows), math.sqrt(sum(error**2 for _, error in rows)) / len(rows)


def row(program, seconds, rows):
    value, error = mean(rows)
    s = share(rows)
    return f"{program:44} {seconds:8.1f} {s:9.1e} {seconds * (s / WANTED) ** 2:12.0f}   {value:.5f} +- {error:.5f}"


def timed(reader, scene, seconds):
    """Readings by vkvol that take about so long, and the seconds of rendering."""
    samples = 1 << 4
    while True:
        rows = reader.read(scene, samples, 1)
        took = json.loads(reader.report.read_text())["seconds"]["render"]
        if took >= .6 * seconds or samples >= reading.MOST_SAMPLES:
            return took, rows
        samples = min(reading.MOST_SAMPLES, int(samples * min(16.0, max(2.0, seconds / took))))


def tiles(mi):
    """A grid of sigma_t, in which the step falls on the tiles' middles."""
    import numpy

    grid = numpy.tile(numpy.array(DEPTHS, dtype=numpy.float32) / HEIGHT, TILES).reshape(1, 1, -1, 1)
    half = .5 * TILES * WIDTH
    place = mi.ScalarTransform4f().translate([-half, 0.0, -half]).scale([2.0 * half, HEIGHT, 2.0 * half])
    return {"type": "gridvolume", "grid": mi.VolumeGrid(grid), "filter_type": "nearest", "raw": True, "to_world": place}, half


def mitsuba_scene(mi):
    sigma_t, half = tiles(mi)
    at = mi.ScalarTransform4f
    medium = {"type": "heterogeneous", "albedo": 1.0, "sigma_t": sigma_t, "phase": {"type": "hg", "g": .85}}
    sensors = {}
    for i in range(COLUMNS):
        x = (i + .5) * WIDTH / COLUMNS - .5 * WIDTH
        # A rectangle faces +z, then down.
        place = at().translate([x, HEIGHT + 1e-3, 0.0]).rotate([1, 0, 0], 90).scale([.5 * WIDTH / COLUMNS, .5 * WIDTH, 1.0])
        film = {"type": "hdrfilm", "width": 1, "height": 1, "rfilter": {"type": "box"}}
        # Of descriptions that are alike Mitsuba makes one thing; hence the seeds.
        sensors[f"column{i:02}"] = {"type": "rectangle", "to_world": place, "bsdf": {"type": "null"},
                                 "sensor": {"type": "irradiancemeter", "film": film, "sampler": {"type": "independent", "seed": i}}}
    return {"type": "scene", "integrator": {"type": "volpath", "max_depth": 100000, "rr_depth": 100000},
            "cloud": {"type": "cube", "to_world": at().translate([0.0, .5 * HEIGHT, 0.0]).scale([half, .5 * HEIGHT, half]),
                      "bsdf": {"type": "null"}, "interior": medium},
            "sun": {"type": "directional", "direction": [0.0, -1.0, 0.0], "irradiance": {"type": "rgb", "value": 1.0}}, **sensors}


def by_mitsuba(variant, seconds):
    try:
        import mitsuba as mi
        import numpy
    except ImportError:
        return None
    mi.set_variant(variant)
    scene = mi.load_dict(mitsuba_scene(mi))
    sensors = sorted(scene.sensors(), key=lambda sensor: sensor.get_shape().bbox().center().x)  # they come in any order
    seed = 0

    def once(samples):
        nonlocal seed
        seed += COLUMNS
        start = time.time()
        values = [float(numpy.array(mi.render(scene, sensor=sensor, spp=samples, seed=seed + i))[0, 0, 1]) for i, sensor in enumerate(sensors)]
        return time.time() - start, values

    once(16)  # kernels are compiled
    start = statistics.median(once(1)[0] for _ in range(3))  # of a render for each column, which vkvol has once and does not count
    # A pass with few samples is mostly its starting: as many more until one takes most of its share.
    samples, took = 64, once(64)[0]
    while took < .6 * seconds / PASSES:
        samples = int(samples * min(8.0, max(1.5, seconds / PASSES / took)))
        took = once(samples)[0]
    passes = [once(samples) for _ in range(PASSES)]
    columns = list(zip(*(values for _, values in passes)))
    return sum(took - start for took, _ in passes), [(statistics.mean(c), statistics.stdev(c) / PASSES**.5) for c in columns]


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--variant", default="llvm_ad_rgb")
    return parser.parse_args()


def step_cloud(reader, chosen):
    print(f"{'step cloud, R in 32 columns':44} {'seconds':>8} {'error':>9} {'s to a 1000th':>12}   mean")
    scene = i3rc.step_cloud_scene(i3rc.step_cloud_sensor("R"))
    print(row("vkvol, particles (the default)", *timed(reader, scene, chosen.seconds)), flush=True)
    paths = scene + "<integrator>ratioTracking</integrator>"
    print(row("vkvol, paths", *timed(reader, paths, chosen.seconds)), flush=True)
    found = by_mitsuba(chosen.variant, chosen.seconds)
    print(row(f"Mitsuba 3, volpath, {chosen.variant}", *found) if found else "without the package mitsuba, none of it", flush=True)


def slab(reader, chosen):
    layers, mu0 = [(2.0, .9, .75)], 1.0
    medium, _ = scenes.slab([(tau, albedo, scenes.henyey_greenstein(g)) for tau, albedo, g in layers])
    print(f"\n{'slab, flux up (depth 2, albedo 0.9, g 0.75)':44} {'seconds':>8} {'error':>9} {'s to a 1000th':>12}   mean")
    print(row("vkvol", *timed(reader, medium + scenes.sun(mu0, 1.0) + scenes.flux(1e-3, False), chosen.seconds)), flush=True)
    try:
        start = time.time()
        up = nanodisort_case.solve(layers, mu0, 0.0, 0.0)[0]
        print(f"{'nanodisort, ' + str(nanodisort_case.STREAMS) + ' streams':44} {time.time() - start:8.3f} {'':22}   {up:.7f}")
    except ImportError:
        print("without the package nanodisort, none of it")


def main():
    chosen = options()
    with tempfile.TemporaryDirectory() as folder:
        reader = reading.Reader((chosen.build / "vkvol").resolve(), folder, "auto")
        step_cloud(reader, chosen)
        slab(reader, chosen)


if __name__ == "__main__":
    main()
