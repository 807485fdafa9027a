"""Reads the lights of vkvol's scene files: <light>, and those between <lights> and </lights>."""
import dataclasses
import math
import pathlib

import numpy as np

import blackbody
import sky


@dataclasses.dataclass
class Directional:
    direction: np.ndarray  # unit, towards the light
    irradiance: np.ndarray


@dataclasses.dataclass
class Sun:
    direction: np.ndarray  # unit, towards its middle
    irradiance: np.ndarray
    angle: float  # degrees, its whole diameter

    @property
    def radiance(self):
        return self.irradiance / (math.pi * math.sin(math.radians(self.angle / 2)) ** 2)


@dataclasses.dataclass
class Point:
    position: np.ndarray
    intensity: np.ndarray


@dataclasses.dataclass
class Spot:
    position: np.ndarray
    target: np.ndarray
    intensity: np.ndarray
    angle: float  # degrees, the cone's whole opening
    blend: float  # part of the opening's half in which it falls off, as a smooth step of the cosine


@dataclasses.dataclass
class Sphere:
    center: np.ndarray
    radius: float
    radiance: np.ndarray


@dataclasses.dataclass
class Disk:
    center: np.ndarray
    target: np.ndarray
    radius: float
    radiance: np.ndarray


@dataclasses.dataclass
class Rectangle:
    center: np.ndarray
    target: np.ndarray
    up: np.ndarray
    width: float
    height: float
    radiance: np.ndarray


@dataclasses.dataclass
class Sky:
    texels: np.ndarray  # times the light's colour
    rotation: float  # degrees, counter-clockwise as seen from above


MET_BY_CHANCE = (Sun, Sky)  # what paths without next-event estimation find


def unit(vector):
    return vector / np.linalg.norm(vector)


class Lights:
    """Of one scene; `reader` is its scene.Reader."""

    def __init__(self, reader):
        self.reader = reader

    def read(self):
        found = []
        element = self.reader.find("light")
        if element is not None:
            irradiance = self.reader.color("light")
            if irradiance.any():
                found.append(Directional(self.direction(element), irradiance))
        group = self.reader.find("lights")
        for element in [] if group is None else group:
            colour = self.colour(element)
            if colour.any():  # a black one is left out
                make = getattr(self, element.tag, None) if element.tag in self.KINDS else None
                found.append(make(element, colour) if make else self.reader.fail(
                    f"<{element.tag}> is not translated; take {', '.join(self.KINDS)}"))
        return found

    KINDS = ("directional", "sun", "point", "spot", "sphere", "disk", "rectangle", "sky")

    def number(self, element, name, default):
        return self.reader.number(element, name, default)

    def place(self, element):
        return self.reader.vector(element)

    def direction(self, element):
        towards = self.reader.vector(element)
        return unit(towards) if towards.any() else self.reader.fail(f"<{element.tag}> has no direction; give it x, y, z")

    def colour(self, element):
        multiplier = self.number(element, "multiplier", 1.0)
        if any(element.get(name) is not None for name in "rgb"):
            return self.reader.vector(element, "rgb") * multiplier
        kelvin = self.number(element, "kelvin", None)
        return (np.ones(3) if kelvin is None else blackbody.rgb(kelvin)) * multiplier

    def shine(self, element, colour, power_per_unit):
        """Intensity or radiance of a light that sends out so much for each unit of it."""
        return colour * self.number(element, "power", power_per_unit) / power_per_unit

    def directional(self, element, colour):
        return Directional(self.direction(element), colour)

    def sun(self, element, colour):
        return Sun(self.direction(element), colour, self.number(element, "angle", 0.53))

    def point(self, element, colour):
        return Point(self.place(element), self.shine(element, colour, 4 * math.pi))

    def spot(self, element, colour):
        angle, blend = self.number(element, "angle", 45.0), self.number(element, "blend", 0.2)
        # The solid angle with half of its rim, for a smooth step of the cosine is one half on average.
        rims = (math.cos(math.radians(angle * part / 2)) for part in (1 - blend, 1))
        intensity = self.shine(element, colour, math.pi * sum(1 - rim for rim in rims))
        return Spot(self.place(element), self.reader.numbers(element, "lookAt"), intensity, angle, blend)

    def sphere(self, element, colour):
        radius = self.number(element, "radius", 1.0)
        return Sphere(self.place(element), radius, self.shine(element, colour, (2 * math.pi * radius) ** 2))

    def disk(self, element, colour):
        radius = self.number(element, "radius", 1.0)
        return Disk(self.place(element), self.reader.numbers(element, "lookAt"), radius,
                    self.shine(element, colour, (math.pi * radius) ** 2))

    def rectangle(self, element, colour):
        width, height = self.number(element, "width", 1.0), self.number(element, "height", 1.0)
        place, target = self.place(element), self.reader.numbers(element, "lookAt")
        # As vkvol chooses where nothing is said.
        up = "0 1 0" if abs(unit(target - place)[1]) < 0.999 else "0 0 1"
        return Rectangle(place, target, self.reader.numbers(element, "up", up), width, height,
                         self.shine(element, colour, math.pi * width * height))

    def sky(self, element, colour):
        folder = self.reader.filled(element.get("baseDir", "")).replace("\\", "/")
        path = self.reader.path.parent / folder / self.reader.filled(element.text or "").replace("\\", "/")
        return Sky(sky.read(pathlib.Path(path)) * colour, self.number(element, "rotation", 0.0))
