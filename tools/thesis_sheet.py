"""What the figures of the thesis are, how their sheet is laid out, and the report's timings. See thesis_figures.py."""
import os
import textwrap
from dataclasses import dataclass, field as new

try:
    import matplotlib
    import numpy
    from PIL import Image
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: apt-get install python3-matplotlib, and run this with /usr/bin/python3")
matplotlib.use("Agg")
import matplotlib.pyplot as pyplot  # after the choice of a backend that needs no display


@dataclass
class Source:
    """A file that can play a field."""
    file: str
    description: str
    original: bool = False
    keys: dict = new(default_factory=dict)


KELVIN = {"temperatureScale": "600", "temperatureOffset": "300"}
FIELDS = {  # best first; the last one make_field makes, under the name that the scenes have for the original
    "bunny": [Source("bunny_cloud.nvdb", "", True),
              Source("bunny_cloud_standin.nvdb", "stand-in: cumulus shaped as a bunny"),
              Source("bunny_cloud.nvdb", "generated cumulus in place of the bunny")],
    "fire": [Source("fire.nvdb", "", True, keys={"temperatureScale": "100", "temperatureOffset": "0"}),
             Source("plume_fire.nvdb", "stand-in: simulated fireball", keys=KELVIN),
             Source("fire.nvdb", "generated fireball in place of the fire", keys=KELVIN)],
}


@dataclass
class Panel:
    label: str
    keys: dict


@dataclass
class Figure:
    number: str
    scene: str
    title: str
    panels: list
    field: str = ""
    spp: int = 4  # light scattered once hardly has noise: these are for edges
    trend: str = ""  # what happens from panel to panel: darker or brighter
    crop: str = ""   # the part of the view that a stand-in fills


def over(key, values, **others):
    return [Panel(f"{key} {value}", {key: value, **others}) for value in values]


SIGMAS = over("sigma_a", ("0.2", "0.4", "0.6", "0.8"))
ASYMMETRIES = over("g", ("0.25", "0", "-0.25", "-0.5"))
DIRECTIONS = [Panel(f"light {name}", {"y": y, "z": z})
              for name, y, z in (("above", "1", "0"), ("below", "-1", "0"), ("in front", "0", "1"), ("behind", "0", "-1"))]
NOISE = [Panel("sigma 0.05 + 0.5", {"sigma_a": "0.05", "sigma_s": "0.5", "octaves": "1"}),
         Panel("sigma 0.2 + 2", {"sigma_a": "0.2", "sigma_s": "2", "octaves": "1"}),
         Panel("sigma 0.2 + 2, four octaves", {"sigma_a": "0.2", "sigma_s": "2", "octaves": "4"})]
ONE = [Panel("", {})]
FLAME = "0.0,1.0,0.5,1.0"


def with_and_without(sun):
    return [Panel("sky alone", {"integrator": "deltaTracking", "sun": "0"}),
            Panel("sky and sun", {"integrator": "ratioTracking", "sun": sun})]


FIGURES = [
    Figure("4.1", "4.01-densitySampling.xml", "densitySampling", SIGMAS, trend="darker"),
    Figure("4.2", "4.02-NEE-absorption.xml", "homogeneousRayMarcherNEE", SIGMAS, trend="darker"),
    Figure("4.3", "4.03-NEE-light.xml", "homogeneousRayMarcherNEE", DIRECTIONS),
    Figure("4.4", "4.04-Improved-above.xml", "RayMarcherImproved, light above", ASYMMETRIES),
    Figure("4.5", "4.05-Improved-behind.xml", "RayMarcherImproved, light behind", ASYMMETRIES, trend="darker"),
    Figure("4.6", "4.06-Improved-front.xml", "RayMarcherImproved, light in front", ASYMMETRIES, trend="brighter"),
    Figure("4.7", "4.07-Perlin.xml", "heterogeneousPerlinNoise", NOISE),
    Figure("4.8", "4.08-nanoVDBSimple-bunny.xml", "nanoVDBSimple", [DIRECTIONS[0], DIRECTIONS[2], DIRECTIONS[3]], "bunny"),
    Figure("4.9", "4.09-nanoVDBEmission-fire.xml", "nanoVDBEmission", ONE, "fire", 16, crop=FLAME),
    Figure("4.10", "4.10-deltaTracking-bunny.xml", "deltaTracking, sky alone", ONE, "bunny", 64),
    Figure("4.11", "4.11-deltaTracking-explosion.xml", "deltaTracking, sky alone", ONE, "fire", 64, crop=FLAME),
    Figure("4.12", "4.12-ratioTracking-bunny.xml", "ratioTracking, sun above", ONE, "bunny", 64),
    Figure("4.13", "4.13-ratioTracking-explosion.xml", "ratioTracking, sun above", ONE, "fire", 64, crop=FLAME),
    Figure("4.14", "4.14-pbrt-bunny.xml", "the view of PBRT's bunny", with_and_without("3"), "bunny", 64),
    Figure("4.15", "4.15-pbrt-explosion.xml", "the view of PBRT's explosion", with_and_without("9"), "fire", 64,
           crop="0.15,0.85,0.45,1.0"),
    Figure("4.16", "4.16-bunny-behind.xml", "ratioTracking, sun behind", ONE, "bunny", 128),
    Figure("4.17", "4.17-bunny-front.xml", "ratioTracking, sun in front", ONE, "bunny", 64),
    Figure("4.18", "4.18-explosion-below.xml", "ratioTracking, sun below", ONE, "fire", 64, crop=FLAME),
]


@dataclass
class Timing:
    """A time of the report. The size and the samples are those of its scene files or pictures; None: not known."""
    what: str
    figure: str
    panel: int  # of ours, from 0; -1: mean of all
    seconds: float
    size: tuple
    spp: int


