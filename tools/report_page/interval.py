"""A measured number with its 95 % interval, and how such numbers are compared and written."""
import math
from dataclasses import dataclass
from typing import Optional

DIGITS = 3  # of all that is printed


@dataclass(frozen=True)
class Interval:
    value: Optional[float]
    low: Optional[float] = None
    high: Optional[float] = None

    @property
    def known(self):
        return self.value is not None and self.value > 0

    @property
    def bounded(self):
        return self.known and self.low is not None and self.high is not None

    def excludes(self, number):
        """Judged as printed, ends rounded outward: what the reader sees must bear out what the sentence claims."""
        if not self.bounded:
            return False
        return rounded(self.low, math.floor) > number or rounded(self.high, math.ceil) < number

    def inverse(self):
        def invert(x):
            return None if not x or x < 0 else 1 / x
        return Interval(invert(self.value), invert(self.high), invert(self.low))

    def __str__(self):
        if self.value is None:
            return "unknown"
        if self.low is None or self.high is None:
            return number(self.value)
        return f"{number(self.value)} [{number(self.low, math.floor)}, {number(self.high, math.ceil)}]"


def quotient(a, b):
    """a / b of independent positive numbers. Logarithms are subtracted, and half-widths add as squares on either side."""
    if not (a.known and b.known):
        return Interval(None)
    value = a.value / b.value
    if not (a.bounded and b.bounded) or min(a.low, b.low) <= 0:
        return Interval(value)
    down = math.hypot(math.log(a.value / a.low), math.log(b.high / b.value))
    up = math.hypot(math.log(a.high / a.value), math.log(b.value / b.low))
    return Interval(value, value * math.exp(-down), value * math.exp(up))


def rounded(x, direction=round):
    """To DIGITS digits; direction may be math.floor or math.ceil."""
    if x == 0 or not math.isfinite(x):
        return x
    place = DIGITS - 1 - math.floor(math.log10(abs(x)))
    scaled = x * 10.0**place
    if abs(scaled - round(scaled)) < 1e-9 * abs(scaled):  # 1.1 is not to become 1.11 for the last bit of its product
        direction = round
    return float(f"{direction(scaled)}e{-place}")


SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def power_of_ten(exponent):
    return "10" + str(exponent).translate(SUPERSCRIPTS)


def number(x, direction=round):
    """As people write it: 12,300, 1.84, 0.0231, 4.1 × 10⁻⁶."""
    if x is None:
        return "unknown"
    x = rounded(x, direction)
    if x == 0:
        return "0"
    exponent = math.floor(math.log10(abs(x)))
    if -4 < exponent < 7:
        text = f"{x:,.{max(0, DIGITS - 1 - exponent)}f}"
        return text.replace("-", "−")
    return f"{x / 10.0**exponent:.{DIGITS - 1}f} × {power_of_ten(exponent)}".replace("-", "−")


def count(x):
    """Whole numbers in full: samples, pixels, cores."""
    return f"{x:,.0f}" if x is not None and x == round(x) and abs(x) < 1e7 else number(x)


def samples(n):
    return f"{count(n)} sample" + ("" if n == 1 else "s")


def percent(fraction):
    return f"{number(100 * fraction)}\u00a0%"


def duration(seconds):
    if seconds is None:
        return "unknown"
    for size, unit in ((86400, "d"), (3600, "h"), (60, "min")):
        if seconds >= 2 * size:
            return f"{number(seconds / size)}\u00a0{unit}"
    return f"{number(seconds)}\u00a0s" if seconds >= 0.1 or seconds == 0 else f"{number(1000 * seconds)}\u00a0ms"
