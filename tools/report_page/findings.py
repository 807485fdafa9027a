"""What the numbers say, in sentences. Nothing is claimed that an interval does not bear out; names stand in `backquotes`."""
import math
from dataclasses import dataclass

from .choice import choose
from .interval import count, duration, number, percent
from .measurements import setup_seconds

USE, NOTE, CAUTION = "Use", "Note", "Caution"


@dataclass(frozen=True)
class Finding:
    kind: str
    text: str


def findings_of(bench):
    choice = choose(bench)
    found = [headline(bench, choice)]
    if choice.judged:
        found += ties(bench, choice) + cost_of_the_worst(bench, choice) + time_to_one_percent(choice)
    found += same(bench)
    found += [bias(estimator) for estimator in bench.estimators if estimator.biased]
    found += unexpected_floors(bench) + slopes(bench) + not_judged(bench)
    return found + reference(bench, choice) + circumstances(bench) + where_time_goes(choice)


def headline(bench, choice):
    scene, default, advised = bench.name, bench.default, choice.advised
    if choice.best is None:
        return Finding(CAUTION, f"No unbiased estimator of {scene} was measured long enough to be judged: there is nothing to choose "
                                f"from. {longer(bench)}")
    if not choice.judged:
        return Finding(CAUTION, f"For {scene} the reference is too noisy to rank the estimators: {percent(choice.noise)} of the "
                                "smallest squared difference measured is its own error. Give a longer `--time`, or a better `--reference`.")
    if default is None:
        return Finding(USE, f"For {scene} use `{advised.name}`, the most efficient of the unbiased estimators measured; the "
                            "scene's default is not among them.")
    if default.biased:
        return Finding(USE, f"For {scene} use `{advised.name}`, the most efficient unbiased estimator. The scene's default, "
                            f"`{default.name}`, is biased: {default.biased}.")
    if default not in bench.unbiased:
        return Finding(USE, f"For {scene} use `{advised.name}`, the most efficient of the estimators that could be judged; "
                            f"`{default.name}`, the scene's default, could not.")
    if advised is not default:
        return Finding(USE, f"For {scene} use `{advised.name}`: {choice.gain} times the efficiency of `{default.name}`, the "
                            "scene's default, which is not the best unbiased choice.")
    if len(bench.unbiased) == 1:
        return Finding(USE, f"For {scene} `{default.name}`, its default, is the only unbiased estimator that was judged.")
    if choice.best is default:
        return Finding(USE, f"For {scene} use `{default.name}`, its default: {runner_up(bench, choice)}.")
    return Finding(USE, f"For {scene} stay with `{default.name}`, its default: {comparison(choice.best, choice.gain)}.")


def comparison(estimator, ratio):
    if not ratio.bounded:
        return f"too few runs to compare it with `{estimator.name}` ({ratio} times its efficiency)"
    return f"no measurable difference from `{estimator.name}` ({ratio} times its efficiency)"


def runner_up(bench, choice):
    others = [e for e in bench.unbiased if e is not choice.best]
    second = max(others, key=lambda e: e.efficiency.value)
    ratio = bench.ratio(choice.best, second)
    if ratio.excludes(1):
        return f"{ratio} times the efficiency of the next best, `{second.name}`"
    return "none of the unbiased estimators measured is better for sure"


def ties(bench, choice):
    """What may be had for the same price; the one that the headline names already is left out."""
    said = choice.best if choice.advised is bench.default and choice.best is not choice.advised else None
    tied = [e for e in choice.ties if e is not said]
    if not tied:
        return []
    listed = ", ".join(f"`{e.name}` ({bench.ratio(e, choice.advised)})" for e in tied)
    return [Finding(NOTE, f"No measurable difference in efficiency between `{choice.advised.name}` and {listed}.")]


def cost_of_the_worst(bench, choice):
    worst = min(bench.unbiased, key=lambda e: e.efficiency.value)
    ratio = bench.ratio(choice.advised, worst)
    if worst is choice.advised or not ratio.excludes(1) or ratio.value < 1:
        return []
    return [Finding(NOTE, f"The same noise takes `{worst.name}` {ratio} times as long as `{choice.advised.name}`.")]


def same(bench):
    return [Finding(NOTE, f"In this scene {', '.join(f'`{n}`' for n in e.same_as)} and `{e.name}` are one and the same, and were measured "
                          f"once, as `{e.name}`.") for e in bench.estimators if e.same_as]


