"""The plots of a scene: error against time, efficiency, and where the time goes."""
import math
import statistics

from .interval import Interval, count, number, percent
from .svg import WIDTH, Frame, drawing, element, group, line, mark, text


def error_plot(bench, palette):
    """relMSE against seconds, with two standard errors and the range of the seconds."""
    shown = [(e, [p for p in e.points if p.relmse and p.relmse > 0 and p.seconds > 0]) for e in bench.estimators]
    points = [p for _, ps in shown for p in ps]
    if not points:
        return ""
    frame = Frame([p.seconds for p in points], [p.relmse for p in points], "seconds of rendering", "relMSE")
    content = guides(frame, points)
    for estimator, own in shown:
        if own:
            parts = fitted(frame, estimator, own)
            parts += "".join(error_bars(frame, p) + mark(palette.shape(estimator.name), frame.x(p.seconds), frame.y(p.relmse),
                                                         3.6, "mark") for p in own)
            content += group(parts, estimator.name, palette.colour(estimator.name))
    return frame.drawing(content, f"{bench.name}: relMSE against seconds of rendering, both logarithmic, for "
                         f"{len(shown)} estimators; the numbers are in the table.")


def middle(points, weights):
    """Of seconds and of relMSE, where both have logarithmic axes."""
    def mean(values):
        return math.exp(sum(w * math.log(v) for w, v in zip(weights, values)) / sum(weights))
    return mean([p.seconds for p in points]), mean([p.relmse for p in points])


def guides(frame, points):
    """How unbiased estimators fall, through the middle of all points; and 1 % of error."""
    x, y = middle(points, [1] * len(points))
    content = frame.power(x, y, -1, "guide")
    one_percent = 1e-4
    if frame.y.holds(one_percent):
        content += frame.power(x, one_percent, 0, "guide") + text(WIDTH - 10, frame.y(one_percent) - 4, "1 % error", "tick", "end")
    return content


def error_bars(frame, p):
    x, y = frame.x(p.seconds), frame.y(p.relmse)
    bars = ""
    if p.relmse_error:
        bars += line(x, frame.inside_y(p.relmse - 2 * p.relmse_error), x, frame.inside_y(p.relmse + 2 * p.relmse_error), "bar")
    if p.seconds_low and p.seconds_high and p.seconds_high > p.seconds_low:
        low, high = (min(max(frame.x(s), frame.x.start), frame.x.end) for s in (p.seconds_low, p.seconds_high))
        bars += line(low, y, high, y, "bar")
    return bars


def fitted(frame, estimator, points):
    """The measured power through the middle of its points, each as heavy as it has runs; a biased estimator's floor."""
    x, y = middle(points, [p.runs or 1 for p in points])
    lines = ""
    if estimator.slope.value is not None and estimator.judged_by_points:
        lines += frame.power(x, y, estimator.slope.value, "fit", points[0].seconds, points[-1].seconds)
    floor = estimator.floor
    if floor.bounded and floor.low > 0 and frame.y.holds(floor.value):
        lines += frame.power(x, floor.value, 0, "fit dashed")
    return lines


ROW, BAR = 42, 14
LONGEST_NAME = 42  # letters that leave room for the value beside them


def clipped(name):
    return name if len(name) <= LONGEST_NAME else name[:LONGEST_NAME - 1] + "…"


def is_shown(estimator):
    return estimator.judged and estimator.efficiency.known


def relative_efficiencies(bench):
    """[(estimator, efficiency over the default's)], or over the best one's if the default was not measured; and over whose."""
    unit = bench.default if bench.default and is_shown(bench.default) else None
    unit = unit or max((e for e in bench.estimators if is_shown(e)), key=lambda e: e.efficiency.value, default=None)
    if unit is None:
        return [], None
    ratios = [(e, Interval(1.0) if e is unit else bench.ratio(e, unit)) for e in bench.estimators if is_shown(e)]
    return sorted(ratios, key=lambda pair: -pair[1].value), unit


def whisker(low, high, y):
    """With a halo of the page's colour, for bars that are as bright as the whisker."""
    parts = ((low, y, high, y), (low, y - 4, low, y + 4), (high, y - 4, high, y + 4))
    return "".join(line(*part, class_) for class_ in ("halo", "whisker") for part in parts)


