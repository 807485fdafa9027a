"""Readings over published curves."""

import html


def write(path, verdicts):
    import matplotlib

    matplotlib.use("svg")
    from io import StringIO

    import matplotlib.pyplot as plt

    parts = ["<!doctype html><meta charset=utf-8><title>Published results</title><style>body{font:15px sans-serif;max-width:60em;"
             "margin:2em auto;padding:0 1em}</style><h1>Published results of radiative transfer</h1>"]
    by_case = {}
    for verdict in verdicts:
        if verdict.label != "mean":
            by_case.setdefault(id(verdict.case), []).append(verdict)
    for rows in by_case.values():
        if len(rows) < 8:
            continue
        case = rows[0].case
        figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(8, 5), height_ratios=(3, 1))
        places = range(1, len(rows) + 1)
        above.plot(places, [v.published for v in rows], color="black", linewidth=1, label=case.source)
        above.errorbar(places, [v.reading for v in rows], [v.error for v in rows], fmt=".", label="vkvol")
        above.set_ylabel(case.what)
        above.legend()
        below.bar(places, [v.z for v in rows])
        below.set_ylabel("z")
        text = StringIO()
        figure.savefig(text, format="svg")
        plt.close(figure)
        svg = text.getvalue()
        parts.append(f"<h2>{html.escape(case.name)}: {html.escape(case.what)}</h2>{svg[svg.index('<svg'):]}")
    path.write_text("".join(parts))
