"""Parts of scene files: what cases are made of. Heights are y; the sun's zenith angle has the cosine mu0, its azimuth is where it
stands, from +x toward -z, that is counter-clockwise as seen from above."""

import math


def toward(mu, azimuth=0.0):
    """Unit vector that goes up by mu, down where that is negative."""
    across = math.sqrt(max(0.0, 1.0 - mu * mu))
    return across * math.cos(math.radians(azimuth)), mu, -across * math.sin(math.radians(azimuth))


def sun(mu0, irradiance, azimuth=0.0):
    """From there, of this irradiance across itself."""
    x, y, z = toward(mu0, azimuth)
    return f'<light x="{x!r}" y="{y!r}" z="{z!r}" r="1" g="1" b="1" multiplier="{irradiance!r}"/>'


def even_sky(radiance):
    """From everywhere: below a slab belongs a black ground."""
    return f'<backgroundColor r="1" g="1" b="1" multiplier="{radiance!r}"/>'


ROWS = 64  # that read the same
SLAB = 8.0  # how wide a domain of one is


def flux(height, down, width=SLAB, depth=SLAB, columns=1, rows=ROWS):
    """A sensor of what comes down there, or goes up, in the whole of a domain: columns along x, and rows along z; the first
    is at high z, as seen from below, or at low z, as seen from above."""
    look = height + (1.0 if down else -1.0)
    up = "0 0 1" if down else "0 0 -1"  # so that columns go along +x
    return (f'<irradiance y="{height!r}" lookAt="0 {look!r} 0" up="{up}" width="{width!r}" '
            f'height="{depth!r}"/><width>{columns}</width><height>{rows}</height>')


def radiance(height, mu, azimuth=0.0, width=0.01, columns=1, rows=ROWS):
    """A camera of parallel rays that sees what leaves a plane at `height`, upwards by mu, in this azimuth: columns along x, of the
    plane, whatever the slant, and rows along z. More than one column are for azimuths along x, or all but upright."""
    d = toward(mu, azimuth)
    slant = mu if abs(d[2]) < 1e-9 else 1.0
    high = width * slant / columns * rows
    far = 2.0 * max(width, high) / mu  # no corner of the picture, however it slants, begins below `height`
    eye = [p + far * q for p, q in zip((0.0, height, 0.0), d)]
    return (f'<camera projection="orthographic" viewHeight="{high!r}" x="{eye[0]!r}" y="{eye[1]!r}" z="{eye[2]!r}" '
            f'lookAt="0 {height!r} 0" up="0 0 -1"/><width>{columns}</width><height>{rows}</height>')


def periodic(width, depth):
    return f'<periodic x="{-0.5 * width!r} {0.5 * width!r}" z="{-0.5 * depth!r} {0.5 * depth!r}"/>'


def coefficients(sigma_t, albedo, phase=""):
    return f"<sigma_a>{sigma_t * (1.0 - albedo)!r}</sigma_a><sigma_s>{sigma_t * albedo!r}</sigma_s>{phase}"


def henyey_greenstein(g):
    return f"<heyneygreenstein_g>{g!r}</heyneygreenstein_g>"


def box(low, high, sigma_t, albedo, phase="", more=""):
    """A volume of the list."""
    middle = [0.5 * (a + b) for a, b in zip(low, high)]
    size = [b - a for a, b in zip(low, high)]
    places = " ".join(f'{n}="{v!r}"' for n, v in zip(("x", "y", "z", "width", "height", "depth"), middle + size))
    return f"<volume><box {places}/>{coefficients(sigma_t, albedo, phase)}{more}</volume>"


def volumes(*items):
    return "<volumes>" + "".join(items) + "</volumes>"


def slab(layers, width=SLAB):
    """Infinite layers, from the top down: (optical depth, albedo, phase). Each is as thick as it is deep; the top is at height 0.
    And the height of the bottom."""
    items, height = [], 0.0
    for tau, albedo, phase in layers:
        items.append(box((-0.5 * width, height - tau, -0.5 * width), (0.5 * width, height, 0.5 * width), 1.0, albedo, phase))
        height -= tau
    return volumes(*items) + periodic(width, width), height


def ground(height, albedo):
    """Matte, without end."""
    return f'<surfaces><plane y="{height!r}" r="{albedo!r}" g="{albedo!r}" b="{albedo!r}"/></surfaces>'
