"""One colour and one shape for each estimator, the same in all plots of a page, and on every page as far as colours go round.

The colours are told apart with every kind of colour vision, stand out from the page by 3 to 1 in light and in dark mode
(tests/tools/report_test.py computes both), and never stand alone: shapes and names say the same.
"""

# Each has its colour; what else is measured takes the next free place.
KNOWN = ("deltaTracking", "ratioTracking", "ratioNEE", "deltaTrackingNEE", "residualRatioTracking", "weightedTracking",
         "decompositionTracking", "spectralTracking", "unbiasedRayMarching", "regularTracking", "rayMarching",
         "adaptiveRayMarching", "densitySampling", "homogeneousRayMarcherNEE", "homogeneousRayMarcherImproved",
         "heterogeneousPerlinNoise", "nanoVDBSimple", "nanoVDBEmission", "lightTracing", "bidirectional",
         "cachedRatioTracking")

LIGHT = ("#2780f2", "#8d3601", "#199c55", "#bc55ae", "#a78e11", "#2c0c92", "#6c6c6c", "#4e121e")
DARK = ("#1cbcfd", "#e38928", "#57f796", "#9d6994", "#fbe405", "#5161de", "#eeeeee", "#d63c4e")
PASSES_LIGHT = ("#538bf5", "#082d5a", "#d17414", "#450591", "#34724b")
PASSES_DARK = ("#3c79f0", "#75c8fc", "#f69200", "#876094", "#3c7145")
SHAPES = ("circle", "square", "triangle", "diamond", "cross", "wedge", "bar")


class Palette:
    """An estimator's own place decides its colour; if another of this page has it, the next free colour does."""

    def __init__(self, names):
        self.places, self.colours = {}, {}
        for name in sorted(dict.fromkeys(names), key=lambda n: KNOWN.index(n) if n in KNOWN else len(KNOWN)):
            free = len(KNOWN) + sum(n not in KNOWN for n in self.places)
            self.places[name] = KNOWN.index(name) if name in KNOWN else free
            wanted = [(self.places[name] + i) % len(LIGHT) for i in range(len(LIGHT))]
            self.colours[name] = next((c for c in wanted if c not in self.colours.values()), wanted[0])

    def colour(self, name):
        """A class of the style sheet."""
        return f"e{self.colours[name]}"

    def shape(self, name):
        return SHAPES[self.places[name] % len(SHAPES)]


def style_variables():
    def rules(estimators, passes):
        named = [(f"e{i}", c) for i, c in enumerate(estimators)] + [(f"p{i}", c) for i, c in enumerate(passes)]
        return " ".join(f"--{name}: {colour};" for name, colour in named)
    classes = " ".join(f".{n} {{ --own: var(--{n}); }}" for n in
                       [f"e{i}" for i in range(len(LIGHT))] + [f"p{i}" for i in range(len(PASSES_LIGHT))])
    return (f":root {{ {rules(LIGHT, PASSES_LIGHT)} }}\n@media (prefers-color-scheme: dark) {{ :root "
            f"{{ {rules(DARK, PASSES_DARK)} }} }}\n{classes}")
