"""Errors of pictures by blocks of pixels, so that a technique that seldom finds its light has an error that tells: what is missing. Of
single pixels, one that a technique never found has the relative error 1, and one that it found once many times more. Needs NumPy."""

import pathlib
import sys

import numpy as np

import table_runs

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "peers"))
import exr  # noqa: E402
from contest import interval  # noqa: E402

SIZE = 4


def in_blocks(image):
    """[row, column, channel]: sums over blocks of SIZE x SIZE pixels."""
    rows, columns, channels = image.shape
    return image.reshape(rows // SIZE, SIZE, columns // SIZE, SIZE, channels).sum(axis=(1, 3))


class Truth:
    """What blocks sum to, and the variances with which that is known."""

    def __init__(self, sums, variances=0.0):
        self.sums, self.variances = sums, variances

    @classmethod
    def of(cls, picture):
        mean, variance, _ = exr.read_rgb(picture)
        return cls(in_blocks(mean), in_blocks(variance))

    def squares(self, picture):
        """Of each block the squared error, less what is due to how well the truth is known."""
        return (in_blocks(exr.read_rgb(picture)[0]) - self.sums) ** 2 - self.variances

    def error(self, picture):
        """Mean squared error over the mean square: of bright blocks most. No less than the truth is known to."""
        return float(max(np.sum(self.squares(picture)), np.sum(self.variances * np.ones_like(self.sums))) / np.sum(self.sums ** 2))

    def relative_error(self, picture):
        """The mean of relative squared errors of all blocks that have a thousandth of the mean: of all alike. No less than they are known to."""
        lit = self.sums > 1e-3 * self.sums.mean()
        if not lit.any():
            sys.exit("the reference is black")
        known_to = np.mean((self.variances * np.ones_like(self.sums))[lit] / self.sums[lit] ** 2)
        return float(max(np.mean(self.squares(picture)[lit] / self.sums[lit] ** 2), known_to))


def in_alternation(options, scene, ways, picture, error, *more):
    """For each of `ways`, name: (program, integrator), (error, seconds of rendering) of options.runs seeds. `error`: of `picture`."""
    found = {way: [] for way in ways}
    for run in range(options.runs):
        for way, (vkvol, integrator) in ways.items():
            report = table_runs.render(vkvol, scene, integrator, run + 1, options.spp, picture, *more)
            found[way].append((error(picture), report["seconds"]["render"]))
    return found


def ratios(found, way, usual, confidence=0.95):
    """Geometric means of errors, seconds and efficiencies, 1 / (error x seconds), of one way over those of another, run by run; the last
    with its interval."""
    pairs = list(zip(found[way], found[usual]))
    error, seconds = (float(np.exp(np.mean([np.log(a[k] / b[k]) for a, b in pairs]))) for k in (0, 1))
    gain = interval([float(np.log(b[0] * b[1] / (a[0] * a[1]))) for a, b in pairs], confidence)
    return error, seconds, gain


def efficiency_of_means(found, way, usual, confidence=0.95, draws=4000):
    """Mean error times mean seconds of the usual way over those of another, with the interval of as many runs drawn from these."""
    rng = np.random.default_rng(1)
    a, b = np.array(found[way]), np.array(found[usual])

    def cost(runs, drawn):  # [draw, run, (error, seconds)]
        return np.prod(runs[drawn].mean(axis=1), axis=-1)

    same = rng.integers(len(a), size=(draws, len(a)))  # runs are in alternation: what is drawn of one way is drawn of the other
    low, high = np.quantile(cost(b, same) / cost(a, same), [(1 - confidence) / 2, (1 + confidence) / 2])
    everything = np.arange(len(a))[None]
    return {"value": float((cost(b, everything) / cost(a, everything))[0]), "low": float(low), "high": float(high)}


def of_means(found, way, usual):
    gain = efficiency_of_means(found, way, usual)
    return f"{gain['value']:9.3g}  {gain['low']:8.3g} {gain['high']:8.3g}"


HEAD = f"{'error':>10} {'seconds':>8} {'efficiency':>11}  {'interval':>17}"


def columns(found, way, usual):
    error, seconds, gain = ratios(found, way, usual)
    return f"{error:10.3g} {seconds:8.2f} {gain['value']:11.3g}  {gain['low']:8.3g} {gain['high']:8.3g}"
