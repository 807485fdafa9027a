"""Measures renderers against each other: one scene, one reference, rounds in rotating order, efficiency with intervals.

A renderer has name(), warm_up(), render(samples, seed) -> picture, seconds, busy cores; set_up() -> seconds by
phase; details() -> further keys of its entry. The first one is what the others are compared with."""
import datetime
import json
import math
import os
import pathlib
import platform
import statistics
import subprocess
import sys

import numpy as np

import exr

EPSILON = 0.01  # in relMSE, as `vkvol compare` has it
CONFIDENCE = 0.95
FEWEST_PASSES, MOST_PASSES = 8, 32  # independent renders that give a peer's picture its variance
REFERENCE_FACTOR = 16  # samples of the reference to those of a measured render
SHORTEST = 0.25  # seconds that a render must take before its rate is believed
NEAR = 1.2  # times the wanted seconds, or over it: near enough. Short renders have other rates than long ones
MOST_TRIES = 5
LIKE = 1.5  # times the seconds of the quickest renderer: beyond, what each costs before it begins is in the figures


def add_options(parser):
    parser.add_argument("--time", default="60s", help="budget of the measured renders: 30s, 5m, or seconds (default 60s); "
                                                      "the reference and the test of agreement take about twice that more")
    parser.add_argument("--rounds", type=int, default=5, help="renders of each renderer, at least 5 (default 5)")
    parser.add_argument("--reference", type=pathlib.Path, help="a picture by vkvol, of this scene and size, with another "
                                                               "seed (default: rendered, and kept as NAME.reference.exr)")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("-o", dest="name", help="NAME of the files that are written (default: the scene's)")


def seconds_of(text):
    factor = {"s": 1, "m": 60, "h": 3600}.get(text[-1:], None)
    try:
        return float(text[:-1]) * factor if factor else float(text)
    except ValueError:
        return sys.exit(f"--time {text}: expected seconds, or a number with s, m or h")


def t_quantile(p, freedom):
    """Of Student's t. With t = sqrt(freedom) tan(theta) its density is a power of the cosine; 2e5 steps give five
    digits."""
    theta = np.linspace(-math.pi / 2, math.pi / 2, 200001)
    cumulative = np.cumsum(np.abs(np.cos(theta)) ** (freedom - 1))
    return math.sqrt(freedom) * math.tan(np.interp(p, cumulative / cumulative[-1], theta))


def interval(logs, confidence=CONFIDENCE):
    """Geometric mean of positive figures from their logarithms, and its interval of confidence."""
    mean = statistics.fmean(logs)
    half = t_quantile((1 + confidence) / 2, len(logs) - 1) * statistics.stdev(logs) / math.sqrt(len(logs))
    return {"value": math.exp(mean), "low": math.exp(mean - half), "high": math.exp(mean + half)}


def relative_mse(image, reference, variance):
    return float(np.mean(((image - reference) ** 2 - variance) / (reference ** 2 + EPSILON)))


def mean_agreement(image, reference, variance=None):
    """Ratio of the picture means and how many standard errors lie between them. Where the variance of the difference is
    unknown its squares stand for it: their expectation is the same if the pictures are."""
    difference = image - reference
    squares = variance if variance is not None else difference ** 2
    error = np.sqrt(squares.sum(axis=(0, 1)))
    z = np.divide(difference.sum(axis=(0, 1)), error, out=np.zeros(3), where=error > 0)
    return {"meanRatio": list(image.sum(axis=(0, 1)) / reference.sum(axis=(0, 1))), "z": list(z)}


