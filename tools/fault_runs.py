"""Runs vkvol under a fault and judges what it leaves behind. tools/faults.py says which faults."""

import concurrent.futures
import json
import os
import pathlib
import shutil
import signal
import struct
import subprocess
import time
import zlib

LAYER = "VK_LAYER_VKVOL_fault"
MOST_SECONDS = 120  # for one run; a run that takes longer hangs


class Lab:
    """What all runs share: the program, a scene, and the picture that an undisturbed run makes of it.

    That takes least_render seconds or more, without reading and writing: moments within it are to be met."""

    def __init__(self, build, root, work, least_render):
        self.build, self.root, self.work = pathlib.Path(build), pathlib.Path(root), pathlib.Path(work)
        self.vkvol = self.build / "vkvol"
        self.grid = self.work / "cumulus.nvdb"
        subprocess.run([self.build / "make_field", "cumulus", "--output", self.grid], check=True, stdout=subprocess.DEVNULL)
        self.render = [self.root / "scenes" / "cumulus.xml", "--grid", self.grid, "--width", "160", "-q"]
        self.sanitized = b"__asan_init" in self.vkvol.read_bytes()
        self.count = 0
        self.old = {}  # a good picture of long ago, by extension
        old = self.work / "old"
        self.must("old", [*self.render[:3], "--width", "8", "--spp", "1", "-q", "-o", f"{old}.exr", "-o", f"{old}.png"])
        for extension in ("exr", "png"):
            self.old[extension] = pathlib.Path(f"{old}.{extension}").read_bytes()
        self.whole = self.work / "whole.exr"
        self.report = self.work / "whole.json"
        spp = 32  # two first batches of a staged render, at least
        run, report = self.undisturbed(spp)
        while report["seconds"]["render"] < least_render:
            spp *= 2
            run, report = self.undisturbed(spp)
        self.render += ["--spp", str(spp)]
        # Two at a time, as most runs are: it is they whose phases are to be hit.
        twins = concurrent.futures.ThreadPoolExecutor(2)
        runs = [twins.submit(self.must, "twin", [*self.render, "-o", self.work / f"twin{i}.exr", "-o", self.work / f"twin{i}.png"])
                for i in range(2)]
        self.seconds = sum(r.result().seconds for r in runs) / 2
        self.device = f"{report['device']['name']}, {report['device']['driver']}"
        picture = report["picture"]
        self.pixels = picture["width"] * picture["height"]
        self.size = f"{picture['width']}x{picture['height']}, {spp} samples per pixel"
        phases = report["seconds"]
        scale = self.seconds / run.seconds
        end = self.seconds - scale * phases["write"]
        self.phase = {"render": (end - scale * phases["render"], end)}
        self.checkpoints = ["--checkpoint", f"{phases['render'] / 4:.3f}s"]  # a few in each run

    def undisturbed(self, spp):
        """Makes the picture that all others are compared with. Returns the shorter of two runs, as on a device with other
        work one may take any time, and its report."""
        pictures = ["-o", self.whole, "-o", self.whole.with_suffix(".png")]
        runs = []
        for _ in range(2):
            run = self.must("whole", [*self.render, "--spp", str(spp), *pictures, "--report", self.report])
            runs.append((run, json.loads(self.report.read_text())))
        return min(runs, key=lambda pair: pair[1]["seconds"]["render"])

    def render_with(self, option, value):
        """The usual render with one option changed or added."""
        if option not in self.render:
            return [*self.render, option, value]
        at = self.render.index(option) + 1
        return [*self.render[:at], value, *self.render[at + 1 :]]

    def must(self, name, arguments):
        run = Run(self, name, arguments).go()
        if run.code != 0:
            raise SystemExit(f"faults: an undisturbed run failed: {run.text}")
        return run

    def place(self, name):
        """A directory for one run, with an old picture in it."""
        self.count += 1
        place = self.work / f"{self.count:04d}-{name}"
        place.mkdir()
        return place

    def compare(self, a, b):
        """0: the same bits; 4: different; else one of them cannot be read."""
        return subprocess.run([self.vkvol, "compare", a, b, "--max-relmse", "0"], capture_output=True, check=False).returncode

    def same(self, picture):
        return self.state(pathlib.Path(picture)) == "same"

    def state(self, picture):
        """Of an EXR: same, other (whole, but other bits) or half."""
        pixels = picture.exists() and pixels_of(picture.read_bytes())
        if pixels and pixels == pixels_of(self.whole.read_bytes()):
            return "same"  # what a process more would find
        return {0: "same", 4: "other"}.get(self.compare(picture, self.whole), "half")


