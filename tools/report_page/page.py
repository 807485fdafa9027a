"""Puts the page together. It is one file that needs no other, runs no script, and parses as XML."""
from html import escape
from pathlib import Path

from . import findings, plots, scaling_fit
from .choice import choose
from .contest import contest_html, findings_of as contest_findings
from .palette import PASSES_LIGHT, Palette, style_variables
from .picture import INFERNO
from .pictures import Pictures
from .svg import element, mark
from .tables import definitions, estimator_table, known, marked, table
from .interval import number, samples


def write_page(benches, contests, scalings, command):
    names = list(dict.fromkeys(x.name for x in (*benches, *contests)))
    title = ", ".join(names) or "how cost grows"
    palette = Palette([e.name for b in benches for e in b.estimators])
    sections = [scene_section(b, [c for c in contests if c.name == b.name], palette, f"scene-{i}",
                              b.name if len(names) > 1 else "In detail")
                for i, b in enumerate(benches, 1)]
    shown = {b.name for b in benches}
    sections += [contest_section(c, f"contest-{i}") for i, c in enumerate(contests, 1) if c.name not in shown]
    if scalings:
        sections.append(scaling_section(scalings))
    style = Path(__file__).with_name("style.css").read_text(encoding="utf-8")
    ramp = f".ramp .colours {{ background: linear-gradient(to right, {', '.join(INFERNO)}); }}"
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8" />
<meta name="viewport" content="width=device-width, initial-scale=1" />
<meta name="color-scheme" content="light dark" />
<title>vkvol: {escape(title)}</title>
<style>
{style_variables()}
{style}
{ramp}
</style>
</head>
<body>
<header>
<p class="eyebrow">vkvol, measured</p>
<h1>{escape(title)}</h1>
</header>
<main>
{summary(benches)}
{"".join(sections)}
<section aria-labelledby="reading">
<h2 id="reading">How to read this</h2>
{READING}
<h3>This page</h3>
<p>was made by</p>
<pre tabindex="0"><code>{escape(command)}</code></pre>
</section>
</main>
</body>
</html>
"""


READING = """<p><strong>relMSE</strong> is the mean over pixels and channels of (I − R)² / (R² + 0.01), with the reference’s own
variance taken off; its root is the relative error. <strong>Efficiency</strong> is 1 / (relMSE × seconds of rendering): twice the
efficiency is the same picture in half the time, however long one waits. Set-up is not part of it.</p>
<p>Numbers in brackets are 95 % intervals. Of twenty comparisons between equals one may therefore show a difference that is
none. Where an interval contains 1, no difference is claimed. Estimators rendered in turns, so that what else the machine
did met all of them.</p>
<p>A <strong>biased</strong> estimator’s efficiency is no promise: its error stops falling at its floor. Its bars are hollow,
and no advice is given from it.</p>"""


def summary(benches):
    if not benches:
        return ""
    items = "".join(finding_item(findings.headline(b, choose(b)), "lede") for b in benches)
    rows = []
    for i, bench in enumerate(benches, 1):
        choice = choose(bench)
        rows.append([f'<a href="#scene-{i}">{escape(bench.name)}</a>',
                     f"<code>{escape(choice.advised.name)}</code>" if choice.judged else "cannot be told",
                     f"<code>{escape(bench.default.name)}</code>" if bench.default else "not measured",
                     default_verdict(bench, choice), known(choice.gain, str) if choice.judged and choice.gain.known else "–"])
    overview = table("Scenes", ["Scene", "Use", "Its default", "Is the default the best unbiased choice?",
                                "Best against the default"], rows, "words") if len(benches) > 1 else ""
    return f'<section aria-label="Findings"><ul class="findings">{items}</ul>{overview}</section>'


def default_verdict(bench, choice):
    if not choice.judged or bench.default is None:
        return "cannot be told"
    if bench.default.biased:
        return "no: it is biased"
    if choice.advised is not bench.default:
        return "no"
    return "none is measurably better" if choice.ties else "yes"


def finding_item(finding, class_=""):
    return (f'<li class="{finding.kind.lower()} {class_}"><strong class="kind">{finding.kind}</strong> '
            f"<span>{marked(finding.text)}</span></li>")


def swatch(palette):
    def draw(name):
        shape = mark(palette.shape(name), 8, 8, 5.0, "mark")
        return element("svg", shape, viewBox="0 0 16 16", class_=f"swatch {palette.colour(name)}", aria_hidden="true")
    return draw


def legend(pairs):
    return '<ul class="legend">' + "".join(f"<li>{picture}{escape(name)}</li>" for picture, name in pairs) + "</ul>"


def figure(title, plot, caption, key=""):
    return f"<figure><h3>{title}</h3>{key}{plot}<figcaption>{caption}</figcaption></figure>" if plot else ""


def scene_section(bench, contests, palette, anchor, title):
    pictures = Pictures(bench)
    draw = swatch(palette)
    names = plots.pass_names(bench) + ["between passes"]
    classes = {name: f"p{i % len(PASSES_LIGHT)}" for i, name in enumerate(names)}
    blocks = [(element("svg", mark("square", 8, 8, 7.0, "block"), viewBox="0 0 16 16", class_=f"swatch {classes[n]}",
                       aria_hidden="true"), n) for n in names]
    figures = (figure("Error against time", plots.error_plot(bench, palette),
                      "Means over runs, with two standard errors and the range of the seconds. Dashed grey: 1/t.",
                      legend([(draw(e.name), e.name) for e in bench.estimators]))
               + figure("Efficiency", plots.efficiency_plot(bench, palette),
                        "In units of the line at 1, the scene’s default; whiskers are 95 % intervals. Hollow: biased.")
               + figure("Where the time goes", plots.cost_plot(bench, classes), "Nanoseconds per path at the largest "
                        "number of samples. Bars with a gap are cut short.", legend(blocks)))
    told = findings.findings_of(bench)[1:] + [f for c in contests for f in contest_findings(c)]
    errors = pictures.errors()  # before `missing` is read
    scene_picture = pictures.scene()
    missing = "".join(f"<li>{escape(m)}</li>" for m in pictures.missing)
    return f"""<section id="{anchor}" aria-labelledby="{anchor}-title">
