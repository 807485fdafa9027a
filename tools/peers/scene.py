"""Reads vkvol's scene files for other renderers: what scenes/README.md says, as far as they can follow.

What they cannot, such as emission, noise or meshes, is an error here, so that no comparison is of different scenes. Lights:
lights.py; surfaces: surfaces.py."""
import dataclasses
import math
import pathlib
import re
import sys
import xml.etree.ElementTree as ET

import numpy as np

import grid as grids
import lights
import surfaces

# Paths that scatter once, or not at all: no path tracer has them.
NOT_MULTIPLE = ("densitySampling", "homogeneousRayMarcherNEE", "homogeneousRayMarcherImproved",
                "heterogeneousPerlinNoise", "nanoVDBSimple", "nanoVDBEmission")
WITHOUT_LIGHT = ("deltaTracking", "densitySampling")
PHASES = ("henyeyGreenstein", "doubleHenyeyGreenstein", "rayleigh")
LEFT_OUT = {"noise": "procedural noise", "models": "a medium in a mesh", "everywhere": "a medium without end",
            "layers": "a density by height"}
# What is translated, and what changes no picture.
KNOWN = ("densityField", "sphere", "box", "sigma_a", "sigma_s", "heyneygreenstein_g", "heynegreenstein_g", "phase", "medium",
         "emission", "lightRayDensityMultiplier", "shadowRayDensityMultiplier", "filter", "light", "lights", "surfaces",
         "backgroundColor", "camera", "width", "height", "pixelFilter", "rayPerPixelCount", "integrator", "march", "maxDepth",
         "russianRoulette", "majorant", "expected", "film")
# Attributes of any element that are not, and the values that say nothing.
NEUTRAL = {"depolarization": "0", "limbDarkening": "0", "mapping": "equirectangular", "mirror": "false", "texture": "", "checker": ""}


@dataclasses.dataclass
class Camera:
    position: np.ndarray
    forward: np.ndarray
    up: np.ndarray
    fov: float  # degrees, vertical, of the reference frame


@dataclasses.dataclass
class Picture:
    width: int
    height: int
    start: tuple  # left and top pixel in the reference frame
    reference: tuple  # its width and height


@dataclasses.dataclass
class Phase:
    name: str  # one of PHASES
    g: float
    second: float = 0.0  # of two of Henyey and Greenstein's
    share: float = 0.5  # of the second


@dataclasses.dataclass
class Medium:
    shape: object  # grids.Grid, Sphere or Box
    sigma_a: np.ndarray  # per world unit, density scale included
    sigma_s: np.ndarray
    phase: object  # Phase
    nearest: bool  # no interpolation

    @property
    def sigma_t(self):
        return self.sigma_a + self.sigma_s


@dataclasses.dataclass
class Sphere:
    center: np.ndarray
    radius: float

    def contains(self, point):
        return np.linalg.norm(point - self.center) < self.radius

    def corners(self):
        return box_corners(self.center - self.radius, self.center + self.radius)


@dataclasses.dataclass
class Box:
    center: np.ndarray
    size: np.ndarray  # full edges

    def contains(self, point):
        return bool(np.all(np.abs(point - self.center) < self.size / 2))

    def corners(self):
        return box_corners(self.center - self.size / 2, self.center + self.size / 2)


@dataclasses.dataclass
class Scene:
    path: pathlib.Path
    camera: Camera
    picture: Picture
    medium: Medium  # or None
    surfaces: list  # of surfaces.Surface
    lights: list  # of what lights.py has
    background: np.ndarray
    max_depth: int  # scattering events; None: unlimited

    def corners(self):
        """Points that span all that is finite."""
        found = [surface.corners() for surface in self.surfaces]
        if self.medium is not None:
            found.append(self.medium.shape.corners())
        return np.concatenate([*found, self.camera.position[None]])


def box_corners(low, high):
    return np.array([[(low, high)[i >> axis & 1][axis] for axis in range(3)] for i in range(8)])


