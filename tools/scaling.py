#!/usr/bin/env python3
"""Measures how the time of a render grows with one thing about it at a time, for tools/report --scaling:

    tools/scaling.py [scenes/cumulus.xml] [--series "image size" --series threads] [--runs 5] [-o scaling.json]

Runs alternate between the points of a series, so that a machine's moods meet all of them; medians, with their range.
Seconds are those of rendering alone, without set-up. Exit code 1: a render failed; 2: the arguments are wrong."""
import argparse
import json
import os
import re
import shlex
import statistics
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


class Failure(Exception):
    pass


def run(command, environment=None):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, env={**os.environ, **(environment or {})})
    if done.returncode:
        raise Failure(f"{shlex.join(str(part) for part in command)} ended with code {done.returncode}: {done.stderr.strip()[-500:]}")
    return done.stdout


class Bench:
    """Renders one scene in a folder of its own that is thrown away."""

    def __init__(self, chosen, folder):
        self.chosen, self.folder = chosen, Path(folder)
        self.vkvol, self.make_field = Path(chosen.build) / "vkvol", Path(chosen.build) / "make_field"
        self.scene = Path(chosen.scene).resolve()

    def render(self, options, scene=None, environment=None):
        report = self.folder / "report.json"
        defaults = {"--width": self.chosen.width, "--spp": self.chosen.spp, **options}
        run([self.vkvol, scene or self.scene, *(str(part) for pair in defaults.items() for part in pair), "-o",
             self.folder / "out.exr", "--report", report, "-q"], environment)
        return json.loads(report.read_text())

    def changed_scene(self, name, change):
        """A copy of the scene, with what it names found where the scene would find it."""
        tree = xml.parse(self.scene)
        for node in tree.iter():
            folder = self.scene.parent / node.attrib.pop("baseDir", ".").replace("\\", "/")
            if node.tag in ("densityField", "model", "sky") and (node.text or "").strip():
                node.text = str(folder / node.text.strip().replace("\\", "/"))
            for attribute in ("file", "texture"):
                if node.get(attribute):
                    node.set(attribute, str(folder / node.get(attribute).replace("\\", "/")))
        change(tree.getroot())
        path = self.folder / f"{name}.xml"
        tree.write(path)
        return path


def set_element(root, tag, value):
    node = root.find(tag)
    (xml.SubElement(root, tag) if node is None else node).text = str(value)


def sigmas(root):
    """Of absorption and scattering, with the defaults of the scene's language."""
    for tag in ("sigma_a", "sigma_s"):
        if root.find(tag) is None:
            set_element(root, tag, 0.5)
    return [root.find(tag) for tag in ("sigma_a", "sigma_s")]


def scale_sigma(root, factor):
    for node in sigmas(root):
        for channel in "rgb":
            if node.get(channel):
                node.set(channel, str(float(node.get(channel)) * factor))
        if node.text and node.text.strip():
            node.text = str(float(node.text) * factor)


def optical_depth(bench):
    """(most that a straight way through the scene's grid meets, its unit), or (1, "times the scene's") where it has no grid."""
    root = xml.parse(bench.scene).getroot()
    field, coefficients = root.find("densityField"), sigmas(root)
    if field is None or any(not (node.text or "").strip() for node in coefficients):
        return 1.0, "times the scene's"
    file = bench.scene.parent / field.get("baseDir", ".").replace("\\", "/") / field.text
    unit = coefficients[0].get("unit", "voxel")
    described = run([bench.vkvol, "info", file])
    found = re.search(rf'unit="{unit}"\)?: at most ([0-9.e+-]+), ([0-9.e+-]+), ([0-9.e+-]+)', described)
    if not found:
        return 1.0, "times the scene's"
    return sum(float(node.text) for node in coefficients) * max(map(float, found.groups())), "at most, along an axis"


# Each gives (unit, [(x, how to render that)]); x None: the number of pixels.
def image_size(bench):
    return "pixels", [(None, lambda w=w: bench.render({"--width": w})) for w in (60, 120, 240, 480, 960)]


def samples(bench):
    return "samples", [(n, lambda n=n: bench.render({"--spp": n})) for n in (1, 2, 4, 8, 16, 32)]


def optical_depths(bench):
    depth, unit = optical_depth(bench)

    def point(factor):
        scene = bench.changed_scene(f"sigma{factor}", lambda root: scale_sigma(root, factor))
        return depth * factor, lambda: bench.render({}, scene)
    return unit, [point(4.0**e) for e in range(-4, 3)]


