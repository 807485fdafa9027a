"""Kobayashi's three-dimensional void, problem 1 (Kobayashi, Sugimura, Nagaya 2000, OECD/NEA NSC/DOC(2000)4): a cube that glows amid a
void amid a shield. The scalar flux at points, over five decades; case i absorbs alone, and is known by quadrature, case ii
scatters half."""

import csv
import math

from . import scenes
from .case import Case

SOURCE = "Kobayashi et al. 2000"
VOID, MATTER = 1e-4, .1  # per cm


def shell(inner, outer):
    """Between two cubes of these half edges: corners of six boxes."""
    for axis in range(3):
        for side in (-1, 1):
            low = [-inner] * axis + [0.0] + [-outer] * (2 - axis)
            high = [-c for c in low]
            low[axis], high[axis] = sorted((side * inner, side * outer))
            yield low, high


def medium(albedo):
    # 1 / (4 pi) for a unit of volume, by absorptions: radiance for each of them.
    glow = f'<medium r="1" g="1" b="1" multiplier="{1.0 / (4.0 * math.pi * MATTER * (1.0 - albedo))!r}"/>'
    return scenes.volumes(scenes.box([-10.0] * 3, [10.0] * 3, MATTER, albedo, more=glow),
                          *(scenes.box(low, high, VOID, albedo) for low, high in shell(10.0, 50.0)),
                          *(scenes.box(low, high, MATTER, albedo) for low, high in shell(50.0, 100.0)))


def cases(table):
    with open(table, newline="") as stream:
        points = list(csv.DictReader(line for line in stream if not line.startswith("#")))
    for case, albedo in (("i", 0.0), ("ii", .5)):
        for row in points:
            place = f"{row['x']} {row['y']} {row['z']}"
            value = float(row[f"flux_{case}"])
            share = float(row["relerr_ii"]) if case == "ii" else 5e-6 / 3**.5
            yield Case(f"voids, case {case}", f"scalar flux at {place}", SOURCE, medium(albedo) + f"<fluence>{(place + '  ') * scenes.ROWS}</fluence><width>1</width>",
                       [place], [value], [share * value], samples=1 << 14)
