"""Reads the surfaces of vkvol's scene files: what stands between <surfaces> and </surfaces>."""
import dataclasses
import pathlib

import numpy as np

import lights

ENDLESS = 1e4  # half an edge of the square that stands for a plane


@dataclasses.dataclass
class Surface:
    shape: str  # "sphere", "disk" and "rectangle" (facing +z) and "cube", each of half-width 1 about 0; or "mesh"
    matrix: np.ndarray  # 4x4, to the world
    file: pathlib.Path  # of a mesh
    material: str
    color: np.ndarray
    ior: float
    eta: np.ndarray  # of a conductor
    k: np.ndarray
    emission: np.ndarray  # from its front
    endless: bool

    def corners(self):
        """Of a box about it, as rows; none of what is endless."""
        if self.endless:
            return np.empty((0, 3))
        points = vertices(self.file) if self.shape == "mesh" else [
            [(-1.0, 1.0)[i >> axis & 1] for axis in range(3)] for i in range(8)]
        return np.asarray(points) @ self.matrix[:3, :3].T + self.matrix[:3, 3]


def vertices(path):
    with open(path, encoding="utf-8", errors="replace") as file:
        return np.array([[float(v) for v in line.split()[1:4]] for line in file if line.startswith("v ")])


def moved_to(place, axes=np.eye(3), scale=(1.0, 1.0, 1.0)):
    """Columns of `axes`, scaled, about `place`."""
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = np.asarray(axes) * np.asarray(scale), place
    return matrix


def facing(towards, up):
    """A frame whose z is `towards`."""
    z = lights.unit(towards)
    x = lights.unit(np.cross(up, z))
    return np.stack([x, np.cross(z, x), z], axis=1)


class Surfaces:
    """Of one scene; `reader` is its scene.Reader."""

    def __init__(self, reader):
        self.reader = reader

    def read(self):
        group = self.reader.find("surfaces")
        return [self.surface(element) for element in ([] if group is None else group)]

    def number(self, element, name, default):
        return self.reader.number(element, name, default)

    def surface(self, element):
        kinds = {"sphere": self.sphere, "disk": self.disk, "rectangle": self.rectangle, "box": self.box,
                 "plane": self.plane, "mesh": self.mesh}
        if element.tag not in kinds:
            self.reader.fail(f"<{element.tag}> is no surface that is translated; take {', '.join(kinds)}")
        shape, matrix, file = kinds[element.tag](element)
        material = self.reader.filled(element.get("material", "diffuse"))
        if material == "conductor" and element.get("eta") is None:
            self.reader.fail("<surfaces> metal: names are not translated; give eta and k")
        if self.number(element, "roughness", 0.0) != 0:
            self.reader.fail("<surfaces> roughness: facets lose light elsewhere, and are not translated")
        glow = element.find("emission")
        if glow is not None and self.number(glow, "sides", 1.0) != 1:
            self.reader.fail('<emission> sides="2" is not translated; take two surfaces')
        return Surface(shape, self.transform(element) @ matrix, file, material, self.color(element, material),
                       self.number(element, "ior", 1.5), self.spectrum(element, "eta"), self.spectrum(element, "k"),
                       np.zeros(3) if glow is None else lights.Lights(self.reader).colour(glow), element.tag == "plane")

    def color(self, element, material):
        multiplier = self.number(element, "multiplier", 1.0)
        if any(element.get(name) is not None for name in "rgb"):
            return self.reader.vector(element, "rgb") * multiplier
        return np.full(3, multiplier * (0.5 if material in ("diffuse", "coated") else 1.0))

    def spectrum(self, element, name):
        values = [self.reader.to_number(word) for word in self.reader.filled(element.get(name, "0")).split()]
        return np.array(values * 3 if len(values) == 1 else values)

    def towards(self, element, place):
        return self.reader.numbers(element, "lookAt") - place

    def sphere(self, element):
        radius = self.number(element, "radius", 1.0)
        return "sphere", moved_to(self.reader.vector(element), scale=[radius] * 3), None

    def disk(self, element):
        place, radius = self.reader.vector(element), self.number(element, "radius", 1.0)
        axes = facing(self.towards(element, place), self.up(element, place))
        return "disk", moved_to(place, axes, [radius] * 3), None

    def up(self, element, place):
        # As vkvol chooses where nothing is said.
        up = "0 1 0" if abs(lights.unit(self.towards(element, place))[1]) < 0.999 else "0 0 1"
        return self.reader.numbers(element, "up", up)

    def rectangle(self, element):
        place = self.reader.vector(element)
        halves = [self.number(element, name, 1.0) / 2 for name in ("width", "height")]
        axes = facing(self.towards(element, place), self.up(element, place))
        return "rectangle", moved_to(place, axes, [*halves, 1.0]), None

    def box(self, element):
        halves = [self.number(element, name, 1.0) / 2 for name in ("width", "height", "depth")]
        return "cube", moved_to(self.reader.vector(element), scale=halves), None

    def plane(self, element):
        place = self.reader.vector(element)
        normal = np.array([0.0, 1.0, 0.0]) if element.get("lookAt") is None else self.towards(element, place)
        axes = facing(normal, np.eye(3)[np.argmin(abs(normal))])
        return "rectangle", moved_to(place, axes, [ENDLESS, ENDLESS, 1.0]), None

    def mesh(self, element):
        name, folder = (self.reader.filled(element.get(key, "")).replace("\\", "/") for key in ("file", "baseDir"))
        if not name.lower().endswith(".obj"):
            self.reader.fail("<mesh> is translated where it is an .obj file alone; write one")
        path = self.reader.path.parent / folder / name
        normals = self.reader.filled(element.get("normals", "file"))
        with open(path, encoding="utf-8", errors="replace") as file:
            if normals == "smooth" or normals == "file" and any(line.startswith("vn ") for line in file):
                self.reader.fail('<mesh> normals: smooth faces are not translated; write normals="flat"')
        return "mesh", np.eye(4), path

    def transform(self, element):
        matrix, group = np.eye(4), element.find("transform")
        for step in [] if group is None else group:
            matrix = self.step(step) @ matrix
        return matrix

    def step(self, step):
        if step.tag == "translate":
            return moved_to(self.reader.vector(step))
        if step.tag == "scale":
            value = self.number(step, "value", 1.0)
            return moved_to(np.zeros(3), scale=[value * self.number(step, axis, 1.0) for axis in "xyz"])
        if step.tag == "rotate":
            axis, angle = lights.unit(self.reader.vector(step)), np.radians(self.number(step, "angle", 0.0))
            across = np.cross(np.eye(3), axis)  # rows e_i x axis: v -> axis x v
            return moved_to(np.zeros(3), np.eye(3) + np.sin(angle) * across + (1 - np.cos(angle)) * across @ across)
        return self.reader.fail(f"<{step.tag}> in <transform> is not translated; take translate, rotate, scale")
