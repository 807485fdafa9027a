"""Plane-parallel cases: fluxes and radiances of slabs and stacks, printed by van de Hulst and as tests of DISORT."""

import math
import pathlib

from . import scenes
from .case import Case, digits

PI = math.pi
MOMENTS = 82


def up_and_down(name, source, layers, light, up, down, last, direct=0.0, irradiance=1.0, more=""):
    """Fluxes up at the top and down at the bottom, of which the print has the diffuse part alone where `direct` light is given."""
    slab, bottom = scenes.slab(layers)
    for what, value, height, is_down in (("flux up at the top", up, 1e-3, False), ("flux down at the bottom", down, bottom - 1e-3, True)):
        if value is not None:
            # Rays from the sensor read what comes straight through without noise.
            rays = "<integrator>ratioTracking</integrator>" if is_down and direct else ""
            yield Case(name, what, source, slab + light + more + scenes.flux(height, is_down) + rays, [what], [value],
                       [digits(last[0] if not is_down else last[1])], scale=1.0 / irradiance,
                       less=[direct] if is_down else [])


def beam(mu0, irradiance, depth):
    """What comes straight through, on a level plane."""
    return mu0 * irradiance * math.exp(-depth / mu0)


def van_de_hulst():
    source = "van de Hulst 1980, table 12"
    published = {1.0: .28616, .9: .30277, .7: .34188, .5: .39102, .3: .45353, .1: .53214}
    slab, _ = scenes.slab([(2.0, .8, "")])
    for mu0, value in published.items():
        # Of radiance per mu0 F, the sun's irradiance across itself being pi F.
        yield Case("van de Hulst, isotropic", f"radiance at the top, mu 0.5, mu0 {mu0}", source,
                   slab + scenes.sun(mu0, PI, 70.0) + scenes.radiance(1e-3, .5), [f"mu0 {mu0}"], [value], [digits(1e-5)],
                   scale=1.0 / mu0)
    name, source = "van de Hulst, forward", "van de Hulst 1980, as quoted by MCML (Wang, Jacques, Zheng 1995)"
    layers = [(2.0, .9, scenes.henyey_greenstein(.75))]
    yield from up_and_down(name, source, layers, scenes.sun(1.0, 1.0), .09739, .66096, (1e-5, 1e-5))


def haze_l(haze):
    """What DISORT's test prints of radiances is of the first 32 moments alone: with all 82 discrete ordinates converge to other figures,
    by 1 % in the nadir, of which the last group is."""
    source, light = "Garcia and Siewert 1985", scenes.sun(1.0, PI)
    _, layers = slab_of(haze, MOMENTS)
    yield from up_and_down("haze L, fluxes", source, layers, light, .173223, 1.81264, (1e-6, 1e-5), direct=beam(1.0, PI, 1.0))
    for name, source, few, figures in (
            ("haze L, 32 moments", "Stamnes et al. 1988", 32, {.1: .0926837, .5: .0659569, 1.0: .0364755}),
            ("haze L, all moments", "nanodisort 0.3.0, 128 streams", MOMENTS, {.1: .0929328, .5: .0660942, 1.0: .0361452})):
        slab, _ = slab_of(haze, few)
        for mu, value in figures.items():
            yield Case(name, f"radiance at the top, mu {mu}", source, slab + light + scenes.radiance(1e-3, mu), [f"mu {mu}"], [value],
                       [digits(1e-7)])


def slab_of(haze, moments):
    """Of optical depth 1, that absorbs nothing, of so many moments besides the first; `haze`: a folder for tables."""
    table = haze / f"haze_l_{moments}.txt"
    numbers = [line for line in pathlib.Path(__file__).with_name("haze_l.txt").read_text().splitlines() if line[0] != "#"]
    table.write_text("\n".join(numbers[:moments + 1]) + "\n")
    layers = [(1.0, 1.0, f'<phase file="{table}">table</phase>')]
    return scenes.slab(layers)[0], layers


def disort(haze):
    source = "Stamnes et al. 1988, test problems of DISORT"
    for albedo, up in ((.2, .0799451), (1.0, .422922)):
        yield from up_and_down(f"DISORT 1, isotropic, albedo {albedo}", source, [(1 / 32, albedo, "")],
                               scenes.sun(.1, PI / .1), up, None, (1e-6 if up > .1 else 1e-7, 0))
    down = 1.73849
    yield from up_and_down("DISORT 3, forward", source, [(1.0, 1.0, scenes.henyey_greenstein(.75))], scenes.sun(1.0, PI), .247374,
                           down, (1e-6, 1e-5), direct=beam(1.0, PI, 1.0))
    yield from haze_l(haze)
    name, source = "Rayleigh, scalar", "Sweigart 1970"
    yield from up_and_down(name, source, [(.2, .5, "<phase>rayleigh</phase>")], scenes.sun(.080442, PI), .0535063, .0441791,
                           (1e-7, 1e-7), direct=beam(.080442, PI, .2))
    name, source = "layers under an even sky", "Stamnes et al. 1988"
    # A flux of 1 from the sky is a radiance of 1 / pi.
    yield from up_and_down(name, source, [(.25, .5, ""), (.25, .3, "")], scenes.even_sky(1.0 / PI), .0929633, .513132,
                           (1e-7, 1e-6), more=scenes.ground(-.51, 0.0))
    # Kirchhoff: what they send out where all of them are as warm is what they keep of that sky, 1 - R - T.
    glow = f'<medium r="1" g="1" b="1" multiplier="{1.0 / PI!r}"/>'
    yield from up_and_down("layers that glow", source, [(.25, .5, glow), (.25, .3, glow)], "", 1.0 - .0929633 - .513132, None, (1e-6, 0))


def cases(haze):
    yield from van_de_hulst()
    yield from disort(haze)
