#!/usr/bin/env python3
"""Makes the map of the sky of scenes/peers: bright at the horizon, blue above, brown below, and a small sun, from which half
of the light comes.

    tools/peers/make_sky.py                 writes scenes/peers/sky.exr"""
import pathlib
import sys

import numpy as np

import exr
import sky

OUTPUT = pathlib.Path(__file__).resolve().parents[2] / "scenes/peers/sky.exr"
HEIGHT, WIDTH = 512, 1024
SUN = np.array([-0.6, 0.5, 0.62])  # towards it: at the camera's left, behind it
SUN_RADIUS = 0.5  # degrees, the standard deviation of a bell; texels have 0.35
HALO_RADIUS = 5.0


def texels():
    towards = sky.directions(*np.mgrid[:HEIGHT, :WIDTH], HEIGHT, WIDTH)
    y = towards[..., 1:2]
    above = np.array([0.08, 0.2, 0.5]) + np.array([0.6, 0.55, 0.4]) * np.exp(-6 * np.maximum(y, 0))
    below = np.array([0.12, 0.09, 0.06]) * (1.2 + y)
    radiance = np.where(y > 0, above, below)
    angle = np.degrees(np.arccos(np.clip(towards @ (SUN / np.linalg.norm(SUN)), -1, 1)))[..., None]
    for colour, radius in (((8000.0, 7000.0, 5500.0), SUN_RADIUS), ((3.0, 2.4, 1.6), HALO_RADIUS)):
        bell = np.exp(-0.5 * (angle / radius) ** 2)
        radiance = radiance + np.array(colour) * np.where(bell > 1e-5, bell, 0)
    return radiance


def main():
    picture = texels().astype("<f2")
    exr.write_channels(OUTPUT, {c: np.ascontiguousarray(picture[..., i]) for i, c in enumerate("RGB")}, compress=True)
    print(f"written: {OUTPUT}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
