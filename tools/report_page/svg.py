"""Elements of SVG as text, scales, and the frame of a plot. Colours are the style sheet's, so that they follow the page."""
import math
from html import escape

from .interval import count, power_of_ten

WIDTH = 420  # of all plots, in their own units; the page shows these as 320 to 560 pixels, so that text stays legible


def element(tag, content="", **attributes):
    """Attributes with a value of None are left out; class_ and hyphens as in stroke_width are written as SVG has them."""
    written = "".join(f' {key.rstrip("_").replace("_", "-")}="{escape(shorten(value), quote=True)}"'
                      for key, value in attributes.items() if value is not None)
    return f"<{tag}{written}>{content}</{tag}>" if content else f"<{tag}{written} />"


def shorten(value):
    return f"{value:.2f}".rstrip("0").rstrip(".") if isinstance(value, float) else str(value)


def line(x1, y1, x2, y2, class_):
    return element("line", x1=float(x1), y1=float(y1), x2=float(x2), y2=float(y2), class_=class_)


def text(x, y, content, class_=None, anchor=None):
    return element("text", escape(content), x=float(x), y=float(y), class_=class_, text_anchor=anchor)


def group(content, title="", class_=None):
    """A title is what a pointer that rests there, and a screen reader, are told."""
    return element("g", (element("title", escape(title)) if title else "") + content, class_=class_)


def mark(shape, x, y, size=4.0, class_=None):
    def path(*points):
        d = "M" + " L".join(f"{shorten(float(x + px * size))} {shorten(float(y + py * size))}" for px, py in points) + " Z"
        return element("path", d=d, class_=class_)
    if shape == "circle":
        return element("circle", cx=float(x), cy=float(y), r=size, class_=class_)
    if shape == "square":
        return path((-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9))
    if shape == "triangle":
        return path((0, -1.2), (1.15, 0.9), (-1.15, 0.9))
    if shape == "wedge":
        return path((0, 1.2), (1.15, -0.9), (-1.15, -0.9))
    if shape == "diamond":
        return path((0, -1.35), (1.2, 0), (0, 1.35), (-1.2, 0))
    if shape == "bar":
        return path((-1.3, -0.5), (1.3, -0.5), (1.3, 0.5), (-1.3, 0.5))
    a, b = 1.2, 0.45  # cross
    return path((-b, -a), (b, -a), (b, -b), (a, -b), (a, b), (b, b), (b, a), (-b, a), (-b, b), (-a, b), (-a, -b), (-b, -b))


def drawing(content, height, label):
    return element("svg", content, viewBox=f"0 0 {WIDTH} {shorten(float(height))}", role="img", aria_label=label, class_="plot")


class LogScale:
    def __init__(self, values, start, end):
        self.low, self.high = math.log10(min(values)), math.log10(max(values))
        room = max(0.05 * (self.high - self.low), 0.08)
        self.low, self.high = self.low - room, self.high + room
        self.start, self.end = start, end

    def __call__(self, value):
        return self.start + (self.end - self.start) * (math.log10(value) - self.low) / (self.high - self.low)

    def holds(self, value):
        return self.low <= math.log10(value) <= self.high

    def ticks(self):
        """[(value, label)]: decades, with 2 and 5 between them where there are few, and only every n-th where many."""
        decades = range(math.floor(self.low), math.ceil(self.high) + 1)
        inside = [d for d in decades if self.low <= d <= self.high]
        if len(inside) >= 3:
            step = -(-len(inside) // 6)
            return [(10.0**d, tick_label(10.0**d)) for d in inside if d % step == 0]
        steps = [m * 10.0**d for d in decades for m in (1, 2, 5) if self.holds(m * 10.0**d)]
        if len(steps) > 6:
            steps = [m * 10.0**d for d in decades for m in (1, 3) if self.holds(m * 10.0**d)]
        if len(steps) < 2:
            steps = [m * 10.0**d for d in decades for m in range(1, 10) if self.holds(m * 10.0**d)]
        return [(v, tick_label(v)) for v in steps]


def tick_label(value):
    """Of a number with one digit that is not 0."""
    decade = math.floor(math.log10(value) + 1e-9)
    if -4 < decade < 4:
        return count(value) if decade >= 0 else f"{value:.{-decade}f}"
    digit = round(value / 10.0**decade)
    return power_of_ten(decade) if digit == 1 else f"{digit} × {power_of_ten(decade)}"


class Frame:
    """Axes of a log-log plot."""
    LEFT, RIGHT, TOP, BOTTOM = 48, 8, 22, 40

    def __init__(self, xs, ys, x_label, y_label, height=300):
        self.height = height
        self.x = LogScale(xs, self.LEFT, WIDTH - self.RIGHT)
        self.y = LogScale(ys, height - self.BOTTOM, self.TOP)
        self.parts = []
        left, right, bottom = self.LEFT, WIDTH - self.RIGHT, height - self.BOTTOM
        for value, written in self.x.ticks():
            self.parts += [line(self.x(value), self.TOP, self.x(value), bottom, "grid"),
                           text(self.x(value), bottom + 16, written, "tick", "middle")]
        for value, written in self.y.ticks():
            self.parts += [line(left, self.y(value), right, self.y(value), "grid"),
                           text(left - 6, self.y(value) + 4, written, "tick", "end")]
        self.parts += [line(left, bottom, right, bottom, "axis"), line(left, self.TOP, left, bottom, "axis"),
                       text((left + right) / 2, height - 6, x_label, "label", "middle"), text(2, 12, y_label, "label")]

    def power(self, x, y, exponent, class_, x_low=None, x_high=None):
        """The straight line y (X / x)^exponent, as far as it lies in the frame."""
        lows = [self.x.low if x_low is None else math.log10(x_low)]
        highs = [self.x.high if x_high is None else math.log10(x_high)]
        if exponent:
            ends = sorted(math.log10(x) + (bound - math.log10(y)) / exponent for bound in (self.y.low, self.y.high))
            lows.append(ends[0])
            highs.append(ends[1])
        a, b = max(lows), min(highs)
        if a >= b:
            return ""
        return line(*(c for e in (a, b) for c in (self.x(10**e), self.y(y * (10**e / x) ** exponent))), class_)

    def inside_y(self, value):
        """A height for a bar's end that may lie outside, or at no logarithm at all."""
        if value <= 0:
            return self.y.start
        return min(max(self.y(value), self.y.end), self.y.start)

    def drawing(self, content, label_):
        return drawing("".join(self.parts) + content, self.height, label_)