def efficiency_plot(bench, palette):
    rows, unit = relative_efficiencies(bench)
    if not rows:
        return ""
    most = max(max(r.high or 0, r.value) for _, r in rows)
    right = WIDTH - 8

    def x(value):
        return max(0.0, value) / most * right
    content = ""
    for i, (estimator, ratio) in enumerate(rows):
        y = i * ROW + 20
        parts = element("rect", x=0, y=y + 4, width=x(ratio.value), height=BAR, rx=2,
                        class_="block hollow" if estimator.biased else "block")
        parts += line(x(1), y + 2, x(1), y + 6 + BAR, "one")
        if ratio.bounded:
            parts += whisker(x(ratio.low), x(ratio.high), y + 4 + BAR / 2)
        name = estimator.name + (" (biased)" if estimator.biased else "")
        parts += text(0, y, clipped(name), "name") + text(WIDTH - 2, y, str(ratio), "value", "end")
        content += group(parts, f"{name}: {ratio}", palette.colour(estimator.name))
    return drawing(content, len(rows) * ROW + 4, f"{bench.name}: efficiency in units of {unit.name}'s: "
                   + "; ".join(f"{e.name} {r}" for e, r in rows))


def pass_names(bench):
    return list(dict.fromkeys(name for e in bench.estimators for name in e.passes))


def pass_costs(bench, estimator):
    """Nanoseconds per path, by pass; what the render took beside its passes comes last."""
    point = estimator.longest
    if not (point and estimator.passes and point.samples > 0):
        return {}
    paths = point.samples * bench.width * bench.height
    costs = {name: 1e9 * seconds / paths for name, seconds in estimator.passes.items()}
    costs["between passes"] = max(0.0, 1e9 * point.seconds / paths - sum(costs.values()))
    return costs


def longest_bar(totals):
    """What fills the width. Much slower ones are cut, lest nothing be seen of the others."""
    return min(max(totals), 6 * statistics.median(totals))


def cost_plot(bench, pass_classes):
    rows = [(e, pass_costs(bench, e)) for e in bench.estimators]
    rows = [(e, costs) for e, costs in rows if costs]
    if not rows:
        return ""
    rows.sort(key=lambda row: sum(row[1].values()))
    most = longest_bar([sum(costs.values()) for _, costs in rows])
    content = ""
    for i, (estimator, costs) in enumerate(rows):
        y, start, total = i * ROW + 20, 0.0, sum(costs.values())
        parts = text(0, y, clipped(estimator.name), "name") + text(WIDTH - 2, y, f"{number(total)} ns", "value", "end")
        for name, cost in costs.items():
            width = cost / max(most, total) * (WIDTH - 2)
            parts += group(element("rect", x=start, y=y + 4, width=width, height=BAR, class_="block"),
                           f"{name}: {number(cost)} ns, {percent(cost / total)}", pass_classes[name])
            start += width
        if total > most:
            parts += "".join(line(WIDTH - x, y + 6 + BAR, WIDTH - x + 6, y + 2, "gap") for x in (24, 20))
        content += group(parts)
    return drawing(content, len(rows) * ROW + 4, f"{bench.name}: nanoseconds per path by pass: "
                   + "; ".join(f"{e.name} {number(sum(c.values()))}" for e, c in rows))


def scaling_plot(series, law, colour):
    points = [p for p in series.points if p[0] > 0 and p[1] > 0]
    if len({p[0] for p in points}) < 2:
        return ""
    ends = [s for p in points for s in p[1:] if s]
    unit = f" ({series.unit})" if series.unit and series.unit not in series.name else ""
    frame = Frame([p[0] for p in points], ends, series.name + unit, "seconds", 260)
    x, y = (math.exp(sum(math.log(p[i]) for p in points) / len(points)) for i in (0, 1))
    content = frame.power(x, y, -1 if law and law.exponent.value < -0.3 else 1, "guide")
    if law and not law.curved:
        parts = frame.power(x, y, law.exponent.value, "fit", points[0][0], points[-1][0])
    else:  # no power describes it: from point to point
        parts = "".join(line(frame.x(a[0]), frame.y(a[1]), frame.x(b[0]), frame.y(b[1]), "fit") for a, b in zip(points, points[1:]))
    for at, seconds, low, high in points:
        if low and high:
            parts += line(frame.x(at), frame.inside_y(low), frame.x(at), frame.inside_y(high), "bar")
        parts += group(mark("circle", frame.x(at), frame.y(seconds), 3.6, "mark"), f"{count(at)}: {number(seconds)} s")
    return frame.drawing(content + group(parts, class_=colour), f"Seconds against {series.name}, both logarithmic: "
                         + "; ".join(f"{count(p[0])} {series.unit}: {number(p[1])} s" for p in points))
