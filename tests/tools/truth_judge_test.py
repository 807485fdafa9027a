"""What tools/truth judges by, where a consensus has a scatter that nobody printed."""

import math
import pathlib
import random
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))

from truth import judge
from truth.case import Case


def map_of(columns, seed):
    """Something rough, of values between 0.02 and 1."""
    draw = random.Random(seed)
    return [0.02 + 0.98 * (0.5 + 0.5 * math.sin(0.01 * i)) * draw.random() for i in range(columns)]


def case_of(published):
    return Case("a map", "I", "nobody", "", [str(i) for i in range(len(published))], published, [])


class Scatter(unittest.TestCase):
    COLUMNS = 20000

    def counted(self, truth, scatter, seed):
        draw = random.Random(seed)
        usual = sum(truth) / len(truth)
        return [value + draw.gauss(0.0, scatter * math.sqrt(value / usual)) for value in truth]

    def test_a_count_s_scatter_is_found_beneath_noise_of_readings(self):
        truth = map_of(self.COLUMNS, 1)
        draw = random.Random(2)
        rows = [(value + draw.gauss(0.0, 0.02), 0.02) for value in truth]
        verdicts = judge.judge(case_of(self.counted(truth, 0.02, 3)), rows, 0.0)
        mean_square = sum(v.z**2 for v in verdicts) / len(verdicts)
        self.assertLess(abs(mean_square - 1.0), 5.0 * math.sqrt(2.0 / self.COLUMNS) + 0.02)  # and what the scatter itself is known to
        self.assertTrue(all(abs(v.z) < judge.limit(self.COLUMNS) for v in verdicts))
        # Its square goes with the figure.
        dark, bright = min(verdicts, key=lambda v: v.published), max(verdicts, key=lambda v: v.published)
        self.assertAlmostEqual(bright.slack / dark.slack, math.sqrt(bright.published / dark.published), 6)

    def test_a_map_that_is_moved_by_a_column_is_seen(self):
        truth = map_of(self.COLUMNS, 4)
        rows = [(value, 1e-4) for value in truth[1:] + truth[:1]]
        verdicts = judge.judge(case_of(self.counted(truth, 0.001, 5)), rows, 0.0)
        self.assertGreater(max(abs(v.z) for v in verdicts), judge.limit(self.COLUMNS))

    def test_so_is_one_as_smooth_as_its_own_noise_may_be(self):
        draw = random.Random(7)
        truth = [draw.gauss(1.0, 0.01) for _ in range(self.COLUMNS)]
        verdicts = judge.judge(case_of(truth), [(value, 1e-5) for value in truth[1:] + truth[:1]], 0.0)
        self.assertGreater(max(abs(v.z) for v in verdicts), judge.limit(self.COLUMNS))

    def test_exact_readings_of_exact_figures_have_no_slack(self):
        truth = map_of(200, 6)
        self.assertTrue(all(v.slack == 0.0 for v in judge.judge(case_of(truth), [(value, 1e-3) for value in truth], 0.0)))


class Nothing(unittest.TestCase):
    def test_figures_and_readings_of_none_agree(self):
        published = [0.0, 0.0, 0.4, 0.2] * 50
        verdicts = judge.judge(case_of(published), [(value, 0.1 * value) for value in published], 0.0)
        self.assertEqual([v.z for v in verdicts], [0.0] * 200)
        dark = judge.judge(case_of(published), [(value or 1e-3, 0.0) for value in published], 0.0)
        self.assertTrue(all(v.z > 0.0 for v in dark if v.published == 0.0))


if __name__ == "__main__":
    unittest.main()
