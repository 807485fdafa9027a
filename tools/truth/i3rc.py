"""Phase 1 of the intercomparison of 3-D radiation codes (Cahalan et al. 2005), experiment 1: the sun overhead, nothing absorbs,
the ground is black. R and T are fluxes over mu0 F0, I radiances times pi over mu0 F0."""

import math
import pathlib
import statistics

from . import grids, scenes
from .case import Case

SOURCE = "I3RC phase 1, consensus"
PHASE = scenes.henyey_greenstein(.85)
CONE = 2.0  # degrees from the nadir
WIDTH, HEIGHT, COLUMNS, DEPTHS = .5, .25, 32, (2.0, 18.0)  # of the step cloud, and its optical depths


def consensus(folder, case, what):
    text = (pathlib.Path(folder) / f"I3RC_cons_res_case{case}_exp1_{what}.txt").read_text()
    return [float(word) for word in text.split()]


def sensor(what, top, bottom, width, columns, depth=1.0, rows=scenes.ROWS):
    if what == "R":
        return scenes.flux(top, False, width, depth, columns, rows)
    if what == "T":
        return scenes.flux(bottom, True, width, depth, columns, rows)
    mu, azimuth = (1.0, 0.0) if what == "Iu" else (0.5, 180.0)
    return scenes.radiance(top, mu, azimuth, width, columns, rows)


def step_cloud_scene(sensor):
    """Infinite along z."""
    cloud = scenes.volumes(*(scenes.box((x0, 0.0, -.5), (x0 + .5 * WIDTH, HEIGHT, .5), tau / HEIGHT, 1.0, PHASE)
                             for x0, tau in zip((-.5 * WIDTH, 0.0), DEPTHS)))
    return cloud + scenes.periodic(WIDTH, 1.0) + scenes.sun(1.0, 1.0) + sensor


def step_cloud_sensor(what):
    return sensor(what, HEIGHT, 0.0, WIDTH, COLUMNS)


def step_cloud_case(folder, name, what, sensors, share, judged=True):
    published = consensus(folder, 1, what)
    first, *others = map(step_cloud_scene, sensors)
    return Case(name, what, SOURCE, first, [f"column {i + 1}" for i in range(COLUMNS)], published, [share * value for value in published],
                scale=math.pi if what[0] == "I" else 1.0, mean=(sum(published) / COLUMNS, share * sum(published) / COLUMNS / COLUMNS**.5),
                others=others, judged=judged)


def step_cloud(folder):
    # How far the consensus scatters from column to column, from its mirror symmetry; of the slant radiance as of the nadir's.
    scatter = {"R": .0010, "T": .0006, "Iu": .0051, "I602": .0051}
    for what, share in scatter.items():
        yield step_cloud_case(folder, "step cloud", what, [step_cloud_sensor(what)], share)
    # The nadir's consensus seems to be that of a cone, in which photons are counted. How wide was found by trying, so that it proves nothing.
    around = [scenes.radiance(HEIGHT, math.cos(math.radians(CONE)), azimuth, WIDTH, COLUMNS) for azimuth in (0.0, 90.0, 180.0, 270.0)]
    yield step_cloud_case(folder, "step cloud, nadir's cone", "Iu", around, scatter["Iu"], judged=False)


def field(folder, name):
    return [float(word) for word in (pathlib.Path(folder) / name).read_text().split()]


def mean_of(folder, case, what):
    """And how far it may be off: half of what R and T lack of 1, or, of radiances, as much of them."""
    means = {each: statistics.mean(consensus(folder, case, each)) for each in {"R", "T", what}}
    return means[what], .5 * abs(means["R"] + means["T"] - 1.0) * (1.0 if what in "RT" else means[what])


def radar_cloud(folder, work):
    """Case 2, by a radar that looked up (MMCR): 640 columns over 32 km, layers of 45 m, the topmost first in the file, of which 40 have
    any cloud; infinite along z. T is what leaves the lowest of these."""
    numpy, _ = grids.module()
    width, layer = 32.0, .045
    depths = numpy.array(field(folder, "mmcr_tau_32km_020898")).reshape(54, 640)
    depths = depths[depths.any(axis=1)]
    height = len(depths) * layer
    grid = grids.write(work / "radar.nvdb", (depths[::-1] / layer).T[:, :, None])
    cloud = grids.volume(grid, (-.5 * width, 0.0, -.5 * width), (width / 640, layer, width), PHASE)
    for what in ("R", "T", "Iu"):
        yield Case("radar's cloud", what, SOURCE,
                   cloud + scenes.periodic(width, width) + scenes.sun(1.0, 1.0) + sensor(what, height, 0.0, width, 640, width),
                   [f"column {i + 1}" for i in range(640)], consensus(folder, 2, what), [], scale=math.pi if what[0] == "I" else 1.0,
                   mean=mean_of(folder, 2, what), least=.03 if what == "Iu" else .01, samples=128)


def landsat_cloud(folder, work):
    """Case 3, seen from a satellite (Landsat): 128 x 128 columns of 30 m, each even from .2 km up, to a metre. The first line is at low z, which is the
    last row of a sensor that looks up: T's lines are turned."""
    numpy, _ = grids.module()
    width, base, metre = 3.84, .2, .001
    depths = numpy.array(field(folder, "scene43.tau.128x128")).reshape(128, 128)
    metres = numpy.rint(numpy.array(field(folder, "scene43.dz.128x128")).reshape(128, 128) / metre).astype(int)
    extinction = depths / (numpy.maximum(metres, 1) * metre)
    is_cloud = numpy.arange(metres.max())[None, :, None] < metres.T[:, None, :]
    grid = grids.write(work / "landsat.nvdb", numpy.where(is_cloud, extinction.T[:, None, :], 0.0).astype(numpy.float32))
    cloud = grids.volume(grid, (-.5 * width, base, -.5 * width), (width / 128, metre, width / 128), PHASE)
    for what in ("R", "T", "Iu"):
        top = base + metre * int(metres.max())
        scene = cloud + scenes.periodic(width, width) + scenes.sun(1.0, 1.0) + sensor(what, top, base, width, 128, width, 128)
        lines = range(127, -1, -1) if what == "T" else range(128)
        places = [128 * line + column for line in lines for column in range(128)]
        published = consensus(folder, 3, what)
        yield Case("Landsat's cloud", what, SOURCE, scene, [f"column {i % 128 + 1}, line {i // 128 + 1}" for i in places],
                   [published[i] for i in places], [], scale=math.pi if what[0] == "I" else 1.0, mean=mean_of(folder, 3, what), least=.06 if what == "Iu" else .03,
                   samples=64, is_map=True)


def cases(folder, work):
    yield from step_cloud(folder)
    if grids.module():
        yield from radar_cloud(folder, work)
        yield from landsat_cloud(folder, work)
    else:
        print("without vkvol's Python module and numpy (PYTHONPATH=build/python) the clouds of grids are left out")
