"""tools/mie.py: the limits that are known in closed form, and energy."""

import importlib.util
import pathlib
import subprocess
import sys
import unittest

import numpy as np

PATH = pathlib.Path(__file__).resolve().parents[2] / "tools" / "mie.py"
SPEC = importlib.util.spec_from_file_location("mie", PATH)
mie = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(mie)


class MieTest(unittest.TestCase):
    def test_small_balls_scatter_as_rayleigh_says(self):
        mu = np.linspace(-1, 1, 41)
        x = 1e-3  # what is left out is of the order of x squared
        s1, s2 = mie.amplitudes(x, 1.333, mu)
        value = 0.5 * (abs(s1) ** 2 + abs(s2) ** 2)
        np.testing.assert_allclose(value / value[20], 1 + mu**2, rtol=1e-5)
        polarisability = (1.333**2 - 1) / (1.333**2 + 2)
        np.testing.assert_allclose(value[20], 0.5 * x**6 * polarisability**2, rtol=1e-5)

    def test_what_does_not_absorb_scatters_all_that_it_takes(self):
        """The optical theorem: the amplitude straight on tells the extinction, the intensity's integral the scattering."""
        for x in (0.5, 3.0, 40.0):
            nodes, weights = np.polynomial.legendre.leggauss(400)  # exact: the intensity is a polynomial of degree < 200
            s1, s2 = mie.amplitudes(x, 1.333, nodes)
            scattered = np.sum(weights * (abs(s1) ** 2 + abs(s2) ** 2)) / x**2
            straight_on, _ = mie.amplitudes(x, 1.333, np.ones(1))
            self.assertAlmostEqual(scattered / (4 / x**2 * straight_on[0].real), 1.0, places=8)

    def test_indices_that_would_amplify_are_refused(self):
        for index in ("1.5-0.1j", "1", "-1.3"):
            done = subprocess.run([sys.executable, PATH, "--diameter", "1", f"--index={index}"], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2)
            self.assertIn("--index is n+kj", done.stderr)


if __name__ == "__main__":
    unittest.main()
