#!/usr/bin/env python3
"""Tests of what tools/report concludes, on files whose conclusions are known, and of what it refuses."""
import copy
import math
import random
import re
import subprocess
import sys
import unittest
from pathlib import Path

import report_data as made

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools"))
from report_page import contest, findings, measurements, scaling_fit  # noqa: E402
from report_page.interval import Interval, number  # noqa: E402
from report_page.json_file import BadFile  # noqa: E402

NUMBER = r"−?[0-9][0-9,]*(?:\.[0-9]+)?(?: × 10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?"
PLAIN = str.maketrans("−⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "--0123456789", ",")


def value_of(text):
    return float(text.translate(PLAIN).replace(" × 10", "e"))


class Folder(made.Folder):
    def bench(self, data):
        return measurements.read_bench(made.write(self.folder.name, "cumulus.bench.json", data))

    def said(self, data):
        return [f.text for f in findings.findings_of(self.bench(data))]


class Conclusions(Folder):
    def test_a_clear_winner_is_named_with_its_ratio(self):
        data = made.cloud()
        first = self.said(data)[0]
        ratio = next(r for r in data["ranking"] if r["integrator"] == "residualRatioTracking")["efficiencyRatioToDefault"]
        self.assertIn("use `residualRatioTracking`", first)
        self.assertIn("not the best unbiased choice", first)
        value, low, high = map(value_of, re.findall(NUMBER, first))
        self.assertAlmostEqual(value, ratio["value"], delta=0.005 * value)
        self.assertTrue(low <= ratio["low"] and high >= ratio["high"])  # rounded outward

    def test_no_difference_is_claimed_where_the_interval_contains_one(self):
        for spread in (0.1, 0.3, 2.0):
            data = made.bench([made.estimator("ratioTracking", default=True, spread=spread),
                               made.estimator("weightedTracking", variance=0.2 / (1 + 0.9 * spread), spread=spread)], ratio_spread=spread)
            first = self.said(data)[0]
            self.assertIn("no measurable difference from `weightedTracking`", first)
            self.assertIn("stay with `ratioTracking`", first)

    def test_an_interval_that_reads_as_containing_one_is_judged_so(self):
        self.assertFalse(Interval(1.05, 1.0004, 1.1).excludes(1))  # would be printed [1.00, 1.10]
        self.assertTrue(Interval(1.05, 1.012, 1.1).excludes(1))
        self.assertFalse(Interval(3.0).excludes(1))

    def test_the_default_is_confirmed_when_it_is_best(self):
        first = self.said(made.bench([made.estimator("ratioTracking", default=True), made.estimator("ratioNEE", 0.2)]))[0]
        self.assertIn("use `ratioTracking`, its default: ", first)
        self.assertIn("times the efficiency of the next best, `ratioNEE`", first)

    def test_biased_estimators_get_their_floor_and_no_advice(self):
        data = made.bench([made.estimator("ratioTracking", default=True),
                           made.estimator("rayMarching", 0.001, 0.01, 2e-3, "takes one point for a step")])
        text = self.said(data)
        self.assertNotIn("rayMarching", text[0])
        bias = next(t for t in text if "is biased" in t)
        self.assertIn("takes one point for a step", bias)
        self.assertEqual([value_of(n) for n in re.findall(NUMBER, bias)], [0.002, 0.00166, 0.0024, 4.47])
        self.assertFalse(any("rayMarching" in t for t in text if t is not bias))

    def test_a_biased_default_is_called_that(self):
        data = made.bench([made.estimator("rayMarching", floor=1e-3, biased="steps", default=True), made.estimator("ratioTracking")])
        self.assertIn("use `ratioTracking`, the most efficient unbiased estimator. The scene's default, `rayMarching`, is biased",
                      self.said(data)[0])

    def test_nothing_is_ranked_by_a_reference_that_is_noisier_than_what_it_judges(self):
        data = made.cloud(reference_error=0.1)
        text = self.said(data)
        self.assertIn("too noisy", text[0])
        self.assertIn("--reference", text[0])
        self.assertFalse(any("times" in t for t in text))

    def test_single_runs_support_no_comparison(self):
        data = made.bench([made.estimator("ratioTracking", default=True, spread=None),
                           made.estimator("ratioNEE", variance=0.05, spread=None)], secondsToJudge=299.5)
        text = self.said(data)
        self.assertIn("was measured long enough", text[0])
        self.assertIn("Give `--time 300` or more", text[0])
        self.assertFalse(any("times" in t for t in text))

    def test_what_a_bench_calls_too_short_is_not_compared(self):
        """However large the ratio, and although the file has an interval of it."""
        data = made.bench([made.estimator("ratioTracking", default=True), made.estimator("ratioNEE", 0.2),
                           made.estimator("weightedTracking", variance=0.004, judged=False)])
        text = self.said(data)
        self.assertIn("use `ratioTracking`, its default: ", text[0])
        about = [t for t in text if "weightedTracking" in t]
        self.assertEqual(about, ["Too few runs to judge `weightedTracking`. Give a longer `--time`."])

    def test_other_names_of_an_estimator_are_said(self):
        text = self.said(made.bench([made.estimator("ratioTracking", default=True, sameAs=["ratioNEE", "weightedTracking"])]))
        self.assertTrue(any("`ratioNEE`, `weightedTracking` and `ratioTracking` are one and the same" in t for t in text))

    def test_floors_of_unbiased_estimators_are_suspicious(self):
        text = self.said(made.bench([made.estimator("ratioTracking", default=True), made.estimator("ratioNEE", floor=1e-3)]))
        self.assertTrue(any("Counted as unbiased" in t and "`ratioNEE`" in t for t in text))

    def test_busy_machines_and_unknown_references_are_told(self):
        data = made.cloud(reference_error=None)
        data["machine"]["load"] = [3.5, 4.0]
        text = " ".join(self.said(data))
        self.assertIn("a load of 3.50 on 2 cores", text)
        self.assertIn("own error is not known", text)

    def test_every_number_follows_from_the_file(self):
        data = made.cloud()
        data["machine"]["load"] = [1.5, 2.0]
        known = {1.0, 2.0, 1.5}
        for e in data["estimators"]:
            known |= {e["secondsToOnePercent"], sum(e["setupSeconds"].values()),
                      100 * e["passSeconds"]["track"] / sum(e["passSeconds"].values()),
                      e["perPath"]["nullCollisions"] / e["perPath"]["realCollisions"], 100 * math.sqrt(e["biasFloor"]["value"])}
            known |= set(e["biasFloor"].values())
            for other in data["estimators"]:
                a, b = e["efficiency"], other["efficiency"]
                down = math.hypot(*(math.log(x) for x in (a["value"] / a["low"], b["high"] / b["value"])))
                up = math.hypot(*(math.log(x) for x in (a["high"] / a["value"], b["value"] / b["low"])))
                ratio = a["value"] / b["value"]
                known |= {ratio, ratio * math.exp(-down), ratio * math.exp(up)}
        for r in data["ranking"]:
            known |= {v for x in r["efficiencyRatioToDefault"].values() for v in (x, 1 / x)}
        known.discard(None)
        for sentence in self.said(data):
            for printed in re.findall(NUMBER, sentence.replace("1/t", "")):
                x = value_of(printed)
                self.assertTrue(any(abs(x - k) <= 0.01 * abs(k) for k in known), f"{printed} in: {sentence}")

    def test_peers_are_compared_only_where_they_agree(self):
        def said(**kinds):
            found = contest.read_contest(made.write(self.folder.name, "p.peer.json", made.peer(**kinds)))
            return contest.findings_of(found)[0].text
        text = said(ratio=0.05, spread=0.25)
        self.assertIn("same picture", text)
        self.assertEqual([value_of(n) for n in re.findall(NUMBER, text.split("ratioTracking has")[1])], [20, 16, 25])  # 1 / (0.05 x 1.25)
        self.assertIn("no measurable difference", said(ratio=0.9, spread=0.25))
        self.assertIsNone(re.search(r"has .* times", said(same=False)))
        self.assertIsNone(re.search(r"has .* times", said(same=None)))


class Scaling(unittest.TestCase):
    def fit(self, xs, seconds):
        points = [(x, seconds(x), 0.98 * seconds(x), 1.02 * seconds(x)) for x in xs]
        series = measurements.Series("pixels", "pixels", "scenes/a.xml", "", points, "")
        law = scaling_fit.fit(points)
        return law, scaling_fit.describe(series, law)

    def test_exponents(self):
        xs = (1, 2, 4, 8, 16)
        for exponent, verdict in ((1, "near-linear"), (2, "more than linear"), (0.5, "less than linear"), (0, "hardly matters"),
                                  (-1, "the more, the faster")):
            law, said = self.fit(xs, lambda x: 3 * x**exponent)
            self.assertAlmostEqual(law.exponent.value, exponent, places=9)
            self.assertAlmostEqual(law.constant, 3, places=9)
            self.assertIn(verdict, said)

    def test_intervals_hold_what_they_promise(self):
        """Of 2000 independent intervals at 95 % the number that miss is binomial: 100 with a standard deviation of 9.7; 5 of
        these allow for less than one false alarm in a million seeds."""
        rng = random.Random(3)
        missed = 0
        for _ in range(2000):
            law = scaling_fit.fit([(x, x**0.8 * math.exp(rng.gauss(0, 0.05))) for x in (1, 2, 4, 8, 16, 32)])
            missed += not law.exponent.low <= 0.8 <= law.exponent.high
        self.assertLess(abs(missed - 100), 5 * 9.7)

    def test_what_is_no_power_is_not_called_one(self):
        law, said = self.fit((1, 4, 16, 64, 256), lambda x: 0.3 + 0.01 * x)
        self.assertTrue(law.curved)
        self.assertIn("no single power", said)

    def test_points_that_scatter_support_no_exponent(self):
        self.assertIn("cannot tell", self.fit((1, 2, 4, 8), lambda x: {1: 1, 2: 0.9, 4: 6, 8: 1}[x])[1])

    def test_two_points_have_no_exponent(self):
        self.assertIn("a factor of 0.5", self.fit((1, 2), lambda x: 1 / x)[1])


class BadInput(Folder):
    def test_missing_and_wrong_keys_are_named_with_their_file(self):
        def without(*path):
            data = copy.deepcopy(made.cloud())
            place = data
            for key in path[:-1]:
                place = place[key]
            del place[path[-1]]
            return data
        cases = {"estimators[1].points[0].seconds": without("estimators", 1, "points", 0, "seconds"),
                 "reference.relMse": without("reference", "relMse"), "scene": without("scene"),
                 "estimators[0].efficiency": without("estimators", 0, "efficiency"), "format": {"format": "other", "version": 1},
                 "version": {**made.cloud(), "version": 2}, "image.width": {**made.cloud(), "image": {"width": "wide", "height": 1}}}
        for key, data in cases.items():
            with self.subTest(key), self.assertRaises(BadFile) as caught:
                self.bench(data)
            self.assertIn("cumulus.bench.json: " + key, str(caught.exception))
            self.assertIn("vkvol bench", str(caught.exception))
        lonely = made.peer()
        del lonely["estimators"][0]
        with self.assertRaises(BadFile) as caught:
            contest.read_contest(made.write(self.folder.name, "p.peer.json", lonely))
        self.assertIn("p.peer.json: estimators has none whose isDefault is true", str(caught.exception))

    def test_the_program_ends_with_code_2(self):
        broken = Path(self.folder.name) / "x.bench.json"
        broken.write_text("{")
        for arguments in ([str(broken)], [self.folder.name + "/none.json"], []):
            done = subprocess.run([sys.executable, ROOT / "tools" / "report", *arguments], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertNotIn("Traceback", done.stderr)

    def test_no_input_is_written_over(self):
        bench = Path(made.write(self.folder.name, "cumulus.bench.json", made.cloud()))
        link = bench.with_name("link.html")
        link.symlink_to(bench)
        for output in (bench, link):
            before = bench.read_bytes()
            done = subprocess.run([sys.executable, ROOT / "tools" / "report", bench, "-o", output], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn("would be lost", done.stderr)
            self.assertEqual(bench.read_bytes(), before)


class Numbers(unittest.TestCase):
    def test_they_are_written_as_people_do(self):
        for x, text in ((12345.6, "12,300"), (1.0, "1.00"), (0.02314, "0.0231"), (4.06e-6, "4.06 × 10⁻⁶"), (0, "0"),
                        (-0.98, "−0.980"), (999.9, "1,000"), (None, "unknown")):
            self.assertEqual(number(x), text)
        self.assertEqual(str(Interval(1.1, 1.1, 1.1)), "1.10 [1.10, 1.10]")
        self.assertEqual(str(Interval(2.0, 1.23456, 2.71828)), "2.00 [1.23, 2.72]")


if __name__ == "__main__":
    unittest.main()
