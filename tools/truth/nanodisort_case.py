"""Slabs of printed tables whose prints are not at hand, and stacks drawn at random, solved by discrete ordinates (PyPI's nanodisort, a C
port of DISORT): fluxes, and radiances at three angles. An optional peer: without the package there are none."""

import math
import random

from . import scenes
from .case import Case

SOURCE = "nanodisort"
STREAMS, MOMENTS = 64, 300
MUS = (.2, .55, .95)
# (optical depth, albedo, g) from the top down, and the sun's mu0.
OF_TABLES = (
    ("van de Hulst, forward, albedo 1", [(2.0, 1.0, .75)], 1.0),
    *((f"DISORT 1, isotropic, depth 32, albedo {albedo}", [(32.0, albedo, 0.0)], .1) for albedo in (.2, .99, 1.0)),
)


def draw(rng):
    """Layers, from the top down, and the sun's mu0 and azimuth."""
    count = rng.choice((1, 1, 2, 4))
    layers = []
    for _ in range(count):
        tau = 10.0 ** rng.uniform(-2.0, 2.0) / count
        albedo = rng.choice((0.0, 1.0, rng.random(), 1.0 - 10.0 ** rng.uniform(-4.0, -1.0), rng.random()))
        layers.append((tau, albedo, rng.uniform(-.9, .95)))
    return layers, rng.uniform(.05, 1.0), rng.choice((0.0, .2, .8)), rng.choice((0.0, 40.0, 130.0, 180.0))


def solve(layers, mu0, ground, azimuth):
    """Flux up at the top, down at the bottom with what comes straight through; radiance at the top at MUS, in an azimuth that counts from
    where the beam goes. The sun's irradiance is 1 across itself."""
    import nanodisort
    import numpy

    state = nanodisort.DisortState()
    state.nstr, state.nmom = STREAMS, MOMENTS
    state.nlyr, state.ntau, state.numu, state.nphi = len(layers), 2, len(MUS), 1
    state.usrtau = state.usrang = state.lamber = state.quiet = True
    state.onlyfl = False
    state.intensity_correction = state.old_intensity_correction = True
    state.allocate()
    state.dtauc = numpy.array([tau for tau, _, _ in layers])
    state.ssalb = numpy.array([albedo for _, albedo, _ in layers])
    state.pmom = numpy.array([[g**n for _, _, g in layers] for n in range(MOMENTS + 1)])
    state.utau, state.umu, state.phi = numpy.array([0.0, sum(state.dtauc)]), numpy.array(MUS), numpy.array([azimuth])
    state.fbeam, state.umu0, state.phi0, state.albedo = 1.0, mu0, 0.0, ground
    state.solve()
    return state.flup[0], state.rfldn[1] + state.rfldir[1], [state.uu[i, 0, 0] for i in range(len(MUS))]


def of_slab(group, what, layers, mu0, ground=0.0, azimuth=0.0):
    up, down, radiances = solve(layers, mu0, ground, azimuth)
    medium, bottom = scenes.slab([(tau, albedo, scenes.henyey_greenstein(g)) for tau, albedo, g in layers])
    scene = medium + scenes.sun(mu0, 1.0) + (scenes.ground(bottom - .01, ground) if ground else "")
    # Of ordinates: as they are stated for such phase functions, a thousandth.
    for label, sensor, value in (("up", scenes.flux(1e-3, False), up), ("down", scenes.flux(bottom - .005, True), down)):
        yield Case(f"{group}, fluxes", what, SOURCE, scene + sensor, [label], [value], [1e-3 * value + 1e-6])
    for mu, value in zip(MUS, radiances):
        yield Case(f"{group}, radiances", what, SOURCE, scene + scenes.radiance(1e-3, mu, 180.0 + azimuth), [f"mu {mu}"], [value],
                   [2e-3 * value + 1e-6])


def cases(count, seed=1):
    try:
        import nanodisort  # noqa: F401
    except ImportError:
        return
    for what, layers, mu0 in OF_TABLES:
        yield from of_slab("nanodisort, of tables", what, layers, mu0)
    rng = random.Random(seed)
    for number in range(count):
        layers, mu0, ground, azimuth = draw(rng)
        what = f"{number + 1}: " + " ".join(f"{tau:.3g}/{albedo:.3g}/{g:.2g}" for tau, albedo, g in layers) + f" mu0 {mu0:.2f}"
        yield from of_slab("nanodisort", what, layers, mu0, ground, azimuth)
