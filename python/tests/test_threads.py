"""Python's lock is given back while Gnomon works."""

from __future__ import annotations

import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import gnomon
from conftest import SIZE

SCENE = gnomon.Scene("columns")
TRACE = gnomon.record("columns", size=(320, 240))
DATA = bytes(TRACE)

WORK = {
    "render": lambda: gnomon.render(SCENE, "shadow-volumes", size=(640, 480)),
    "truth": lambda: gnomon.truth(SCENE, size=(64, 48)),
    "compare": lambda: gnomon.compare(SCENE, ["shadow-volumes"], size=(64, 48)),
    "record": lambda: gnomon.record(SCENE, size=(160, 120)),
    "replay": lambda: TRACE.replay(),
    "pixel": lambda: TRACE.pixel(160, 200),
    "traffic": lambda: TRACE.traffic("imr-2008"),
    "accesses": lambda: TRACE.accesses(),
    "open": lambda: gnomon.Trace.from_bytes(DATA),
    "scene": lambda: gnomon.Scene("peer-c"),
}


@pytest.fixture
def counted():
    """A thread that counts, as long as it is let. Threads change places only where one
    gives the lock back: nobody is interrupted for a thousand seconds."""
    count = [0]
    stop = threading.Event()

    def run() -> None:
        while not stop.is_set():
            count[0] += 1
            time.sleep(0.0002)

    interval = sys.getswitchinterval()
    sys.setswitchinterval(1000.0)
    thread = threading.Thread(target=run)
    thread.start()
    yield count
    stop.set()
    thread.join()
    sys.setswitchinterval(interval)


@pytest.mark.parametrize("name", WORK)
def test_other_threads_go_on(counted, name):
    """The counter moves while a call runs. Were the lock held, it could not, however often
    it is tried; that is so of a call that holds it."""
    work = WORK[name]
    for _ in range(200):
        before = counted[0]
        work()
        if counted[0] > before:
            break
    assert counted[0] > before
    for _ in range(20):
        before = counted[0]
        sorted(range(200_000), key=lambda n: -n)
        assert counted[0] == before


def test_calls_beside_each_other_have_the_bits_of_calls_alone():
    techniques = ["shadow-volumes", "pcss", "soft-shadow-volumes", "penumbra-wedges"] * 2
    alone = [gnomon.render(SCENE, t, size=SIZE).rgba8 for t in techniques]
    with ThreadPoolExecutor(4) as pool:
        beside = list(pool.map(lambda t: gnomon.render(SCENE, t, size=SIZE).rgba8, techniques))
    assert all(np.array_equal(a, b) for a, b in zip(alone, beside))
