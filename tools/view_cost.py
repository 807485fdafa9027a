#!/usr/bin/env python3
"""What it costs a render to be looked at: samples per second alone and on the page of `vkvol view`, in turn.

    tools/view_cost.py scenes/cumulus.xml --width 640 --spp 48      [VKVOL=build/vkvol ROUNDS=3 in the environment]

A script asks for every picture, as a page does, but draws none. The machine should have nothing else to do.
"""
import json
import os
import pathlib
import re
import signal
import statistics
import struct
import subprocess
import sys
import tempfile
import urllib.request

VKVOL = os.environ.get("VKVOL", str(pathlib.Path(__file__).resolve().parent.parent / "build/vkvol"))


def alone(arguments, folder):
    report = f"{folder}/report.json"
    subprocess.run([VKVOL, *arguments, "-q", "-o", f"{folder}/picture.exr", "--report", report], check=True)
    with open(report) as file:
        figures = json.load(file)
    return figures["samplesPerPixel"]["most"] / figures["seconds"]["render"]


def watched(arguments):
    """Samples per second, and how many pictures there were."""
    view = subprocess.Popen([VKVOL, "view", *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    address = next(found for found in (re.search(r"(http://\S+)/\?key=(\w+)", line) for line in view.stdout) if found)
    state, pictures = {"version": 0}, 0
    while not state.get("done"):
        with urllib.request.urlopen(f"{address[1]}/frame?key={address[2]}&since={state['version']}&exposure=&curve=") as answer:
            body = answer.read()
        if body:
            length, = struct.unpack("<I", body[:4])
            state = json.loads(body[4:4 + length])
            pictures += 1
    view.send_signal(signal.SIGINT)
    view.wait()
    return state["samples"] / state["seconds"], pictures


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    rates = {True: [], False: []}
    with tempfile.TemporaryDirectory() as folder:
        for turn in range(int(os.environ.get("ROUNDS", 3))):
            for is_watched in (True, False, True, False, False, True):
                rate, pictures = watched(sys.argv[1:]) if is_watched else (alone(sys.argv[1:], folder), 0)
                rates[is_watched].append(rate)
                print(f"{'watched' if is_watched else 'alone':8} {rate:.3f} samples per second and pixel, {pictures} pictures", flush=True)
    medians = {key: statistics.median(values) for key, values in rates.items()}
    print(f"medians: alone {medians[False]:.3f}, watched {medians[True]:.3f}: {100 * (1 - medians[True] / medians[False]):.1f} % less")


if __name__ == "__main__":
    main()
