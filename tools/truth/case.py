"""A published case: one scene whose readings, scaled, are figures that others have printed."""

from dataclasses import dataclass, field


@dataclass
class Case:
    name: str  # of the group that it is judged in
    what: str  # the quantity
    source: str  # whose figures they are
    scene: str  # elements between <options> and </options>; {spp} aside
    labels: list  # of the readings: columns of the picture, whose rows are the same again, for a device has more than one lane
    published: list  # numbers, one a reading
    slack: list  # of each, one standard deviation of what the print leaves out: rounding, or the scatter of a consensus;
    # none: of neighbours, see judge.py
    scale: float = 1.0  # readings times this are in the figures' unit
    less: list = field(default_factory=list)  # taken from the readings after that: what the figures leave out, known exactly
    mean: tuple = ()  # published mean over the readings and its slack; or nothing
    samples: int = 1 << 10  # of a reading, to begin with
    least: float = 0.0  # standard errors that do, as a share of the figures' mean
    is_map: bool = False  # rows of the picture are readings too, in their order
    others: list = field(default_factory=list)  # scenes besides; the mean of all is read
    judged: bool = True  # or only shown, since the figures are of something a little different


def digits(last):
    """Slack of a figure that is rounded to `last`, a standard deviation of what that has taken away."""
    return last / 12**0.5
