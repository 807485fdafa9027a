#!/usr/bin/env python3
"""What the mean of each scene in scenes/hard must be, computed from the formulas in the scenes' comments.

Shares nothing with the renderer or its reference but the CIE observer's table. Without arguments compares the <expected> elements with the formulas
and fails if one differs by more than a part in a million; with scene names prints theirs.
"""
import math
import pathlib
import sys
import xml.etree.ElementTree as ET
from math import exp, pi, sqrt

from cie_1931 import observer

SCENES = pathlib.Path(__file__).resolve().parent.parent / "scenes/hard"


def grey(value):
    return (value, value, value)


def hg(g, from_peak):
    """Henyey-Greenstein per steradian, at 1 - |mu| from its peak."""
    a = abs(g)
    return (1 - a) * (1 + a) / (4 * pi * ((1 - a) ** 2 + 2 * a * from_peak) ** 1.5)


def slab_reflection(albedo, p, tau, mu0, mu=1.0):
    """Radiance per irradiance, scattered once back out of a slab."""
    return albedo * p * mu0 / (mu + mu0) * -math.expm1(-tau * (1 / mu + 1 / mu0))


def slab_transmission(albedo, p, tau, mu0, mu=1.0):
    """Scattered once, on the far side."""
    if abs(mu0 - mu) < 1e-6:
        return albedo * p * tau / mu * exp(-tau / mu)
    return albedo * p * mu0 / (mu - mu0) * (exp(-tau / mu) - exp(-tau / mu0))


def airlight(sigma_s, sigma_t, g, past, distance, steps=200000):
    """Radiance scattered once in endless fog about a point of intensity 1 per steradian, which the ray passes by at `past`, `distance` from
    its origin: over the angle u at the light, t = distance + past tan(u), in which 1 / r^2 dt is du / past."""
    start = -math.atan(distance / past)
    h = (pi / 2 - start) / steps
    angles = (start + (i + 0.5) * h for i in range(steps))
    return sigma_s / past * h * sum(hg(g, 1 + math.copysign(1, g) * math.sin(u)) * exp(-sigma_t * (distance + past * (math.tan(u) + 1 / math.cos(u))))
                                    for u in angles)


def expint(n, x):
    """Exponential integral E_n: the series of E_1 for x <= 1, else a continued fraction (Abramowitz & Stegun 5.1)."""
    if x == 0:
        return 1.0 / (n - 1)
    if x > 1:
        fraction = 0.0
        for k in range(60, 0, -1):
            fraction = k * (n + k - 1) / (x + n + 2 * k - fraction)
        return exp(-x) / (x + n - fraction)
    e = -0.57721566490153286 - math.log(x) - sum((-x) ** k / (k * math.factorial(k)) for k in range(1, 25))
    for k in range(1, n):
        e = (exp(-x) - x * e) / k
    return e


def depth_one_furnace(tau, steps=20000):
    """A slab of albedo 1 in a sky of 1, paths of at most one scattering: those that pass, and those that scatter
    isotropically at t and then leave on either side."""
    h = tau / steps
    once = sum(exp(-t) * (expint(2, t) + expint(2, tau - t)) for t in ((i + 0.5) * h for i in range(steps)))
    return exp(-tau) + 0.5 * h * once


def solve(row, right):
    """Conjugate gradients for a symmetric positive Toeplitz matrix."""
    n = len(right)
    band = row[:0:-1] + row
    x, r = [0.0] * n, right[:]
    p, rr = r[:], sum(v * v for v in r)
    for _ in range(4 * n):
        q = [sum(map(float.__mul__, band[n - 1 - i:2 * n - 1 - i], p)) for i in range(n)]
        step = rr / sum(map(float.__mul__, p, q))
        x = [a + step * b for a, b in zip(x, p)]
        r = [a - step * b for a, b in zip(r, q)]
        rest = sum(v * v for v in r)
        if rest < 1e-26:
            break
        p = [a + rest / rr * b for a, b in zip(r, p)]
        rr = rest
    return x


