"""Pictures for a page: what was rendered, and where it is wrong."""
import base64
import struct
import zlib

import numpy

EPSILON = 0.01  # as of relMSE in `vkvol compare`
WIDEST = 640    # pixels; wider ones are averaged down

# Inferno at equal distances: its lightness grows evenly, which every kind of colour vision can see.
INFERNO = ("#000004", "#1b0c41", "#4a0c6b", "#781c6d", "#a52c60", "#cf4446", "#ed6925", "#fb9b06", "#f7d13d", "#fcffa4")
DARKEST, LIGHTEST = 1e-3, 1.0  # relative errors at the ends of it


def shrink(picture):
    """Means over squares of pixels, so that it is at most WIDEST wide."""
    factor = -(-picture.shape[1] // WIDEST)
    height, width = (n // factor * factor for n in picture.shape[:2])
    cut = picture[:height, :width]
    return cut.reshape(height // factor, factor, width // factor, factor, -1).mean(axis=(1, 3)).squeeze() if factor > 1 else cut


def png(pixels, palette=None):
    """Height x width x 3, or height x width indices of a palette, in bytes."""
    height, width = pixels.shape[:2]
    rows = pixels.reshape(height, -1).astype(numpy.uint8)
    filtered = rows.copy()
    step = 3 if palette is None else 1
    filtered[:, step:] -= rows[:, :-step]  # each byte less the same channel's to its left: filter 1
    raw = numpy.concatenate([numpy.ones((height, 1), numpy.uint8), filtered], axis=1).tobytes()

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = struct.pack(">IIBBBBB", width, height, 8, 2 if palette is None else 3, 0, 0, 0)
    colours = b"" if palette is None else chunk(b"PLTE", palette.astype(numpy.uint8).tobytes())
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + colours + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b"")


def data_uri(bytes_of_png):
    return "data:image/png;base64," + base64.b64encode(bytes_of_png).decode()


def displayed(linear):
    """As a PNG of vkvol's: sRGB, what is brighter than white cut off."""
    x = numpy.clip(numpy.nan_to_num(shrink(linear)), 0, 1)
    curve = numpy.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)
    return data_uri(png(numpy.rint(255 * curve)))


def error_squares(picture, reference):
    """Each pixel's share of relMSE."""
    return ((picture - reference) ** 2 / (reference**2 + EPSILON)).mean(axis=2)


def error_picture(picture, reference):
    """(data URI, relMSE): the root of each pixel's share, from DARKEST to LIGHTEST on a logarithmic scale."""
    squares = numpy.nan_to_num(error_squares(picture, reference), nan=numpy.inf)
    error = numpy.sqrt(shrink(squares))
    level = numpy.log(numpy.clip(error, DARKEST, LIGHTEST) / DARKEST) / numpy.log(LIGHTEST / DARKEST)
    stops = numpy.array([[int(c[i:i + 2], 16) for i in (1, 3, 5)] for c in INFERNO])
    where = numpy.linspace(0, len(stops) - 1, 256)
    palette = numpy.stack([numpy.interp(where, range(len(stops)), stops[:, c]) for c in range(3)], axis=1).round()
    return data_uri(png(numpy.rint(255 * level), palette)), float(squares.mean())
