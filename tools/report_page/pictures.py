"""The pictures of a scene: what it looks like, and each estimator's error."""
from html import escape
from pathlib import Path

from .exr import BadPicture, read_exr
from .interval import duration, number, samples
from .picture import displayed, error_picture


def find(name, bench):
    """A picture beside its file of measurements, or where the path says."""
    beside = bench.file.parent
    for candidate in (beside / name, beside / Path(name).name, Path(name)):
        if candidate.is_file():
            return candidate
    raise BadPicture(f"{name} is not to be found, neither as it is written nor beside {bench.file.name}")


class Pictures:
    """Those of one scene that are there. What is not is said in `missing`, and the page does without."""

    def __init__(self, bench):
        self.bench, self.missing, self.renders = bench, [], {}
        self.reference = self.read(bench.reference["file"])
        for estimator in bench.estimators:
            render = self.read(estimator.image)
            if render is not None:
                self.renders[estimator.name] = render

    def read(self, name):
        if not name:
            return None
        try:
            return read_exr(find(name, self.bench))
        except BadPicture as error:
            self.missing.append(str(error))
            return None

    def scene(self):
        """The reference, or else what the default made, or else nothing."""
        bench, by, linear = self.bench, bench_reference(self.bench), self.reference
        if linear is None and self.renders:
            first = bench.default.name if bench.default and bench.default.name in self.renders else next(iter(self.renders))
            by, linear = f"as {first} rendered it", self.renders[first]
        if linear is None:
            return ""
        return (f'<figure class="picture"><img src="{displayed(linear)}" width="{linear.shape[1]}" height="{linear.shape[0]}" '
                f'alt="The scene {escape(bench.name, quote=True)}, {escape(by, quote=True)}" />'
                f"<figcaption>{escape(bench.name)}, {escape(by)}</figcaption></figure>")

    def errors(self):
        if self.reference is None or not self.renders:
            return ""
        figures = []
        for estimator in self.bench.estimators:
            render = self.renders.get(estimator.name)
            if render is None:
                continue
            if render.shape != self.reference.shape:
                self.missing.append(f"{estimator.image} has another size than the reference")
                continue
            uri, relmse = error_picture(render, self.reference)
            point, name = estimator.longest, escape(estimator.name, quote=True)
            spent = f", {samples(point.samples)} in {duration(point.seconds)}" if point else ""
            figures.append(f'<figure><img src="{uri}" width="{render.shape[1]}" height="{render.shape[0]}" loading="lazy" '
                           f'alt="Relative error of each pixel of {name}; relMSE {number(relmse)}" />'
                           f"<figcaption><code>{name}</code>{spent}; relMSE of this picture {number(relmse)}</figcaption></figure>")
        return ('<h3>Where the error is</h3><p>Each pixel’s relative difference from the reference, its noise included.</p>'
                '<div class="ramp"><span>0.1 % or less</span><span class="colours" role="presentation"></span>'
                f'<span>100 % or more</span></div><div class="errors">{"".join(figures)}</div>') if figures else ""


def bench_reference(bench):
    number_of = bench.reference["samples"]
    return (f"the reference by {bench.reference['integrator'] or 'an unnamed estimator'}"
            + (f", {samples(number_of)}" if number_of else ""))
