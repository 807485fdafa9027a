"""Grids from published arrays, by vkvol's Python module (PYTHONPATH=build/python) and numpy."""


def module():
    """numpy and vkvol, or nothing."""
    try:
        import numpy
        import vkvol
    except ImportError:
        return None
    return numpy, vkvol


def write(path, density):
    """Voxel (i, j, k) fills the cube from there to (i + 1, j + 1, k + 1)."""
    _, vkvol = module()
    vkvol.Grids(density=density, voxel_size=1.0, origin=(.5, .5, .5)).write(path)
    return path


def volume(path, low, size, phase):
    """Its voxels, each even and `size` large, from the corner `low` on; values are extinctions, and nothing absorbs."""
    scale = " ".join(f'{axis}="{value!r}"' for axis, value in zip("xyz", size))
    move = " ".join(f'{axis}="{value!r}"' for axis, value in zip("xyz", low))
    return (f'<volumes><volume><densityField baseDir="/">{str(path)[1:]}</densityField><sigma_a unit="world">0</sigma_a><sigma_s unit="world">1</sigma_s>{phase}'
            f"<transform><scale {scale}/><translate {move}/></transform></volume></volumes>"
            '<filter>nearest</filter>')
