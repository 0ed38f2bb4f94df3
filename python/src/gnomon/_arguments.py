"""What users give, checked, and as the native half takes it.

Every error names the argument, what it was and what would be valid.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from operator import index
from typing import Any, Union

import numpy as np

from gnomon import _gnomon
from gnomon._gnomon import Scene

#: A scene, the name of a built-in one, or the path of a file.
SceneLike = Union[Scene, str, "os.PathLike[str]"]
#: A value of a parameter.
Value = Union[bool, int, float, str, Sequence[int]]
#: Names of parameters and their values.
Settings = Mapping[str, Value]
#: Width and height in pixels.
Size = Sequence[int]

#: The size of pictures of scenes that ask for none, as on the command line.
DEFAULT_SIZE = (800, 600)
TILES = (16, 32, 64, 128)


def scene_of(given: SceneLike) -> Scene:
    """The scene itself, or the one that a name or a path stands for."""
    return given if isinstance(given, Scene) else Scene(given)


def size_of(given: Size | None, scene: Scene, default: Size = DEFAULT_SIZE) -> tuple[int, int]:
    """Width and height: as given, or as the scene wants it, or the default."""
    if given is None:
        given = scene.size or default
    valid = f"expected (width, height) in pixels, each 1 to {_gnomon.MAX_SIZE}"
    if isinstance(given, (str, bytes)) or not isinstance(given, Iterable):
        raise TypeError(f"size is {given!r}; {valid}")
    sides = tuple(index(side) for side in given)
    if len(sides) != 2 or not all(1 <= side <= _gnomon.MAX_SIZE for side in sides):
        raise ValueError(f"size is {given!r}; {valid}")
    return sides[0], sides[1]


def whole(name: str, given: int, low: int, high: int) -> int:
    """A whole number from `low` to `high`."""
    number = index(given)
    if not low <= number <= high:
        raise ValueError(f"{name} is {number}; expected a whole number from {low} to {high}")
    return number


def threads_of(given: int | None) -> int:
    """A number of threads; 0 for one per core."""
    return 0 if given is None else whole("threads", given, 0, _gnomon.MAX_THREADS)


def execution_of(
    threads: int | None, tile: int = 64, simd: str = "auto", skip: bool = True
) -> tuple[int, int, str, bool]:
    """How to execute; none of it changes a bit of the result."""
    if index(tile) not in TILES:
        raise ValueError(f"tile is {tile}; valid are: {', '.join(map(str, TILES))}")
    return threads_of(threads), index(tile), simd, bool(skip)


def text_of(name: str, value: Value) -> str:
    """A value as the command line writes it."""
    if isinstance(value, str):
        return value
    if isinstance(value, (bool, np.bool_)):
        return "on" if value else "off"
    if isinstance(value, float):
        # Whole numbers as such: parameters that take only those take 8.0 too.
        number = float(value)
        return str(int(number)) if number.is_integer() and abs(number) < 2**53 else repr(number)
    if isinstance(value, Sequence):
        several: Sequence[Any] = value
        return "+".join(str(index(one)) for one in several)
    try:
        return str(index(value))
    except TypeError:
        pass
    try:
        return text_of(name, float(value))
    except (TypeError, ValueError):
        raise TypeError(
            f"parameter {name} is {value!r}; expected bool, int, float, str "
            "or a sequence of int"
        ) from None


def technique_of(given: str, params: Settings | None = None) -> tuple[str, list[str]]:
    """A technique's name and its settings: ``name:key=value:...`` and `params`."""
    if not isinstance(given, str):
        raise TypeError(f"technique is {given!r}; expected a name, such as 'pcss:samples=64'")
    name, *settings = split_colons(given)
    for setting in settings:
        if not setting.partition("=")[0].strip() or "=" not in setting:
            raise ValueError(f"`{setting}` of technique `{given}` is no setting; expected KEY=VALUE")
    settings += [f"{key}={text_of(key, value)}" for key, value in (params or {}).items()]
    return name.strip(), settings


def split_colons(text: str) -> list[str]:
    """Parts between colons, as the command line reads them."""
    return [part.strip() for part in text.split(":")]
