"""tools/against.py: what counts as a loss of efficiency."""

import pathlib
import sys
import types
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import against  # noqa: E402


def renders(variances, seconds):
    return [types.SimpleNamespace(mean=np.ones((4, 4, 3)), variance=np.full((4, 4, 3), variance), seconds=second)
            for variance, second in zip(variances, seconds)]


class Ratios(unittest.TestCase):
    def test_half_the_variance_in_half_the_time_is_four_times_the_efficiency(self):
        efficiency, speed, lost = against.ratios(renders([0.2] * 5, [2.0] * 5), renders([0.1] * 5, [1.0] * 5), 0.95)
        self.assertAlmostEqual(efficiency["value"], 4.0)
        self.assertAlmostEqual(efficiency["low"], 4.0)
        self.assertAlmostEqual(speed["value"], 2.0)
        self.assertFalse(lost)

    def test_a_loss_is_one_that_rounds_agree_on(self):
        steady = [1.0, 1.01, 0.99, 1.0, 1.0]
        slower = [1.1 * seconds for seconds in steady]
        self.assertTrue(against.ratios(renders([0.1] * 5, steady), renders([0.1] * 5, slower), 0.95)[2])
        self.assertFalse(against.ratios(renders([0.1] * 5, slower), renders([0.1] * 5, steady), 0.95)[2])
        noisy = [0.9, 1.4, 0.9, 1.3, 1.0]
        efficiency, _, lost = against.ratios(renders([0.1] * 5, steady), renders([0.1] * 5, noisy), 0.95)
        self.assertLess(efficiency["value"], 1.0)
        self.assertFalse(lost)
        # The more scenes there are, the surer each has to be.
        small = [1.0, 1.02, 1.03, 1.01, 1.025]
        self.assertTrue(against.ratios(renders([0.1] * 5, [1.0] * 5), renders([0.1] * 5, small), 0.95)[2])
        self.assertFalse(against.ratios(renders([0.1] * 5, [1.0] * 5), renders([0.1] * 5, small), 0.95 ** 0.001)[2])


if __name__ == "__main__":
    unittest.main()
