"""How cost grows: a power law fitted to the points of a series, and what may be said of it."""
import math
from dataclasses import dataclass
from typing import Optional

import numpy

from .interval import Interval, count, number, quotient

# Student's t, 97.5 %, for 1 to 30 degrees of freedom; beyond, the normal value with its first correction.
STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131,
           2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042)


def student(freedom):
    return STUDENT[freedom - 1] if freedom <= len(STUDENT) else 1.96 + 2.4 / freedom


@dataclass
class Fit:
    exponent: Interval
    constant: float  # seconds = constant * x ^ exponent
    first: float     # exponents between the first two points and the last two
    last: float
    curved: bool     # a parabola in logarithms fits measurably better, and the ends differ by more than NEAR


NEAR = 0.1  # exponents this close are called the same; 10 times the work then costs within 26 % of 10 times the time


def least_squares(columns, y):
    """Coefficients and their 95 % half-widths, None where no degree of freedom is left."""
    matrix = numpy.stack(columns, axis=1)
    coefficients, *_ = numpy.linalg.lstsq(matrix, y, rcond=None)
    freedom = len(y) - matrix.shape[1]
    if freedom < 1:
        return coefficients, None
    variance = float(numpy.sum((y - matrix @ coefficients) ** 2)) / freedom
    covariance = variance * numpy.linalg.inv(matrix.T @ matrix)
    return coefficients, student(freedom) * numpy.sqrt(numpy.diag(covariance))


def fit(points) -> Optional[Fit]:
    positive = [(math.log(x), math.log(s)) for x, s, *_ in points if x > 0 and s > 0]
    if len({x for x, _ in positive}) < 2:
        return None
    x, y = numpy.array(positive).T
    centre = x.mean()  # keeps the columns far from parallel
    (level, slope), halves = least_squares([numpy.ones_like(x), x - centre], y)
    steps = [(y[j] - y[i]) / (x[j] - x[i]) for i, j in ((0, 1), (-2, -1)) if x[j] > x[i]]
    first, last = steps[0], steps[-1]
    curved = False
    if len(set(x)) >= 4:
        parabola, widths = least_squares([numpy.ones_like(x), x - centre, (x - centre) ** 2], y)
        curved = bool(widths is not None and abs(parabola[2]) > widths[2] and abs(last - first) > NEAR)
    half = halves[1] if halves is not None else None
    exponent = Interval(float(slope), *(() if half is None else (float(slope - half), float(slope + half))))
    return Fit(exponent, math.exp(level - slope * centre), float(first), float(last), curved)


def seconds(point):
    """With the range of its runs; a single run has none."""
    _, middle, low, high = point
    return Interval(middle) if low == high else Interval(middle, low, high)


def describe(series, law):
    """One sentence. `law` is the fit of the series."""
    what = f"{scene_name(series)}: cost against {series.name}"
    if law is None:
        return f"{what} needs two points or more."
    if law.exponent.low is None:
        ratio = quotient(seconds(series.points[-1]), seconds(series.points[0]))
        runs = "range of the runs" if ratio.bounded else "of single runs"
        return (f"{what}: from {count(series.points[0][0])} to {count(series.points[-1][0])} {series.unit} the seconds change by a "
                f"factor of {ratio} ({runs}); too few points for an exponent.")
    if law.curved:
        return (f"{what} follows no single power: its exponent goes from {number(law.first)} between the first two points to "
                f"{number(law.last)} between the last two" + (": near-linear there." if abs(law.last - 1) <= NEAR else "."))
    return f"{what} grows as its power {law.exponent}: {verdict(law.exponent)}."


def verdict(exponent):
    low, high = exponent.low, exponent.high
    if 1 - NEAR <= low and high <= 1 + NEAR:
        return "near-linear"
    if -NEAR <= low and high <= NEAR:
        return "it hardly matters"
    if low <= 0 and 1 <= high:
        return "these points cannot tell how"
    if low <= 1 <= high:
        return "linear within what the points can tell"
    if low <= 0 <= high:
        return "no measurable dependence"
    return "more than linear" if low > 1 else "less than linear" if low > 0 else "the more, the faster"


def scene_name(series):
    return series.scene.rsplit("/", 1)[-1].removesuffix(".xml")