class Measured:
    """What a renderer did."""

    def __init__(self, renderer):
        self.renderer, self.samples = renderer, 1
        self.errors, self.seconds, self.cores = [], [], []
        self.agreement = None

    def calibrate(self, target, seed):
        """Finds the number of samples that take `target` seconds. Returns the seconds that it does take."""
        self.renderer.warm_up()
        self.renderer.render(self.samples, seed)  # the first with caches may have to fill them
        while True:
            _, seconds, _ = self.renderer.render(self.samples, seed)
            if seconds >= min(SHORTEST, target / 2) or self.samples >= 1 << 20:
                break
            self.samples *= 2
        for _ in range(MOST_TRIES):
            self.samples = max(1, round(self.samples * target / seconds))
            _, seconds, _ = self.renderer.render(self.samples, seed)  # some compile another kernel than for powers of two
            if self.samples == 1 or target / NEAR < seconds < target * NEAR:
                break
        return seconds

    def render(self, seed, reference, variance):
        image, seconds, cores = self.renderer.render(self.samples, seed)
        if image.shape != reference.shape:
            sys.exit(f"{self.renderer.name()} made {image.shape[1]}x{image.shape[0]} pixels, the reference has "
                     f"{reference.shape[1]}x{reference.shape[0]}; render both at the same size")
        self.errors.append(relative_mse(image, reference, variance))
        self.seconds.append(seconds)
        self.cores.append(cores)

    def log_efficiencies(self):
        if min(self.errors) <= 0:
            sys.exit(f"{self.renderer.name()}: its error is below the reference's noise; give more --time, or a "
                     "--reference with more samples")
        return [-math.log(error * seconds) for error, seconds in zip(self.errors, self.seconds)]

    def entry(self, pixels):
        error, runs = statistics.fmean(self.errors), len(self.errors)
        seconds = statistics.median(self.seconds)
        point = {"samples": self.samples, "runs": runs, "seconds": seconds, "secondsLow": min(self.seconds),
                 "secondsHigh": max(self.seconds), "relMse": error,
                 "relMseError": statistics.stdev(self.errors) / math.sqrt(runs), "relMseFromVariance": None}
        efficiency = interval(self.log_efficiencies())
        entry = {"renderer": self.renderer.name(), "isDefault": True, "biased": "",
                 "setupSeconds": self.renderer.set_up(), "points": [point], "slope": None, "biasFloor": None,
                 "efficiency": efficiency,
                 "perPath": None, "laneUse": {}, "passSeconds": None,
                 "samplesPerSecond": self.samples * pixels / seconds, "busyCores": statistics.median(self.cores),
                 "image": None, "agreement": self.agreement}
        return {**entry, **self.renderer.details()}


def check_times(seconds):
    """Of one render by each renderer."""
    if max(seconds.values()) > LIKE * min(seconds.values()):
        sys.exit("renders are too unlike to be compared, in seconds: "
                 + ", ".join(f"{name} {value:.2f}" for name, value in seconds.items())
                 + "; give more --time, or fewer pixels, and nothing else to do to the machine")


