"""Arrays are the memory that results were made in: nothing is copied on the way."""

from __future__ import annotations

import gc
import tracemalloc

import numpy as np
import pytest

import gnomon
from conftest import SIZE

ARRAYS = ("rgba8", "color", "visibility", "depth", "stencil")


def address(array: np.ndarray) -> int:
    return array.__array_interface__["data"][0]


def owner(array: np.ndarray) -> object:
    """What the memory belongs to in the end."""
    while isinstance(array.base, np.ndarray):
        array = array.base
    return array.base


def all_arrays() -> list[tuple[str, np.ndarray]]:
    frame = gnomon.render("cylinder", size=SIZE)
    trace = gnomon.record("cylinder", size=SIZE)
    pixel = trace.pixel(48, 40)
    places = trace.traffic("gnomon", by="tile").dram_bytes
    assert places is not None
    named = [(name, getattr(frame, name)) for name in ARRAYS]
    named += [(f"output {name}", array) for name, array in trace.replay().outputs.items()]
    named += [("truth", gnomon.truth("cylinder", size=SIZE).visibility)]
    named += [("events", pixel.events), ("values", pixel.values)]
    named += [("traffic", places), ("accesses", trace.accesses())]
    return named


def test_every_array_is_a_vector_of_rust_and_can_only_be_read():
    named = all_arrays()
    assert len(named) > 10
    for name, array in named:
        assert not array.flags.owndata, name
        assert type(owner(array)).__name__ == "PySliceContainer", name
        assert not array.flags.writeable, name
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0


def test_asking_twice_gives_the_same_memory():
    frame = gnomon.render("cylinder", size=SIZE)
    for name in ARRAYS:
        first, second = getattr(frame, name), getattr(frame, name)
        assert address(first) == address(second), name
    scene = gnomon.Scene("cylinder").objects[0]
    assert address(scene.positions) == address(scene.positions)
    assert address(scene.triangles) == address(scene.triangles)


def test_numpy_allocates_no_pictures():
    """NumPy tells tracemalloc of all memory that it asks for; a picture is none of it."""
    size = (640, 480)
    pixels = size[0] * size[1]
    scene = gnomon.Scene("cylinder")
    gnomon.render(scene, size=(8, 8))
    tracemalloc.start()
    try:
        frame = gnomon.render(scene, size=size)
        held = sum(getattr(frame, name).nbytes for name in ARRAYS)
        _, peak = tracemalloc.get_traced_memory()
        assert peak < pixels, f"{peak} bytes were allocated by Python and NumPy"
        assert held == pixels * (4 + 12 + 4 + 4 + 1)
        # The measure sees copies.
        copy = frame.rgba8.copy()
        _, peak = tracemalloc.get_traced_memory()
        assert peak >= copy.nbytes
    finally:
        tracemalloc.stop()


def test_arrays_outlive_what_they_came_from():
    frame = gnomon.render("cylinder", size=SIZE)
    picture, wanted = frame.rgba8, frame.rgba8.copy()
    accesses = gnomon.record("cylinder", size=SIZE).accesses()
    total = int(accesses["covered"].sum(dtype=np.uint64))
    del frame
    gc.collect()
    junk = [gnomon.render("parallel-plates", size=SIZE) for _ in range(3)]
    assert np.array_equal(picture, wanted) and len(junk) == 3
    assert int(accesses["covered"].sum(dtype=np.uint64)) == total
