#!/usr/bin/env python3
"""Renders scenes/hard/*.xml on the device and with the scalar reference, and holds each mean against the expected one.

A scene passes if |got - expected| <= bias + rounding + k * standard error in every channel. `bias` is the scene's own,
derived in its comment. `rounding` is 2^-23 of the expected value: pixels are kept in single precision. k is the
quantile of Student's t at which the whole table raises a false alarm with the probability --significance (Sidak's
correction for the number of comparisons). Scenes that say exact="true" have no noise: k is 0.

tools/hard_expected.py, which computes the expected values anew, runs first.
"""
import argparse
import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ET

ROOT = pathlib.Path(__file__).resolve().parent.parent
WAITING = {
    27: "a sun's disc against a directional light, a sky with one bright texel: no scene of it here yet",
    28: "a firefly clamp: there is none, nothing is clipped",
    30: "interfaces and empty boxes nested ten deep: no scene of it here yet",
}
BY_TESTS_ALONE = {
    9: "a point light in fog: [lights], single scattering against quadrature",
    12: "g about 0",
    25: "random numbers at the ends of their range",
    29: "caps are counted",
    31: "overlapping volumes against one with summed densities: [several], halves on top of each other",
    35: "more paths than slots",
    36: "2^25 samples of value 1",
    37: "ranges of samples, windows and merges",
    38: "damaged and foreign files",
    39: "grids beyond a storage buffer",
    40: "a lost device",
}


def t_quantile(p, freedom):
    """Upper quantile of Student's t by the series around the normal's (Abramowitz & Stegun 26.7.5), which is exact to
    1e-6 from 100 degrees of freedom on; below, scenes have too few samples for the normal limit anyway."""
    if freedom < 100:
        sys.exit(f"{freedom} degrees of freedom are too few: give the scene more samples")
    z = statistics.NormalDist().inv_cdf(1 - p)
    g1 = (z ** 3 + z) / 4
    g2 = (5 * z ** 5 + 16 * z ** 3 + 3 * z) / 96
    g3 = (3 * z ** 7 + 19 * z ** 5 + 17 * z ** 3 - 15 * z) / 384
    return z + g1 / freedom + g2 / freedom ** 2 + g3 / freedom ** 3


class Case:
    def __init__(self, path):
        root = ET.parse(path).getroot()
        expected = root.find("expected")
        if expected is None:
            sys.exit(f"{path}: has no <expected mean=\"...\"/>; see scenes/README.md")

        def channels(name):
            values = [float(v) for v in expected.get(name, "0").split()]
            return values * 3 if len(values) == 1 else values

        self.path = path
        self.number = int(path.stem[:2])
        self.mean, self.bias = channels("mean"), channels("bias")
        self.exact = expected.get("exact", "false")[0] in "1tTyY"
        samples = int(root.findtext("rayPerPixelCount", "1"))
        self.freedom = int(root.findtext("width")) * int(root.findtext("height")) * (samples - 1)

    def allowed(self, channel, error, p):
        """How far a mean with that standard error may be off."""
        k = 0 if self.exact else t_quantile(p / 2, self.freedom)
        return self.bias[channel] + 2 ** -23 * self.mean[channel] + k * error


class Renderer:
    def __init__(self, program, seed, arguments):
        self.program, self.seed, self.arguments = program, seed, arguments

    def render(self, path, folder):
        """The report, or the first line of what went wrong."""
        report = pathlib.Path(folder) / "report.json"
        report.unlink(missing_ok=True)
        command = [self.program, path, "--seed", self.seed, "-o", f"{folder}/picture.exr", "--report", report]
        done = subprocess.run([str(word) for word in command + self.arguments], capture_output=True, text=True)
        if done.returncode != 0:
            return None, ((done.stderr or done.stdout).strip().splitlines() or [f"exit code {done.returncode}"])[-1]
        report = json.loads(report.read_text())
        caps = report.get("caps", {})
        for name in ("steps", "nonFiniteSamples", "queueOverflows"):
            if caps.get(name, 0):
                return report, f"{caps[name]} {name}"
        return report, None


def rows_of(case, results, p):
    """Table rows, one for each channel that differs from the first, and whether all is well."""
    verdicts, well = [], True
    for channel in range(3):
        wrong = []
        for name, (report, error) in results.items():
            if error:
                wrong.append(f"{name}: {error}")
                continue
            value, sigma = (report["mean"][key][channel] for key in ("value", "standardError"))
            # A mean that is no number fails too.
            if not abs(value - case.mean[channel]) <= case.allowed(channel, sigma, p):
                wrong.append(f"{name} DIFFERS")
        verdicts.append("; ".join(wrong) or "ok")
        well = well and not wrong
    rows = []
    grey = len(set(case.mean)) == 1 and len(set(verdicts)) == 1
    for channel in range(1 if grey else 3):
        name = case.path.stem + ("" if grey else " " + "rgb"[channel])
        row = f"{case.number:>4}  {name:38} {case.mean[channel]:>13.7g}"
        for report, _ in results.values():
            if report is None:
                row += f" {'-':>13} {'-':>8}"
            else:
                mean = report["mean"]
                row += f" {mean['value'][channel]:>13.7g} {mean['standardError'][channel]:>8.1e}"
        rows.append(f"{row}  {verdicts[channel]}{' (exact)' if case.exact else ''}")
    return rows, well


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="scenes, without folder and .xml (default: all)")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build", help="folder of the programs")
    parser.add_argument("--significance", type=float, default=0.001, help="of the whole table (default 0.001)")
    parser.add_argument("--device", help="which device, as for vkvol")
    options = parser.parse_args()

    if subprocess.run([sys.executable, ROOT / "tools/hard_expected.py"]).returncode != 0:
        return 1
    cases = [Case(path) for path in sorted((ROOT / "scenes/hard").glob("*.xml"), key=lambda path: path.stem)]
    # Each renderer is tested in each channel.
    p = 1 - (1 - options.significance) ** (1 / (6 * len(cases)))
    if unknown := set(options.names) - {case.path.stem for case in cases}:
        parser.error(f"scenes/hard has no {', '.join(sorted(unknown))}")
    cases = [case for case in cases if not options.names or case.path.stem in options.names]
    renderers = {
        "device": Renderer(options.build / "vkvol", 1, ["-q"] + (["--device", options.device] if options.device else [])),
        "reference": Renderer(options.build / "reference_render", 2, []),
    }
    print(f"{'case':>4}  {'scene':38} {'expected':>13} {'device':>13} {'+-':>8} {'reference':>13} {'+-':>8}  verdict")
    start, failed = time.monotonic(), 0
    with tempfile.TemporaryDirectory() as folder:
        for case in cases:
            results = {name: renderer.render(case.path, folder) for name, renderer in renderers.items()}
            rows, well = rows_of(case, results, p)
            print(*rows, sep="\n", flush=True)
            failed += not well
    k = statistics.NormalDist().inv_cdf(1 - p / 2)
    print(f"\n{len(cases)} scenes, {failed} failed, {time.monotonic() - start:.0f} s; +- is one standard error, of which "
          f"{k:.2f} are allowed (significance {options.significance:g} in all)")
    if not options.names:
        print("\nCases that tests alone cover ([hard] unless another is named):",
              *(f"{number:>4}  {what}" for number, what in BY_TESTS_ALONE.items()), sep="\n")
        print("\nCases that wait:", *(f"{number:>4}  {what}" for number, what in WAITING.items()), sep="\n")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
