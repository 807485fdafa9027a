"""tools/peers/contest.py: renderers are given as many samples as take the time that was asked for."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools/peers"))
from contest import NEAR, Measured, check_times  # noqa: E402


class Renderer:
    """One whose seconds are a function of samples; the first of a number compiles for `compiling` more."""

    def __init__(self, seconds_of, compiling=0.0):
        self.seconds_of, self.compiling, self.compiled, self.renders = seconds_of, compiling, set(), 0

    def name(self):
        return "fake"

    def warm_up(self):
        pass

    def render(self, samples, seed):
        seconds = self.seconds_of(samples) + (self.compiling if samples not in self.compiled else 0.0)
        self.compiled.add(samples)
        self.renders += 1
        return None, seconds, 2.0


class Calibration(unittest.TestCase):
    def calibrated(self, renderer, target):
        measured = Measured(renderer)
        told = measured.calibrate(target, 1)
        return measured, told

    def test_as_long_as_asked_for_whatever_short_renders_cost(self):
        def short_are_slow(samples):  # a third of the speed below 100 samples
            return 0.02 * (min(samples, 100) + max(samples - 100, 0) / 3)

        for seconds_of in (short_are_slow, lambda n: 0.3 + 0.001 * n, lambda n: 0.01 * n):
            renderer = Renderer(seconds_of)
            measured, told = self.calibrated(renderer, 6.0)
            self.assertEqual(told, seconds_of(measured.samples))
            self.assertLess(max(told / 6.0, 6.0 / told), NEAR)
            self.assertLess(renderer.renders, 20)

    def test_compiling_is_not_taken_for_rendering(self):
        renderer = Renderer(lambda n: 0.01 * n, compiling=1.5)
        measured, told = self.calibrated(renderer, 2.0)
        self.assertLess(renderer.renders, 20)
        self.assertLessEqual(told, 2.0 * NEAR)

    def test_one_sample_may_take_longer(self):
        measured, told = self.calibrated(Renderer(lambda n: 9.0 * n), 6.0)
        self.assertEqual((measured.samples, told), (1, 9.0))

    def test_unlike_times_are_refused(self):
        check_times({"vkvol": 6.0, "peer": 8.9})
        with self.assertRaisesRegex(SystemExit, "vkvol 0.30, peer 6.00; give more --time"):
            check_times({"vkvol": 0.3, "peer": 6.0})


if __name__ == "__main__":
    unittest.main()
