#!/usr/bin/env python3
"""Renders density files as `vkvol FILE` does by itself, or scenes, and lays the pictures out on one sheet.

    tools/volume_sheet.py smoke.nvdb fire.vdb ... -o sheet.png [--vkvol build/vkvol] [-- options of vkvol]

Below each picture stands what vkvol assumed; of a file that has nothing to render, what it said."""
import argparse
import pathlib
import subprocess
import sys
import tempfile
import textwrap

try:
    import matplotlib
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: apt-get install python3-matplotlib, and run this with /usr/bin/python3")
matplotlib.use("Agg")
import matplotlib.pyplot as pyplot  # after the choice of a backend that needs no display

ROOT = pathlib.Path(__file__).resolve().parent.parent


def render(vkvol, file, options, folder):
    """The picture, or None, and what was said about it."""
    picture = pathlib.Path(tempfile.mkdtemp(dir=folder)) / (file.name + ".png") # of files of one name each has its own
    run = subprocess.run([vkvol, file, "-o", picture, "--progress", "none", *options], capture_output=True, text=True)
    said = run.stdout.strip() if run.returncode == 0 else run.stderr.strip()
    print(said, flush=True)
    # Of the lines, the assumptions, without the folders that files are in; and how long it took.
    said = said.replace(str(file), file.name).replace(f"{picture}: ", "").split("; scene: ")[0]
    if run.returncode == 0 and file.suffix == ".xml":
        said = file.stem + ": " + said.split(", on ")[0].replace(str(picture), "")
    elif run.returncode == 0:
        said += run.stdout.strip().split("\n")[-1].replace(str(picture), "").split(", on ")[0]
    return (picture if picture.exists() else None), said.removeprefix("vkvol: error: ")


def draw(results, path, columns):
    rows = -(-len(results) // columns)
    figure, axes = pyplot.subplots(rows, columns, figsize=(3.1 * columns, 2.75 * rows), squeeze=False)
    for axis in axes.flat:
        axis.axis("off")
    for axis, (picture, said) in zip(axes.flat, results):
        text = "\n".join(textwrap.wrap(said, 62))
        if picture:
            axis.imshow(pyplot.imread(picture), interpolation="antialiased")
            axis.text(0.5, -0.03, text, transform=axis.transAxes, ha="center", va="top", fontsize=6)
        else:
            axis.text(0.5, 0.5, text, transform=axis.transAxes, ha="center", va="center", fontsize=6)
    figure.subplots_adjust(left=0.01, right=0.99, top=0.995, bottom=0.16 / rows, wspace=0.04, hspace=0.2)
    figure.savefig(path, dpi=90)


def main():
    arguments = sys.argv[1:]
    options = []
    if "--" in arguments:
        at = arguments.index("--")
        arguments, options = arguments[:at], arguments[at + 1:]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=pathlib.Path)
    parser.add_argument("-o", "--output", default="sheet.png", help="[sheet.png]")
    parser.add_argument("--columns", type=int, default=4)
    parser.add_argument("--vkvol", default=ROOT / "build/vkvol")
    chosen = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as folder:
        results = [render(chosen.vkvol, file, options, pathlib.Path(folder)) for file in chosen.files]
        draw(results, chosen.output, chosen.columns)
    return 0 if all(picture for picture, _ in results) else 1


if __name__ == "__main__":
    sys.exit(main())
