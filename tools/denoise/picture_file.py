"""EXR files with all that they hold: what nobody asks for goes from file to file as it is."""
import os
import struct
import sys
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from peers.exr import KINDS, ZIP_LINES, zipped  # noqa: E402
from report_page.exr import BadPicture, decode, text  # noqa: E402

MAGIC = b"v/1\x01"
LONG_NAMES = 0x400  # of the version field: names of 32 bytes and more


class Refusal(Exception):
    """What is wrong with an input or an output, and what helps: one line."""


@dataclass
class Picture:
    """attributes: (type, bytes) by name, in the file's order; channels: [row, column] by name, of u4, f2 or f4."""
    attributes: dict
    channels: dict

    @property
    def shape(self):
        """Rows and columns."""
        return next(iter(self.channels.values())).shape

    def stack(self, prefix="", letters="RGB"):
        """[row, column, letter] in double precision; None where the file lacks one of these channels."""
        names = [prefix + letter for letter in letters]
        return np.stack([self.channels[n].astype(float) for n in names], axis=2) if set(names) <= self.channels.keys() else None

    def text(self, name):
        kind, value = self.attributes.get(name, ("", b""))
        return value.decode("utf-8", "replace") if kind == "string" else ""

    def number(self, name):
        """None where there is no number of this name."""
        kind, value = self.attributes.get(name, ("", b""))
        return struct.unpack({"int": "<i", "float": "<f"}[kind], value)[0] if kind in ("int", "float") else None

    def set_text(self, name, value):
        self.attributes[name] = ("string", value.encode())


def attributes_of(data):
    found, at = {}, 8
    while data[at]:
        name, at = text(data, at)
        kind, at = text(data, at)
        (size,) = struct.unpack_from("<I", data, at)  # unsigned: a walk that goes back would never end
        found[name] = (kind, data[at + 4:at + 4 + size])
        at += 4 + size
    return found


def read(file):
    try:
        data = Path(file).read_bytes()
        if data[:len(MAGIC)] != MAGIC:
            raise Refusal(f"{file}: is no EXR file; give the .exr that vkvol wrote")
        return Picture(attributes_of(data), decode(data))
    except OSError as error:
        raise Refusal(f"{file}: cannot be read: {error.strerror}")
    except BadPicture as error:
        raise Refusal(f"{file}: {error}")
    except (KeyError, IndexError, ValueError, MemoryError, struct.error, zlib.error) as error:
        raise Refusal(f"{file}: is damaged, or not complete ({error}); copy or render it again")


def encoded(picture):
    """The file's bytes: scan lines, ZIP."""
    names = sorted(picture.channels, key=str.encode)
    height, _ = picture.shape
    attributes = dict(picture.attributes)
    attributes["channels"] = ("chlist", b"".join(
        n.encode() + b"\0" + struct.pack("<IIII", KINDS[picture.channels[n].dtype.str[1:]], 0, 1, 1) for n in names) + b"\0")
    attributes["compression"] = ("compression", b"\3")
    attributes["lineOrder"] = ("lineOrder", b"\0")
    longest = max(len(n.encode()) for n in [*names, *attributes])
    header = MAGIC + struct.pack("<I", 2 | (LONG_NAMES if longest > 31 else 0)) + b"".join(
        n.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<I", len(value)) + value
        for n, (kind, value) in attributes.items()) + b"\0"
    first = struct.unpack("<4i", attributes["dataWindow"][1])[1]
    blocks = []
    for y in range(0, height, ZIP_LINES):
        rows = range(y, min(y + ZIP_LINES, height))
        data = zipped(b"".join(picture.channels[n][row].tobytes() for row in rows for n in names))
        blocks.append(struct.pack("<iI", first + y, len(data)) + data)
    places = len(header) + 8 * len(blocks) + np.cumsum([0] + [len(block) for block in blocks[:-1]])
    return header + places.astype("<u8").tobytes() + b"".join(blocks)


def write(file, picture):
    """Under another name first, so that nobody finds half a file."""
    target = Path(os.path.realpath(file))  # a link stays a link
    temporary = Path(f"{target}.{os.getpid()}.partial")
    try:
        with open(temporary, "wb") as out:
            out.write(encoded(picture))
            out.flush()
            os.fsync(out.fileno())
        os.replace(temporary, target)
    except OSError as error:
        raise Refusal(f"{file}: cannot be written: {error.strerror}; name another place with -o")
    finally:
        temporary.unlink(missing_ok=True)
