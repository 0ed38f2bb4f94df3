"""Traces: frames in files, replayed and explained."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gnomon import _gnomon
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
from gnomon._dtypes import ACCESS, ENDS, EVENT, KINDS
from gnomon._gnomon import Replay

_MOST = 2**32 - 1


@dataclass(frozen=True)
class PixelHistory:
    """Everything that happened to a pixel, in order."""

    #: Column and row.
    pixel: tuple[int, int]
    #: A record each: ``event``, ``kind`` (number in `KINDS`), ``pass``, ``draw``,
    #: ``primitive``, ``piece``, ``front``, ``end`` (number in `ENDS`) and the ``depth`` of
    #: the fragment as it would be stored; 2**32 - 1 where there is none.
    events: NDArray[np.void] = field(repr=False)
    #: What each attachment holds before the first event and after each, as it is stored:
    #: axes are moments, attachments, channels; depth and stencil are the first two.
    values: NDArray[np.uint32] = field(repr=False)
    #: Names of the attachments.
    attachments: tuple[str, ...]
    #: What ``gnomon pixel --json`` prints.
    document: Mapping[str, Any] = field(repr=False)

    KINDS = KINDS
    ENDS = ENDS

    @property
    def fragments(self) -> NDArray[np.void]:
        """The events that are fragments."""
        of_kind: NDArray[np.void] = self.events[self.events["kind"] == KINDS.index("fragment")]
        return of_kind


@dataclass(frozen=True)
class Traffic:
    """What a frame moves under a profile of memory."""

    profile: str
    #: A mapping each, as ``gnomon traffic --json`` has them.
    rows: Sequence[Mapping[str, Any]] = field(repr=False)
    totals: Mapping[str, Mapping[str, int]]
    #: Bytes between caches and memory by tile (8x8 pixels) or pixel: rows, columns; `None`
    #: where rows are no places.
    dram_bytes: NDArray[np.uint64] | None = field(repr=False)
    document: Mapping[str, Any] = field(repr=False)


class Trace:
    """Frames that were recorded; `record` makes one, `open` reads one."""

    def __init__(self, native: _gnomon.Trace) -> None:
        self._native = native

    @classmethod
    def open(cls, path: str | os.PathLike[str]) -> Trace:
        """The trace in a file."""
        return cls(_gnomon.Trace.open(path))

    @classmethod
    def from_bytes(cls, data: bytes) -> Trace:
        """The trace that `data` are."""
        return cls(_gnomon.Trace.from_bytes(data))

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the file; it appears whole or not at all."""
        self._native.write(path)

    def __bytes__(self) -> bytes:
        return self._native.to_bytes()

    def __len__(self) -> int:
        return self._native.frames

    def __repr__(self) -> str:
        info = self.info()
        return f"<gnomon.Trace of {info['scene']} by {info['technique']}, {len(self)} frames>"

    @property
    def frames(self) -> int:
        """How many there are."""
        return self._native.frames

    @property
    def lost(self) -> str | None:
        """What is lost of a file that was cut short."""
        return self._native.lost

    def info(self) -> dict[str, Any]:
        """What ``gnomon info --json`` prints."""
        return self._native.info()

    def replay(
        self,
        frame: int = 0,
        *,
        deep: bool = False,
        threads: int | None = None,
        tile: int = 64,
        simd: str = "auto",
        skip: bool = True,
    ) -> Replay:
        """Draws a frame again and compares; `deep` compares what every draw left."""
        execution = execution_of(threads, tile, simd, skip)
        return self._native.replay(_frame(frame), bool(deep), execution)

    def pixel(
        self,
        x: int,
        y: int,
        *,
        frame: int = 0,
        image: str | None = None,
        skip: bool = True,
        threads: int | None = None,
    ) -> PixelHistory:
        """Everything that happened to a pixel; without `skip` what zmin/zmax hid is shown."""
        place = (whole("x", x, 0, _MOST), whole("y", y, 0, _MOST))
        execution = execution_of(threads, skip=skip)
        text, rows, values = self._native.pixel(place, _frame(frame), image, execution)
        document = json.loads(text)
        return PixelHistory(
            pixel=place,
            events=rows.reshape(-1).view(EVENT),
            values=values,
            attachments=tuple(a["label"] for a in document["attachments"]),
            document=document,
        )

    def traffic(
        self,
        profile: str,
        *,
        by: str = "pass",
        frame: int = 0,
        merged: bool = False,
    ) -> Traffic:
        """What a frame moves under a profile (see `profiles`) or that of a ``.toml`` file.

        `by` is ``pass``, ``draw``, ``client``, ``tile`` or ``pixel``; `merged` lets passes of
        tilers go on in the tiles of those before.
        """
        if not isinstance(profile, str):
            profile = os.fspath(profile)
        text, places = self._native.traffic(profile, by, _frame(frame), bool(merged))
        document = json.loads(text)
        return Traffic(
            profile=document["profile"],
            rows=document["rows"],
            totals=document["totals"],
            dram_bytes=places,
            document=document,
        )

    def accesses(self, frame: int = 0) -> NDArray[np.void]:
        """What each primitive did to each block of 8x8 pixels, in order, with zmin/zmax off:
        a record each, as `gnomon_raster::BlockAccess` has it."""
        return self._native.accesses(_frame(frame)).view(ACCESS)


def record(
    scene: SceneLike,
    technique: str = "shadow-volumes",
    params: Settings | None = None,
    *,
    size: Size | None = None,
    traffic: bool = True,
    frozen: bool = False,
    threads: int | None = None,
    simd: str = "auto",
) -> Trace:
    """Records a frame; without `traffic` it says nothing of accesses, and is small.

    >>> trace = record("cylinder", "shadow-volumes", size=(64, 48))
    >>> trace.replay().equal
    True
    """
    of = scene_of(scene)
    return Trace(
        _gnomon.record(
            of,
            technique_of(technique, params),
            size_of(size, of),
            execution_of(threads, simd=simd),
            bool(traffic),
            bool(frozen),
        )
    )


def _frame(given: int) -> int:
    return whole("frame", given, 0, _MOST)
