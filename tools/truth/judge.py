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


def judge(case, rows):
    """Of each figure, and of their mean where that is published."""
    less = case.less or [0.0] * len(rows)
    found = [Verdict(case, label, case.scale * mean - known, case.scale * error, published, slack)
             for label, (mean, error), published, slack, known in zip(case.labels, rows, case.published, case.slack, less, strict=True)]
    if case.mean:
        n = len(found)
        found.append(Verdict(case, "mean", sum(v.reading for v in found) / n, math.sqrt(sum(v.error**2 for v in found)) / n, *case.mean))
    return found