def conservative_slab(tau, n):
    """Milne's equation J(t) = 1/2 int E1|t - s| J(s) ds + exp(-t) / 4 pi, J constant in n cells and the equation taken
    in the mean over each, which loses no light; for a beam of irradiance 1 along the normal. Returns radiance along the
    normal, back and through, and reflected and transmitted flux."""
    h = tau / n
    third = [expint(3, k * h) for k in range(n + 1)]
    kernel = [2 / h * (h - 0.5 + third[1])] + [(third[k - 1] - 2 * third[k] + third[k + 1]) / h for k in range(1, n)]
    row = [(1.0 if k == 0 else 0.0) - 0.5 * kernel[k] for k in range(n)]
    beam = [(exp(-k * h) - exp(-(k + 1) * h)) / h / (4 * pi) for k in range(n)]
    J = solve(row, beam)
    back = sum(J[k] * (exp(-k * h) - exp(-(k + 1) * h)) for k in range(n))
    through = sum(J[n - 1 - k] * (exp(-k * h) - exp(-(k + 1) * h)) for k in range(n))
    flux = [2 * pi * (third[k] - third[k + 1]) for k in range(n)]
    reflected = sum(J[k] * flux[k] for k in range(n))
    transmitted = sum(J[n - 1 - k] * flux[k] for k in range(n)) + exp(-tau)
    return back, through, reflected, transmitted


def refined_slab(tau, n=150):
    """The error of conservative_slab is of second order: one step of Richardson's extrapolation."""
    coarse, fine = conservative_slab(tau, n), conservative_slab(tau, 2 * n)
    result = [(4 * f - c) / 3 for c, f in zip(coarse, fine)]
    assert abs(result[2] + result[3] - 1) < 1e-9, result
    return result


def gauss_legendre(n):
    """Nodes and weights on [0, 1], by Newton's method."""
    nodes = []
    for i in range(n):
        x = math.cos(pi * (i + 0.75) / (n + 0.5))
        for _ in range(10):
            p, before = 1.0, 0.0
            for k in range(1, n + 1):
                p, before = ((2 * k - 1) * x * p - (k - 1) * before) / k, p
            slope = n * (x * p - before) / (x * x - 1)
            x -= p / slope
        nodes.append(((1 + x) / 2, 1 / ((1 - x * x) * slope * slope)))
    return nodes


def h_function(albedo, mu):
    """Chandrasekhar's, by iteration of 1/H(mu) = sqrt(1 - w) + w/2 int x H(x) / (x + mu) dx, x = y^2."""
    nodes = [(y * y, 2 * y * w) for y, w in gauss_legendre(40)]

    def at(m, H):
        return 1 / (sqrt(1 - albedo) + 0.5 * albedo * sum(w * x * h / (x + m) for (x, w), h in zip(nodes, H)))

    H = [1.0] * len(nodes)
    for _ in range(400):
        H = [at(x, H) for x, _ in nodes]
    return at(mu, H)


def plane_albedo(albedo):
    return 1 - sqrt(1 - albedo) * h_function(albedo, 1.0)


def back_along_beam(albedo):
    return albedo * h_function(albedo, 1.0) ** 2 / (8 * pi)


def ball_window(sigma, x0, x1, y0, y1, n=600):
    """Mean transmittance of a unit ball over a window, seen from infinity."""
    total = 0.0
    for j in range(n):
        y = y0 + (y1 - y0) * (j + 0.5) / n
        for i in range(n):
            x = x0 + (x1 - x0) * (i + 0.5) / n
            total += exp(-2 * sigma * sqrt(max(0.0, 1 - x * x - y * y)))
    return total / n / n


def sheared_depth(sigma):
    """Through the first and last layer of 16 samples, along -z: sigma * 16 / |dk/dz|."""
    a, b, c = (0.4, 0.15, 0.0), (-0.2, 0.5, 0.1), (0.1, -0.05, -0.75)  # images of the index axes
    det = (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]))
    return sigma * 16 / abs((a[0] * b[1] - a[1] * b[0]) / det)


