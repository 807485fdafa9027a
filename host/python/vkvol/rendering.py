"""Rendering: at one go, or samples as wanted."""

from __future__ import annotations

import json
import sys
import warnings
from pathlib import Path
from typing import Any, Callable, Collection, Optional, Sequence, Union

from . import _vkvol
from .picture import Picture
from .scene import Grids, Scene, StrPath

Progress = Callable[[float, Optional[float]], object]
SCHEDULES = ("auto", "fused", "staged")


class SceneWarning(UserWarning):
    """What a scene asks for and does not get."""


class Session:
    """A render whose samples are taken as they are wanted. The bits of its picture depend on scene, seed and samples alone.

    scene: a Scene, or the name of a file as for Scene.from_file.
    spp: samples per pixel in place of the scene's.
    seed: another one gives another, independent noise.
    sample_offset: the number of the first sample.
    time: seconds after which a call of render() ends.
    noise: it ends as well once Picture.noise is no more than this; looked at when samples are a power of two.
    width, height: the same view in as many pixels; of one of them alone the other follows.
    crop: (x0, x1, y0, y1), the part of the picture to render; x1 and y1 excluded.
    integrator: "ratioTracking:flight=weighted", say, in place of the scene's; see integrators().
    aov: names of layers, such as ["direct", "depth"].
    alpha: leave out what is behind the media, for compositing.
    frame: move the camera so that the media fill the picture.
    grid: a density file in place of the scene's.
    device: "auto", a number, UUID or part of a name of devices(), "0,1" for several, or "cpu".
    schedule: "auto", "fused" or "staged".
    validate: under the Vulkan validation layer, whose objections are errors.
    strict: what of a pbrt scene cannot be rendered is an error; so is a picture for which something was cut short.
    progress: called now and then, progress(samples, noise), on the thread that renders; noise may be None. What it
        raises ends the render. It cannot use sessions of the device that renders: RenderError.

    Sessions of one device take turns, in whatever threads they are. Python runs on while one renders, and Ctrl-C ends it;
    a session goes on after that as if nothing had been, but where paths under way took more than five seconds to end:
    they are abandoned then, and render() raises RenderError. (After os.fork() a session, and its
    device, are the parent's: in the other process both raise RenderError. Take multiprocessing's "spawn".)
    """

    def __init__(self, scene: Union[Scene, StrPath], *, spp: Optional[int] = None, seed: int = 0, sample_offset: int = 0,
                 time: Optional[float] = None, noise: Optional[float] = None, width: Optional[int] = None,
                 height: Optional[int] = None, crop: Optional[Sequence[int]] = None, integrator: Optional[str] = None,
                 aov: Sequence[str] = (), alpha: bool = False, frame: bool = False, grid: Optional[StrPath] = None,
                 device: Union[str, int] = "auto", schedule: str = "auto", validate: bool = False, strict: bool = False,
                 progress: Optional[Progress] = None) -> None:
        if isinstance(scene, Grids):
            raise _vkvol.InputError("Grids are no scene; put them into one: Scene.from_dict({'densityField': grids, ...})")
        source = scene if isinstance(scene, Scene) else Scene.from_file(scene)
        options: dict[str, Any] = {"seed": _whole("seed", seed, 0, 2**32 - 1), "alpha": bool(alpha), "frame": bool(frame),
                                   "sample_offset": _whole("sample_offset", sample_offset, 0, 2**31 - 1),
                                   "device": str(device), "schedule": _one_of("schedule", schedule, SCHEDULES),
                                   "validate": bool(validate),
                                   "aov": ",".join(_one_of("aov", name, _vkvol.layer_names()) for name in _names(aov))}
        for name, value, most in (("spp", spp, 2**31 - 1), ("width", width, 65536), ("height", height, 65536)):
            if value is not None:
                options[name] = _whole(name, value, 1, most)
        if time is not None:
            options["time"] = _between("time", time, 0.0, 1e9)
        if noise is not None:
            options["noise"] = _between("noise", noise, 0.0, 1.0)
        if crop is not None:
            if not isinstance(crop, Collection) or len(crop) != 4:
                raise _vkvol.InputError(f"crop: {crop!r} is not (x0, x1, y0, y1)")
            options["crop"] = [float(_whole("crop", edge, 0, 65536)) for edge in crop]
        if integrator is not None:
            options["integrator"] = integrator
        if grid is not None:
            options["grid"] = Path(grid)
        self._strict = strict
        self._progress = progress
        self._told: set[str] = set()
        self._session = _vkvol.Session(source._source, options, strict)
        for warning in self._session.warnings:
            warnings.warn(warning, SceneWarning, stacklevel=_frames_here())

    def render(self, samples: Optional[int] = None) -> int:
        """Renders until every pixel has as many samples in all, or time or noise end it. None: as many as the scene or
        `spp` say; without `spp` time and noise alone decide, where they are there. Returns how many every pixel has."""
        return self._session.render(None if samples is None else _whole("samples", samples, 1, 2**31 - 1),
                                    self._progress)

    @property
    def samples(self) -> int:
        """That every pixel has."""
        return self._session.samples

    @property
    def assumed(self) -> str:
        """What was chosen for a density file, or a scene without a camera; else empty."""
        return self._session.assumed

    def picture(self) -> Picture:
        """As it is now, whole and its own: further samples do not change it. Raises RenderError before there are any.
        SceneWarnings, each kind once in a session, say what makes it less than it claims to be."""
        picture = Picture(self._session.picture())
        cut = {name: n for name, n in picture.report["caps"].items() if isinstance(n, int) and n}
        if self._strict and cut:
            raise _vkvol.RenderError("under strict: " + ", ".join(f"{n} {name}" for name, n in cut.items()))
        for note in picture.notes:
            _, kind = note.split(" ", 1)  # behind how many
            if kind not in self._told:
                self._told.add(kind)
                warnings.warn(note, SceneWarning, stacklevel=_frames_here())
        return picture