SPHERE = (640, 640)
TABLES = {
    "Table 4.1, marching": [
        Timing("densitySampling, sphere", "4.1", -1, 0.45, SPHERE, 16),
        Timing("homogeneousRayMarcherNEE, sphere", "4.2", -1, 1.24, SPHERE, 16),
        Timing("homogeneousRayMarcherImproved, sphere", "4.4", -1, 1.8, SPHERE, 16),
        Timing("heterogeneousPerlinNoise, sphere", "4.7", 0, 6.1, SPHERE, 16),
        Timing("nanoVDBSimple, bunny", "4.8", 0, 132, None, 16),
        Timing("nanoVDBEmission, fire", "4.9", 0, 302, None, 256)],
    "Table 4.2, tracking": [
        Timing("deltaTracking, bunny", "4.10", 0, 62, (1080, 1080), 16),
        Timing("ratioTracking, bunny", "4.12", 0, 2182, (1080, 1080), 1),
        Timing("deltaTracking, explosion", "4.11", 0, 226, (540, 1080), 16),
        Timing("ratioTracking, explosion", "4.13", 0, 283, (540, 1080), 16)],
    "Table 4.3, PBRT-v4 (theirs: PBRT)": [
        Timing("simplevolpath, bunny", "4.14", 0, 91, (1920, 1080), 64),
        Timing("volpath, bunny", "4.14", 1, 516, (1920, 1080), 64),
        Timing("simplevolpath, explosion", "4.15", 0, 77, (1300, 1800), 64),
        Timing("volpath, explosion", "4.15", 1, 337, (1300, 1800), 64)],
}


def work(report):
    """Pixels and samples per pixel of one of our renders."""
    x0, x1, y0, y1 = report["picture"]["crop"]
    return (x1 - x0, y1 - y0), report["samplesPerPixel"]["most"]


def row(size, spp, seconds):
    million = size[0] * size[1] * spp * 1e-6 if size else None
    shape = f"{size[0]}x{size[1]}" if size else "?"
    return f"{seconds:8.2f} {shape:>10} {spp:4} " + (f"{seconds / million:9.2f}" if million else f"{'?':>9}")


def print_tables(results):
    device = results[0]["report"]["device"]
    print(f"\nOurs: {device['name']}, {device['driver']}; {os.cpu_count()} processors, load average "
          f"{os.getloadavg()[2]:.1f} over a quarter of an hour. The report's: i7-7700K, 8 threads, Windows 10.\n"
          "Seconds, pixels, samples per pixel, seconds per million samples: theirs, then ours; last, theirs per sample over ours.\n"
          "Sizes and samples of theirs are those of the report's scene files and the repository's pictures, supposed to be what was\n"
          "timed (the bunny's single sample may well not be); ?: not known. Under the same names they did cheaper or dearer things\n"
          "than we do (scenes/README.md), so this compares pictures of one subject, not implementations of one algorithm.")
    for title, timings in TABLES.items():
        print(f"\n{title}")
        for timing in timings:
            print_timing(timing, [r["report"] for r in results if r["figure"].number == timing.figure])
    print("\nSeconds of every figure (sum of its panels, rendering alone)")
    for figure in FIGURES:
        times = [r["report"]["seconds"]["render"] for r in results if r["figure"] is figure]
        if times:
            print(f"  {figure.number:5} {figure.title:50} {sum(times):8.2f} in {len(times)}")


def print_timing(timing, reports):
    theirs = row(timing.size, timing.spp, timing.seconds)
    chosen = reports if timing.panel < 0 else reports[timing.panel:timing.panel + 1]
    if not chosen:
        print(f"  {timing.what:40} {theirs}   not rendered")
        return
    size, spp = work(chosen[0])
    seconds = sum(r["seconds"]["render"] for r in chosen) / len(chosen)
    ours = row(size, spp, seconds)
    faster = "?"
    if timing.size:
        per_sample = timing.seconds / (timing.size[0] * timing.size[1] * timing.spp)
        faster = "%.3g" % (per_sample / (seconds / (size[0] * size[1] * spp)))
    print(f"  {timing.what:40} {theirs}   {ours} {faster:>8}")


def middle_luminance(path):
    """Mean linear luminance (Rec. 709) over the middle third of the picture, which lies inside the sphere."""
    pixels = numpy.asarray(Image.open(path).convert("RGB"), dtype=float) / 255
    height, width, _ = pixels.shape
    pixels = pixels[height // 3:-(height // 3), width // 3:-(width // 3)]
    linear = numpy.where(pixels <= 0.04045, pixels / 12.92, ((pixels + 0.055) / 1.055) ** 2.4)
    return float((linear @ [0.2126, 0.7152, 0.0722]).mean())


def draw_sheet(results, path, columns=8):
    rows = -(-len(results) // columns)
    figure, axes = pyplot.subplots(rows, columns, figsize=(1.75 * columns, 2.3 * rows), squeeze=False)
    for axis in axes.flat:
        axis.axis("off")
    for axis, result in zip(axes.flat, results):
        axis.imshow(Image.open(result["png"]), interpolation="nearest")
        lines = [f"{result['figure'].number} {result['figure'].title}", result["label"], result["field"],
                 "%.2f s" % result["report"]["seconds"]["render"]]
        text = "\n".join(part for line in lines if line for part in textwrap.wrap(line, 38))
        axis.text(0.5, -0.03, text, transform=axis.transAxes, ha="center", va="top", fontsize=5.5)
    figure.subplots_adjust(left=0.01, right=0.99, top=0.99, bottom=0.2 / rows, wspace=0.05, hspace=0.3)
    figure.savefig(path, dpi=120)
    pyplot.close(figure)