def time_to_one_percent(choice):
    seconds = choice.advised.seconds_to_one_percent
    if seconds is None:
        return []
    setup = setup_seconds(choice.advised.setup)
    then = "" if setup is None else f", and takes {duration(setup)} to set up"
    return [Finding(NOTE, f"`{choice.advised.name}` reaches a noise of 1\u00a0% after "
                          f"{duration(seconds)} of rendering{then}.")]


def bias(estimator):
    """Of an estimator that is known to be biased."""
    floor, said = estimator.floor, f"`{estimator.name}` is biased ({estimator.biased})"
    if not estimator.judged_by_points or floor.low is None or floor.high is None or floor.high <= 0:
        return Finding(NOTE, f"{said}; how much was not measured.")
    if floor.low > 0:
        return Finding(NOTE, f"{said}: no number of samples brings its relMSE below {floor}, an error of "
                             f"{percent(math.sqrt(floor.value))}.")
    return Finding(NOTE, f"{said}, by less than shows here: at most a relMSE of {number(floor.high, math.ceil)}, an error of "
                         f"{percent(math.sqrt(floor.high))}.")


def unexpected_floors(bench):
    floors = [f"`{e.name}` {e.floor}" for e in bench.estimators
              if not e.biased and e.judged_by_points and e.floor.bounded and e.floor.low > 0]
    if not floors:
        return []
    return [Finding(CAUTION, f"Counted as unbiased, yet more samples would leave a relMSE of {', '.join(floors)}: a bias, rare "
                             "bright samples, or an error of the reference.")]


def slopes(bench):
    """Of unbiased estimators whose error does not fall as 1/t."""
    slower, faster = [], []
    for e in bench.estimators:
        s = e.slope
        if e.biased or not e.judged_by_points or None in (s.value, s.low, s.high) or s.low <= -1 <= s.high:
            continue
        (slower if s.value > -1 else faster).append(f"`{e.name}` {s}")
    found = []
    if slower:
        found.append(Finding(NOTE, f"The error falls more slowly than 1/t, as seconds to the power: {', '.join(slower)}. Rare bright "
                                   "samples do that, and bias."))
    if faster:
        found.append(Finding(NOTE, f"The error falls faster than 1/t, as seconds to the power: {', '.join(faster)}. A fixed cost of "
                                   "each render does that, and a machine that grew less busy."))
    return found


def not_judged(bench):
    names = [f"`{e.name}`" for e in bench.estimators if not e.judged]
    return [Finding(CAUTION, f"Too few runs to judge {', '.join(names)}. {longer(bench)}")] if names else []


def longer(bench):
    seconds = bench.seconds_to_judge
    return f"Give `--time {math.ceil(seconds)}` or more." if seconds else "Give a longer `--time`."


def reference(bench, choice):
    own, made_by = bench.reference["relmse"], bench.reference["integrator"]
    found = []
    if own is None:
        found.append(Finding(CAUTION, f"The reference's own error is not known: small errors on {bench.name} may be its, in part."))
    elif choice.judged and choice.noise > 0.2:
        found.append(Finding(CAUTION, f"The reference of {bench.name} is noisy: up to {percent(choice.noise)} of the squared "
                                      "differences is its own error, which is taken off."))
    if any(e.name == made_by for e in bench.estimators):
        found.append(Finding(CAUTION, f"The reference was rendered by `{made_by}`, which is itself measured here: an error that it "
                                      "always makes would not show."))
    return found


def circumstances(bench):
    found = []
    if bench.interrupted:
        found.append(Finding(CAUTION, f"The measurement of {bench.name} was interrupted: its intervals are wider than the time "
                                      "asked for would have made them."))
    return found + load(bench)


def load(bench):
    if not (bench.load and bench.cores) or bench.load[0] <= bench.cores / 2:
        return []
    return [Finding(CAUTION, f"The machine was busy: a load of {number(bench.load[0])} on {count(bench.cores)} cores before "
                             f"{bench.name} began. Estimators take turns, so that ratios suffer less than seconds.")]


def where_time_goes(choice):
    estimator = choice.advised
    total = sum(estimator.passes.values()) if estimator else 0
    if not total:
        return []
    name, seconds = max(estimator.passes.items(), key=lambda item: item[1])
    text = f"`{estimator.name}` spends {percent(seconds / total)} of its passes' time in {name}"
    real, null = (estimator.per_path.get(k) for k in ("realCollisions", "nullCollisions"))
    if real and null is not None:
        text += f", with {number(null / real)} null collisions to a real one"
    return [Finding(NOTE, text + ".")]
