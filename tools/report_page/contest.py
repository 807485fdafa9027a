"""vkvol and other renderers on one scene, taking turns: what NAME.peer.json holds, and what it says."""
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Optional

from .findings import CAUTION, NOTE, Finding
from .interval import Interval, duration, number, quotient
from .json_file import load
from .measurements import read_facts, setup_seconds
from .tables import definitions, known, table


@dataclass
class Entrant:
    name: str
    is_ours: bool
    biased: str
    efficiency: Interval
    samples_per_second: Optional[float]
    setup: dict
    mean_ratio: list
    z: list
    same: Optional[bool]
    reason: str


@dataclass
class Contest:
    file: str
    scene: str
    command: str
    facts: dict
    entrants: list
    ranking: dict

    @property
    def name(self):
        return Path(self.scene).stem

    @property
    def ours(self):
        return next((e for e in self.entrants if e.is_ours), None)

    @property
    def peers(self):
        return [e for e in self.entrants if not e.is_ours]

    def ratio(self, entrant):
        """The entrant's efficiency over ours. The file's own, which knows what runs share, where it has one."""
        found = self.ranking.get(entrant.name, Interval(None))
        return found if found.known else quotient(entrant.efficiency, self.ours.efficiency)


def read_entrant(node):
    agreement = node.object("agreement", None)
    return Entrant(node.text("renderer"), node.truth("isDefault"), node.text("biased"), node.interval("efficiency"),
                   node.number("samplesPerSecond"), node.numbers("setupSeconds"), agreement.get("meanRatio", (list,), "a list", None) or [],
                   agreement.get("z", (list,), "a list", None) or [], agreement.get("same", (bool,), "true or false", None),
                   agreement.text("reason", ""))


def read_contest(file):
    root = load(file, "vkvol-peer", "write it anew with the tool that runs the other renderers")
    contest = Contest(file, root.text("scene"), root.text("command"), read_facts(root),
                      [read_entrant(node) for node in root.objects("estimators")],
                      {node.text("renderer"): node.interval("efficiencyRatioToDefault") for node in root.objects("ranking")})
    if contest.ours is None:
        root.fail("estimators", "has none whose isDefault is true, which the others are compared with")
    return contest


def findings_of(contest):
    return [finding(contest, peer) for peer in contest.peers]


def finding(contest, peer):
    scene, ours, ratio = contest.name, contest.ours.name, contest.ratio(peer).inverse()
    if peer.same is not True:
        verdict = "renders another picture" if peer.same is False else "was not compared pixel by pixel"
        return Finding(CAUTION, f"{peer.name} {verdict} of {scene}: its efficiency is no measure of the same work.")
    if not ratio.bounded:
        return Finding(NOTE, f"{peer.name} renders the same picture of {scene}; too few runs to compare its speed.")
    if not ratio.excludes(1):
        return Finding(NOTE, f"{peer.name} renders the same picture of {scene}; no measurable difference in efficiency ({ours} has "
                             f"{ratio} times its efficiency).")
    return Finding(NOTE, f"{peer.name} renders the same picture of {scene}; {ours} has {ratio} times its efficiency.")


def verdict(entrant):
    if entrant.is_ours:
        return "–"
    return {True: "same picture", False: "another picture", None: "not compared"}[entrant.same]


def row(contest, e):
    comparable = e.is_ours or e.same is True
    means = ", ".join(f"{m:.4f}" for m in e.mean_ratio if m is not None)
    worst = max((abs(z) for z in e.z if z is not None), default=None)
    return [escape(e.name) + (" <small>biased</small>" if e.biased else ""), verdict(e),
            "1" if e.is_ours else known(contest.ratio(e) if comparable else None, str), known(e.efficiency, str),
            known(e.samples_per_second), known(setup_seconds(e.setup), duration),
            means or "–", known(worst)]


def contest_html(contest):
    compared = table(f"{contest.name}: other renderers", [
        "Renderer", "Agreement", "Efficiency against vkvol", "Efficiency, 1/s", "Samples/s", "Set-up", "Mean over vkvol’s (R, G, B)",
        "Largest z of the means"], [row(contest, e) for e in contest.entrants])
    reasons = "".join(f"<li>{escape(e.name)}: {verdict(e)}, {escape(e.reason)}</li>" for e in contest.peers if e.reason)
    return (compared + (f'<ul class="missing">{reasons}</ul>' if reasons else "")
            + "<details><summary>Where and how the renderers were compared</summary>"
            + definitions(contest.facts.items(), "facts")
            + f'<pre tabindex="0"><code>{escape(contest.command)}</code></pre></details>')
