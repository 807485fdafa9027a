#!/usr/bin/env python3
"""Puts vkvol under faults and prints a table of what became of it. Started by tools/faults.sh, which explains."""

import argparse
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import threading
import time

from fault_disks import disk_rows
from fault_runs import Lab, Place, Run, Table, with_layer

def count_calls(lab):
    counts = lab.work / "counts"
    Run(lab, "counts", [*lab.render, "-o", lab.work / "counts.exr"], with_layer(lab, VKVOL_FAULT_COUNTS=str(counts))).go()
    pairs = (line.split() for line in counts.read_text().splitlines())
    return {name: int(number) for name, number in pairs}


def spread(count, most):
    """Numbers from 1 to count: the first ones, the last, and evenly between."""
    if count <= most:
        return list(range(1, count + 1))
    early = min(4, most // 2)
    rest = most - early
    return sorted({*range(1, early + 1), *(early + (count - early) * (i + 1) // rest for i in range(rest))})


def check_resume(run, place):
    if place.checkpoint.exists() != ("--resume goes on" in run.text):
        run.lose("the message and the checkpoint disagree")
    return place.resume(run)


def device_rows(lab, table, quick):
    calls = count_calls(lab)

    def lose_device(function, n, checkpoint):
        place = Place(lab, "lost", old=n % 2 == 0)
        more = lab.checkpoints if checkpoint else []
        run = Run(lab, "lost", [*lab.render, *place.outputs, *more],
                  with_layer(lab, f"{function}:{n}:VK_ERROR_DEVICE_LOST")).go()
        if run.code == 0:  # a machine with time on its hands needs fewer calls
            return place.judge(run, "same")
        place.judge(run.expect(1).expect_message("VK_ERROR_DEVICE_LOST"), "unchanged")
        return check_resume(run, place) if checkpoint else run

    for function in ("vkQueueSubmit", "vkWaitForFences"):
        numbers = spread(calls[function], 2 if quick else 15)
        for checkpoint in (False, True):
            name = f"device lost in {function}" + (", with checkpoints" if checkpoint else "")
            table.row(name, lambda n, f=function, c=checkpoint: lose_device(f, n, c), numbers)

    def fail(function, n, result, code):
        place = Place(lab, "call", old=n % 2 == 0)
        run = Run(lab, "call", [*lab.render, *place.outputs], with_layer(lab, f"{function}:{n}:{result}")).go()
        if code == 0 or run.code == 0 and n == calls[function]:  # the last call of all may not be needed each time
            return place.judge(run.expect(0), "same")
        return place.judge(run.expect(code).expect_message(result), "unchanged")

    rows = [("vkAllocateMemory", "VK_ERROR_OUT_OF_DEVICE_MEMORY", 1), ("vkCreateBuffer", "VK_ERROR_OUT_OF_HOST_MEMORY", 1),
            ("vkBindBufferMemory", "VK_ERROR_OUT_OF_DEVICE_MEMORY", 1), ("vkMapMemory", "VK_ERROR_MEMORY_MAP_FAILED", 1),
            ("vkCreateComputePipelines", "VK_ERROR_OUT_OF_HOST_MEMORY", 1),
            ("vkCreateShaderModule", "VK_ERROR_OUT_OF_HOST_MEMORY", 1),
            ("vkCreatePipelineCache", "VK_ERROR_OUT_OF_HOST_MEMORY", 0),
            ("vkGetPipelineCacheData", "VK_ERROR_OUT_OF_HOST_MEMORY", 0),
            ("vkCreateDescriptorSetLayout", "VK_ERROR_OUT_OF_HOST_MEMORY", 1),
            ("vkCreatePipelineLayout", "VK_ERROR_OUT_OF_HOST_MEMORY", 1),
            ("vkCreateDescriptorPool", "VK_ERROR_OUT_OF_DEVICE_MEMORY", 1),
            ("vkAllocateDescriptorSets", "VK_ERROR_OUT_OF_POOL_MEMORY", 1),
            ("vkCreateCommandPool", "VK_ERROR_OUT_OF_HOST_MEMORY", 1),
            ("vkAllocateCommandBuffers", "VK_ERROR_OUT_OF_DEVICE_MEMORY", 1),
            ("vkBeginCommandBuffer", "VK_ERROR_OUT_OF_HOST_MEMORY", 1),
            ("vkEndCommandBuffer", "VK_ERROR_OUT_OF_DEVICE_MEMORY", 1), ("vkCreateFence", "VK_ERROR_OUT_OF_HOST_MEMORY", 1),
            ("vkResetFences", "VK_ERROR_OUT_OF_DEVICE_MEMORY", 1),
            ("vkCreateQueryPool", "VK_ERROR_OUT_OF_DEVICE_MEMORY", 1), ("vkCreateDevice", "VK_ERROR_INITIALIZATION_FAILED", 3),
            ("vkCreateInstance", "VK_ERROR_OUT_OF_HOST_MEMORY", 3),
            ("vkEnumeratePhysicalDevices", "VK_ERROR_INITIALIZATION_FAILED", 3)]
    for function, result, code in rows:
        many = function in ("vkBeginCommandBuffer", "vkEndCommandBuffer", "vkResetFences")
        numbers = spread(calls[function], 4 if many else 40)
        if quick:  # one that is needed each time
            numbers = [1 if many else max(1, calls[function] - 1)]
        table.row(f"{function}: {result[len('VK_ERROR_'):].lower().replace('_', ' ')}",
                  lambda n, f=function, r=result, c=code: fail(f, n, r, c), numbers)


def moment(lab, i, rng):
    """A fifth while loading and compiling, two while rendering, one while writing, one anywhere."""
    t = lab.seconds
    begin, end = lab.phase["render"]
    return {0: rng.uniform(0.0, begin), 3: rng.uniform(end - 0.05, t + 0.02), 4: rng.uniform(0.0, 1.1 * t)}.get(
        i % 5, rng.uniform(begin, end))


def signal_rows(lab, table, quick, seed):
    def interrupt(number, i):
        rng = random.Random(f"{seed} {number} {i}")
        checkpoint = i % 2 == 0
        place = Place(lab, "signal", old=i % 4 < 2)
        more = lab.checkpoints if checkpoint else []
        run = Run(lab, "signal", [*lab.render, *place.outputs, *more], signals=[(moment(lab, i, rng), number)]).go()
        return judge_signalled(run, place, number, checkpoint)

    def judge_signalled(run, place, number, checkpoint):
        # Before the program has begun, the signal ends it as it would any other.
        run.expect(0, 130, -number)
        place.judge(run, *{0: ["same"], 130: ["unchanged", "other", "same"]}.get(run.code, ["unchanged"]))
        if checkpoint and run.code != 0:
            place.resume(run)
        place.clear()
        return run

    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        runs = 2 if quick else 10 if number == signal.SIGHUP else 50
        table.row(f"{number.name} at random moments", lambda i, n=number: interrupt(n, i), range(runs))

    def twice(i):
        rng = random.Random(f"{seed} twice {i}")
        first = moment(lab, i, rng)
        second = first + rng.uniform(0.001, 0.05)
        place = Place(lab, "twice", old=i % 4 < 2)
        run = Run(lab, "twice", [*lab.render, *place.outputs, *lab.checkpoints],
                  signals=[(first, signal.SIGINT), (second, signal.SIGINT)]).go()
        others = max(1.0, os.getloadavg()[0] / os.cpu_count())
        if run.seconds > run.signalled + (10.0 if lab.sanitized else 2.0) * others:  # whose shadow of all memory is let go of, too
            run.lose(f"it took {run.seconds - run.signalled:.1f} s to end")
        return judge_signalled(run, place, signal.SIGINT, True)

    table.row("SIGINT twice: ends at once", twice, range(2 if quick else 25))
    kill_rows(lab, table, quick, seed)


def kill_rows(lab, table, quick, seed):
    kills = []

    def kill(i):
        rng = random.Random(f"{seed} kill {i}")
        place = Place(lab, "kill", old=i % 2 == 0)
        arguments = [*lab.render, *place.outputs, *lab.checkpoints, "--resume"]
        losses = []
        for _ in range(1 + i % 4):
            run = Run(lab, "kill", arguments, signals=[(moment(lab, 3 + i % 2 if i % 3 == 0 else 1, rng), signal.SIGKILL)]).go()
            place.judge(run.expect(0, -signal.SIGKILL), "unchanged", "same", strays=True)
            losses += run.losses
            if run.code == 0:
                break
            kills.append(len(place.strays()))
        if run.code != 0:
            run = place.resume(run)
        run.losses = losses + [l for l in run.losses if l not in losses]
        return run

    if table.row("kill -9 at random moments, up to four times, and --resume", kill, range(2 if quick else 20)):
        table.note(f"{len(kills)} kills; temporary files left behind: {sum(kills)}")


def a_checkpoint(lab):
    """Of a render that was killed some way into it."""
    place = Place(lab, "good")
    found = []

    def far_enough():
        data = place.checkpoint.read_bytes() if place.checkpoint.exists() else None
        header = data and json.loads(data[16 : 16 + int.from_bytes(data[8:16], "little")])
        if header and 1 < header["done"] + header["batch"]:
            found.append(data)
        return found

    for _ in range(10):  # on a busy machine the render may be over before it is looked at
        run = Run(lab, "begun", [*lab.render, *place.outputs, "--checkpoint", "0.01s"],
                  signals=[(far_enough, signal.SIGKILL)]).go()
        if found:
            return found[0]
    raise SystemExit(f"faults: no checkpoint was made: {run.code} {run.text}")


def file_rows(lab, table, quick, seed):
    rng = random.Random(f"{seed} files")
    if table.wants("checkpoint") or table.wants("grid"):
        good = a_checkpoint(lab)
        checkpoint_rows(lab, table, quick, rng, good)
        grid_rows(lab, table, quick, rng, good)


def checkpoint_rows(lab, table, quick, rng, good):
    def refuse(damaged, option="--seed", value=0):
        here = Place(lab, "damaged")
        here.checkpoint.write_bytes(damaged)
        run = Run(lab, "damaged", [*lab.render_with(option, value), *here.outputs, "--resume"]).go().expect(2)
        if here.checkpoint.read_bytes() != damaged:
            run.lose("the checkpoint is touched")
        return here.judge(run.expect_message("checkpoint"), "unchanged")

    if table.wants("checkpoint"):
        sizes = [*([0, 15, len(good) - 1] if quick else [0, 1, 8, 15, 16, 20, len(good) - 1]), *(rng.randrange(len(good)) for _ in range(1 if quick else 13))]
        table.row("checkpoint truncated", lambda n: refuse(good[:n]), sizes)

        def flipped(bit):
            data = bytearray(good)
            data[bit // 8] ^= 1 << bit % 8
            return refuse(bytes(data))

        bits = [*range(0, 24 * 8, 64 if quick else 19), *(rng.randrange(8 * len(good)) for _ in range(1 if quick else 20))]
        table.row("checkpoint with a flipped bit", flipped, bits)
        others = [["--seed", "7"], ["--width", "319"], ["--spp", "1"], ["--sample-offset", "3"], ["--integrator", "deltaTracking"],
                  ["--crop", "0,9,0,9"], ["--grid", lab.grid.with_name("other.nvdb")]]
        subprocess.run([lab.build / "make_field", "sphere", "--output", others[-1][1]], check=True, stdout=subprocess.DEVNULL)
        table.row("checkpoint of another render", lambda o: refuse(good, *o), others[::3] if quick else others)


def grid_rows(lab, table, quick, rng, good):
    grid = lab.grid.read_bytes()

    def with_grid(content, during=None):
        here = Place(lab, "grid")
        here.checkpoint.write_bytes(good)
        file = here.directory / "cloud.nvdb"
        here.known.add(file.name)
        if content is not None:
            file.write_bytes(content)
        timer = threading.Timer(during or 0, lambda: os.truncate(file, len(grid) // 2) if during else None)
        timer.start()
        run = Run(lab, "grid", [*lab.render_with("--grid", file), *here.outputs, "--resume"]).go()
        timer.join()
        if during:  # the file was read by then, or not
            return here.judge(run.expect(0, 2), "unchanged" if run.code else "same")
        return here.judge(run.expect(2).expect_message(file), "unchanged")

    table.row("grid file gone before --resume", with_grid, [None])
    sizes = [*([0, 671, len(grid) - 1] if quick else [0, 1, 16, 671, 672, len(grid) - 1]), *(rng.randrange(len(grid)) for _ in range(1 if quick else 10))]
    table.row("grid file truncated before --resume", with_grid, [grid[:n] for n in sizes])
    moments = [lab.seconds * rng.uniform(0.01, 0.6) for _ in range(2 if quick else 15)]
    table.row("grid file truncated while it is read", lambda t: with_grid(grid, t), moments)


def stream_rows(lab, table):
    loud = [a for a in lab.render if a != "-q"]

    def closed_pipe():
        reading, writing = os.pipe()
        os.close(reading)
        return writing

    ways = {"stdout closed": 'exec "$@" >&-', "stderr closed": 'exec "$@" 2>&-', "all closed": 'exec "$@" <&- >&- 2>&-',
            "stdout full": 'exec "$@" >/dev/full', "stderr full": 'exec "$@" 2>/dev/full', "both full": 'exec "$@" >/dev/full 2>&1',
            "stdout to nobody": '"$@" 9>&- | true; exit "${PIPESTATUS[0]}"', "stderr to nobody": None, "both to nobody": None}

    def render(way):
        place = Place(lab, "stream")
        more = [*lab.checkpoints, "--progress", "json"]
        pipes = {}
        if ways[way] is None:
            pipes = {name: closed_pipe() for name in (["stderr"] if way.startswith("stderr") else ["stdout", "stderr"])}
        wrap = ["bash", "-c", ways[way], "bash"] if ways[way] else []
        run = Run(lab, "stream", [*loud, *place.outputs, *more], wrap=wrap, **pipes).go().expect(0)
        for pipe in pipes.values():
            os.close(pipe)
        return place.judge(run, "same")

    table.row("render: stdout, stderr closed, full or read by nobody", render, ways)

    def result(command):
        run = Run(lab, "result", command, wrap=["bash", "-c", 'exec "$@" >/dev/full', "bash"]).go()
        return run.expect(1).expect_message()

    table.row("a result that stdout does not take", result,
              [["info", lab.grid], ["compare", lab.whole, lab.whole], ["devices"], ["integrators"], ["--help"],
               [*lab.render[:5], "-o", lab.work / "t.exr", "--pixel", "80,40", "--sample", "0", "--trace"]])


def limit_rows(lab, table, quick):
    def limited(option, bytes_, codes, *more):
        place = Place(lab, "limit")
        run = Run(lab, "limit", [*lab.render, *place.outputs, *more], wrap=["prlimit", f"--{option}={bytes_}"]).go()
        # One picture may fit where the other does not.
        place.judge(run.expect(*codes), *(["same"] if run.code == 0 else ["unchanged", "same"]))
        return run.expect_message() if run.code in (1, 2, 3) else run

    sizes = [4096, 65536, lab.whole.stat().st_size - 1] if quick else [0, 1, 4096, 65536, 262144, lab.whole.stat().st_size - 1]
    # SwiftShader's kernels lie in a file in memory, which may then grow no more than other files.
    driver = (-signal.SIGBUS,) if "SwiftShader" in lab.device else ()
    runs = table.row("ulimit -f", lambda n: limited("fsize", n, [0, 1, *driver]), sizes)
    if died := [run for run in runs if run.code in driver]:
        table.note(f"{len(died)} of {len(runs)} ended by the driver, whose kernels are in a file in memory")
    if lab.sanitized:
        table.skip("ulimit -v", "the sanitizer needs its address space")
        return
    steps = range(100, 2600, 800 if quick else 100)
    # The driver may give up in its own way: an abort in LLVM, a crash in a thread that could not be made.
    driver = (-signal.SIGABRT, -signal.SIGSEGV, 127)
    runs = table.row("ulimit -v", lambda n: limited("as", n << 20, [0, 1, 2, 3, *driver]), steps)
    if died := [run for run in runs if run.code in driver]:
        table.note(f"{len(died)} ended by driver or dynamic linker: {died[-1].text[-160:]!r}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", default="")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--no-mounts", action="store_true")
    options = parser.parse_args()
    root = pathlib.Path(__file__).resolve().parent.parent
    start = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="vkvol-faults-") as work:
        lab = Lab(options.build.resolve(), root, work, 0.2 if options.quick else 0.4)
        print(f"tools/faults.sh{' --quick' if options.quick else ''} --seed {options.seed}; {lab.device}")
        print(f"Each run is of scenes/cumulus.xml, {lab.size}, {lab.seconds:.1f} s undisturbed.\n")
        table = Table(options.only)
        device_rows(lab, table, options.quick)
        if options.no_mounts:
            table.skip("disk full (7 rows), read-only or vanishing directories", "nothing may be mounted here")
        else:
            disk_rows(lab, table, options.quick)
        signal_rows(lab, table, options.quick, options.seed)
        file_rows(lab, table, options.quick, options.seed)
        stream_rows(lab, table)
        limit_rows(lab, table, options.quick)
    print(f"\n{table.runs} runs, {table.lost} with losses; {time.monotonic() - start:.0f} s")
    if not table.matched:
        sys.exit(f"no row's name contains {options.only!r}")
    return 1 if table.lost else 0


if __name__ == "__main__":
    sys.exit(main())
