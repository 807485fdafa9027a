"""OpenEXR files as vkvol, Mitsuba and pbrt write them. Reading is the report page's; films and maps are written here."""
import struct
import sys
import zlib
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from report_page.exr import BadPicture, decode  # noqa: E402


def read(path):
    """Channels by name, each [row, column], in double precision."""
    try:
        return {name: plane.astype(float) for name, plane in decode(Path(path).read_bytes()).items()}
    except OSError as error:
        sys.exit(f"{path}: cannot be read: {error.strerror}")
    except BadPicture as error:
        sys.exit(f"{path}: {error}; convert it, for example with oiiotool --scanline --compression zip")
    except (KeyError, IndexError, ValueError, struct.error, zlib.error) as error:
        sys.exit(f"{path}: damaged ({error!r})")


def read_rgb(path):
    """Colour, and its variance and number of samples where the file has them, else None."""
    images = read(path)
    if not {"R", "G", "B"} <= images.keys():
        sys.exit(f"{path}: has channels {', '.join(images)}; R, G and B are needed")

    def stack(prefix):
        return np.stack([images[prefix + c] for c in "RGB"], axis=2) if prefix + "R" in images else None
    return stack(""), stack("variance."), images.get("samples")


KINDS = {"u4": 0, "f2": 1, "f4": 2}
ZIP_LINES = 16  # in a block


def zipped(raw):
    """The format's own: even bytes before odd ones, their differences, zlib; as it is where that would not be shorter."""
    data = np.frombuffer(raw, np.uint8)
    data = np.concatenate([data[0::2], data[1::2]])
    data = np.concatenate([data[:1], np.diff(data) + np.uint8(128)])
    packed = zlib.compress(data.tobytes(), 9)
    return packed if len(packed) < len(raw) else raw


def write_channels(path, images, compress=False, numbers=None):
    """Scan lines of channels by name, each [row, column] of u4, f2 or f4. `numbers`: whole ones, by name, in the header."""
    names = sorted(images)
    height, width = images[names[0]].shape
    step = ZIP_LINES if compress else 1

    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<I", len(value)) + value
    channels = b"".join(name.encode() + b"\0" + struct.pack("<IIII", KINDS[images[name].dtype.str[1:]], 0, 1, 1)
                        for name in names) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = b"v/1\x01" + struct.pack("<I", 2) + b"".join((
        attribute("channels", "chlist", channels), attribute("compression", "compression", b"\3" if compress else b"\0"),
        attribute("dataWindow", "box2i", window), attribute("displayWindow", "box2i", window),
        attribute("lineOrder", "lineOrder", b"\0"), attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
        attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        attribute("screenWindowWidth", "float", struct.pack("<f", 1)),
        *(attribute(name, "int", struct.pack("<i", number)) for name, number in (numbers or {}).items()))) + b"\0"
    blocks = []
    for y in range(0, height, step):
        raw = b"".join(images[name][row].tobytes() for row in range(y, min(y + step, height)) for name in names)
        data = zipped(raw) if compress else raw
        blocks.append(struct.pack("<iI", y, len(data)) + data)
    places = len(header) + 8 * len(blocks) + np.cumsum([0] + [len(block) for block in blocks[:-1]])
    Path(path).write_bytes(header + places.astype("<u8").tobytes() + b"".join(blocks))


def write(path, mean, variance, samples, passes=0):
    """The channels of vkvol's films: mean, variance of the mean, samples of each pixel. `passes`: that the variance is known
    from, if not from samples."""
    images = {c: mean[..., i].astype("<f4") for i, c in enumerate("RGB")}
    images.update({"variance." + c: variance[..., i].astype("<f4") for i, c in enumerate("RGB")})
    images["samples"] = np.full(mean.shape[:2], samples, "<u4")
    write_channels(path, images, numbers={"vkvol/passes": passes} if passes else None)
