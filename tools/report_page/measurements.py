"""What `vkvol bench` and tools/scaling.py measured, as this program holds it."""
from dataclasses import dataclass
from pathlib import Path
from typing import Optional

from .interval import Interval, count, number, quotient
from .json_file import load


@dataclass
class Point:
    """All runs of an estimator with one number of samples."""
    samples: float
    runs: Optional[float]
    seconds: float
    seconds_low: Optional[float]
    seconds_high: Optional[float]
    relmse: Optional[float]
    relmse_error: Optional[float]


def setup_seconds(phases):
    """Before the first sample, in all; None if no phase was measured. What else a file knows of set-up, as of compiling with
    an empty cache, is part of these or beside the matter."""
    own = [phases[name] for name in ("load", "upload", "pipeline") if name in phases]
    return sum(own) if own else None


@dataclass
class Estimator:
    name: str
    same_as: list  # other names of it in this scene
    is_default: bool
    biased: str
    setup: dict
    points: list
    slope: Interval
    floor: Interval
    efficiency: Interval
    judged: bool  # measured long enough to be compared
    seconds_to_one_percent: Optional[float]
    per_path: dict
    lane_use: dict
    passes: dict
    samples_per_second: Optional[float]
    image: str

    @property
    def judged_by_points(self):
        """Whether slope and floor mean something: fewer points lean on the first renders, of which there is one each."""
        return len(self.points) >= 5

    @property
    def longest(self):
        return max(self.points, key=lambda point: point.samples, default=None)


@dataclass
class Bench:
    file: Path
    scene: str
    command: str
    facts: dict  # what a reader wants to know of machine and date, by its label
    cores: Optional[float]
    load: list
    width: float
    height: float
    reference: dict
    estimators: list
    ranking: dict
    interrupted: bool
    seconds_to_judge: Optional[float]  # --time that judges all

    @property
    def name(self):
        return Path(self.scene).stem

    @property
    def default(self):
        return next((e for e in self.estimators if e.is_default), None)

    @property
    def unbiased(self):
        """Those to choose from."""
        return [e for e in self.estimators if not e.biased and e.judged and e.efficiency.known]

    def ratio(self, a, b):
        """Efficiency of a over that of b. The file's own, which knows what runs share, where it has one."""
        unknown = Interval(None)
        if not (a.judged and b.judged):
            return unknown
        if b.is_default and self.ranking.get(a.name, unknown).known:
            return self.ranking[a.name]
        if a.is_default and self.ranking.get(b.name, unknown).known:
            return self.ranking[b.name].inverse()
        return quotient(a.efficiency, b.efficiency)


def read_point(node):
    return Point(node.needed("samples"), node.number("runs"), node.needed("seconds"), node.number("secondsLow"),
                 node.number("secondsHigh"), node.number("relMse"), node.number("relMseError"))


def read_estimator(node):
    efficiency = node.interval("efficiency")
    return Estimator(
        node.text("integrator"), node.get("sameAs", (list,), "a list", None) or [], node.truth("isDefault"), node.text("biased"), node.numbers("setupSeconds"),
        sorted((read_point(p) for p in node.objects("points")), key=lambda p: p.samples), node.interval("slope"),
        node.interval("biasFloor"), efficiency, node.truth("judged", efficiency.bounded),
        node.number("secondsToOnePercent"),
        node.numbers("perPath"), node.numbers("laneUse"), node.numbers("passSeconds"), node.number("samplesPerSecond"),
        node.text("image"))


def read_reference(node):
    return {"file": node.text("file"), "integrator": node.text("integrator"), "samples": node.number("samples"),
            "seconds": node.number("seconds"), "relmse": node.number("relMse")}


def read_facts(root):
    """What a reader wants to know of program, machine and date, by its label."""
    device, machine = root.object("device"), root.object("machine")
    cores, load_average = machine.number("cores"), load_of(machine)
    return {"Program": root.text("program"), "Device": device.text("name"), "Driver": device.text("driver"),
            "Vulkan": device.text("api"), "Processor": machine.text("processor"), "Date": root.text("date"),
            "Scene": root.text("scene"), "Scene hash": root.text("sceneHash"), "Cores": count(cores) if cores else "",
            "Load": "{} before, {} after".format(*map(number, load_average)) if len(load_average) == 2 else ""}


def load_of(machine):
    return [x for x in machine.get("load", (list,), "a list") or [] if isinstance(x, (int, float))]


def read_bench(file):
    root = load(file, "vkvol-bench", "write it anew with vkvol bench")
    machine, image = root.object("machine"), root.object("image")
    bench = Bench(Path(file), root.text("scene"), root.text("command"), read_facts(root), machine.number("cores"), load_of(machine),
                  image.needed("width"), image.needed("height"), read_reference(root.object("reference")),
                  [read_estimator(e) for e in root.objects("estimators")],
                  {e.text("integrator"): e.interval("efficiencyRatioToDefault") for e in root.objects("ranking")},
                  root.truth("interrupted", False), root.number("secondsToJudge", None))
    if not bench.estimators:
        root.fail("estimators", "is empty")
    return bench


@dataclass
class Series:
    """How long renders take as one thing about them grows."""
    name: str
    unit: str
    scene: str
    command: str
    points: list  # (x, seconds, low, high)
    note: str


def read_scaling(file):
    root = load(file, "vkvol-scaling", "write it anew with tools/scaling.py")
    return [Series(node.text("name"), node.text("unit"), node.text("scene"), node.text("command"),
                   sorted((p.needed("x"), p.needed("seconds"), p.number("secondsLow"), p.number("secondsHigh"))
                          for p in node.objects("points")), node.text("note", ""))
            for node in root.objects("series")]
