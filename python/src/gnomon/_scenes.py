"""The built-in scenes."""

from __future__ import annotations

from dataclasses import dataclass

from gnomon import _gnomon


@dataclass(frozen=True)
class SceneInfo:
    """A scene that needs no file."""

    name: str
    description: str
    triangles: int
    objects: int
    casters: int
    lights: int
    #: Whether it changes with time.
    animated: bool


def scenes() -> list[SceneInfo]:
    """The built-in scenes.

    >>> "cylinder" in [scene.name for scene in scenes()]
    True
    """
    return [SceneInfo(**scene) for scene in _gnomon.scenes()["scenes"]]
