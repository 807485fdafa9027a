"""Writes scenes of which each has something of everything, or nothing, at random. For tools/crossed_scenes.py."""

import math
import random
import re
import subprocess

# By make_field: what makes it, its middle and its extent, world units.
FIELDS = {"cumulus": (("cumulus", "--size", "32"), (1, 20, 1), 60), "broken": (("broken_cloud", "--size", "32"), (0, 12, 0), 95),
          "checker": (("checker",), (1, 0, 4), 10), "ramp": (("ramp",), (8, 8, 8), 16), "voxel": (("voxel",), (-14, -6, -22), 3),
          "sheared": (("sheared",), (1.2, 1.2, 1.2), 8), "glow": (("glow",), (1.2, 1.2, 1.2), 8), "tiles": (("tiles",), (-2, 15, 15), 36),
          "eight": (("ramp", "--type", "fp8"), (8, 8, 8), 16)}

SKIES = [">sky.hdr", ">sky.hdr", 'mapping="equalArea">square.hdr']


class Writer:
    """One scene, by the numbers of `seed`."""

    def __init__(self, seed):
        self.r = random.Random(seed)

    def some(self, chance):
        return self.r.random() < chance

    def number(self, low, high):
        return f"{self.r.uniform(low, high):.4g}"

    def numbers(self, count, low, high):
        return " ".join(self.number(low, high) for _ in range(count))

    def place(self, spread=1.0, lift=0.0):
        return 'x="%s" y="%s" z="%s"' % tuple(self.number(-spread, spread) if i != 1 else self.number(lift - spread, lift + spread)
                                              for i in range(3))

    def color(self, low, high, faint=0.0):
        """Grey, or not; with this chance a thousandth of it."""
        if self.some(faint):
            low, high = 1e-3 * low, 1e-3 * high
        if self.some(0.5):
            value = self.number(low, high)
            return f'r="{value}" g="{value}" b="{value}"'
        return 'r="%s" g="%s" b="%s"' % tuple(self.number(low, high) for _ in range(3))

    def transform(self, spread, first=""):
        parts = [first] if first else []
        if self.some(0.4):
            scale = [self.r.choice([-1, 1, 1]) * self.r.uniform(0.6, 1.5) for _ in range(3)] if self.some(0.5) else [self.r.uniform(0.6, 1.4)] * 3
            parts.append('<scale x="%.4g" y="%.4g" z="%.4g"/>' % tuple(scale))
        if self.some(0.5):
            parts.append('<rotate x="%s" y="%s" z="%s" angle="%s"/>' % (self.number(-1, 1), self.number(-1, 1), self.number(-1, 1),
                                                                     self.r.choice(["90", "180", self.number(0, 360)])))
        if self.some(0.5):
            parts.append(f"<translate {self.place(spread)}/>")
        return f"<transform>{''.join(parts)}</transform>" if parts else ""

    def points(self, name, value, last, transfer):
        rows, at = [], 0.0
        for _ in range(self.r.randint(2, 4)):
            row = f'{value}="{at:.4g}" '
            if transfer:
                row += f'sigma_t="{self.number(0, 3)}" albedo="{self.numbers(self.r.choice([1, 3]), 0.3, 1)}"'
                row += f' emission="{self.numbers(self.r.choice([1, 3]), 0, 0.5)}"' if self.some(0.3) else ""
            else:
                row += f'density="{self.number(0, 2)}"'
            rows.append(f"<{name} {row}/>")
            at += 0.0 if self.some(0.15) and at > 0.0 and len(rows) == 1 else self.r.uniform(0.2, 0.6) * last
        return "".join(rows)

    def phase(self):
        g = self.number(-0.8, 0.8)
        kind = self.r.choice(["", "", "rayleigh", "doubleHenyeyGreenstein", "draine", "droplets", "fournierForand", "table"])
        more = {"doubleHenyeyGreenstein": f'second="{self.number(-0.8, 0.8)}" share="{self.number(0, 1)}"',
                "draine": f'alpha="{self.number(0, 5)}"', "droplets": f'diameter="{self.number(0.3, 3)}"',
                "fournierForand": f'index="{self.number(1.02, 1.3)}" backscatter="{self.number(0.1, 0.4)}"',
                "rayleigh": f'depolarization="{self.number(0, 0.5)}"', "table": 'file="phase.txt"'}.get(kind, "")
        text = f"<phase {more}>{kind}</phase>" if kind else ""
        return text + (f"<heyneygreenstein_g>{g}</heyneygreenstein_g>" if kind in ("", "doubleHenyeyGreenstein", "draine") else "")

    def coefficients(self):
        """Of extinctions about 1, alike in all channels or not."""
        sigma_t = self.r.uniform(0.3, 3.0)
        if self.some(0.25):
            return f"<sigma_a {self.color(0.0, 0.5)}/><sigma_s {self.color(0.2, 2)}/>"
        albedo = [self.r.uniform(0.4, 1.0) for _ in range(3)] if self.some(0.4) else [self.r.choice([1.0, 0.9, 0.6])] * 3
        names = [(name, ['%.6g' % (sigma_t * (a if name == "sigma_s" else 1 - a)) for a in albedo]) for name in ("sigma_a", "sigma_s")]
        return "".join(f'<{name} unit="world" r="{r}" g="{g}" b="{b}"/>' for name, (r, g, b) in names)

    def medium(self, alone):
        shapes = ["sphere", "box", "noise", "layers", "layers", "grid", "grid", "grid", "models"] + (["everywhere"] if self.some(0.3) else [])
        shape = self.r.choice(shapes)
        text, first, transfer = "", "", False
        if shape in ("sphere", "noise"):
            text = f'<sphere {self.place(0.5)} radius="{self.number(0.7, 1.6)}"/>'
        elif shape in ("box", "layers"):
            text = f'<box {self.place(0.5)} width="{self.number(1, 3)}" height="{self.number(1, 3)}" depth="{self.number(1, 3)}"/>'
        elif shape == "models":
            text = f'<models><model>{self.r.choice(["cube", "stone"])}.obj</model></models>'
        elif shape == "grid":
            name = self.r.choice(sorted(FIELDS))
            _, middle, extent = FIELDS[name]
            first = '<translate x="%g" y="%g" z="%g"/>' % tuple(-x for x in middle) + f'<scale value="{self.number(2, 3.5)[:4]}"/><scale value="{1 / extent:.4g}"/>'
            text = f"<densityField>{name}.nvdb</densityField>"
            if name == "glow" and self.some(0.7):
                text += f"<emission {self.color(0.1, 0.5)}/>" if self.some(0.5) else '<emission model="blackbody" temperatureScale="2000" r="1" g="1" b="1" multiplier="0.2"/>'
            kind = self.r.choice(["", "map", "transfer"])
            if kind == "transfer":
                transfer = True
                text += f'<transferFunction unit="world">{self.points("point", "value", 0.5, True)}</transferFunction>'
            elif kind == "map":
                text += f'<densityMap>{self.points("point", "value", 0.5, False)}</densityMap>'
        if shape == "noise":
            text += f'<noise frequency="{self.number(0.5, 2)}" octaves="{self.r.randint(1, 3)}"/>'
        if shape in ("layers", "everywhere"):
            up = self.r.choice(["x", "y", "z"])
            if self.some(0.5):
                text += f'<layers up="{up}" scaleHeight="{self.number(0.3, 2) if self.some(0.8) else self.number(0.01, 0.04)}" height="{self.number(-1, 0.5) if self.some(0.5) else -1}"/>'
            else:
                transfer = self.some(0.5)
                text += f'<layers up="{up}">{self.layers(transfer)}</layers>'
        if shape == "everywhere":
            text = "<everywhere/>" + text
        if not transfer:
            text += self.coefficients()
        if self.some(0.15) and not alone:
            text += f'<lightRayDensityMultiplier>{self.r.choice([0, 0.5])}</lightRayDensityMultiplier>'
        text += self.phase()
        if self.some(0.25):
            text += f"<medium {self.color(0, 0.5)}/>"
        movable = shape != "everywhere" and not (alone and shape == "models")
        return text + (self.transform(0.6, first) if movable else ""), shape

    def layers(self, transfer):
        rows, at = [], self.r.uniform(-1.5, 0)
        for i in range(self.r.randint(2, 4)):
            amount = (f'sigma_t="{self.number(0, 2)}" albedo="{self.numbers(self.r.choice([1, 3]), 0.3, 1)}"' +
                      (f' emission="{self.numbers(3, 0, 0.4)}"' if self.some(0.3) else "")) if transfer else f'density="{self.number(0, 2)}"'
            rows.append(f'<layer height="{at:.4g}" {amount}/>')
            at += self.r.uniform(0.2, 1)
        return "".join(rows)

    def shine(self, low, high, power, faint=0.0):
        """A lamp's colour by its radiance or intensity, as a black body, or by what it sends out in all, up to so much."""
        way = self.r.choice(["color", "color", "kelvin", "power"])
        return {"color": self.color(low, high, faint),
                "kelvin": f'kelvin="{self.number(1000, 12000)}" multiplier="{self.number(low, high)}"',
                "power": f'power="{self.number(0.2 * power, power)}"'}[way]

    def light(self, periodic, at=None):
        """At a place, or anywhere."""
        kind = self.r.choice(["directional", "sun", "sky"] + ([] if periodic else ["point", "spot", "sphere", "disk", "rectangle"]))
        about = f'{at or self.place(2.0, 1.5)} lookAt="{self.numbers(3, -0.5, 0.5)}"'
        return {"directional": f'<directional {self.place(1, 1)} {self.color(0.3, 2, 0.1)}/>',
                "sun": f'<sun {self.place(1, 1)} angle="{self.number(2, 60)}" limbDarkening="{self.r.choice([0, 0, 0.6, 1])}" {self.color(0.3, 2)}/>',
                "sky": f'<sky rotation="{self.number(0, 360)}" multiplier="{self.number(0.3, 1)}" {self.r.choice(SKIES)}</sky>',
                "point": f"<point {at or self.place(2, 1.5)} {self.shine(1, 8, 50, 0.2)}/>",
                "spot": f'<spot {about} angle="{self.number(30, 120)}" {self.shine(2, 20, 20)}/>',
                "sphere": f'<sphere {self.place(2, 1.5)} radius="{self.number(0.2, 0.6)}" {self.shine(1, 8, 20, 0.2)}/>',
                "disk": f'<disk {about} radius="{self.number(0.2, 0.6)}" {self.shine(1, 8, 5)}/>',
                "rectangle": f'<rectangle {about} width="{self.number(0.3, 1)}" height="{self.number(0.3, 1)}" {self.shine(1, 8, 5)}/>'}[kind]

    def surface(self, flat_only):
        kind = self.r.choice(["sphere", "disk", "rectangle", "box", "mesh", "plane"] if not flat_only else ["plane", "sphere", "rectangle"])
        material = self.r.choice(["diffuse", "diffuse", "diffuse", "coated", "conductor", "dielectric", "mirror", "thinDielectric"])
        if kind in ("disk", "rectangle", "plane") and material == "dielectric":
            material = "diffuse"
        attributes = f'material="{material}"'
        if material in ("diffuse", "coated", "mirror"):
            attributes += " " + self.color(0.2, 0.9)
        if material == "dielectric":
            attributes += f' ior="{self.number(1.1, 1.8)}"'
        if material in ("conductor", "dielectric") and self.some(0.7):
            attributes += f' roughness="{self.number(0.2, 0.7)}"'
        if material == "diffuse" and kind in ("rectangle", "sphere") and self.some(0.3):
            attributes += f' checker="{self.number(0, 1)}" repeat="2"'
        facing = f'lookAt="{self.numbers(3, -1, 1)}"'
        inside = ""
        if self.some(0.2) and material != "dielectric":
            inside = f'<emission {self.color(0.2, 1.5)} sides="{self.r.choice([1, 1, 2])}"/>'
        smooth = kind == "mesh" and self.some(0.5) # of a file
        shape = {"sphere": f'<sphere {self.place(1.2)} radius="{self.number(0.3, 0.7)}" ',
                 "disk": f'<disk {self.place(1.2)} {facing} radius="{self.number(0.3, 1)}" ',
                 "rectangle": f'<rectangle {self.place(1.2)} {facing} width="{self.number(0.3, 2)}" height="{self.number(0.3, 2)}" ',
                 "box": f'<box {self.place(1.2)} width="{self.number(0.3, 1)}" height="{self.number(0.3, 1)}" depth="{self.number(0.3, 1)}" ',
                 "plane": f'<plane y="{self.number(-2.5, -1)}" ',
                 "mesh": '<mesh ' + (f'file="{self.r.choice(["cube", "stone"])}.obj" normals="smooth" ' if smooth else "")}[kind]
        if kind == "mesh" and not smooth:
            corners, faces = self.r.choice([cube, stone])()
            inside += f"<vertices>{' '.join('%.6g' % x for v in corners for x in v)}</vertices><triangles>{' '.join(str(i) for f in faces for i in f)}</triangles>"
        if kind in ("box", "mesh") and self.some(0.7):
            inside += self.transform(1.2)
        return f"{shape}{attributes}>{inside}</{kind}>"

    def sensor(self, periodic, height):
        """Sometimes in the plane of a surface, at this height if any."""
        kind = self.r.choice(["camera"] * 5 + ["panorama", "orthographic", "lens", "irradiance", "irradiance", "fluence", "absorption"])
        look = f'lookAt="{self.numbers(3, -0.3, 0.3)}" distance="{self.number(3, 12)}" azimuth="{self.number(0, 360)}" elevation="{self.number(-30, 70)}"'
        if kind == "irradiance":
            facing = self.numbers(3, -3, 3)
            place = self.place(0.3, self.r.uniform(-1, 1))
            if height is not None:
                place = f'x="0" y="{height:.6g}" z="0"'
                facing = f"0 {height + self.r.choice([-9, 9]):.6g} 0"
            if periodic:
                y = self.r.uniform(-2, 2)
                place, facing = f'x="{self.number(-0.2, 0.2)}" y="{y:.4g}" z="{self.number(-0.2, 0.2)}"', f"0 {self.r.choice([-9, 9])} 0"
                x, z = place.split('"')[1], place.split('"')[5]
                facing = f"{x} {facing.split()[1]} {z}"
                return f'<irradiance {place} lookAt="{facing}" up="0 0 1" width="1" height="1.2"/>'
            return f'<irradiance {place} lookAt="{facing}" up="0.3 0.1 1" width="{self.number(0.3, 2)}" height="{self.number(0.3, 2)}"/>'
        if kind == "fluence":
            return f"<fluence>{self.numbers(12, -1, 1)}</fluence>"
        if kind == "absorption":
            return f'<absorption width="{self.number(1, 3)}" height="{self.number(1, 3)}" depth="{self.number(1, 3)}" cells="2 2 2"/>'
        more = {"camera": f'fov="{self.number(15, 70)}"', "panorama": 'projection="equirectangular"',
                "orthographic": f'projection="orthographic" viewHeight="{self.number(2, 5)}"',
                "lens": f'fov="30" lensRadius="{self.number(0.05, 0.5)}"'}[kind]
        return f"<camera {look} {more}/>"

    def write(self):
        periodic = self.some(0.12)
        count = self.r.choice([0, 1, 1, 1, 1, 2, 2, 3])
        parts, everywhere = [], False
        if count == 1:
            text, shape = self.medium(True)
            everywhere = shape == "everywhere"
            parts.append(f"<volumes><volume>{text}</volume></volumes>" if "<transform>" in text else text)
        elif count > 1:
            volumes = []
            for _ in range(count):
                text, shape = self.medium(False)
                everywhere = everywhere or shape == "everywhere"
                volumes.append(f"<volume>{text}</volume>")
            parts.append(f"<volumes>{''.join(volumes)}</volumes>")
        surfaces = self.r.choice([0, 0, 0, 1, 2, 3]) if count else self.r.randint(1, 3)
        height, at = None, None
        if surfaces:
            texts = [self.surface(periodic) for _ in range(surfaces)]
            parts.append(f"<surfaces>{''.join(texts)}</surfaces>")
            planes = [float(found) for found in re.findall(r'<plane y="([^"]*)"', "".join(texts))]
            planes += [0.7 for text in texts if "<mesh" in text and "-0.7 -0.7" in text and "<transform" not in text]  # a cube's top
            height = planes[0] if planes else None
            if height is not None and self.some(0.5):
                at = f'x="{self.number(-0.5, 0.5)}" y="{height:.6g}" z="{self.number(-0.5, 0.5)}"'
        lights = [self.light(periodic or everywhere and self.some(0.8), at if self.some(0.5) else None)
                  for _ in range(self.r.choice([0, 1, 1, 2, 3]))]
        skies = [light for light in lights if light.startswith("<sky")]
        lights = [light for light in lights if not light.startswith("<sky")] + skies[:1]
        if lights:
            parts.append(f"<lights>{''.join(lights)}</lights>")
        if not lights or self.some(0.5):
            parts.append(f"<backgroundColor {self.color(0.1, 1)}/>")
        if periodic:
            parts.append('<periodic x="-1.5 1.5" z="-1.4 1.4"/>')
        parts.append(self.sensor(periodic, height if self.some(0.5) else None))
        if self.some(0.3):
            parts.append(f'<pixelFilter>{self.r.choice(["tent", "gaussian", "blackmanHarris"])}</pixelFilter>')
        if self.some(0.3):
            parts.append(f'<filter>{self.r.choice(["nearest", "trilinear", "stochastic"])}</filter>')
        parts.append(f"<maxDepth>{self.r.choice([1, 2, 5, 20, 100])}</maxDepth>")
        return "<options>\n" + "\n".join(parts) + "\n</options>\n"