def render(scene: Union[Scene, StrPath], **options: Any) -> Picture:
    """The picture of a scene: all samples at one go. Options are those of Session."""
    session = Session(scene, **options)
    session.render()
    return session.picture()


def devices() -> list[dict[str, Any]]:
    """What there is to render on: name, type, driver, and whether it is usable, or why not."""
    found: list[dict[str, Any]] = json.loads(_vkvol.devices_json())
    return found


def integrators() -> list[str]:
    """Names of what there is to render with; `vkvol integrators` says what they are."""
    return _vkvol.integrator_names()


def _frames_here() -> int:
    """The caller's frame and those above it that are of this file, and one more: what calls it."""
    frame, frames = sys._getframe(1), 1
    while frame.f_back and frame.f_code.co_filename == __file__:
        frame, frames = frame.f_back, frames + 1
    return frames


def _names(value: Union[str, Sequence[str]]) -> Sequence[str]:
    if not isinstance(value, (str, Collection)):
        raise _vkvol.InputError(f"aov: {value!r} is no list of names")
    return value.replace(",", " ").split() if isinstance(value, str) else value


def _one_of(name: str, value: str, choices: Sequence[str]) -> str:
    if value not in choices:
        raise _vkvol.InputError(f"{name}: {value!r} is none of {', '.join(choices)}")
    return value


def _whole(name: str, value: Any, low: int, high: int) -> int:
    if isinstance(value, bool) or not hasattr(value, "__index__") or not low <= value.__index__() <= high:
        raise _vkvol.InputError(f"{name}: {value!r} is not a whole number from {low} to {high}")
    return int(value)


def _between(name: str, value: Any, low: float, high: float) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise _vkvol.InputError(f"{name}: {value!r} is no number") from None
    if not low < number < high:
        raise _vkvol.InputError(f"{name}: {value!r} is not between {low:g} and {high:g}")
    return number
