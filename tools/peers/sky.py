"""Maps of the sky as vkvol has them: columns are longitudes, rows latitudes, the zenith (y) on top; the middle column is at -z,
and further right is further towards +x. Radiance is linear between the middles of texels; beyond the outermost rows' it
stays as it is there."""
import pathlib
import sys

import numpy as np

import exr


def read(path):
    """Texels, [row, column, channel]; what is negative or no number counts as 0."""
    if pathlib.Path(path).suffix.lower() != ".exr":
        sys.exit(f"{path}: <sky> maps are read from .exr files only; convert it, for example with oiiotool")
    if not pathlib.Path(path).exists():
        sys.exit(f"{path}: no such map; that of scenes/peers is made by tools/peers/make_sky.py")
    texels, _, _ = exr.read_rgb(path)
    return np.where(np.isfinite(texels) & (texels > 0), texels, 0.0)


def directions(row, column, height, width):
    """Towards places in a map that is not turned; [..., xyz]. Middles of texels are at whole rows and columns."""
    latitude = (np.asarray(row) + 0.5) / height * np.pi  # from the zenith
    longitude = ((np.asarray(column) + 0.5) / width - 0.5) * 2 * np.pi
    return np.stack(np.broadcast_arrays(np.sin(latitude) * np.sin(longitude), np.cos(latitude),
                                        -np.sin(latitude) * np.cos(longitude)), axis=-1)


def turned(direction, rotation):
    """Where in a map that is not turned one finds what a map turned by `rotation` degrees has in this direction."""
    angle = np.radians(rotation)  # counter-clockwise as seen from above
    x, y, z = np.moveaxis(np.asarray(direction, float), -1, 0)
    return np.stack([x * np.cos(angle) - z * np.sin(angle), y, x * np.sin(angle) + z * np.cos(angle)], axis=-1)


def radiance(texels, direction, rotation=0.0):
    """What comes from directions [..., xyz]."""
    height, width, _ = texels.shape
    x, y, z = np.moveaxis(turned(direction, rotation), -1, 0)
    column = (np.arctan2(x, -z) / (2 * np.pi) + 0.5) * width - 0.5
    row = np.clip(np.arctan2(np.hypot(x, z), y) / np.pi * height - 0.5, 0, height - 1)
    left, top = np.floor(column).astype(int), np.floor(row).astype(int)
    across, down = (column - left)[..., None], (row - top)[..., None]
    bottom = np.minimum(top + 1, height - 1)

    def between(rows):
        return texels[rows, left % width] * (1 - across) + texels[rows, (left + 1) % width] * across
    return between(top) * (1 - down) + between(bottom) * down


def with_rows_at_poles(texels):
    """The same map where the first and the last row lie at the poles themselves, as Mitsuba has it. With rows at the middles
    between vkvol's as well nothing is lost: what is linear between two rows is linear on both sides of a third."""
    rows = np.empty((2 * len(texels) + 1, *texels.shape[1:]))
    rows[0], rows[-1], rows[1::2] = texels[0], texels[-1], texels
    rows[2:-1:2] = (texels[1:] + texels[:-1]) / 2
    return rows
