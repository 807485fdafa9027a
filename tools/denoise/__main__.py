#!/usr/bin/env python3
"""Removes the noise of a picture of vkvol's by Intel Open Image Denoise, and says what that does to its error.

    python3 tools/denoise smoke.exr                         smoke.denoised.exr
    python3 tools/denoise smoke.exr -o smoke.png            the same, and a picture to look at
    python3 tools/denoise smoke.exr --reference long.exr    and the error before and after
    python3 tools/denoise --self-test

A denoiser guesses: what it returns is biased, and no number of samples tells by how much. The file says so
(vkvol/biased), and keeps the noisy picture and its variance as the layer `noisy`. Layers of the file that tell what is
seen help to guess: render with --aov albedo, or albedo,normal where there are surfaces.

Needs numpy and pyoidn: /usr/bin/python3 -m venv --system-site-packages oidn && oidn/bin/pip install pyoidn; then
oidn/bin/python tools/denoise. Exit code 2: an input is missing or wrong, or pyoidn is not there."""
import argparse
import subprocess
import sys
from pathlib import Path

try:
    import numpy as np
except ModuleNotFoundError:
    print("denoise: error: numpy is missing: apt-get install python3-numpy, and run this with /usr/bin/python3", file=sys.stderr)
    sys.exit(2)

import open_image_denoise
import picture_file
from comparison import comparison_lines
from picture_file import Refusal

ROOT = Path(__file__).resolve().parents[2]
LAYER = "noisy"