def grid_size(bench):
    def point(size):
        grid = bench.folder / f"grid{size}.nvdb"
        run([bench.make_field, "cumulus", "--size", size, "-o", grid])
        return size, lambda: bench.render({"--grid": grid})
    return "samples along an edge", [point(size) for size in (32, 64, 128, 256)]


def max_depth(bench):
    def point(depth):
        scene = bench.changed_scene(f"depth{depth}", lambda root: set_element(root, "maxDepth", depth))
        return depth, lambda: bench.render({}, scene)
    return "scattering events", [point(2**e) for e in range(8)]


def threads(bench):
    """Of Mesa's software driver; others do not know the variable."""
    most = os.cpu_count() or 1
    counts = sorted({2**e for e in range(most.bit_length())} | {most})
    return "threads", [(n, lambda n=n: bench.render({}, environment={"LP_NUM_THREADS": str(n)})) for n in counts]


SERIES = {"image size": image_size, "samples per pixel": samples, "optical depth": optical_depths, "grid size": grid_size,
          "path length limit": max_depth, "threads": threads}


def measure(name, bench):
    chosen = bench.chosen
    unit, points = SERIES[name](bench)
    seconds, xs, counts = [[] for _ in points], [None] * len(points), [0] * len(points)
    for turn in range(chosen.runs):
        for k in range(len(points)):
            i = (k + turn) % len(points)  # another point goes first each time
            report = points[i][1]()
            picture = report["picture"]
            xs[i] = picture["width"] * picture["height"] if points[i][0] is None else points[i][0]
            counts[i] = report["samplesPerPixel"]["most"]
            seconds[i].append(report["seconds"]["render"])
        print(f"{name}: run {turn + 1} of {chosen.runs}", file=sys.stderr)
    return {"name": name, "unit": unit, "scene": str(chosen.scene), "command": command(chosen, name),
            "points": [{"x": x, "seconds": statistics.median(s), "secondsLow": min(s), "secondsHigh": max(s), "samples": n}
                       for x, s, n in zip(xs, seconds, counts)]}


def command(chosen, name):
    return shlex.join(["tools/scaling.py", str(chosen.scene), "--series", name, "--runs", str(chosen.runs), "--width",
                       str(chosen.width), "--spp", str(chosen.spp)])


def write(output, series):
    temporary = Path(output + ".partial")
    temporary.write_text(json.dumps({"format": "vkvol-scaling", "version": 1, "series": series}, indent=1) + "\n")
    os.replace(temporary, output)


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="?", default=os.path.relpath(ROOT / "scenes" / "cumulus.xml"), help="default: %(default)s")
    parser.add_argument("--series", action="append", choices=list(SERIES), help="this one alone; may be given again")
    parser.add_argument("--runs", type=int, default=5, metavar="N", help="of each point, default %(default)s")
    parser.add_argument("--width", type=int, default=240, metavar="W", help="pixels across where that is not what grows")
    parser.add_argument("--spp", type=int, default=4, metavar="N", help="samples per pixel where that is not what grows")
    parser.add_argument("--build", default=str(ROOT / "build"), metavar="DIR", help="where vkvol and make_field are")
    parser.add_argument("-o", "--output", default="scaling.json", metavar="FILE.json", help="default: %(default)s")
    chosen = parser.parse_args()
    if min(chosen.runs, chosen.width, chosen.spp) < 1:
        parser.error("--runs, --width and --spp must be at least 1")
    if os.path.exists(chosen.scene) and os.path.exists(chosen.output) and os.path.samefile(chosen.scene, chosen.output):
        parser.error(f"{chosen.output} is the scene, and would be lost to the results; give another name with -o")
    if not (Path(chosen.build) / "vkvol").exists():
        parser.error(f"there is no vkvol in {chosen.build}; build it, or say where it is with --build")
    return chosen


def main():
    chosen = options()
    try:
        series = []
        for name in chosen.series or SERIES:
            with tempfile.TemporaryDirectory() as folder:
                series.append(measure(name, Bench(chosen, folder)))
            write(chosen.output, series)  # what is measured is kept, whatever the next brings
    except Failure as error:
        print(f"scaling: {error}", file=sys.stderr)
        return 1
    except OSError as error:
        print(f"scaling: {error.filename or chosen.output}: {error.strerror}; check the scene's name and -o", file=sys.stderr)
        return 2
    except (xml.ParseError, ValueError) as error:
        print(f"scaling: {chosen.scene} cannot be changed: {error}; give a scene of plain numbers, without $keys", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
