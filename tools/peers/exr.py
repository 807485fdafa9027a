"""OpenEXR files of scan lines, as vkvol, Mitsuba and pbrt write them: channels of half, float or uint; no compression,
ZIPS or ZIP."""
import struct
import sys
import zlib

import numpy as np

MAGIC = 20000630
TYPES = {0: np.dtype("<u4"), 1: np.dtype("<f2"), 2: np.dtype("<f4")}
LINES = {0: 1, 2: 1, 3: 16}  # per chunk: no compression, ZIPS, ZIP
TILED_OR_DEEP_OR_PARTS = 0x200 | 0x800 | 0x1000


def text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def read_header(data, path):
    magic, version = struct.unpack_from("<II", data)
    if magic != MAGIC or version & TILED_OR_DEEP_OR_PARTS:
        sys.exit(f"{path}: not an EXR file of scan lines; convert it, for example with oiiotool --scanline")
    at, attributes = 8, {}
    while data[at]:
        name, at = text(data, at)
        _, at = text(data, at)
        size, = struct.unpack_from("<I", data, at)
        attributes[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def read_channels(attribute):
    channels, at = [], 0
    while attribute[at]:
        name, at = text(attribute, at)
        channels.append((name, TYPES[struct.unpack_from("<I", attribute, at)[0]]))
        at += 16
    return channels


def unzip(packed, size):
    """ZIP in OpenEXR: bytes are differences, the even ones first."""
    if len(packed) == size:
        return packed
    raw = np.frombuffer(zlib.decompress(packed), np.uint8).astype(np.uint8)
    raw = (np.cumsum(raw, dtype=np.int64) - 128 * np.arange(len(raw))).astype(np.uint8)
    out = np.empty_like(raw)
    half = (len(raw) + 1) // 2
    out[::2], out[1::2] = raw[:half], raw[half:]
    return out.tobytes()


def read(path):
    """Channels by name, each [row, column], in double precision."""
    try:
        with open(path, "rb") as file:
            data = file.read()
    except OSError as error:
        sys.exit(f"{path}: cannot be read: {error.strerror}")
    attributes, at = read_header(data, path)
    compression = attributes["compression"][0]
    if compression not in LINES:
        sys.exit(f"{path}: compressed in a way that is not read here; convert it, for example with oiiotool --compression zip")
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height, lines = x1 - x0 + 1, y1 - y0 + 1, LINES[compression]
    channels = read_channels(attributes["channels"])
    images = {name: np.empty((height, width)) for name, _ in channels}
    row_bytes = width * sum(type_.itemsize for _, type_ in channels)
    for offset in struct.unpack_from(f"<{-(-height // lines)}Q", data, at):
        y, size = struct.unpack_from("<iI", data, offset)
        rows = min(lines, y1 + 1 - y)
        pixels = unzip(data[offset + 8:offset + 8 + size], rows * row_bytes) if compression else data[offset + 8:]
        position = 0
        for row in range(y - y0, y - y0 + rows):
            for name, type_ in channels:
                images[name][row] = np.frombuffer(pixels, type_, width, position)
                position += width * type_.itemsize
    return images


def read_rgb(path):
    """Colour, and its variance and number of samples where the file has them, else None."""
    images = read(path)
    if not {"R", "G", "B"} <= images.keys():
        sys.exit(f"{path}: has channels {', '.join(images)}; R, G and B are needed")

    def stack(prefix):
        return np.stack([images[prefix + c] for c in "RGB"], axis=2) if prefix + "R" in images else None
    return stack(""), stack("variance."), images.get("samples")


def write(path, mean, variance, samples):
    """The channels of vkvol's films: mean, variance of the mean, samples of each pixel."""
    height, width, _ = mean.shape
    images = {c: mean[..., i] for i, c in enumerate("RGB")}
    images.update({"variance." + c: variance[..., i] for i, c in enumerate("RGB")})
    images["samples"] = np.full((height, width), samples)
    names = sorted(images)

    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<I", len(value)) + value
    channels = b"".join(name.encode() + b"\0" + struct.pack("<IIII", 2, 0, 1, 1) for name in names) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<II", MAGIC, 2) + b"".join((
        attribute("channels", "chlist", channels), attribute("compression", "compression", b"\0"),
        attribute("dataWindow", "box2i", window), attribute("displayWindow", "box2i", window),
        attribute("lineOrder", "lineOrder", b"\0"), attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
        attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        attribute("screenWindowWidth", "float", struct.pack("<f", 1)))) + b"\0"
    row_bytes = 4 * width * len(names)
    first = len(header) + 8 * height
    with open(path, "wb") as file:
        file.write(header + struct.pack(f"<{height}Q", *(first + y * (8 + row_bytes) for y in range(height))))
        for y in range(height):
            file.write(struct.pack("<iI", y, row_bytes))
            file.write(b"".join(images[name][y].astype("<f4").tobytes() for name in names))