def options(arguments):
    parser = argparse.ArgumentParser(prog="denoise", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("noisy", nargs="?", type=Path, metavar="noisy.exr", help="what vkvol wrote")
    parser.add_argument("-o", "--output", action="append", default=[], type=Path, metavar="FILE",
                        help=".exr (default: noisy.denoised.exr, beside the noisy one), .png; may be given several times")
    parser.add_argument("--reference", type=Path, metavar="ref.exr",
                        help="the same picture of many more samples and another --seed, to measure errors by")
    parser.add_argument("--vkvol", type=Path, default=ROOT / "build/vkvol", metavar="PROGRAM",
                        help="draws PNG (default: build/vkvol)")
    parser.add_argument("--self-test", action="store_true", help="test this tool, without vkvol")
    chosen = parser.parse_args(arguments)
    if not chosen.noisy and not chosen.self_test:
        parser.error("name a picture, noisy.exr")
    return chosen


def outputs_of(chosen):
    """(the .exr files, the .png files) to write. There is always an .exr, since only that can say that it is biased."""
    strange = [file for file in chosen.output if file.suffix.lower() not in (".exr", ".png")]
    if strange:
        raise Refusal(f"{strange[0]}: unknown kind of picture; expected .exr or .png")
    images = [file for file in chosen.output if file.suffix.lower() == ".exr"]
    drawings = [file for file in chosen.output if file.suffix.lower() == ".png"]
    images = images or [chosen.noisy.with_suffix(".denoised.exr")]
    for file in [*images, *drawings]:
        if not file.parent.is_dir():
            raise Refusal(f"{file}: the directory {file.parent} does not exist; make it first")
        for what, read in (("noisy picture", chosen.noisy), ("reference", chosen.reference)):
            if read and file.exists() and read.exists() and file.samefile(read):
                raise Refusal(f"{file}: is the {what}, and would be lost; name another place with -o")
    real = [file.resolve() for file in [*images, *drawings]]
    if twice := [file for file in real if real.count(file) > 1]:
        raise Refusal(f"{twice[0]}: is named twice with -o; once is enough")
    if drawings and not chosen.vkvol.is_file():
        raise Refusal(f"{drawings[0]}: {chosen.vkvol} draws PNG and is not there; build it, or name it with --vkvol")
    return images, drawings


def count_bad(values):
    """Pixels of [row, column, channel] with a channel that is not finite."""
    return int((~np.isfinite(values)).any(axis=2).sum())


def color_of(picture, file):
    """[row, column, channel], checked to be a picture that a denoiser can do something with."""
    color = picture.stack()
    if color is None:
        raise Refusal(f"{file}: has channels {', '.join(picture.channels)}; R, G and B are needed")
    if min(picture.shape) < 2:
        raise Refusal(f"{file}: is of {picture.shape[1]}x{picture.shape[0]} pixels; a denoiser needs neighbours, 2x2 at least")
    for name, values in (("colour", color), ("variance", picture.stack("variance."))):
        if values is not None and count_bad(values):
            raise Refusal(f"{file}: the {name} of {count_bad(values)} pixels is not finite; render it again (--strict tells why)")
    return color


def helpers_of(picture, file):
    """(albedo, normal), each [row, column, channel] or None; normals alone are of no use to the library."""
    albedo, normal = picture.stack("albedo."), picture.stack("normal.", "XYZ")
    for name, values in (("albedo", albedo), ("normal", normal)):
        if values is not None and count_bad(values):
            raise Refusal(f"{file}: the layer {name} of {count_bad(values)} pixels is not finite; render it again without it")
    return albedo, normal if albedo is not None else None


def read_noisy(file):
    picture = picture_file.read(file)
    if LAYER + ".R" in picture.channels:
        raise Refusal(f"{file}: is denoised already; give the noisy picture")
    return picture


def used(albedo, normal):
    """In words: "colour, albedo and normal"."""
    names = ["colour", *(name for name, image in (("albedo", albedo), ("normal", normal)) if image is not None)]
    return " and ".join(filter(None, [", ".join(names[:-1]), names[-1]]))


def alpha_of(picture):
    """[row, column], by which the picture is multiplied; or None."""
    return picture.channels.get("A") if picture.number("vkvol/premultiplied") == 1 else None


def denoised_picture(noisy, color, alpha, bias):
    """The file to write: color [row, column, channel] and alpha, if there is one, in place of the noisy ones, which become a
    layer with its variance.

    Its own variance nobody knows. Were the noisy one's kept, `vkvol compare` would take it for that."""
    channels = dict(noisy.channels)
    clean = {letter: color[..., i] for i, letter in enumerate("RGB")} | ({} if alpha is None else {"A": alpha})
    for letter, values in clean.items():
        channels[f"{LAYER}.{letter}"] = noisy.channels[letter]
        channels[letter] = values.astype(noisy.channels[letter].dtype)
        if f"variance.{letter}" in noisy.channels:
            channels[f"variance.{LAYER}.{letter}"] = channels.pop(f"variance.{letter}")
    attributes = {name: value for name, value in noisy.attributes.items() if name != "vkvol/sumVariance"}
    result = picture_file.Picture(attributes, channels)
    result.set_text("vkvol/layers", f"{noisy.text('vkvol/layers')} {LAYER}".strip())
    result.set_text("vkvol/biased", "; ".join(filter(None, [noisy.text("vkvol/biased"), bias])))
    return result


def draw(program, image, file):
    """As vkvol draws it: by the tone curve and exposure that the picture was rendered with."""
    result = subprocess.run([program, "develop", image, "-q", "-o", file], capture_output=True, text=True)
    if result.returncode != 0:
        raise Refusal(f"{file}: not drawn: {' '.join(result.stderr.split())}")


def note(text):
    print(f"denoise: note: {text}", file=sys.stderr)


def tell_doubts(noisy, color, albedo, file):
    """What makes a result less than it could be, though it is one."""
    samples = noisy.channels.get("samples")
    if samples is not None and (samples == 0).any():
        note(f"{file}: {int((samples == 0).sum())} pixels have no sample, and count as black")
    if (color < 0).any():
        note(f"{file}: {int((color < 0).any(axis=2).sum())} pixels are below 0, which the denoiser takes for 0")
    if albedo is None:
        note(f"{file}: has no layer albedo, which often helps: render with --aov albedo, or albedo,normal")


def run(chosen):
    images, drawings = outputs_of(chosen)
    noisy = read_noisy(chosen.noisy)
    color, (albedo, normal) = color_of(noisy, chosen.noisy), helpers_of(noisy, chosen.noisy)
    reference = chosen.reference and picture_file.read(chosen.reference)
    if reference:
        color_of(reference, chosen.reference)
        for window in ("dataWindow", "displayWindow"):
            if reference.attributes[window] != noisy.attributes[window]:
                raise Refusal(f"{chosen.reference}: is not of the size, or the window, of {chosen.noisy}; render the same one")
    result, alpha, version, seconds = open_image_denoise.denoise(color, albedo, normal, alpha_of(noisy))
    by = f"by Open Image Denoise {version} from {used(albedo, normal)}"
    for file in images:
        picture_file.write(file, denoised_picture(noisy, result, alpha, "denoised " + by))
    for file in drawings:
        draw(chosen.vkvol, images[0], file)
    tell_doubts(noisy, color, albedo, chosen.noisy)
    print(f"{', '.join(map(str, [*images, *drawings]))}: {by}, {seconds:.2f} s; biased, as the EXR says")
    if reference:
        for line in comparison_lines(noisy, result.astype(float), reference, seconds):
            print(line)


def main(arguments=None):
    chosen = options(arguments)
    if chosen.self_test:
        import self_test
        return self_test.main()
    try:
        run(chosen)
    except Refusal as refusal:
        print(f"denoise: error: {' '.join(str(refusal).split())}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
