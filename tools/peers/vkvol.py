"""Runs vkvol, as one of the renderers of a contest."""
import json
import os
import pathlib
import resource
import subprocess
import sys
import time

import exr

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def add_scene_options(parser):
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("--grid", type=pathlib.Path, help="a .nvdb file in place of the scene's density field")
    parser.add_argument("-D", dest="keys", action="append", default=[], metavar="KEY=VALUE", help="fills $KEY in the scene")
    parser.add_argument("--width", type=int, help="pixels across; the view stays")
    parser.add_argument("--height", type=int, help="pixels down; likewise")


def add_options(parser):
    """Those that say what is rendered, and with which program."""
    add_scene_options(parser)
    parser.add_argument("--vkvol", type=pathlib.Path, default=ROOT / "build/vkvol", help="the program (default build/vkvol)")
    parser.add_argument("--device", help="as for vkvol")
    parser.add_argument("--integrator", help="of vkvol, in place of the scene's")
    parser.add_argument("--threads", type=int, default=os.cpu_count(),
                        help="of renderers on the processor (default: all)")


class Vkvol:
    def __init__(self, options, folder):
        self.program, self.folder = options.vkvol.resolve(), pathlib.Path(folder)
        if not self.program.exists():
            sys.exit(f"{self.program}: no such program; build it, or name it with --vkvol")
        self.arguments = [str(options.scene), "-q"]
        for name in ("device", "integrator", "grid", "width", "height"):
            if getattr(options, name) is not None:
                self.arguments += ["--" + name, str(getattr(options, name))]
        for key in options.keys:
            self.arguments += ["-D", key]
        # Mesa's software driver, where that is the device.
        self.environment = dict(os.environ, LP_NUM_THREADS=str(options.threads))
        self.reports = []
        self.first = None  # report of the first render, without any cache

    def name(self):
        return f"vkvol {self.first['version']} {self.first['integrator']}"

    def run(self, samples, seed, output, arguments=(), environment=None):
        report = self.folder / "report.json"
        command = [str(self.program), *self.arguments, "--spp", str(samples), "--seed", str(seed), "-o", str(output),
                   "--report", str(report), *arguments]
        done = subprocess.run(command, env=environment or self.environment, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{' '.join(command)}: {(done.stderr or done.stdout).strip()}")
        report = json.loads(report.read_text())
        # That paths end at maxDepth is the scene's will, which the peers heed too.
        biases = [bias for bias in report["biased"].split("; ") if bias and not bias.endswith("ended at maxDepth")]
        if biases:
            sys.exit(f"{self.arguments[0]}: {report['integrator']} is biased here: {'; '.join(biases)}; take an unbiased "
                     "integrator with --integrator")
        return report

    def warm_up(self):
        """One sample a pixel, with no cache of kernels."""
        self.first = self.run(1, 0, self.folder / "vkvol.exr", ["--no-cache"],
                              dict(self.environment, MESA_SHADER_CACHE_DISABLE="1"))

    def render(self, samples, seed):
        """Picture, seconds of rendering alone, and how many cores were busy."""
        before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        report = self.run(samples, seed, self.folder / "vkvol.exr")
        wall, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
        busy = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        self.reports.append(report)
        return exr.read_rgb(self.folder / "vkvol.exr")[0], report["seconds"]["render"], busy / wall

    def set_up(self):
        """Seconds with warm caches, and without."""
        def median(phase):
            return sorted(report["seconds"][phase] for report in self.reports)[len(self.reports) // 2]
        warm = {phase: median(phase) for phase in ("load", "upload", "pipeline")}
        return dict(warm, coldPipeline=self.first["seconds"]["pipeline"])

    def details(self):
        """What the contract of `vkvol bench` has beyond what any renderer can tell."""
        report = self.reports[-1]
        counts, paths = report["counts"], report["counts"]["paths"]
        names = {"realCollisions": "realCollisions", "nullCollisions": "nullCollisions", "lookups": "densityLookups",
                 "majorantCells": "majorantCells", "shadowRays": "shadowRays"}
        return {"perPath": {name: counts[key] / paths for name, key in names.items()},
                "passSeconds": report["seconds"]["passes"]}
