"""A program as a user writes it, for the type checker."""

import numpy as np
from numpy.typing import NDArray

import gnomon

scene: gnomon.Scene = gnomon.Scene("cylinder")
frame: gnomon.Frame = gnomon.render(scene, "pcss", {"samples": 16}, size=(32, 24))
picture: NDArray[np.uint8] = frame.rgba8
written: int = frame.counters["fragments"]["written"]

found: gnomon.Comparison = gnomon.compare(scene, ["pcss", ("pcf", {})], size=(32, 24))
errors: dict[str, float | None] = {result.technique: result.rmse for result in found.results}
truth: NDArray[np.float64] = found.truth.visibility

trace: gnomon.Trace = gnomon.record(scene, size=(32, 24))
ends: NDArray[np.void] = trace.pixel(16, 12).fragments
known: list[gnomon.Parameter] = [p for t in gnomon.techniques() for p in t.parameters]

assert picture.shape == (24, 32, 4) and truth.shape == (24, 32)
assert written > 0 and set(errors) == {"pcss", "pcf"} and known
print(picture.shape, written, errors, ends)
