#!/usr/bin/env python3
"""Renders the figures of the thesis that vkvol grew out of (scenes/thesis) into one contact sheet, checks what they must
show, and prints the report's timings beside ours. scenes/thesis/README.md says what of the figures is known.
    tools/thesis_figures.py [--volumes DIR] [--spp-scale X] [--size N] [--out DIR] [--only 4.5]...
Needs Debian's python3-matplotlib (which brings numpy and PIL). Exit code 1: a render failed, or a figure shows the wrong trend."""
import argparse
import json
import os
import subprocess
import sys
import xml.etree.ElementTree as xml

from thesis_sheet import FIGURES, FIELDS, draw_sheet, middle_luminance, print_tables

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), ".."))
SCENES = os.path.join(ROOT, "scenes", "thesis")


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--volumes", default=os.environ.get("VKVOL_VOLUMES"), metavar="DIR",
                        help="folder of real volumes, in place of those that make_field makes (default: $VKVOL_VOLUMES)")
    parser.add_argument("--spp-scale", type=float, default=1, metavar="X", help="multiplies each figure's samples per pixel")
    parser.add_argument("--size", type=int, default=180, metavar="N", help="pixels along the longer edge of a picture")
    parser.add_argument("--out", default=os.path.join(ROOT, "out", "thesis"), metavar="DIR")
    parser.add_argument("--only", action="append", metavar="FIG", help="this figure alone, as 4.5; may be given again")
    parser.add_argument("--build", default=os.path.join(ROOT, "build"), metavar="DIR", help="where vkvol and make_field are")
    chosen = parser.parse_args()
    unknown = set(chosen.only or []) - {f.number for f in FIGURES}
    if unknown:
        parser.error(f"no figure {', '.join(sorted(unknown))}: there are 4.1 to 4.18")
    return chosen


def find_field(name, chosen):
    """(path, the Source it is of) of the first there is: the original or a stand-in among the real volumes, or what make_field makes."""
    *real, made = FIELDS[name]
    for source in real if chosen.volumes else []:
        path = os.path.join(chosen.volumes, source.file)
        if os.path.isfile(path):
            return path, source
    path = os.path.join(ROOT, "density_fields", made.file)
    if not os.path.isfile(path):
        print(f"making {path}", flush=True)
        recipe = os.path.splitext(made.file)[0]
        subprocess.run([os.path.join(chosen.build, "make_field"), recipe, "-o", path], check=True, stdout=subprocess.DEVNULL)
    return path, made


def view_options(figure, path, source, chosen):
    """--size pixels along the longer edge. A stand-in that fills part of the view is rendered in that part."""
    tree = xml.parse(path)
    width, height = (int(tree.findtext(edge)) for edge in ("width", "height"))
    crop = figure.crop if figure.crop and source and not source.original else "0.0,1.0,0.0,1.0"
    x0, x1, y0, y1 = (float(edge) for edge in crop.split(","))
    scale = chosen.size / max(width * (x1 - x0), height * (y1 - y0))
    return ["--width", str(max(1, round(width * scale))), "--height", str(max(1, round(height * scale))), "--crop", crop]


def render(figure, panel, chosen):
    """One panel: its label, the path of its PNG, the report of vkvol, and the field's description, or an error."""
    name = f"{figure.number}-{figure.panels.index(panel) + 1}"
    result = {"figure": figure, "label": panel.label, "name": name, "png": os.path.join(chosen.out, name + ".png"),
              "keys": panel.keys, "field": ""}
    path = os.path.join(SCENES, figure.scene)
    report = os.path.join(chosen.out, name + ".json")
    keys, grid, source = dict(panel.keys), [], None
    try:
        if figure.field:
            file, source = find_field(figure.field, chosen)
            grid, result["field"] = ["--grid", file], source.description
            keys.update({k: v for k, v in source.keys.items() if "${" + k in open(path).read()})
        command = [os.path.join(chosen.build, "vkvol"), path, "-q", "--tonemap", "srgb", "-o", result["png"], "--report",
                   report, "--spp", str(max(1, round(figure.spp * chosen.spp_scale)))]
        command += grid + view_options(figure, path, source, chosen)
        for key, value in keys.items():
            command += ["-D", f"{key}={value}"]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            result["error"] = (done.stderr or done.stdout).strip() or f"exit code {done.returncode}"
        else:
            result["report"] = json.load(open(report))
    except (OSError, ValueError, subprocess.SubprocessError) as error:
        result["error"] = str(error)
    return result


def trend_failures(results):
    """Figures whose panels must get darker or brighter one by one, in the middle of the picture, and do not."""
    failures = []
    for figure in FIGURES:
        panels = [r for r in results if r["figure"] is figure and "error" not in r]
        if not figure.trend or len(panels) != len(figure.panels):
            continue
        means = [middle_luminance(r["png"]) for r in panels]
        steps = [b - a for a, b in zip(means, means[1:])]
        holds = all(s < 0 for s in steps) if figure.trend == "darker" else all(s > 0 for s in steps)
        print(f"figure {figure.number} gets {figure.trend}: {', '.join('%.3f' % m for m in means)}"
              + ("" if holds else "  WRONG"))
        if not holds:
            failures.append(f"figure {figure.number} does not get {figure.trend}")
    return failures


def main():
    chosen = options()
    os.makedirs(chosen.out, exist_ok=True)
    results = []
    for figure in FIGURES:
        if chosen.only and figure.number not in chosen.only:
            continue
        for panel in figure.panels:
            result = render(figure, panel, chosen)
            results.append(result)
            what = "FAILED" if "error" in result else "%.2f s" % result["report"]["seconds"]["render"]
            print(f"{figure.number:5} {figure.title}{', ' + panel.label if panel.label else ''}: {what}", flush=True)
    rendered = [r for r in results if "error" not in r]
    if rendered:
        sheet = os.path.join(chosen.out, "sheet.png")
        draw_sheet(rendered, sheet)
        print_tables(rendered)
        print(f"\nThe sheet is {sheet}")
    failures = [f"{r['name']}: {r['error']}" for r in results if "error" in r] + trend_failures(rendered)
    for failure in failures:
        print(failure, file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