class Reader:
    def __init__(self, path, keys):
        self.path, self.keys = pathlib.Path(path), dict(key.split("=", 1) for key in keys)
        try:
            self.root = ET.parse(path).getroot()
        except (OSError, ET.ParseError) as error:
            sys.exit(f"{path}: cannot be read as a scene: {error}")

    def fail(self, what):
        sys.exit(f"{self.path}: {what}")

    def filled(self, text):
        """With $key, ${key} and ${key:-default} replaced."""
        def value(match):
            if match[0] == "$$":
                return "$"
            name, default = match[1] or match[2], match[3]
            if name is None:
                return self.fail(f"'{text}' computes, which is not translated; give the number")
            if name in self.keys and not (self.keys[name] == "" and default is not None):
                return self.keys[name]
            return default if default is not None else self.fail(f"${name} has no value; give one with -D {name}=VALUE")
        return re.sub(r"\$(?:\$|(\w+)|\{(\w+)(?::-([^{}$]*))?\}|)", value, text).strip()

    def find(self, *names):
        return next((e for e in map(self.root.find, names) if e is not None), None)

    def text(self, name, default=""):
        element = self.find(name)
        return default if element is None else self.filled(element.text or "")

    def number(self, element, attribute, default):
        text = None if element is None else element.get(attribute)
        return default if text is None else self.to_number(text)

    def to_number(self, text):
        try:
            return float(self.filled(text))
        except ValueError:
            return self.fail(f"'{text}' is no number")

    def vector(self, element, names="xyz"):
        return np.array([self.number(element, name, 0.0) for name in names])

    def numbers(self, element, name, default=None):
        """Three of them, in one attribute."""
        values = [self.to_number(word) for word in self.filled(element.get(name, default) or "").split()]
        return np.array(values) if len(values) == 3 else self.fail(f"<{element.tag}> {name}: expected three numbers, x y z")

    def color(self, name):
        element = self.find(name)
        return self.vector(element, "rgb") * self.number(element, "multiplier", 1.0)

    def refuse_other_views(self):
        """The peers are told of pinholes, and of pixels that are boxes."""
        camera, pixel, flux = self.find("camera"), self.find("pixelFilter"), self.find("irradiance", "fluence")
        if flux is not None:
            self.fail(f"<{flux.tag}> reads flux, which is not translated; take a <camera>")
        if camera is None:
            self.fail("has no <camera>, and the one that vkvol gives it is not translated; write that which it names")
        said = {} if camera is None else {name: self.filled(text) for name, text in camera.attrib.items()}
        if said.get("projection", "perspective") != "perspective":
            self.fail(f"<camera> projection {said['projection']} is not translated; take perspective")
        if "viewHeight" in said:
            self.fail("<camera> viewHeight: has a meaning with projection=\"orthographic\" only, which is not translated; "
                      "remove it")
        if self.number(camera, "lensRadius", 0.0) != 0:
            self.fail("<camera> lensRadius: lenses are not translated; take a pinhole, lensRadius=\"0\"")
        if pixel is not None and (self.text("pixelFilter") != "box" or self.number(pixel, "radius", 0.5) != 0.5):
            self.fail("<pixelFilter> is not translated, but for a box of radius 0.5; remove it")

    def scene(self, grid_override):
        self.refuse_other_views()
        for name, what in LEFT_OUT.items():
            if self.find(name) is not None:
                self.fail(f"has {what} (<{name}>), which is not translated; take a scene with a grid, a sphere or a box")
        if self.find("albedo") is not None:
            self.fail("has an albedo of its own in each place (<albedo>), which is not translated; remove it")
        for name in ("densityMap", "transferFunction"):
            if self.find(name) is not None:
                self.fail(f"maps the values of its grid (<{name}>), which is not translated; remove it")
        if self.color("medium").any() or self.color("emission").any():
            self.fail("the medium glows, which is not translated; remove <medium> and <emission>")
        for element in self.root:
            if isinstance(element.tag, str) and element.tag not in KNOWN:  # else a comment
                self.fail(f"<{element.tag}> is not translated; remove it")
        for element in self.root.iter():
            for name, text in element.attrib.items():
                if self.filled(text) != NEUTRAL.get(name, self.filled(text)):
                    self.fail(f"<{element.tag}> {name}: is not translated; remove it")
        integrator = self.text("integrator")
        choices = {} if self.find("integrator") is None else self.find("integrator").attrib
        if integrator in NOT_MULTIPLE or choices.get("scattering", "multiple") != "multiple":
            self.fail("the integrator leaves multiple scattering out, which the peers cannot; take another one")
        found = lights.Lights(self).read()
        if integrator in WITHOUT_LIGHT or choices.get("nee") == "none":
            found = [light for light in found if isinstance(light, lights.MET_BY_CHANCE)]
        depth = self.text("maxDepth")
        return Scene(path=self.path, camera=self.camera(), picture=self.picture(), medium=self.medium(grid_override),
                     surfaces=self.surfaces(), lights=found, background=self.color("backgroundColor"),
                     max_depth=int(depth) if depth else None)

    def camera(self):
        element = self.find("camera")
        fov = self.number(element, "fov", 90.0)
        if element is not None and element.get("lookAt") is not None:
            if element.get("distance") is not None:
                self.fail("<camera> distance: orbits are not translated; say where the camera is by x, y, z")
            place = self.vector(element)
            forward = lights.unit(self.numbers(element, "lookAt") - place)
            return Camera(place, forward, self.numbers(element, "up", "0 1 0"), fov)
        pitch, yaw, roll = (math.radians(self.number(element, name, 0.0)) for name in ("pitch", "yaw", "roll"))
        rotation = rotation_about(2, roll) @ rotation_about(1, yaw) @ rotation_about(0, pitch)
        return Camera(self.vector(element), rotation @ [0, 0, -1], rotation @ [0, 1, 0], fov)

    def picture(self):
        size, start, reference = [], [], []
        for name in ("width", "height"):
            element = self.find(name)
            size.append(int(self.text(name, "400") or 400))
            start.append(self.number(element, "startOffset", 0.0))
            reference.append(self.number(element, "reference", 0.0) or size[-1])
        return Picture(*size, tuple(start), tuple(reference))

    def coefficient(self, name):
        element = self.find(name)
        if element is not None and element.get("r") is not None:
            return self.vector(element, "rgb")
        return np.full(3, self.to_number(self.text(name, "0.5") or "0"))

    def shape(self, grid_override):
        """The grid, sphere or box; None without a medium."""
        field, sphere, box = (self.find(name) for name in ("densityField", "sphere", "box"))
        if grid_override or field is not None:
            name = "density" if field is None else field.get("grid", "density")
            folder = "" if field is None else self.filled(field.get("baseDir", "")).replace("\\", "/")
            path = grid_override or self.path.parent / folder / self.filled(field.text).replace("\\", "/")
            return grids.read(path, name)
        if sphere is not None:
            return Sphere(self.vector(sphere), self.number(sphere, "radius", 1.0))
        if box is not None:
            return Box(self.vector(box), np.array([self.number(box, name, 1.0) for name in ("width", "height", "depth")]))
        return None

    def surfaces(self):
        return surfaces.Surfaces(self).read()

    def phase(self):
        element, name = self.find("phase"), self.text("phase", PHASES[0])
        if name not in PHASES:
            self.fail(f"<phase> {name} is not translated; take {', '.join(PHASES)}")
        g = self.to_number(self.text("heyneygreenstein_g") or self.text("heynegreenstein_g") or "0")
        return Phase(name, g, self.number(element, "second", 0.0), self.number(element, "share", 0.5))

    def medium(self, grid_override):
        shape = self.shape(grid_override)
        if shape is None:
            return None if self.surfaces() else self.fail("has no medium and no surfaces; there is nothing to compare")
        sigma_a, sigma_s = self.coefficient("sigma_a"), self.coefficient("sigma_s")
        scale = self.to_number(self.text("lightRayDensityMultiplier", "1"))
        units = {e.get("unit", "voxel") for e in (self.find("sigma_a"), self.find("sigma_s")) if e is not None}
        if isinstance(shape, grids.Grid) and units != {"world"}:
            scale /= shape.voxel_size
        return Medium(shape, sigma_a * scale, sigma_s * scale, self.phase(), self.text("filter") == "nearest")


def rotation_about(axis, angle):
    c, s = math.cos(angle), math.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[[i, j], [i, j]] = c
    matrix[i, j], matrix[j, i] = -s, s
    return matrix


def resize(picture, width, height):
    """As vkvol's --width and --height: the view stays, and with one of the two the shape as well."""
    if not width and not height:
        return picture
    # To the nearest pixel, halves up, as vkvol has it.
    width = width or max(1, math.floor(picture.width * height / picture.height + 0.5))
    height = height or max(1, math.floor(picture.height * width / picture.width + 0.5))
    factors = (width / picture.width, height / picture.height)
    return Picture(width, height, tuple(s * f for s, f in zip(picture.start, factors)),
                   tuple(r * f for r, f in zip(picture.reference, factors)))


def read(path, width=None, height=None, keys=(), grid=None):
    scene = Reader(path, keys).scene(grid)
    scene.picture = resize(scene.picture, width, height)
    return scene
