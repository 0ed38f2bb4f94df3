"""Techniques beside the truth."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Union

from gnomon import _gnomon
from gnomon._api import MAX_LIGHT, MAX_REPEAT
from gnomon._arguments import (
    SceneLike,
    Settings,
    Size,
    execution_of,
    scene_of,
    size_of,
    technique_of,
    whole,
)
from gnomon._gnomon import Frame, Truth

#: What is compared where nothing is asked for, as on the command line: hard, by a map,
#: filtered, by geometry.
PRINCIPAL = ("shadow-volumes", "pcss", "convolution-soft-shadows", "soft-shadow-volumes")
#: The size of pictures of scenes that ask for none.
DEFAULT_SIZE = (640, 480)


@dataclass(frozen=True)
class Result:
    """How far a technique is from the truth; figures without pixels are `None`."""

    technique: str
    #: All of its parameters, as text.
    params: Mapping[str, str]
    #: Errors of visibility: root of the mean square, largest, 99th percentile, mean.
    rmse: float | None
    max: float | None
    p99: float | None
    mean: float | None
    rmse_umbra: float | None
    rmse_penumbra: float | None
    rmse_lit: float | None
    #: Of the shaded pictures; `None` for equal ones, of which it is infinite.
    psnr: float | None
    ssim: float | None
    flip: float
    time_ms: float
    #: Bytes that the frame moved, clears included.
    bytes: int
    shaded_fragments: int
    warnings: Sequence[Mapping[str, Any]]
    #: Everything that ``gnomon compare --json`` tells of it.
    document: Mapping[str, Any] = field(repr=False)
    #: The frame itself.
    frame: Frame = field(repr=False)


@dataclass(frozen=True)
class Comparison:
    """Techniques beside the truth about one light."""

    scene: str
    results: tuple[Result, ...]
    truth: Truth
    #: What ``gnomon compare --json`` prints.
    document: Mapping[str, Any] = field(repr=False)


def compare(
    scene: SceneLike,
    techniques: Sequence[Union[str, tuple[str, Settings]]] = PRINCIPAL,
    *,
    light: int = 0,
    size: Size | None = None,
    reference: str = "exact",
    threads: int | None = None,
    tile: int = 64,
    simd: str = "auto",
    skip: bool = True,
    repeat: int = 1,
    cache: str | os.PathLike[str] | None = None,
) -> Comparison:
    """Holds techniques against the truth about one light.

    Each is a name with settings behind colons, or a pair of a name and settings.

    >>> found = compare("parallel-plates", ["shadow-volumes"], size=(64, 48))
    >>> found.results[0].rmse_umbra
    0.0
    """
    of = scene_of(scene)
    if isinstance(techniques, str):
        raise TypeError(f"techniques is {techniques!r}; expected a list, such as ['pcss']")
    if not techniques:
        raise ValueError("techniques is empty; expected names of at least one")
    text, frames, truth = _gnomon.compare(
        of,
        [_entry(given) for given in techniques],
        whole("light", light, 0, MAX_LIGHT),
        size_of(size, of, DEFAULT_SIZE),
        reference,
        execution_of(threads, tile, simd, skip),
        whole("repeat", repeat, 1, MAX_REPEAT),
        cache,
    )
    document = json.loads(text)
    results = zip(document["results"], frames)
    return Comparison(
        scene=document["scene"],
        results=tuple(_result(told, frame) for told, frame in results),
        truth=truth,
        document=document,
    )


def _entry(given: Union[str, tuple[str, Settings]]) -> tuple[str, list[str]]:
    name, settings = technique_of(given) if isinstance(given, str) else technique_of(*given)
    for setting in settings:
        key, _, value = setting.partition("=")
        if key.strip() == "light":
            raise ValueError(
                f"light of technique '{name}' is {value}; one light is compared at a time: "
                "choose it with light=N of compare"
            )
    return name, settings


#: Keys of a result that are attributes too.
_TOLD = (
    "technique params rmse max p99 mean rmse_umbra rmse_penumbra rmse_lit psnr ssim flip "
    "time_ms bytes shaded_fragments warnings"
).split()


def _result(document: dict[str, Any], frame: Frame) -> Result:
    told = {key: document[key] for key in _TOLD}
    return Result(**told, document=document, frame=frame)
