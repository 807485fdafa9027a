"""Published results of radiative transfer, each reading beside the figure in print. A z is the difference over its standard error,
that of the reading and that of the print (rounding, or the scatter of a consensus) together; fails where one is beyond
Sidak's limit over all of them. (Of maps of radiances those beyond 4 are read once more, by themselves, with 16 times the samples.)

    python3 tools/truth [--figures DIR] [WORD ...]     WORD: only where "GROUP, QUANTITY" contains one
    --figures DIR  a folder with i3rc/ and kobayashi_problem1.csv; without it their cases are left out
    --share .33    standard errors as a share of the prints' own slack
    --least 1e-3   and as a share of the figures: what is printed to more digits is read no better than this
    --slabs N      so many slabs and stacks at random besides, against PyPI's nanodisort, if it is there
    --schedule     fused or staged
    --page FILE    an HTML page with the columns of the step cloud over the consensus
"""

import argparse
import pathlib
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))  # where this is run as a folder

from truth import i3rc, judge, nanodisort_case, page, reading, slabs, voids

AGAIN, MORE = 4.0, 16
FEW = 40  # figures of a case, all of which are printed; else the worst and the mean
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("words", nargs="*")
    parser.add_argument("--figures", type=pathlib.Path)
    parser.add_argument("--slabs", type=int, default=0)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    parser.add_argument("--schedule", default="auto")
    parser.add_argument("--share", type=float, default=1 / 3)
    parser.add_argument("--least", type=float, default=1e-3)
    parser.add_argument("--page", type=pathlib.Path)
    return parser.parse_args()


def cases(chosen, folder):
    yield from slabs.cases(pathlib.Path(folder))
    yield from nanodisort_case.cases(chosen.slabs)
    if chosen.figures:
        yield from i3rc.cases(chosen.figures / "i3rc", pathlib.Path(folder))
        yield from voids.cases(chosen.figures / "kobayashi_problem1.csv")


def read_again(case, verdicts, reader, samples):
    """Of a map of radiances what is further off than AGAIN is read once more, with MORE times the samples, and that reading is judged: where light comes by
    few bright paths, one that has met less of them than it should is too low, and its own error too small, the more so the fewer its samples.
    (Not so of fluxes, whose particles are of the whole scene, and counted.)"""
    places = reader.places
    for verdict, place in zip(verdicts, places if case.is_map and case.what.startswith("I") else []):  # the mean, behind them, is of all that were read
        if abs(verdict.z) > AGAIN:
            print(row(verdict) + " read again:", flush=True)
            mean, error = reader.read_alone(case, place, MORE * samples)
            verdict.reading, verdict.error = case.scale * mean, case.scale * error
            print(row(verdict), flush=True)


def row(verdict):
    v = verdict
    return f"{v.case.name:28} {v.case.what + ', ' + v.label if v.label != v.case.what else v.label:44.44} {v.reading:11.6g} " \
           f"{v.published:11.6g} {v.reading - v.published:+9.1e} {v.error:8.1e} {v.slack:8.1e} {v.z:+6.2f}" + ("" if v.case.judged else " not judged")


def main():
    chosen = options()
    found, groups = [], {}
    print(f"{'group':28} {'quantity':44} {'reading':>11} {'published':>11} {'less':>9} {'error':>8} {'slack':>8} {'z':>6}")
    with tempfile.TemporaryDirectory() as folder:
        reader = reading.Reader((chosen.build / "vkvol").resolve(), folder, chosen.schedule)
        for case in cases(chosen, folder):
            if chosen.words and not any(word in f"{case.name}, {case.what}" for word in chosen.words):
                continue
            start = time.time()
            rows, samples = reader.read_to(case, chosen.share, chosen.least)
            verdicts = judge.judge(case, rows, reader.mean_error)
            read_again(case, verdicts, reader, samples)
            found += verdicts
            seconds, figures = groups.get(case.name, (0.0, 0))
            groups[case.name] = seconds + time.time() - start, figures + len(verdicts)
            for verdict in verdicts if len(verdicts) <= FEW else [max(verdicts, key=lambda v: abs(v.z)), verdicts[-1]]:
                print(row(verdict), flush=True)
    if not found:
        raise SystemExit("no group and quantity contain such a word")
    judged = [v for v in found if v.case.judged]
    most = judge.limit(max(len(judged), 1))
    print(f"\n{len(judged)} figures; |z| may be {most:.2f}\n")
    for name, (seconds, figures) in groups.items():
        here = [v for v in found if v.case.name == name]
        worst = max(here, key=lambda v: abs(v.z))
        of_figure = max(v.error / max(abs(v.published), 1e-30) for v in here)
        print(f"{name:28} {figures:4} figures in {seconds:6.1f} s, errors up to {of_figure:.1e} of the figure, largest |z| {abs(worst.z):.2f} "
              f"({worst.case.what}, {worst.label})")
    as_good = sum(v.error <= 1.001 * chosen.share * v.slack for v in judged)
    print(f"{as_good} of {len(judged)} are read to {chosen.share:.2g} of the prints' slack, or better; the others to {chosen.least:g} of the figure, if that is in reach")
    if chosen.page:
        page.write(chosen.page, found)
    return 0 if all(abs(v.z) <= most for v in judged) else 1


if __name__ == "__main__":
    sys.exit(main())