def planck_rgb(kelvin, reference, step=0.1):
    """Linear Rec. 709 of Planck's law under the CIE observer of 1931; luminance 1 at reference."""
    def xyz(T):
        total = [0.0, 0.0, 0.0]
        for i in range(round(470 / step)):
            nm = 360 + (i + 0.5) * step
            planck = nm ** -5 / math.expm1(1.438776877e7 / (nm * T))
            total = [sum + planck * seen for sum, seen in zip(total, observer(nm))]
        return total

    luminance = xyz(reference)[1]
    X, Y, Z = (v / luminance for v in xyz(kelvin))
    rgb = (3.2404542 * X - 1.5371385 * Y - 0.4985314 * Z, -0.9692660 * X + 1.8760108 * Y + 0.0415560 * Z,
           0.0556434 * X - 0.2040259 * Y + 1.0572252 * Z)
    return tuple(max(c, 0.0) for c in rgb)


isotropic = 1 / (4 * pi)
oblique = 3 * slab_reflection(0.9, isotropic, 1.0, 0.6)  # irradiance 3, albedo 0.9, tau 1
peak = 1e-6 * 0.5 * hg(0.9999, 1 - math.cos(math.atan(1e-4)))  # irradiance 1e-6, albedo 0.5

FORMULAS = {
    "01-absorbing-slab": lambda: grey(exp(-1)),
    "01-absorbing-slab-closed-form": lambda: grey(exp(-1)),
    "01-absorbing-slab-closed-form-8": lambda: grey(exp(-8)),
    "01-absorbing-slab-closed-form-17": lambda: grey(exp(-17)),
    "01-absorbing-slab-closed-form-87": lambda: grey(exp(-87)),
    "01-absorbing-slab-marched": lambda: grey(exp(-8)),
    "01-opaque-slab": lambda: grey(0.0),
    "02-emissive-slab": lambda: tuple(le * -math.expm1(-1) + lb * exp(-1) for le, lb in zip((4, 2, 1), (.25, .5, 2))),
    "02-emissive-opaque-slab": lambda: (4, 2, 1),
    "03-thin-slab": lambda: grey(1e6 * slab_reflection(0.8, isotropic, 1e-6, 0.6)),
    "03-thinner-slab": lambda: grey(1e9 * slab_reflection(0.8, isotropic, 1e-9, 0.6)),
    "03-thin-grid": lambda: grey(1e6 * slab_reflection(0.8, isotropic, 1e-6, 1.0)),
    "04-furnace-sphere": lambda: (0.5, 1, 1.5),
    "04-furnace-box": lambda: (0.5, 1, 1.5),
    "04-furnace-grid": lambda: (0.5, 1, 1.5),
    "05-furnace-depth-limit": lambda: grey(depth_one_furnace(1.0)),
    "06-conservative-slab-reflection": lambda: grey(refined_slab(5.0)[0]),
    "06-conservative-slab-transmission": lambda: grey(refined_slab(5.0)[1]),
    "07-semi-infinite-sky-0.5": lambda: grey(plane_albedo(0.5)),
    "07-semi-infinite-sky-0.9": lambda: grey(plane_albedo(0.9)),
    "07-semi-infinite-sky-0.99": lambda: grey(plane_albedo(0.99)),
    "07-semi-infinite-beam-0.5": lambda: grey(back_along_beam(0.5)),
    "07-semi-infinite-beam-0.9": lambda: grey(back_along_beam(0.9)),
    "07-semi-infinite-beam-0.99": lambda: grey(back_along_beam(0.99)),
    "08-single-scattering-reflection": lambda: grey(3 * slab_reflection(0.9, hg(0.5, 1 + 0.6), 1.0, 0.6)),
    "08-single-scattering-transmission": lambda: grey(3 * slab_transmission(0.9, hg(0.5, 1 - 0.6), 1.0, 0.6)),
    "09-point-in-fog": lambda: grey(airlight(0.3, 0.4, 0.0, 0.05, 5.0)),
    "09-point-in-fog-forward": lambda: grey(airlight(0.3, 0.4, 0.8, 0.05, 5.0)),
    "09-point-in-fog-beside": lambda: grey(airlight(0.3, 0.4, 0.0, 0.005, 5.0)),
    "10-chromatic-albedo": lambda: (plane_albedo(0.99), plane_albedo(0.5), 0.0),
    "10-chromatic-extinction": lambda: (exp(-1), exp(-0.25), 1.0),
    "10-chromatic-extinction-closed-form": lambda: (exp(-1), exp(-0.25), 1.0),
    "10-chromatic-extinction-grid": lambda: (exp(-1), exp(-0.25), 1.0),
    "11-forward-peak": lambda: grey(peak * exp(-1)),
    "11-backward-peak": lambda: grey(peak * 0.5 * -math.expm1(-2)),
    "13-empty-grid": lambda: (0.3, 0.5, 0.9),
    "13-zero-density": lambda: (0.3, 0.5, 0.9),
    "14-spike": lambda: grey(exp(-0.5 * 2)),
    "14-spike-loose-majorant": lambda: grey(exp(-0.5 * 2)),
    "15-low-majorant": lambda: grey(exp(-1)),
    "16-tight-majorant": lambda: grey(exp(-1)),
    "17-unclean-grid": lambda: grey(exp(-0.125 * 12 * 0.5)),
    "18-constant-grid": lambda: grey(exp(-1)),
    "19-ray-in-voxel-faces": lambda: grey(exp(-1)),
    "19-ray-in-voxel-faces-backwards": lambda: grey(exp(-1)),
    "19-ray-in-border-face": lambda: grey(1.0),
    "20-camera-in-sphere": lambda: grey(exp(-1.2)),
    "20-camera-on-sphere": lambda: grey(exp(-1.2)),
    "21-scale-1e-5": lambda: grey(oblique),
    "21-scale-1e6": lambda: grey(oblique),
    "22-offset": lambda: grey(oblique),
    "22-offset-grid": lambda: grey(3 * slab_reflection(0.9, isotropic, 1.0, 1.0)),
    "23-far-camera": lambda: grey(ball_window(1.0, 0.3, 1.2, -0.45, 0.45)),
    "24-sheared-grid": lambda: grey(exp(-sheared_depth(0.125))),
    "26-roulette-negative-weights": lambda: grey(1.0),
    "32-constant-grid-scattering": lambda: grey(3 * slab_reflection(0.9, isotropic, 1.0, 1.0)),
    "33-blackbody": lambda: tuple(1e-3 * c for c in planck_rgb(3000, 1500)),
    "33-blackbody-cold": lambda: grey(0.0),
    "34-ramp": lambda: grey(exp(-1)),
    "34-ramp-fp8": lambda: grey(exp(-1)),
    "34-ramp-fp4": lambda: grey(exp(-1)),
}


def check(path):
    """An error message, or nothing."""
    mean = [float(v) for v in ET.parse(path).getroot().find("expected").get("mean").split()]
    mean = mean * 3 if len(mean) == 1 else mean
    if path.stem not in FORMULAS:
        return f"{path}: no formula in {pathlib.Path(__file__).name}; add one"
    computed = FORMULAS[path.stem]()
    if any(abs(a - b) > 1e-6 * abs(b) for a, b in zip(mean, computed)):
        return f"{path}: expects {mean}, but its formula gives {computed}"
    return None


def main():
    if sys.argv[1:]:
        for name in sys.argv[1:]:
            print(name, *FORMULAS[name]())
        return 0
    errors = [error for error in map(check, sorted(SCENES.glob("*.xml"))) if error]
    print(*errors, sep="\n", end="\n" if errors else "")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
