"""What was rendered."""

from __future__ import annotations

import json
import tempfile
from functools import cached_property
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _vkvol
from .scene import StrPath


class Picture:
    """A picture with its error. Arrays are copies, rows from top to bottom."""

    def __init__(self, picture: _vkvol.Picture) -> None:
        self._picture = picture

    @cached_property
    def mean(self) -> npt.NDArray[np.float32]:
        """Radiance, linear Rec. 709: (height, width, 3)."""
        return self._picture.mean

    @cached_property
    def variance(self) -> npt.NDArray[np.float32]:
        """Of the mean, the square of its standard error: (height, width, 3); 0 of a single sample."""
        return self._picture.variance

    @cached_property
    def samples(self) -> npt.NDArray[np.uint32]:
        """Of each pixel: (height, width). They differ if Ctrl-C or `time` ended the render, or samples were not finite."""
        return self._picture.samples

    @cached_property
    def layers(self) -> dict[str, npt.NDArray[np.float32]]:
        """What `aov` asked for, by name: (height, width, channels), or (height, width) of a single channel."""
        return self._picture.layers

    @cached_property
    def layer_variances(self) -> dict[str, npt.NDArray[np.float32]]:
        """Of the layers' means, of those for which it is known."""
        return self._picture.layer_variances

    @property
    def noise(self) -> Optional[float]:
        """Root mean square error over root mean square signal; None of a single sample, or a black picture."""
        return self._picture.noise

    @cached_property
    def report(self) -> dict[str, Any]:
        """What was done and how long it took; README.md of the sources says what is in it."""
        report: dict[str, Any] = json.loads(self._picture.report_json)
        return report

    @property
    def notes(self) -> list[str]:
        """What makes it less than it claims to be: voxels that count as 0, paths that were cut short, samples dropped."""
        return self._picture.notes

    def develop(self, tonemap: Optional[str] = None, exposure: Union[float, str, None] = None) -> npt.NDArray[np.uint8]:
        """For looking at: (height, width, 3).

        tonemap: "srgb", "aces", "agx" or "reinhard"; None: srgb, or agx of what glows.
        exposure: in stops, or "auto".
        """
        return self._picture.develop(tonemap, exposure)

    def write(self, file: StrPath, tonemap: Optional[str] = None, exposure: Union[float, str, None] = None) -> None:
        """Writes .exr, with all layers and what `vkvol merge` and `compare` need; .png; or .csv. Tone curve and exposure
        are for .png, and are noted in .exr. Never half: the file gets a temporary name first."""
        self._picture.write(Path(file), tonemap, exposure)

    def _repr_png_(self) -> bytes:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "picture.png"
            self.write(file)
            return file.read_bytes()

    def __repr__(self) -> str:
        height, width, _ = self.mean.shape
        noise = "" if self.noise is None else f", noise {100 * self.noise:.2g} %"
        most = int(self.samples.max())
        return f"<vkvol.Picture {width}x{height}, {most} sample{'' if most == 1 else 's'}{noise}>"
