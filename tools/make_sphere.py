#!/usr/bin/env python3
"""Writes the sphere of the thesis' figures 4.1-4.7: an icosahedron whose faces are split in four twice over, its vertices
moved onto the sphere. 162 vertices, 320 triangles, closed, faces counter-clockwise seen from outside.
    tools/make_sphere.py [FOLDER]      default scenes/thesis/models: SphereOnly.obj and SphereOnly.mtl"""
import math
import os
import sys

CENTRE, RADIUS, SPLITS = (0.0, 0.5, 0.0), 2.5456, 2  # the original's, measured in its pictures and file
MATERIAL = """# The original's material. A medium has no surface: Kd is the colour of the fog of densitySampling,
# and d < 1 told the original's loader that the inside is visible.
newmtl SphereOnly
Kd 0.8 0.1 0.5
d 0.5
"""


def normalised(p):
    length = math.sqrt(sum(x * x for x in p))
    return tuple(x / length for x in p)


def icosahedron():
    """Unit vertices: the even permutations of (0, ±1, ±golden ratio). Faces: the triples one edge apart, turned outwards."""
    golden = (1 + math.sqrt(5)) / 2
    corners = [(0, s, t * golden) for s in (-1, 1) for t in (-1, 1)]
    vertices = [normalised(p[-k:] + p[:-k]) for k in range(3) for p in corners]
    edge = 4 / (golden * golden + 1) * 1.0001  # squared, on the unit sphere; the next distance is 2.6 times it
    near = lambda a, b: sum((x - y) ** 2 for x, y in zip(vertices[a], vertices[b])) < edge
    faces = [outwards(vertices, (a, b, c)) for a in range(12) for b in range(a + 1, 12) for c in range(b + 1, 12)
             if near(a, b) and near(b, c) and near(c, a)]
    return vertices, faces


def outwards(vertices, face):
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (vertices[i] for i in face)
    determinant = ax * (by * cz - bz * cy) - ay * (bx * cz - bz * cx) + az * (bx * cy - by * cx)
    return face if determinant > 0 else (face[0], face[2], face[1])


def split(vertices, faces):
    """Each triangle becomes four; neighbours share the vertex in the middle of their edge, so the mesh stays closed."""
    vertices, middles, smaller = list(vertices), {}, []

    def middle(a, b):
        key = (min(a, b), max(a, b))
        if key not in middles:
            middles[key] = len(vertices)
            vertices.append(normalised([x + y for x, y in zip(vertices[a], vertices[b])]))
        return middles[key]

    for a, b, c in faces:
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        smaller += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return vertices, smaller


def check(vertices, faces):
    """Closed and consistently turned: each directed edge occurs once, and so does its opposite."""
    edges = [(f[k], f[(k + 1) % 3]) for f in faces for k in range(3)]
    assert len(set(edges)) == len(edges) == len(set(edges) & {(b, a) for a, b in edges})
    assert (len(vertices), len(faces)) == (162, 320)


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(__file__), "../scenes/thesis/models")
    vertices, faces = icosahedron()
    for _ in range(SPLITS):
        vertices, faces = split(vertices, faces)
    check(vertices, faces)
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "SphereOnly.mtl"), "w") as file:
        file.write(MATERIAL)
    with open(os.path.join(folder, "SphereOnly.obj"), "w") as file:
        file.write("# Made by tools/make_sphere.py: radius %g about (%g, %g, %g).\nmtllib SphereOnly.mtl\no SphereOnly\n"
                   % (RADIUS, *CENTRE))
        for vertex in vertices:
            file.write("v %.7f %.7f %.7f\n" % tuple(c + RADIUS * x for c, x in zip(CENTRE, vertex)))
        file.write("usemtl SphereOnly\n")
        for face in faces:
            file.write("f %d %d %d\n" % tuple(i + 1 for i in face))


main()
