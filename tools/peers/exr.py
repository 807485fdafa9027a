"""OpenEXR files as vkvol, Mitsuba and pbrt write them. Reading is the report page's; vkvol's films are written here."""
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


def write(path, mean, variance, samples):
    """The channels of vkvol's films: mean, variance of the mean, samples of each pixel."""
    height, width, _ = mean.shape
    images = {c: mean[..., i] for i, c in enumerate("RGB")}
    images.update({"variance." + c: variance[..., i] for i, c in enumerate("RGB")})
    images["samples"] = np.full((height, width), samples)
    names = sorted(images)

    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<I", len(value)) + value
    channels = b"".join(name.encode() + b"\0" + struct.pack("<IIII", 0 if name == "samples" else 2, 0, 1, 1) for name in names) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = b"v/1\x01" + struct.pack("<I", 2) + b"".join((
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
            file.write(b"".join(images[name][y].astype("<u4" if name == "samples" else "<f4").tobytes() for name in names))
