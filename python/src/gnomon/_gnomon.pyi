"""The native half of the package; everything public is in `gnomon`."""

import os
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "MAX_SIZE",
    "MAX_THREADS",
    "VERSION",
    "Frame",
    "Replay",
    "Scene",
    "SceneObject",
    "Trace",
    "Truth",
    "compare",
    "profiles",
    "record",
    "render",
    "scenes",
    "techniques",
    "truth",
]

MAX_SIZE: int
MAX_THREADS: int
VERSION: str

_Path = str | os.PathLike[str]
#: Threads, side of tiles, instruction set, whether zmin/zmax skip work.
_Execution = tuple[int, int, str, bool]
#: A name, and settings ``key=value``.
_Technique = tuple[str, list[str]]

@final
class Scene:
    """A scene at one moment, and where it is from."""

    def __new__(
        cls, name: _Path, *, time: float = 0.0, allow_outside: bool = False
    ) -> Scene: ...
    @staticmethod
    def from_file(
        path: _Path, *, time: float = 0.0, allow_outside: bool = False
    ) -> Scene: ...
    @staticmethod
    def from_toml(
        text: str, *, folder: _Path | None = None, time: float = 0.0, allow_outside: bool = False
    ) -> Scene: ...
    def at(self, time: float) -> Scene: ...
    @property
    def name(self) -> str: ...
    @property
    def time(self) -> float: ...
    @property
    def size(self) -> tuple[int, int] | None: ...
    @property
    def lights(self) -> list[dict[str, Any]]: ...
    @property
    def warnings(self) -> list[dict[str, Any]]: ...
    @property
    def objects(self) -> list[SceneObject]: ...

@final
class SceneObject:
    """An object of a scene."""

    @property
    def name(self) -> str: ...
    @property
    def casts(self) -> bool: ...
    @property
    def receives(self) -> bool: ...
    @property
    def positions(self) -> NDArray[np.float32]: ...
    @property
    def triangles(self) -> NDArray[np.uint32]: ...

@final
class Frame:
    """A picture, what it was made of, and what it cost."""

    @property
    def rgba8(self) -> NDArray[np.uint8]: ...
    @property
    def color(self) -> NDArray[np.float32]: ...
    @property
    def visibility(self) -> NDArray[np.float32]: ...
    @property
    def depth(self) -> NDArray[np.float32]: ...
    @property
    def stencil(self) -> NDArray[np.uint8]: ...
    @property
    def time_ms(self) -> float: ...
    @property
    def counters(self) -> dict[str, Any]: ...
    @property
    def passes(self) -> list[dict[str, Any]]: ...
    @property
    def warnings(self) -> list[dict[str, Any]]: ...
    @property
    def hash(self) -> dict[str, str]: ...
    @property
    def document(self) -> dict[str, Any]: ...

@final
class Truth:
    """Visibility of a light as an oracle finds it."""

    @property
    def visibility(self) -> NDArray[np.float64]: ...
    @property
    def light(self) -> int: ...
    @property
    def soft(self) -> bool: ...
    @property
    def cached(self) -> bool: ...
    @property
    def reference(self) -> str: ...
    @property
    def warnings(self) -> list[str]: ...

@final
class Replay:
    """A frame that was drawn again, and what it left."""

    @property
    def equal(self) -> bool: ...
    @property
    def difference(self) -> str | None: ...
    @property
    def attachments(self) -> int: ...
    @property
    def draws(self) -> int: ...
    @property
    def rgba8(self) -> NDArray[np.uint8] | None: ...
    @property
    def outputs(self) -> dict[str, NDArray[Any]]: ...

@final
class Trace:
    """Frames that were recorded."""

    @staticmethod
    def open(path: _Path) -> Trace: ...
    @staticmethod
    def from_bytes(data: bytes) -> Trace: ...
    def write(self, path: _Path) -> None: ...
    def to_bytes(self) -> bytes: ...
    @property
    def frames(self) -> int: ...
    @property
    def lost(self) -> str | None: ...
    def info(self) -> dict[str, Any]: ...
    def replay(self, frame: int, deep: bool, execution: _Execution) -> Replay: ...
    def pixel(
        self, pixel: tuple[int, int], frame: int, image: str | None, execution: _Execution
    ) -> tuple[str, NDArray[np.uint32], NDArray[np.uint32]]: ...
    def traffic(
        self, profile: str, by: str, frame: int, merged: bool
    ) -> tuple[str, NDArray[np.uint64] | None]: ...
    def accesses(self, frame: int) -> NDArray[np.uint64]: ...

def scenes() -> dict[str, Any]: ...
def techniques() -> dict[str, Any]: ...
def profiles() -> list[str]: ...
def render(
    scene: Scene,
    technique: _Technique,
    size: tuple[int, int],
    execution: _Execution,
    repeat: int,
    cache: _Path | None,
) -> Frame: ...
def truth(
    scene: Scene,
    light: int,
    size: tuple[int, int],
    reference: str,
    threads: int,
    cache: _Path | None,
) -> Truth: ...
def compare(
    scene: Scene,
    techniques: list[_Technique],
    light: int,
    size: tuple[int, int],
    reference: str,
    execution: _Execution,
    repeat: int,
    cache: _Path | None,
) -> tuple[str, list[Frame], Truth]: ...
def record(
    scene: Scene,
    technique: _Technique,
    size: tuple[int, int],
    execution: _Execution,
    traffic: bool,
    frozen: bool,
) -> Trace: ...