def cube():
    corners = [(x, y, z) for x in (-0.7, 0.7) for y in (-0.7, 0.7) for z in (-0.7, 0.7)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return corners, [half for a, b, c, d in quads for half in ((a, b, c), (a, c, d))]


def stone():
    """An icosahedron."""
    golden = (1 + math.sqrt(5)) / 2
    corners = [tuple(0.45 * x for x in v) for a in (-1, 1) for b in (-golden, golden) for v in ((0, a, b), (a, b, 0), (b, 0, a))]
    near = lambda p, q: abs(math.dist(p, q) - 0.9) < 1e-6
    faces = []
    for i, p in enumerate(corners):
        for j, q in enumerate(corners):
            for k, s in enumerate(corners):
                if i < j < k and near(p, q) and near(q, s) and near(p, s):
                    u, v = [b - a for a, b in zip(p, q)], [b - a for a, b in zip(p, s)]
                    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
                    faces.append((i, j, k) if sum(a * b for a, b in zip(n, p)) > 0 else (i, k, j))
    return corners, faces


def write_files(folder, make_field):
    """What scenes refer to."""
    for name, (arguments, _, _) in FIELDS.items():
        subprocess.run([make_field, *arguments, "--if-missing", "-o", folder / f"{name}.nvdb"], check=True, stdout=subprocess.DEVNULL)
    for name, (corners, faces) in (("cube", cube()), ("stone", stone())):
        lines = ["v %.9g %.9g %.9g" % v for v in corners] + ["f %d %d %d" % tuple(i + 1 for i in face) for face in faces]
        (folder / f"{name}.obj").write_text("\n".join(lines) + "\n")
    (folder / "phase.txt").write_text("".join(f"{angle} {0.3 + math.exp(-angle / 20):.6g}\n" for angle in range(0, 181, 5)))
    texels = bytes(byte for row in range(8) for column in range(16)
                   for byte in ((250, 230, 200, 131) if (row, column) == (2, 5) else (60 + 10 * row, 80, 160 - 12 * row + column, 128)))
    head = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X "
    (folder / "sky.hdr").write_bytes(head + b"16\n" + texels)
    (folder / "square.hdr").write_bytes(head + b"8\n" + texels[:4 * 64])
