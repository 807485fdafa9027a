"""vkvol's lights in Mitsuba's terms: entries of a dictionary for load_dict.

Lamps, which stop nothing in vkvol, are shapes of an area light with a surface that is none (`null`)."""
import math

import numpy as np

import lights
import sky

FAR = 1e5  # of the sun, in extents of the scene: directions to it differ by its inverse
WIDEST = 170.0  # degrees of what is projected on a plane: the sun, and a spot that falls off
TEXELS = 1024  # across the picture of a spot's rim: where a quarter of it falls off, linear to 1e-5 of the whole


def rgb(values):
    return {"type": "rgb", "value": [float(v) for v in values]}


class Lights:
    """`fail` takes one line on what cannot be translated; center and extent are those of the rest of the scene."""

    def __init__(self, mi, center, extent, fail):
        self.mi, self.center, self.extent, self.fail = mi, np.asarray(center), extent, fail

    def entry(self, light):
        return getattr(self, type(light).__name__.lower())(light)

    def look_at(self, place, target, up=None):
        """From +z to the target, y up."""
        along = lights.unit(target - place)
        if up is None:
            up = np.eye(3)[np.argmin(abs(along))]
        return self.mi.ScalarTransform4f().look_at(list(map(float, place)), list(map(float, place + along)),
                                                   list(map(float, up)))

    @staticmethod
    def lamp(radiance, **shape):
        return dict(shape, bsdf={"type": "null"}, emitter={"type": "area", "radiance": rgb(radiance)})

    def directional(self, light):
        return {"type": "directional", "direction": [float(v) for v in -light.direction], "irradiance": rgb(light.irradiance)}

    def sun(self, light):
        """A disk far away that faces the scene."""
        if light.angle > WIDEST:
            self.fail(f"<sun> angle: {light.angle:g} degrees cannot be translated; take at most {WIDEST:g}")
        place = self.center + FAR * self.extent * light.direction
        radius = FAR * self.extent * math.tan(math.radians(light.angle / 2))
        return self.disk(lights.Disk(place, self.center, radius, light.radiance))

    def point(self, light):
        return {"type": "point", "position": light.position.tolist(), "intensity": rgb(light.intensity)}

    def spot(self, light):
        result = {"type": "spot", "to_world": self.look_at(light.position, light.target), "intensity": rgb(light.intensity),
                  "cutoff_angle": light.angle / 2, "beam_width": light.angle / 2}
        if light.blend > 0:
            if light.angle > WIDEST:
                self.fail(f"<spot> angle: {light.angle:g} degrees cannot be translated with a rim; take at most {WIDEST:g}, "
                          'or blend="0"')
            result["texture"] = {"type": "bitmap", "bitmap": self.mi.Bitmap(spot_picture(light)), "raw": True,
                                 "filter_type": "bilinear", "wrap_mode": "clamp"}
        return result

    def sphere(self, light):
        return self.lamp(light.radiance, type="sphere", center=light.center.tolist(), radius=light.radius)

    def disk(self, light):
        place, radius = self.look_at(light.center, light.target), float(light.radius)
        return self.lamp(light.radiance, type="disk", to_world=place @ self.mi.ScalarTransform4f().scale([radius] * 3))

    def rectangle(self, light):
        place = self.look_at(light.center, light.target, light.up)
        halves = [light.width / 2, light.height / 2, 1.0]
        return self.lamp(light.radiance, type="rectangle", to_world=place @ self.mi.ScalarTransform4f().scale(halves))

    def sky(self, light):
        """Mitsuba's map has its edges, not its middle, at -z."""
        texels = np.ascontiguousarray(sky.with_rows_at_poles(light.texels), np.float32)
        return {"type": "envmap", "bitmap": self.mi.Bitmap(texels),
                "to_world": self.mi.ScalarTransform4f().rotate([0, 1, 0], 180 + light.rotation)}


def spot_picture(light):
    """How much of its intensity a spot has, on the plane across its axis on which its rim spans from edge to edge."""
    edge = math.radians(light.angle / 2)
    across = (np.arange(TEXELS) + 0.5) / TEXELS * 2 - 1
    cosine = np.cos(np.arctan(math.tan(edge) * np.hypot(across[:, None], across)))
    none, full = math.cos(edge), math.cos(edge * (1 - light.blend))
    t = np.clip((cosine - none) / (full - none), 0, 1)
    return np.ascontiguousarray(np.repeat((t * t * (3 - 2 * t))[..., None], 3, axis=2), np.float32)


def map_agrees(mi, emitter, light):
    """Whether this Mitsuba has the map where vkvol has it, about the brightest texel: it has not always put texels in the
    same places."""
    size = light.texels.shape[:2]
    row, column = np.unravel_index(light.texels.sum(axis=2).argmax(), size)
    place = mi.SurfaceInteraction3f()
    for down, right in ((0, 0), (0.5, 0), (-0.5, 0), (0, 0.5), (0, -0.5)):
        direction = sky.turned(sky.directions(row + down, column + right, *size), -light.rotation)
        place.wi = [-float(v) for v in direction]
        found = np.array(emitter.eval(place), dtype=float).ravel()
        # Single precision has places in the map to a thousandth of a texel or so.
        if np.any(abs(found - sky.radiance(light.texels, direction, light.rotation)) > 2e-3 * light.texels.max()):
            return False
    return True
