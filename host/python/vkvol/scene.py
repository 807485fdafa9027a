"""What is rendered: scenes from files, texts and dicts, and grids from arrays."""

from __future__ import annotations

import os
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any, Mapping, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import _vkvol

StrPath = Union[str, "os.PathLike[str]"]
MEMORY = "in-memory-{}.nvdb"  # what the grids of a dict are called in its scene file


class Grids:
    """Density fields from arrays, in the place of an .nvdb file; all of them have one transform.

    density, or any other name by which a scene asks for a grid (`temperature`, ...): arrays of shape (nx, ny, nz), the
    first axis along x, as OpenVDB has them; with a fourth axis of 3 for colours. They are kept as float32; 0 takes no
    memory.
    voxel_size: the edge of a voxel in world units, or its edges along x, y and z.
    origin: where the middle of voxel (0, 0, 0) is, in world units.

    Raises InputError for arrays of another shape.
    """

    def __init__(self, density: Optional[npt.ArrayLike] = None, *, voxel_size: Union[float, Sequence[float]] = 1.0,
                 origin: Sequence[float] = (0.0, 0.0, 0.0), **others: npt.ArrayLike) -> None:
        arrays = ({} if density is None else {"density": density}) | others
        if not arrays:
            raise _vkvol.InputError("Grids: there is no array; e.g. Grids(density=array)")
        self._grids = _vkvol.Grids([(name, np.asarray(np.ma.filled(array, 0), np.float32)) for name, array in arrays.items()],
                                   _three("voxel_size", voxel_size), _three("origin", origin))

    def write(self, file: StrPath) -> None:
        """Writes them as an .nvdb file, which renders to the same bits."""
        self._grids.write(Path(file))


def _three(name: str, value: npt.ArrayLike) -> tuple[float, float, float]:
    try:
        x, y, z = np.broadcast_to(np.asarray(value, float), 3).tolist()
    except (TypeError, ValueError):
        raise _vkvol.InputError(f"{name}: {value!r} is not three numbers") from None
    return x, y, z


class Scene:
    """A scene, not yet read: whoever renders it does, and finds what is wrong with it.

    Made by from_file, from_xml or from_dict.
    """

    def __init__(self, file: StrPath, xml: Optional[str], defines: Optional[Mapping[str, object]],
                 grids: Optional[Mapping[str, Grids]], up: str = "y") -> None:
        if up not in ("y", "z"):
            raise _vkvol.InputError(f"up: {up!r} is neither 'y' nor 'z'")
        self.file = Path(file)
        self.xml = xml
        self._grids = dict(grids or {})
        self._source = _vkvol.Scene(self.file, xml, {name: str(value) for name, value in (defines or {}).items()},
                                    {name: grid._grids for name, grid in self._grids.items()}, up)

    @classmethod
    def from_file(cls, file: StrPath, defines: Optional[Mapping[str, object]] = None, *, up: str = "y") -> Scene:
        """A scene file (.xml), a scene of pbrt-v4 (.pbrt), or a density file (.nvdb, .vdb), for which one is made.

        defines: values of the scene's $keys, as by `vkvol -D`.
        up: which axis of a density file is up, "y" or "z".
        """
        return cls(file, None, defines, None, up)

    @classmethod
    def from_xml(cls, text: str, folder: StrPath = ".", defines: Optional[Mapping[str, object]] = None,
                 grids: Optional[Mapping[str, Grids]] = None) -> Scene:
        """The text of a scene file, whose names of files start from the folder.

        grids: in the place of density fields, by the names that these have in the text: {"smoke.nvdb": Grids(...)}.
        """
        return cls(Path(folder) / "scene.xml", text, defines, grids)

    @classmethod
    def from_dict(cls, scene: Mapping[str, Any], folder: StrPath = ".",
                  defines: Optional[Mapping[str, object]] = None) -> Scene:
        """Elements of a scene file, by their names.

        {"width": 320}                                   <width>320</width>
        {"sphere": {"radius": 2}}                        <sphere radius="2"/>
        {"sigma_s": {"unit": "world", "text": 3}}        <sigma_s unit="world">3</sigma_s>
        {"lights": [("point", {"x": 1, "r": 1})]}        <lights><point x="1" r="1"/></lights>
        {"volumes": [("volume", {"everywhere": {}, "sigma_s": 0.1, "name": "haze"})]}
        {"densityField": Grids(...)}
        {"surfaces": [("mesh", {"vertices": array, "triangles": array, "r": 0.5})]}

        A dict holds attributes, "text", and elements: what is a dict, an array, or a list of pairs of a name and an
        element, for names that are there several times. In <options>, <volume> and <models>, whose elements are plain
        texts as a rule, plain values are elements too, but for the attributes `name` and `like` of a volume. Several
        numbers in one value are a tuple.
        """
        grids: dict[str, Grids] = {}
        text = ElementTree.tostring(_element("options", scene, grids), encoding="unicode")
        return cls(Path(folder) / "scene.xml", text, defines, grids)


# The elements whose plain values are elements of their own, and which of these are attributes all the same.
_OF_ELEMENTS: dict[str, tuple[str, ...]] = {"options": (), "volume": ("name", "like"), "models": ()}


def _text(value: Any) -> str:
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, (list, tuple, np.ndarray)):
        return " ".join(_text(part) for part in np.asarray(value).ravel())
    return str(value)


def _is_elements(value: Any) -> bool:
    return isinstance(value, Mapping) or (isinstance(value, list) and len(value) > 0 and
                                          all(isinstance(pair, tuple) and len(pair) == 2 and isinstance(pair[0], str)
                                              for pair in value))


def _element(name: str, value: Any, grids: dict[str, Grids]) -> ElementTree.Element:
    element = ElementTree.Element(name)
    if isinstance(value, Grids):
        value = {"text": value}
    if not _is_elements(value):
        element.text = _text(value)
        return element
    for key, part in value.items() if isinstance(value, Mapping) else value:
        if key == "text" and isinstance(part, Grids):
            known = next((name for name, grid in grids.items() if grid is part), None)
            element.text = known or MEMORY.format(len(grids) + 1)  # one of many uses is read and uploaded once
            grids[element.text] = part
        elif key == "text":
            element.text = _text(part)
        elif isinstance(part, (Grids, np.ndarray)) or _is_elements(part) or key not in _OF_ELEMENTS.get(name, (key,)):
            element.append(_element(key, part, grids))
        else:
            element.set(key, _text(part))
    return element
