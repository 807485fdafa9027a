"""Which unbiased estimator suits a scene, and how sure that is."""
from dataclasses import dataclass
from typing import Optional

from .interval import Interval
from .measurements import Estimator


@dataclass
class Choice:
    best: Optional[Estimator]     # of the unbiased ones, by the value alone
    advised: Optional[Estimator]  # the default if nothing is measurably better, else the best
    gain: Interval                # over the default's efficiency: of the advised one, or of `best` if that is no gain for sure
    ties: list                    # unbiased ones that do not measurably differ from the advised one
    noise: float                  # share of the reference's own error in the smallest squared difference measured

    @property
    def judged(self):
        """Once half of what was measured is the reference's noise, taking it off leaves more doubt than result."""
        return self.best is not None and self.noise <= 0.5


def reference_share(bench):
    own = bench.reference["relmse"]
    if own is None:
        return 0.0
    shares = [own / (own + max(e.longest.relmse, 0)) for e in bench.estimators
              if own > 0 and e.longest and e.longest.relmse is not None]
    return max(shares, default=0.0)


def choose(bench):
    best = max(bench.unbiased, key=lambda e: e.efficiency.value, default=None)
    default = bench.default
    advised, gain = best, Interval(None)
    if best is not None and default in bench.unbiased:
        gains = {e.name: bench.ratio(e, default) for e in bench.unbiased if e is not default}
        better = [e for e in bench.unbiased if e is not default and measurably_above(gains[e.name])]
        advised = max(better, key=lambda e: e.efficiency.value, default=default)
        gain = gains.get((advised if better else best).name, gain)
    ties = [e for e in bench.unbiased if e is not advised and not bench.ratio(e, advised).excludes(1)]
    return Choice(best, advised, gain, ties, reference_share(bench))


def measurably_above(ratio):
    return ratio.excludes(1) and ratio.value > 1
