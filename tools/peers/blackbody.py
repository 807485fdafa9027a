"""The colour of a black body in linear Rec.709: Planck's law seen by the CIE 1931 observer, as vkvol has it."""
import numpy as np

C2 = 1.438776877e7  # h c / k, in nm K
# Wyman, Sloan and Shirley, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions", 2013: height, centre,
# and slopes below and above it, in nm.
LOBES = (((1.056, 599.8, 0.0264, 0.0323), (0.362, 442.0, 0.0624, 0.0374), (-0.065, 501.1, 0.0490, 0.0382)),
         ((0.821, 568.8, 0.0213, 0.0247), (0.286, 530.9, 0.0613, 0.0322)),
         ((1.217, 437.0, 0.0845, 0.0278), (0.681, 459.0, 0.0385, 0.0725)))
REC709 = np.array([[3.2404542, -1.5371385, -0.4985314],
                   [-0.9692660, 1.8760108, 0.0415560],
                   [0.0556434, -0.2040259, 1.0572252]])


def rgb(kelvin):
    """Of luminance 1, but for what Rec.709 cannot show, which is clipped at 0."""
    nm = np.arange(360.0, 831.0, 2.0)
    planck = 1e15 / (nm ** 5 * np.expm1(C2 / (nm * kelvin)))

    def seen(lobes):
        return sum(height * np.exp(-0.5 * ((nm - centre) * np.where(nm < centre, below, above)) ** 2)
                   for height, centre, below, above in lobes)
    xyz = np.array([np.sum(planck * seen(lobes)) for lobes in LOBES])
    return np.maximum(REC709 @ (xyz / xyz[1]), 0.0)