<h2 id="{anchor}-title">{escape(title)}</h2>
<div class="opening">{scene_picture}
<ul class="findings">{"".join(finding_item(f) for f in told)}</ul></div>
<div class="figures">{figures}</div>
{estimator_table(bench, draw)}
{"".join(contest_html(c) for c in contests)}
{errors}
{f'<p>Pictures that are not shown:</p><ul class="missing">{missing}</ul>' if missing else ""}
<h3>Measured on</h3>
{definitions(circumstances(bench), "facts")}
<p>To measure again:</p>
<pre tabindex="0"><code>{escape(bench.command)}</code></pre>
</section>
"""


def contest_section(contest, anchor):
    """Of a scene that no vkvol bench was given of."""
    return f"""<section id="{anchor}" aria-labelledby="{anchor}-title">
<h2 id="{anchor}-title">{escape(contest.name)}</h2>
<ul class="findings">{"".join(finding_item(f) for f in contest_findings(contest))}</ul>
{contest_html(contest)}
</section>
"""


def circumstances(bench):
    reference, facts = bench.reference, dict(bench.facts)
    facts["Picture"] = f"{bench.width:.0f} × {bench.height:.0f} pixels"
    facts["Reference"] = ", ".join(part for part in (
        reference["integrator"], samples(reference['samples']) if reference["samples"] else "",
        f"relMSE {number(reference['relmse'])}" if reference["relmse"] is not None else "own error not known") if part)
    return facts.items()


def scaling_section(scalings):
    figures = []
    for series in scalings:
        law = scaling_fit.fit(series.points)
        sentence = scaling_fit.describe(series, law)
        note = f"<p>{escape(series.note)}</p>" if series.note else ""
        figures.append(f"<figure><h3>{escape(series.name)}</h3>{plots.scaling_plot(series, law, 'e0')}<figcaption>"
                       f'<p class="said">{marked(sentence)}</p>{note}<pre tabindex="0"><code>{escape(series.command)}</code></pre>'
                       "</figcaption></figure>")
    return (f'<section aria-labelledby="scaling"><h2 id="scaling">How cost grows</h2><p>Medians of alternating runs, with their '
            "range; the line is the fitted power, dashed grey the power 1 (or −1 where cost falls). Brackets: 95 % intervals of "
            f'the fit.</p><div class="figures">{"".join(figures)}</div></section>')
