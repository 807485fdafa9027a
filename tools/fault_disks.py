"""Faults of file systems: full, read-only, gone. tools/faults.py says what becomes of them."""

import os
import random
import signal
import subprocess
import threading
import time

from fault_runs import Place, Run, with_layer

PAGE = 4096  # what a file system in memory gives out


class Disk:
    """A small file system in memory. Nobody outside sees it."""

    def __init__(self, lab, bytes_):
        self.path = lab.place("disk")
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={bytes_}", "none", self.path], check=True)

    def leave(self, free):
        """Fills it up to so many bytes."""
        state = os.statvfs(self.path)
        filler = self.path / "filler"
        with open(filler, "wb") as file:
            file.write(bytes(max(0, state.f_bavail * state.f_frsize - free)))

    def read_only(self):
        subprocess.run(["mount", "-o", "remount,ro", self.path], check=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        subprocess.run(["umount", "-l", self.path], check=False)


def free_sizes(need, quick):
    pages = (need + PAGE - 1) // PAGE
    if quick:
        return [0, pages // 2 * PAGE, (pages - 1) * PAGE, (pages + 8) * PAGE]
    parts = [pages * i // 10 * PAGE for i in range(10)]
    return sorted({0, PAGE, *parts, *(max(0, pages + i) * PAGE for i in range(-4, 9))})


class DiskRuns:
    """Each method makes one run, and judges it."""

    def __init__(self, lab):
        self.lab = lab
        self.whole_exr, self.whole_png = lab.whole, lab.whole.with_suffix(".png")

    def rescued(self, run):
        kept = run.text.rpartition("kept as ")[2].strip()
        if "kept as " not in run.text or not self.lab.same(kept):
            run.lose(f"no whole picture is rescued: {run.text[-300:]}")
        return run

    def picture(self, extension, free, rescue=True):
        lab = self.lab
        with Disk(lab, 8 << 20) as disk:
            place = Place(lab, "full", directory=disk.path, pictures=[f"a.{extension}"])
            place.known.add("filler")
            disk.leave(free)
            env = {} if rescue else {"TMPDIR": str(disk.path)}
            run = Run(lab, "full", [*lab.render, *place.outputs], env).go().expect(0, 1)
            if run.code == 0:
                return place.judge(run, "same")
            place.judge(run.expect_message(place.pictures[0], "No space left"), "unchanged")
            if not rescue and "kept as" in run.text:
                run.lose("the rescue is a tale")
            return self.rescued(run) if rescue else run

    def beside(self, free):
        """The PNG has room, the EXR does not."""
        lab = self.lab
        with Disk(lab, 8 << 20) as disk:
            place = Place(lab, "full", directory=disk.path, pictures=["a.exr"])
            place.known.add("filler")
            disk.leave(free)
            good = Place(lab, "good", pictures=["a.png"])
            run = Run(lab, "full", [*lab.render, *place.outputs, *good.outputs]).go().expect(1)
            self.rescued(run.expect_message(place.pictures[0]))
            place.judge(run, "unchanged")
            return good.judge(run, "same")

    def report(self, free):
        lab = self.lab
        with Disk(lab, 1 << 20) as disk:
            file = disk.path / "report.json"
            file.write_text("old")
            disk.leave(free)
            place = Place(lab, "report")
            run = Run(lab, "report", [*lab.render, *place.outputs, "--report", file]).go().expect(1).expect_message(file)
            if file.read_text() != "old":
                run.lose("the old report is lost")
            return place.judge(run, "same")

    def checkpoint(self, free):
        """The first picture fits; a checkpoint, which is larger, does not, or not a second one beside the first."""
        lab = self.lab
        with Disk(lab, 8 << 20) as disk:
            place = Place(lab, "full", directory=disk.path, pictures=["a.png"])
            place.known.add("filler")
            disk.leave(self.whole_png.stat().st_size + free)
            good = Place(lab, "good", pictures=["a.exr"])
            run = Run(lab, "full", [*lab.render, *place.outputs, *good.outputs, "--checkpoint", "0.01s"]).go().expect(0)
            if "the last checkpoint stays" not in run.text and "there is no checkpoint yet" not in run.text:
                run.lose("no warning")
            place.judge(run, "same")
            return good.judge(run, "same")

    def second_checkpoint(self, seed):
        lab = self.lab
        with Disk(lab, 16 << 20) as disk:
            place = Place(lab, "full", directory=disk.path, pictures=["a.png"])
            place.known.add("filler")
            disk.leave(64 * lab.pixels * 5 // 4)
            moment = lab.seconds * random.Random(seed).uniform(0.7, 1.0)
            run = Run(lab, "full", [*lab.render, *place.outputs, *lab.checkpoints],
                      signals=[(moment, signal.SIGKILL)]).go().expect(0, -signal.SIGKILL)
            (disk.path / "filler").unlink()
            # A late moment may lie between the picture's writing and the end of the process.
            place.judge(run, *(["unchanged", "same"] if run.code else ["same"]), strays=True)
            return place.resume(run)

    def cache(self, how):
        """`how`: read-only, or so many bytes free."""
        lab = self.lab
        with Disk(lab, 4 << 20) as disk:
            if how == "read-only":
                disk.read_only()
            else:
                disk.leave(int(how))
            place = Place(lab, "cache")
            env = with_layer(lab, XDG_CACHE_HOME=str(disk.path), VKVOL_FAULT_CACHE_BYTES="1000000")
            run = Run(lab, "cache", [*lab.render, *place.outputs], env).go().expect(0)
            for file in (disk.path / "vkvol").rglob("*.*"):
                whole = lab.work / "cache" / "vkvol" / "kernels" / file.name  # of the runs before
                is_whole = file.read_bytes() == whole.read_bytes() if whole.exists() else file.suffix == ".bin" and file.stat().st_size > 1000000
                if not is_whole:
                    run.lose(f"half a cache: {file.name}, {file.stat().st_size} bytes")
            return place.judge(run, "same")

    def read_only_place(self):
        lab = self.lab
        with Disk(lab, 1 << 20) as disk:
            place = Place(lab, "ro", directory=disk.path)
            disk.read_only()
            run = Run(lab, "ro", [*lab.render, *place.outputs]).go().expect(2).expect_message(place.pictures[0])
            return place.judge(run, "unchanged")

    def vanish(self):
        lab = self.lab
        place = Place(lab, "vanish")
        gone = place.directory.with_name(place.directory.name + "-gone")

        def move_away():  # at the first of some checkpoints: then it renders, on any machine
            end = time.monotonic() + 60
            while not place.checkpoint.exists() and time.monotonic() < end:
                time.sleep(0.002)
            place.directory.rename(gone)

        thief = threading.Thread(target=move_away)
        thief.start()
        run = Run(lab, "vanish", [*lab.render, *place.outputs, "--checkpoint", "0.01s"]).go().expect(1)
        thief.join()
        place.directory = gone
        place.pictures = [gone / p.name for p in place.pictures]
        return self.rescued(place.judge(run, "unchanged"))


def disk_rows(lab, table, quick):
    runs = DiskRuns(lab)
    for extension, whole in (("exr", runs.whole_exr), ("png", runs.whole_png)):
        sizes = free_sizes(whole.stat().st_size, quick)
        table.row(f"disk full: the {extension.upper()}, an old one there", lambda f, e=extension: runs.picture(e, f), sizes)
    table.row("disk full, and the temporary directory too", lambda f: runs.picture("exr", f, rescue=False), [0, 64 << 10])
    table.row("disk full: the EXR, the PNG elsewhere", runs.beside, [0, 64 << 10])
    table.row("disk full: the report", runs.report, [0])
    table.row("disk full: the checkpoint", runs.checkpoint, [PAGE, 256 << 10])
    table.row("disk full: the second checkpoint, then kill -9", runs.second_checkpoint, range(2 if quick else 8))
    table.row("pipeline cache: disk full or read-only", runs.cache, ["0", str(PAGE), str(64 << 10), str(900 << 10), "2000000", "read-only"])
    table.row("output directory read-only", lambda _: runs.read_only_place(), [0])
    table.row("output directory vanishes during the render", lambda _: runs.vanish(), range(1 if quick else 3))
