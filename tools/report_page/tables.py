"""Tables of a page, and the small pieces of HTML that several parts of it need."""
import re
from html import escape

from .interval import Interval, duration, number
from .measurements import setup_seconds


def marked(sentence):
    """Escaped, with what stands in `backquotes` as code."""
    return re.sub(r"`([^`]*)`", r"<code>\1</code>", escape(sentence))


def table(caption, columns, rows, class_="figures-of"):
    """rows are lists of HTML, the first cell of each its header. What is too wide scrolls in a box of its own."""
    head = "".join(f'<th scope="col">{c}</th>' for c in columns)
    body = "".join(f'<tr><th scope="row">{row[0]}</th>' + "".join(f"<td>{cell}</td>" for cell in row[1:]) + "</tr>\n"
                   for row in rows)
    return (f'<div class="scroll" role="region" aria-label="{escape(caption, quote=True)}" tabindex="0"><table class="{class_}">'
            f"<caption>{escape(caption)}</caption><thead><tr>{head}</tr></thead><tbody>\n{body}</tbody></table></div>")


def definitions(pairs, class_):
    return f'<dl class="{class_}">' + "".join(f"<div><dt>{escape(k)}</dt><dd>{escape(v)}</dd></div>" for k, v in pairs if v) + "</dl>"


def known(value, form=number):
    return "–" if value is None or getattr(value, "value", 0) is None else escape(form(value))


COLUMNS = (
    ("Efficiency, 1/s", "1 / (relMSE × seconds of rendering), with its 95 % interval"),
    ("Against the default", "efficiency over that of the scene's default"),
    ("To 1 % noise", "seconds of rendering until the noise, root mean square error over root mean square signal, is 1 %, extrapolated"),
    ("Samples/s", "camera paths finished per second of rendering"),
    ("Error’s power", "of seconds by which relMSE falls; −1 is what independent samples give"),
    ("Bias floor", "relMSE that more samples would not remove, with an interval; all of them together hold with 95 %. 0 if it contains that. "
     "This and the power take five numbers of samples"),
    ("Lookups", "of density, per path"),
    ("Real collisions", "per path"),
    ("Null per real", "null collisions to each real one: what loose majorants cost"),
    ("Majorant cells", "steps through the majorant grid that were no collision, per path"),
    ("Shadow rays", "tracked ones, per path"),
    ("Lane use", "share of lanes that had work in an iteration of a pass"),
    ("Set-up", "reading, uploading and compiling, before the first sample; in none of the other columns"))


def estimator_row(bench, e, swatch):
    real, null = e.per_path.get("realCollisions"), e.per_path.get("nullCollisions")
    notes = [n for n, holds in (("default", e.is_default), ("biased", e.biased)) if holds]
    name = swatch(e.name) + f"<code>{escape(e.name)}</code>" + "".join(f" <small>{n}</small>" for n in notes)
    against = bench.ratio(e, bench.default) if bench.default and e is not bench.default else None
    slope, floor = (e.slope, e.floor) if e.judged_by_points else (Interval(None), Interval(None))
    if floor.low is not None and floor.low <= 0:
        floor = Interval(0.0)
    lanes = ", ".join(f"{k} {number(100 * v)} %" for k, v in e.lane_use.items())
    name += f" <small>= {escape(', '.join(e.same_as))}</small>" if e.same_as else ""
    efficiency = e.efficiency if e.judged else Interval(None)
    return [name, known(efficiency, str), "1" if e.is_default and e.judged else known(against, str), known(e.seconds_to_one_percent, duration),
            known(e.samples_per_second), known(slope, str), known(floor, str),
            known(e.per_path.get("lookups")), known(real), known(null / real if real and null is not None else None),
            known(e.per_path.get("majorantCells")), known(e.per_path.get("shadowRays")), escape(lanes) or "–",
            known(setup_seconds(e.setup), duration)]


def estimator_table(bench, swatch):
    order = sorted(bench.estimators, key=lambda e: (bool(e.biased), -(e.efficiency.value or 0)))
    legend = "".join(f"<div><dt>{name}</dt><dd>{escape(what)}</dd></div>" for name, what in COLUMNS)
    return (table(f"{bench.name}: what was measured", ["Estimator"] + [name for name, _ in COLUMNS],
                  [estimator_row(bench, e, swatch) for e in order])
            + f'<details><summary>What the columns mean</summary><dl class="facts">{legend}</dl></details>')
