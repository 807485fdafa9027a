#!/usr/bin/env python3
"""Mie's theory of scattering by balls, as a table for <phase file="...">table</phase>: angles in degrees and values.

    tools/mie.py --diameter 20 > droplets.txt         water droplets of 20 micrometres on average, in green light
    tools/mie.py --diameter 1 --index 1.5+0.01j       dust

Diameters follow a gamma distribution of this mean and a standard deviation of --spread times it, which blurs the ripples
of a single size. After Bohren and Huffman, "Absorption and Scattering of Light by Small Particles" (1983), chapter 4.
"""

import argparse

import numpy as np


def amplitudes(x, m, mu):
    """S1 and S2 at the cosines mu, of a ball of size parameter x = pi diameter / wavelength and relative index m."""
    last = int(np.ceil(x + 4.05 * x ** (1 / 3) + 2))
    start = int(max(last, np.ceil(abs(m * x)))) + 15
    log_derivative = np.zeros(start + 1, complex)  # of psi_n(m x), downwards
    for n in range(start, 0, -1):
        log_derivative[n - 1] = n / (m * x) - 1 / (log_derivative[n] + n / (m * x))
    psi_before, psi, chi_before, chi = np.cos(x), np.sin(x), -np.sin(x), np.cos(x)
    pi_before, pi = np.zeros_like(mu), np.ones_like(mu)
    s1, s2 = np.zeros(mu.shape, complex), np.zeros(mu.shape, complex)
    for n in range(1, last + 1):
        psi_before, psi = psi, (2 * n - 1) / x * psi - psi_before
        chi_before, chi = chi, (2 * n - 1) / x * chi - chi_before
        xi_before, xi = psi_before - 1j * chi_before, psi - 1j * chi
        d = log_derivative[n]
        a = ((d / m + n / x) * psi - psi_before) / ((d / m + n / x) * xi - xi_before)
        b = ((m * d + n / x) * psi - psi_before) / ((m * d + n / x) * xi - xi_before)
        tau = n * mu * pi - (n + 1) * pi_before
        weight = (2 * n + 1) / (n * (n + 1))
        s1 += weight * (a * pi + b * tau)
        s2 += weight * (a * tau + b * pi)
        pi_before, pi = pi, ((2 * n + 1) * mu * pi - (n + 1) * pi_before) / n
    return s1, s2


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--diameter", type=float, required=True, help="mean [micrometres]")
    parser.add_argument("--spread", type=float, default=0.2, help="standard deviation over the mean; 0: one size")
    parser.add_argument("--wavelength", type=float, default=0.55, help="[micrometres]")
    parser.add_argument("--index", type=complex, default=1.333, help="n+kj of refraction, relative to what is around; k is not below 0, and absorbs")
    options = parser.parse_args()
    if not (options.diameter > 0 and options.spread >= 0 and options.wavelength > 0):
        parser.error("--diameter and --wavelength are lengths above 0, and --spread is not below 0")
    if not (options.index.real > 0 and options.index.imag >= 0) or options.index == 1:
        parser.error("--index is n+kj with n above 0 and k not below it (others write n-kj), and not 1, which scatters nothing")
    # Close together where the peak is, and where bows are.
    angles = np.unique(np.concatenate([np.geomspace(0.01, 10, 160), np.arange(10, 180.01, 0.25), [0.0]]))
    mu = np.cos(np.radians(angles))
    # Light goes with the square of the size, and straight on with its fourth power: so far does the tail count.
    sizes = np.linspace(max(1 - 3 * options.spread, 0.02), 1 + 5 * options.spread + 8 * options.spread**2,
                        round(120 + 400 * options.spread) if options.spread > 0 else 1)
    shape = 1 / max(options.spread, 1e-6) ** 2
    density = np.exp((shape - 1) * np.log(sizes) - shape * (sizes - 1)) if options.spread > 0 else np.ones(1)
    value = np.zeros_like(mu)
    for size, share in zip(sizes if options.spread > 0 else [1.0], density):
        s1, s2 = amplitudes(np.pi * options.diameter * size / options.wavelength, options.index, mu)
        value += share * 0.5 * (abs(s1) ** 2 + abs(s2) ** 2)
    integral = np.sum(0.5 * (value[1:] + value[:-1]) * -np.diff(mu)) * 2 * np.pi
    print(f"# Mie: diameter {options.diameter:g}, spread {options.spread:g}, wavelength {options.wavelength:g} micrometres, "
          f"index {options.index:g}")
    for angle, p in zip(angles, value / integral):
        print(f"{angle:.5g} {p:.5g}")


if __name__ == "__main__":
    main()