def with_layer(lab, fault=None, **more):
    """The environment in which the n-th call of a function fails: fault is FUNCTION:N:RESULT."""
    env = {"VK_LAYER_PATH": str(lab.build / "tests" / "fault_layer"), "VK_INSTANCE_LAYERS": LAYER, **more}
    return {**env, "VKVOL_FAULT": fault} if fault else env


def is_whole_png(data):
    """Every chunk there with its checksum, and as many rows as the head says."""
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        return False
    at, pixels, size = 8, b"", None
    while at + 12 <= len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + length]
        if data[at + 8 + length : at + 12 + length] != struct.pack(">I", zlib.crc32(kind + body)):
            return False
        size = struct.unpack(">II", body[:8]) if kind == b"IHDR" else size
        pixels += body if kind == b"IDAT" else b""
        at += 12 + length
        if kind == b"IEND":
            return at == len(data) and len(zlib.decompress(pixels)) == size[1] * (3 * size[0] + 1)
    return False


def pixels_of(exr):
    """What follows an EXR's header, which holds times; nothing if that has no end."""
    at = 8
    while 0 < exr.find(b"\0", at) != at:
        kind = exr.find(b"\0", at) + 1
        size = exr.find(b"\0", kind) + 1
        at = size + 4 + int.from_bytes(exr[size : size + 4], "little")
    return exr[at + 1 :]


def is_pending(process, number):
    """Whether such a signal was sent to a process that has not taken it yet: another is lost."""
    try:
        status = dict(line.split(":", 1) for line in pathlib.Path(f"/proc/{process}/status").read_text().splitlines())
    except OSError:
        return False
    return status["State"].strip()[0] != "Z" and bool(int(status["ShdPnd"], 16) >> (number - 1) & 1)


class Run:
    """One start of the program. `losses` collects what should not have happened."""

    def __init__(self, lab, name, arguments, env=None, signals=(), wrap=(), stdout=subprocess.PIPE, stderr=subprocess.PIPE):
        self.lab, self.name, self.arguments = lab, name, [str(a) for a in arguments]
        if "--grid" in self.arguments and "--schedule" not in self.arguments:  # a render: faults meet both schedules
            self.arguments += ["--schedule", ("fused", "staged")[lab.count % 2]]
        self.env, self.signals, self.wrap = env or {}, signals, list(wrap)
        self.stdout, self.stderr = stdout, stderr
        self.code, self.text, self.seconds, self.losses = None, "", 0.0, []
        self.signalled = 0.0  # when the last signal was sent

    def go(self):
        env = {**os.environ, "XDG_CACHE_HOME": str(self.lab.work / "cache"), "TMPDIR": str(self.lab.work / "rescued"),
               "ASAN_OPTIONS": "detect_leaks=0", **self.env}
        (self.lab.work / "rescued").mkdir(exist_ok=True)
        start = time.monotonic()
        process = subprocess.Popen([*self.wrap, str(self.lab.vkvol), *self.arguments], env=env, stdin=subprocess.DEVNULL,
                                   stdout=self.stdout, stderr=self.stderr)
        for moment, number in self.signals:
            self.wait_for(moment, start, process)
            self.wait_for(lambda n=number: not is_pending(process.pid, n), start, process)
            process.send_signal(number)  # none is sent to a process that has ended
            self.signalled = time.monotonic() - start
        try:
            _, errors = process.communicate(timeout=MOST_SECONDS)
            self.text = (errors or b"").decode(errors="replace").strip()
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            self.losses.append("it hangs")
        self.code, self.seconds = process.returncode, time.monotonic() - start
        return self

    @staticmethod
    def wait_for(moment, start, process):
        """Seconds after the start, or a condition, while the process lasts."""
        if callable(moment):
            while not moment() and process.poll() is None and time.monotonic() < start + MOST_SECONDS:
                time.sleep(0.01)
        else:
            time.sleep(max(0.0, start + moment - time.monotonic()))

    def lose(self, what):
        self.losses.append(what)

    def expect(self, *codes):
        if self.code not in codes:
            self.lose(f"exit code {self.code}: {self.text[-300:]}")
        return self

    def expect_message(self, *words):
        """One line that says what and where."""
        lines = self.text.splitlines()
        if len(lines) != 1 or not lines[0].startswith("vkvol: error: "):
            self.lose(f"not one message: {self.text[-400:]!r}")
        for word in words:
            if str(word) not in self.text:
                self.lose(f"the message does not name {word}: {self.text[-300:]!r}")
        return self


