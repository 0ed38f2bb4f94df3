"""Rendering, and the truth."""

from __future__ import annotations

import os

from gnomon import _gnomon
from gnomon._arguments import (
    SceneLike,
    Settings,
    Size,
    execution_of,
    scene_of,
    size_of,
    technique_of,
    threads_of,
    whole,
)
from gnomon._gnomon import Frame, Truth

#: Most lights that a scene could be asked for.
MAX_LIGHT = 2**32 - 1
#: Most frames that are timed.
MAX_REPEAT = 1_000_000


def render(
    scene: SceneLike,
    technique: str = "shadow-volumes",
    params: Settings | None = None,
    *,
    size: Size | None = None,
    threads: int | None = None,
    tile: int = 64,
    simd: str = "auto",
    skip: bool = True,
    repeat: int = 1,
    cache: str | os.PathLike[str] | None = None,
) -> Frame:
    """Renders a scene by a technique.

    `technique` is a name, with settings behind colons if need be (``"pcss:samples=64"``);
    `params` are further ones. `threads`, `tile`, `simd` and `skip` say how to execute: none
    of them changes a bit of the picture. Of `repeat` frames the median time is told. In the
    folder `cache` is kept what a technique computes ahead.

    >>> frame = render("cylinder", "shadow-volumes", {"method": "zfail"}, size=(64, 48))
    >>> frame.visibility.shape
    (48, 64)
    """
    of = scene_of(scene)
    return _gnomon.render(
        of,
        technique_of(technique, params),
        size_of(size, of),
        execution_of(threads, tile, simd, skip),
        whole("repeat", repeat, 1, MAX_REPEAT),
        cache,
    )


def truth(
    scene: SceneLike,
    light: int = 0,
    *,
    size: Size | None = None,
    reference: str = "exact",
    threads: int | None = None,
    cache: str | os.PathLike[str] | None = None,
) -> Truth:
    """Visibility of a light as an oracle in double precision finds it.

    `reference` is ``"exact"`` (areas in closed form) or ``"rays"`` (4096 of them a pixel). In
    the folder `cache` is kept what was computed.

    >>> float(truth("parallel-plates", size=(32, 24)).visibility[-1, 16]) <= 1.0
    True
    """
    of = scene_of(scene)
    light = whole("light", light, 0, MAX_LIGHT)
    return _gnomon.truth(of, light, size_of(size, of), reference, threads_of(threads), cache)
