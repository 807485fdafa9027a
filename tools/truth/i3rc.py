"""Phase 1 of the intercomparison of 3-D radiation codes (Cahalan et al. 2005), experiment 1: the sun overhead, nothing absorbs,
the ground is black. R and T are fluxes over mu0 F0, I radiances times pi over mu0 F0."""

import math
import pathlib

from . import scenes
from .case import Case

SOURCE = "I3RC phase 1, consensus"
PHASE = scenes.henyey_greenstein(.85)


def consensus(folder, case, what):
    text = (pathlib.Path(folder) / f"I3RC_cons_res_case{case}_exp1_{what}.txt").read_text()
    return [float(word) for word in text.split()]


def sensor(what, top, bottom, width, columns):
    if what == "R":
        return scenes.flux(top, False, width, 1.0, columns)
    if what == "T":
        return scenes.flux(bottom, True, width, 1.0, columns)
    mu, azimuth = (1.0, 0.0) if what == "Iu" else (0.5, 180.0)
    return scenes.radiance(top, mu, azimuth, width, columns)


def step_cloud_scene(what):
    """32 columns over 0.5 km, of optical depth 2 and 18; infinite along z."""
    width, height = .5, .25
    cloud = scenes.volumes(*(scenes.box((x0, 0.0, -.5), (x1, height, .5), tau / height, 1.0, PHASE)
                             for x0, x1, tau in ((-.25, 0.0, 2.0), (0.0, .25, 18.0))))
    return cloud + scenes.periodic(width, 1.0) + scenes.sun(1.0, 1.0) + sensor(what, height, 0.0, width, 32)


def step_cloud(folder):
    # How far the consensus scatters from column to column, from its mirror symmetry; of the slant radiance as of the nadir's.
    scatter = {"R": .0010, "T": .0006, "Iu": .0051, "I602": .0051}
    for what, share in scatter.items():
        published = consensus(folder, 1, what)
        yield Case("step cloud", what, SOURCE, step_cloud_scene(what), [f"column {i + 1}" for i in range(32)], published,
                   [share * value for value in published], scale=math.pi if what[0] == "I" else 1.0,
                   mean=(sum(published) / 32, share * sum(published) / 32 / 32**.5))


def cases(folder):
    yield from step_cloud(folder)
