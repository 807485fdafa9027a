"""Reads the OpenEXR files that vkvol writes: one part, scan lines, no compression or ZIP."""
import struct
import zlib
from pathlib import Path

import numpy


class BadPicture(Exception):
    pass


TYPES = {0: ("<u4", 4), 1: ("<f2", 2), 2: ("<f4", 4)}
LINES = {0: 1, 2: 1, 3: 16}  # per block: none, ZIPS, ZIP
TILED_DEEP_OR_PARTS = 0x1A00


def text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode("utf-8", "replace"), end + 1


def read_header(data):
    """(attributes, where the table of blocks begins)."""
    attributes, at = {}, 8
    while data[at]:
        name, at = text(data, at)
        _, at = text(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def channels_of(data):
    """[(name, numpy type, bytes)] in the file's order."""
    found, at = [], 0
    while data[at]:
        name, at = text(data, at)
        kind, _, step_x, step_y = struct.unpack_from("<iIii", data, at)
        if kind not in TYPES or (step_x, step_y) != (1, 1):
            raise BadPicture(f"its channel {name} is of a kind that is not read here")
        found.append((name, *TYPES[kind]))
        at += 16
    return found


def unpack(block, size):
    """Undoes ZIP: the file holds differences of bytes, the even ones first. A block that would have grown is stored as it is."""
    if len(block) == size:
        return block
    stored = numpy.frombuffer(zlib.decompress(block), numpy.uint8).astype(numpy.int64)
    stored[1:] -= 128
    plain = numpy.cumsum(stored).astype(numpy.uint8)
    result = numpy.empty(size, numpy.uint8)
    half = (size + 1) // 2
    result[0::2], result[1::2] = plain[:half], plain[half:]
    return result.tobytes()


def decode(data):
    if data[:4] != b"v/1\x01" or struct.unpack_from("<i", data, 4)[0] & TILED_DEEP_OR_PARTS:
        raise BadPicture("it is no OpenEXR file of one part in scan lines")
    attributes, at = read_header(data)
    channels, compression = channels_of(attributes["channels"]), attributes["compression"][0]
    if compression not in LINES:
        raise BadPicture(f"its compression, number {compression}, is not read here; save it with ZIP")
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height, lines = x1 - x0 + 1, y1 - y0 + 1, LINES[compression]
    planes = {name: numpy.empty((height, width), kind) for name, kind, _ in channels}
    line_bytes = width * sum(size for *_, size in channels)
    for offset in struct.unpack_from(f"<{-(-height // lines)}Q", data, at):
        y, size = struct.unpack_from("<ii", data, offset)
        count = min(lines, y1 - y + 1)
        block, start = unpack(data[offset + 8:offset + 8 + size], count * line_bytes), 0
        for row in range(y - y0, y - y0 + count):
            for name, kind, bytes_each in channels:
                planes[name][row] = numpy.frombuffer(block, kind, width, start)
                start += width * bytes_each
    return planes


def read_exr(file):
    """Height x width x 3, linear."""
    try:
        planes = decode(Path(file).read_bytes())
        return numpy.stack([planes[c].astype(numpy.float64) for c in "RGB"], axis=-1)
    except OSError as error:
        raise BadPicture(f"{file} cannot be read: {error.strerror}")
    except BadPicture as error:
        raise BadPicture(f"{file} is not shown: {error}")
    except (KeyError, IndexError, ValueError, struct.error, zlib.error) as error:
        raise BadPicture(f"{file} is not shown: it is damaged, or has no channels R, G, B ({error!r})")