class Place:
    """A directory with the pictures that a render is to make, or has made before."""

    def __init__(self, lab, name, old=True, directory=None, pictures=("a.exr", "a.png")):
        self.lab = lab
        self.directory = directory or lab.place(name)
        self.pictures = [self.directory / p for p in pictures]
        self.old = old
        if old:
            for picture in self.pictures:
                picture.write_bytes(lab.old[picture.suffix[1:]])
        self.outputs = [word for picture in self.pictures for word in ("-o", picture)]
        self.checkpoint = self.pictures[0].with_suffix(".checkpoint")
        self.known = {p.name for p in [*self.pictures, self.checkpoint]}

    def state(self, picture):
        """absent, old, same, other (whole, but other bits) or half"""
        if not picture.exists():
            return "absent"
        data = picture.read_bytes()
        if data == self.lab.old[picture.suffix[1:]]:
            return "old"
        if picture.suffix == ".png":
            whole = self.lab.whole.with_suffix(".png").read_bytes()
            return "same" if data == whole else "other" if is_whole_png(data) else "half"
        return self.lab.state(picture)

    def strays(self):
        return [p for p in self.directory.iterdir() if p.name not in self.known]

    def judge(self, run, *allowed, strays=False):
        """Each picture must be in one of the allowed states; `unchanged` is old or absent, whichever it was."""
        states = {("old" if self.old else "absent") if s == "unchanged" else s for s in allowed}
        for picture in self.pictures:
            state = self.state(picture)
            if state not in states:
                run.lose(f"{picture.name} is {state}")
        if not strays and self.strays():
            run.lose("left behind: " + ", ".join(p.name for p in self.strays()))
        return run

    def resume(self, run, most=1):
        """What is there goes on to the bits of an undisturbed run, and clears up after itself."""
        again = Run(self.lab, run.name, [*self.lab.render, *self.outputs, "--checkpoint", "10s", "--resume"]).go()
        if again.code != 0:
            run.lose(f"does not resume: {again.code} {again.text[-300:]}")
        self.judge(run, "same", strays=True)
        if self.checkpoint.exists():
            run.lose("the checkpoint of a finished render stays")
        return run

    def clear(self):
        shutil.rmtree(self.directory, ignore_errors=True)


class Table:
    """A fault a row."""

    def __init__(self, only):
        self.only, self.runs, self.lost = only, 0, 0
        self.matched = False  # any row's name
        # Half of the time of a short run is reading, on one core.
        self.pool = concurrent.futures.ThreadPoolExecutor(max(1, (os.cpu_count() or 2)))
        print(f"{'fault':<58} {'runs':>5}  {'exit codes':<26} {'losses':>6}  verdict", flush=True)

    def wants(self, name):
        wanted = not self.only or self.only in name
        self.matched = self.matched or wanted
        return wanted

    def row(self, name, job, items):
        """job(item) is one run, judged."""
        if not self.wants(name):
            return []
        runs = list(self.pool.map(job, items))
        codes = {}
        for run in runs:
            codes[run.code] = codes.get(run.code, 0) + 1
        losses = sum(1 for run in runs if run.losses)
        text = " ".join(f"{code_name(c)}x{n}" for c, n in sorted(codes.items()))
        print(f"{name:<58} {len(runs):>5}  {text:<26} {losses:>6}  {'LOST' if losses else 'ok'}", flush=True)
        shown = [f"    {loss}" for run in runs for loss in run.losses][:6]
        for line in shown:
            print(line, flush=True)
        self.runs += len(runs)
        self.lost += losses
        return runs

    def note(self, text):
        print(f"    {text}", flush=True)

    def skip(self, name, why):
        if self.wants(name):
            print(f"{name:<58} {0:>5}  {'-':<26} {'-':>6}  skipped: {why}", flush=True)


def code_name(code):
    return signal.Signals(-code).name if code < 0 else str(code)
