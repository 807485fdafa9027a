"""The colour of a black body in linear Rec.709: Planck's law seen by the CIE 1931 observer, as vkvol has it."""
import pathlib
import sys

import numpy as np

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
from cie_1931 import observer

C2 = 1.438776877e7  # h c / k, in nm K
REC709 = np.array([[3.2404542, -1.5371385, -0.4985314],
                   [-0.9692660, 1.8760108, 0.0415560],
                   [0.0556434, -0.2040259, 1.0572252]])


def rgb(kelvin):
    """Of luminance 1, but for what Rec.709 cannot show, which is clipped at 0."""
    nm = np.arange(360.25, 830.0, 0.5)
    planck = 1e15 / (nm ** 5 * np.expm1(C2 / (nm * kelvin)))
    xyz = planck @ np.array([observer(each) for each in nm])
    return np.maximum(REC709 @ (xyz / xyz[1]), 0.0)
