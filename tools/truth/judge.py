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
        return (self.reading - self.published) / math.hypot(self.error, self.slack)


def limit(count, alpha=0.01):
    """Of |z| over `count` figures, if all together may fail by chance with probability alpha (Sidak)."""
    return NormalDist().inv_cdf(0.5 + 0.5 * (1.0 - alpha) ** (1.0 / count))


def scatter(case, rows):
    """Of a consensus whose own is not published: by how much neighbouring figures differ at random from the readings. From second
    differences, so that whatever differs smoothly, or all alike, is no part of it. No more than a tenth of the figures, so that a wrong
    map cannot excuse itself."""
    apart = [case.scale * mean - published for (mean, _), published in zip(rows, case.published, strict=True)]
    rough = [a - 2.0 * b + c for a, b, c in zip(apart, apart[1:], apart[2:])]
    own = sum((case.scale * error) ** 2 for _, error in rows) / len(rows)
    most = 0.1 * sum(map(abs, case.published)) / len(case.published)
    return min(math.sqrt(max(0.0, sum(x * x for x in rough) / (6.0 * len(rough)) - own)), most)


def judge(case, rows, mean_error):
    """Of each figure, and of their mean, of that error, where it is published."""
    less = case.less or [0.0] * len(rows)
    slacks = case.slack or [scatter(case, rows)] * len(rows)
    found = [Verdict(case, label, case.scale * mean - known, case.scale * error, published, slack)
             for label, (mean, error), published, slack, known in zip(case.labels, rows, case.published, slacks, less, strict=True)]
    if case.mean:
        n = len(found)
        found.append(Verdict(case, "mean", sum(v.reading for v in found) / n, case.scale * mean_error, *case.mean))
    return found