class Contest:
    def __init__(self, options, renderers):
        if options.rounds < 5:
            sys.exit("--rounds: at least 5 are needed for an interval of confidence")
        self.options, self.measured = options, [Measured(renderer) for renderer in renderers]
        self.name = options.name or options.scene.stem
        self.budget = seconds_of(options.time)
        self.seed = options.seed * 1000 + 1  # seeds that no two renders share
        self.load = [os.getloadavg()[0]]

    def next_seed(self):
        self.seed += 1
        return self.seed

    def run(self):
        target = self.budget / (self.options.rounds * len(self.measured))
        seconds = {}
        for measured in self.measured:
            name = measured.renderer.name()
            seconds[name] = measured.calibrate(target, self.next_seed())
            self.say(f"{name}: {measured.samples} samples a pixel take {seconds[name]:.1f} s")
        check_times(seconds)
        self.make_reference()
        for turn in range(self.options.rounds):
            first = turn % len(self.measured)
            for measured in self.measured[first:] + self.measured[:first]:
                measured.render(self.next_seed(), self.reference, self.variance)
            self.say(f"round {turn + 1} of {self.options.rounds} is done")
        for measured in self.measured[1:]:
            self.test_agreement(measured)
        self.load.append(os.getloadavg()[0])

    @staticmethod
    def say(text):
        print(text, file=sys.stderr, flush=True)

    def make_reference(self):
        ours = self.measured[0]
        self.reference_file, samples, seconds = self.options.reference, None, None
        seed = self.next_seed()  # whoever made it: else the first render may be a part of it
        if self.reference_file is None:
            self.reference_file, samples = pathlib.Path(self.name + ".reference.exr"), REFERENCE_FACTOR * ours.samples
            report = ours.renderer.run(samples, seed, self.reference_file)
            seconds = report["seconds"]["render"]
            self.say(f"reference: {samples} samples a pixel by {ours.renderer.name()} in {seconds:.1f} s")
        self.reference, self.variance, counts = exr.read_rgb(self.reference_file)
        if self.variance is None:
            sys.exit(f"{self.reference_file}: has no variance; render the reference with vkvol")
        self.reference_entry = {
            "file": str(self.reference_file), "integrator": ours.renderer.first["integrator"],
            "samples": int(samples or counts.max()), "seconds": seconds, "cached": self.options.reference is not None,
            "relMse": relative_mse(self.reference, self.reference, -self.variance)}

    def test_agreement(self, measured):
        """The peer's picture with variance from independent passes, against the reference, by vkvol's own test."""
        wanted = 2 * measured.samples
        samples = max(1, wanted // MOST_PASSES)
        count = min(MOST_PASSES, max(FEWEST_PASSES, wanted // samples))
        passes = np.stack([measured.renderer.render(samples, self.next_seed())[0] for _ in range(count)])
        mean, variance = passes.mean(axis=0), passes.var(axis=0, ddof=1) / count
        path = f"{self.name}.{self.measured.index(measured)}.exr"
        exr.write(path, mean, variance, samples * count, passes=count)
        command = [self.options.vkvol.resolve(), "compare", path, self.reference_file, "--json", "--significance", "0.001"]
        done = subprocess.run(command, capture_output=True, text=True)
        verdict = json.loads(done.stdout) if done.stdout else sys.exit(done.stderr)
        measured.agreement = dict(mean_agreement(mean, self.reference, variance + self.variance),
                                  same=not verdict["different"], reason=verdict["reason"], image=path)

    def report(self):
        height, width, _ = self.reference.shape
        entries = [measured.entry(width * height) for measured in self.measured]
        ours = self.measured[0].log_efficiencies()
        ranking = [{"renderer": measured.renderer.name(),
                    # Of the same round, so that what disturbs the machine for long disturbs both.
                    "efficiencyRatioToDefault": interval([a - b for a, b in zip(measured.log_efficiencies(), ours)])}
                   for measured in self.measured]
        first = self.measured[0].renderer.first
        return {"format": "vkvol-peer", "version": 1, "scene": str(self.options.scene), "sceneHash": first["sceneHash"],
                "command": " ".join(sys.argv), "program": f"vkvol {first['version']}",
                "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
                "device": {"name": first["device"]["name"], "driver": first["device"]["driver"],
                           "api": first["device"]["vulkan"]},
                "machine": {"processor": processor(), "cores": os.cpu_count(), "threads": self.options.threads,
                            "load": self.load},
                "image": {"width": width, "height": height}, "budgetSeconds": self.budget, "seed": self.options.seed,
                "reference": self.reference_entry, "estimators": entries, "ranking": ranking,
                "agreement": entries[-1]["agreement"]}

    def finish(self):
        report = self.report()
        path = pathlib.Path(self.name + ".peer.json")
        path.write_text(json.dumps(report, indent=2) + "\n")
        print_table(report)
        print(f"\nwritten: {path}")
        return 0 if all(e["agreement"] is None or e["agreement"]["same"] for e in report["estimators"]) else 4


def processor():
    try:
        lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
        return next(line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor()


def figures(value):
    if value["low"] is None:
        return f"{value['value']:.3g}"
    return f"{value['value']:.3g} [{value['low']:.3g}, {value['high']:.3g}]"


def set_up_text(seconds):
    cold = seconds["coldPipeline"]
    warm = [s for phase, s in seconds.items() if phase != "coldPipeline" and s is not None]
    return f"{sum(warm):.2f}" + (f" ({cold:.2f})" if cold is not None else "") if warm else "-"


def error_text(point):
    spread = point["relMseError"]
    return f"{point['relMse']:.3g}" + (f" +- {spread:.1g}" if spread is not None else "")


def print_table(report):
    image, machine = report["image"], report["machine"]
    reference, load = report["reference"], machine["load"]
    print(f"\n{report['scene']}, {image['width']}x{image['height']}; {report['device']['name']}; {machine['processor']}, "
          f"{machine['threads']} threads, load {load[0]:.1f} to {load[-1]:.1f}\n"
          f"reference: {reference['samples']} samples by vkvol, its own relMSE {reference['relMse']:.2g}\n")
    rows = [("renderer", "samples", "seconds", "cores", "samples/s", "relMSE", "1/(relMSE s)", "ratio to vkvol",
             "set-up s (cold)")]
    for entry, rank in zip(report["estimators"], report["ranking"]):
        point = entry["points"][0]
        cores = entry.get("busyCores")
        rows.append((entry["renderer"], str(point["samples"]), f"{point['seconds']:.2f}",
                     "-" if cores is None else f"{cores:.1f}",
                     f"{entry['samplesPerSecond']:.3g}", error_text(point),
                     figures(entry["efficiency"]), figures(rank["efficiencyRatioToDefault"]),
                     set_up_text(entry["setupSeconds"])))
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        print("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip())
    print("\nseconds: median of rendering alone; relMSE: mean over rounds and its standard error; [95 % intervals];\n"
          "set-up: loading, upload, kernels from caches (kernels without any cache)")
    for entry in report["estimators"]:
        if entry["agreement"]:
            print_agreement(entry["renderer"], entry["agreement"])


def print_agreement(name, agreement):
    ratio, z = (" ".join(f"{v:.{digits}f}" for v in agreement[key]) for key, digits in (("meanRatio", 5), ("z", 2)))
    verdict = "SAME" if agreement["same"] else "DIFFERENT"
    print(f"{name}: mean / reference's {ratio}; z {z}; {verdict}: {agreement['reason']}")
