"""Renders participating media: clouds, smoke, fire, fog, scanned volumes, on any Vulkan device.

    import numpy, vkvol

    picture = vkvol.render("scene.xml", spp=64)              # a scene file, a scene of pbrt-v4, or a density file
    picture.mean                                             # float32 (height, width, 3): linear Rec. 709 radiance
    picture.write("cloud.exr")                               # or .png, .csv

    smoke = vkvol.Grids(density=numpy.random.rand(64, 64, 64), voxel_size=1 / 64)
    scene = vkvol.Scene.from_dict({
        "densityField": smoke,
        "sigma_s": {"unit": "world", "text": 20},
        "light": {"x": 1, "y": 2, "z": 1, "r": 1, "g": 1, "b": 1, "multiplier": 3},
        "width": 320, "height": 320, "rayPerPixelCount": 64,
    })
    session = vkvol.Session(scene, seed=1)
    session.render(16)                                       # more samples whenever they are wanted
    session.picture().noise

Elements and attributes of scenes are those of scene files: scenes/README.md of the sources has them all. What is wrong is
raised, as InputError (the scene, a file or an argument), DeviceError (no Vulkan device can be used) or RenderError.
"""

from ._vkvol import DeviceError, Error, InputError, RenderError
from ._vkvol import version as __version__
from .picture import Picture
from .rendering import SceneWarning, Session, devices, integrators, render
from .scene import Grids, Scene

__all__ = ["DeviceError", "Error", "Grids", "InputError", "Picture", "RenderError", "Scene", "SceneWarning", "Session",
           "__version__", "devices", "integrators", "render"]

for _error in (DeviceError, Error, InputError, RenderError):
    _error.__module__ = __name__  # where people find them
