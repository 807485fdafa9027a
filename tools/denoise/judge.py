"""How far two pictures are from a reference: what a denoiser removed, and where it did harm."""
from dataclasses import dataclass

import numpy as np

EPSILON = 0.01   # as of relMSE in `vkvol compare`
ROUNDING = 1e-5  # relative: what sums in float may do, likewise
VISIBLE = 0.01   # relative: about the least step of brightness that an eye sees
TENTH = 0.9


@dataclass
class Error:
    """Means over pixels and channels, less what the reference's own variance adds; by chance below 0."""
    relmse: float
    mse: float

    @property
    def rmse(self):
        return max(self.mse, 0.0) ** 0.5


def error_of(picture, reference, variance):
    """All [row, column, channel]; variance is that of the reference's mean, or 0."""
    squares = (picture - reference) ** 2 - variance
    return Error(float(np.mean(squares / (reference**2 + EPSILON))), float(np.mean(squares)))


def own_relmse(reference, variance):
    """What the reference's noise adds to relMSE of whatever is held against it."""
    return float(np.mean(variance / (reference**2 + EPSILON)))


def noise_between(variance, samples, reference_variance, reference_samples):
    """[row, column]: variance of noisy picture less reference, summed over channels; their variances are [row, column,
    channel], their samples [row, column] or None.

    Few samples may all miss a rare bright event and then underestimate their variance, so of both variances per sample
    the larger holds for both pictures, as in `vkvol compare`."""
    if samples is None or reference_samples is None:
        return (variance + reference_variance).sum(axis=2)
    n, m = (np.maximum(count.astype(float), 1)[..., None] for count in (samples, reference_samples))
    return (np.maximum(variance * n, reference_variance * m) * (1 / n + 1 / m)).sum(axis=2)


@dataclass
class Harm:
    """Shares of pixels. Worse: the denoised picture is beyond 2 standard errors of noise, and further off than before."""
    worse: float
    visible: float  # worse, and off by more than VISIBLE; what follows is of these
    even: float     # of all pixels, those that had no noise
    edges: float    # of the tenth where the reference is steepest
    bright: float   # of its brightest tenth
    rest: float     # of those in neither


def steepness(picture):
    """[row, column]: change of brightness from pixel to pixel, relative to it."""
    brightness = picture.mean(axis=2)
    down, right = np.gradient(brightness)
    return np.sqrt((down**2 + right**2) / (brightness**2 + EPSILON))


def upper_tenth(values):
    return values > np.quantile(values, TENTH)


def share(mask, among=None):
    chosen = mask if among is None else mask[among]
    return float(chosen.mean()) if chosen.size else 0.0


def harm_of(noisy, denoised, reference, noise):
    """Pictures [row, column, channel], noise as of noise_between. A pixel's error is summed over its channels."""
    before, after = (((picture - reference) ** 2).sum(axis=2) for picture in (noisy, denoised))
    least = ROUNDING**2 * (reference**2).sum(axis=2)
    worse = (after > np.maximum(4 * noise, least)) & (after > before)
    visible = worse & (after > VISIBLE**2 * (reference**2 + EPSILON).sum(axis=2))
    edges, bright = upper_tenth(steepness(reference)), upper_tenth(reference.mean(axis=2))
    return Harm(share(worse), share(visible), share(visible & (noise <= least)), share(visible, edges),
                share(visible, bright), share(visible, ~edges & ~bright))
