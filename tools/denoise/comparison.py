"""In words and a table: error before and after, and what the time would have bought otherwise."""
import re

import numpy as np

import judge

GOOD_ENOUGH = 0.1  # a reference's own error, of what is measured by it


def percent(share):
    return f"{100 * share:.2g} %"


def seconds_text(seconds):
    return f"{seconds:.3g} s" if seconds < 120 else f"{seconds / 60:.3g} min"


def ranges_of(picture):
    """[(seed, first sample, one past the last)] that the file says it holds."""
    merged = re.findall(r"(\d+):(\d+)-(\d+)", picture.text("vkvol/ranges"))
    if merged:
        return [tuple(map(int, each)) for each in merged]
    seed, first, count = picture.text("vkvol/seed"), picture.number("vkvol/sampleOffset"), picture.number("samplesPerPixel")
    return [(int(seed), first, first + count)] if seed.isdecimal() and None not in (first, count) else []


def share_samples(a, b):
    return any(seed == other and first < last_b and first_b < last
               for seed, first, last in ranges_of(a) for other, first_b, last_b in ranges_of(b))


def doubts(noisy, reference, own, measured):
    """What makes the reference a bad judge; own and measured are relMSE."""
    if share_samples(noisy, reference):
        yield "the reference shares samples with the noisy picture, so that every figure here is wrong: give it another --seed"
    scenes = {picture.text("vkvol/sceneHash") for picture in (noisy, reference)} - {""}
    if len(scenes) > 1:
        yield "the reference is of another scene, or another bias (vkvol/sceneHash)"
    if reference.text("vkvol/biased"):
        yield f"the reference is biased: {reference.text('vkvol/biased')}"
    if own > GOOD_ENOUGH * max(measured, 0.0):
        yield ("the reference's own noise is more than a tenth of the denoised picture's error: it is subtracted, but more "
               "samples would tell more")


def row(name, error):
    return f"{name:<20}{error.relmse:>11.3g}{error.rmse:>11.3g}"


def longer(before, after, spent):
    """How long rendering would have taken for this error; noise falls as 1 / time."""
    if after <= 0 or before <= 0:
        return "unknown: the reference is too noisy"
    factor = before / after
    return f"{factor:.3g} times the samples" + ("" if spent is None else f", {seconds_text(factor * spent)}")


def harm_lines(noisy, denoised, reference, variance):
    own = noisy.stack("variance.")
    if own is None:
        return ["Where it did harm is not known: the noisy picture has no variance."]
    noise = judge.noise_between(own, noisy.channels.get("samples"), variance, reference.channels.get("samples"))
    harm = judge.harm_of(noisy.stack(), denoised, reference.stack(), noise)
    among = {"all pixels": harm.visible, "had no noise at all": harm.even, "of the steepest tenth (edges)": harm.edges,
             "of the brightest tenth": harm.bright, "of those in neither": harm.rest}
    return [f"Further off than before, and by more than 2 standard errors of noise: {percent(harm.worse)} of the pixels; "
            f"by more than {percent(judge.VISIBLE)} as well:", *(f"  {name:<32}{percent(share)}" for name, share in among.items())]


def mean_line(noisy, denoised):
    """Of the picture, channel by channel: what keeps it, keeps the energy."""
    before, own = noisy.stack(), noisy.stack("variance.")
    means, pixels = before.mean(axis=(0, 1)), before.shape[0] * before.shape[1]
    change = denoised.mean(axis=(0, 1)) - means
    parts = ", ".join(f"{100 * c / m:+.2g} %" if m > 0 else "?" for c, m in zip(change, means))
    text = f"The picture's mean (red, green, blue) changed by {parts}"
    if own is None or not own.any():
        return text + "."
    variance = own.sum(axis=(0, 1))
    if noisy.number("vkvol/correlated"):  # pixels that share samples, as particles' do: their sum has a variance of its own, if any
        words = noisy.text("vkvol/sumVariance").split()
        if len(words) != 3:
            return text + "."
        variance = np.array([float(word) for word in words])
    errors = np.sqrt(variance) / pixels
    in_errors = ", ".join(f"{abs(c) / e:.2g}" if e > 0 else "?" for c, e in zip(change, errors))
    return f"{text}: {in_errors} standard errors of the noisy one's."


def comparison_lines(noisy, denoised, reference, seconds):
    """noisy, reference: files read; denoised: [row, column, channel]; seconds that the denoiser took."""
    truth, variance = reference.stack(), reference.stack("variance.")
    known = variance is not None
    variance = variance if known else np.zeros_like(truth)
    before, after = (judge.error_of(picture, truth, variance) for picture in (noisy.stack(), denoised))
    own, spent = judge.own_relmse(truth, variance), noisy.number("renderTimeSeconds")
    yield f"{'':<20}{'relMSE':>11}{'RMSE':>11}"
    samples = noisy.number("samplesPerPixel")
    yield row("noisy" if samples is None else f"noisy, {samples} spp", before)
    yield row("denoised", after)
    yield (f"{'reference itself':<20}{own:>11.3g}{judge.error_of(truth, truth, -variance).rmse:>11.3g}   subtracted above"
           if known else "The reference has no variance: its own noise counts as error above.")
    yield (f"Rendering took {'a time that the file does not tell' if spent is None else seconds_text(spent)}, denoising "
           f"{seconds_text(seconds)}. Rendering alone, to the denoised picture's")
    yield f"  relMSE: {longer(before.relmse, after.relmse, spent)}"
    yield f"  RMSE:   {longer(before.mse, after.mse, spent)}"
    yield from harm_lines(noisy, denoised, reference, variance)
    yield mean_line(noisy, denoised)
    for doubt in doubts(noisy, reference, own, after.relmse):
        yield f"Note: {doubt}."
