"""Whether readings are the figures."""

import math
from dataclasses import dataclass
from statistics import NormalDist


@dataclass
class Verdict:
    case: object
    label: str
    reading: float
    error: float  # standard error of it
    published: float
    slack: float

    @property
    def z(self):
        if not math.isfinite(self.error):
            return math.inf  # of a reading that nothing is known of
        apart, known_to = self.reading - self.published, math.hypot(self.error, self.slack)
        return apart / known_to if known_to > 0.0 else math.copysign(math.inf, apart) if apart else 0.0


def limit(count, alpha=0.01):
    """Of |z| over `count` figures, if all together may fail by chance with probability alpha (Sidak)."""
    return NormalDist().inv_cdf(0.5 + 0.5 * (1.0 - alpha) ** (1.0 / count))


def scatter(case, rows):
    """Of a consensus whose own is not published, for each figure: by how much neighbouring figures differ at random from the readings. From
    second differences, so that whatever differs smoothly, or all alike, is no part of it. Its square is in proportion to the figure, as that of
    what is counted is (of none as of the least that was): so it is in Landsat's nadir radiance, octile by octile. No more than a tenth of the figures, nor than 0.7 of what these
    themselves differ so: a map that is moved by a column would have more than all of that, and is seen if its columns are thousands."""
    apart = [case.scale * mean - published for (mean, _), published in zip(rows, case.published, strict=True)]
    own = sum((case.scale * error) ** 2 for _, error in rows) / len(rows)
    usual = sum(map(abs, case.published)) / len(case.published)
    of_usual = min(math.sqrt(max(0.0, roughness(apart) - own)), 0.1 * usual, 0.7 * math.sqrt(roughness(case.published)))
    least = min(abs(published) for published in case.published if published)
    return [of_usual * math.sqrt(max(abs(published), least) / usual) for published in case.published]


def roughness(values):
    """The variance of what differs at random between neighbours."""
    second = [a - 2.0 * b + c for a, b, c in zip(values, values[1:], values[2:])]
    return sum(x * x for x in second) / (6.0 * len(second))


def judge(case, rows, mean_error):
    """Of each figure, and of their mean, of that error, where it is published."""
    less = case.less or [0.0] * len(rows)
    slacks = case.slack or scatter(case, rows)
    found = [Verdict(case, label, case.scale * mean - known, case.scale * error, published, slack)
             for label, (mean, error), published, slack, known in zip(case.labels, rows, case.published, slacks, less, strict=True)]
    if case.mean:
        n = len(found)
        found.append(Verdict(case, "mean", sum(v.reading for v in found) / n, case.scale * mean_error, *case.mean))
    return found
