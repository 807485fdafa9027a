"""Readings by vkvol, with as many samples as they need."""

import csv
import json
import math
import pathlib
import statistics
import subprocess

MOST_SAMPLES = 1 << 26


def mean_of(readings):
    n = len(readings)
    return [(sum(mean for mean, _ in each) / n, math.sqrt(sum(error**2 for _, error in each)) / n) for each in zip(*readings)]


class Reader:
    def __init__(self, vkvol, folder, schedule):
        self.vkvol, self.folder, self.schedule = vkvol, pathlib.Path(folder), schedule
        self.count, self.report = 0, None
        self.mean_error = math.inf  # of the mean over what was read last

    def read(self, scene, samples, seed, is_map=False, options=()):
        """Of each column its mean and standard error, or of each pixel: of the middle channel, since all are alike. Of one column it
        is the picture's mean, whose error the report knows, as it does that of the mean over several. Pixels of one column are taken for
        independent; those that count particles are not: each is in one of them, so that the errors stated of columns are some too large."""
        self.count += 1
        file = self.folder / f"case{self.count}.xml"
        table, report = file.with_suffix(".csv"), file.with_suffix(".json")
        self.report = report  # of the latest
        self.places = []
        file.write_text(f"<options>{scene}<rayPerPixelCount>{samples}</rayPerPixelCount></options>\n")
        command = [self.vkvol, file, "-q", "--seed", str(seed), "--schedule", self.schedule, "-o", table, "--report", report, *options]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit(f"{file}: {done.stderr.strip()}")
        with open(table, newline="") as stream:
            columns = {}
            for row in csv.DictReader(stream):
                place = int(row["row"]) if is_map else 0, int(row["column"])
                columns.setdefault(place, []).append((float(row["G"]), float(row["standardError.G"] or "inf")))
                if any(not math.isclose(float(row[other]), float(row["G"]), rel_tol=1e-5, abs_tol=1e-30) for other in "RB"):
                    raise SystemExit(f"{file}: all is grey, but a reading is {row}")
        self.places = sorted(columns)
        mean = json.loads(report.read_text())["mean"]
        errors = mean["standardError"]  # none of a single sample; 0 where nothing varies
        self.mean_error = errors[1] if errors and errors[1] is not None else math.inf
        if len(columns) == 1:
            return [(mean["value"][1], self.mean_error)]
        return [(sum(mean for mean, _ in column) / len(column), math.sqrt(sum(error**2 for _, error in column)) / len(column))
                for _, column in sorted(columns.items())]

    def read_to(self, case, share, least):
        """Readings whose standard errors are at most `share` of the figures' slack, or `least` of the figures, or as good as
        MOST_SAMPLES make them."""
        samples, seed = case.samples, 100 * self.count + 1  # cases are independent
        usual = sum(case.published) / len(case.published)
        wanted = [max(share * slack, least * abs(value), case.least * usual) / case.scale
                  for slack, value in zip(case.slack or [0.0] * len(case.published), case.published)]
        while True:
            readings, means = [], []
            for i, scene in enumerate([case.scene, *case.others]):
                readings.append(self.read(scene, samples, seed + 50 * i, case.is_map))
                means.append(self.mean_error)
            rows = mean_of(readings)
            self.mean_error = math.hypot(*means) / len(means)
            # Of maps a few pixels are noisier by chance.
            short = (statistics.mean if case.is_map else max)((error / goal) ** 2 for (_, error), goal in zip(rows, wanted))
            if short <= 1.0 or samples >= MOST_SAMPLES:
                return rows, samples
            samples = min(MOST_SAMPLES, max(2 * samples, int(min(1.15 * short * samples, MOST_SAMPLES))))
            seed += 1

    def read_alone(self, case, place, samples):
        """One reading of a map, as often and with other random numbers."""
        row, column = place
        return self.read(case.scene, samples, 100 * self.count + 1, True, ["--crop", f"{column},{column + 1},{row},{row + 1}"])[0]
