"""What is wrong is told: where, what it was, what would be valid. Nothing panics."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

import gnomon

SMALL = (16, 16)
TRACE = gnomon.record("cylinder", size=SMALL)

BAD = [
    (lambda: gnomon.Scene("cilinder"), ValueError, "did you mean 'cylinder'"),
    (lambda: gnomon.Scene("nowhere.toml"), FileNotFoundError, "nowhere.toml"),
    (lambda: gnomon.Scene("nowhere.obj"), FileNotFoundError, "nowhere.obj"),
    (lambda: gnomon.Scene("cylinder", time=float("nan")), ValueError, "time is NaN"),
    (lambda: gnomon.Scene.from_file("cylinder"), ValueError, ".toml scenes and models"),
    (lambda: gnomon.Scene.from_toml("x = ["), ValueError, "<toml>:1:"),
    (lambda: gnomon.Scene.from_toml("[camera]\neye = 3"), ValueError, "<toml>:2:7"),
    (lambda: gnomon.Scene("walk").at(float("inf")), ValueError, "time is inf"),
    (lambda: gnomon.render("cylinder", "pcsss"), ValueError, "did you mean 'pcss'"),
    (lambda: gnomon.render("cylinder", "pcss:samples"), ValueError, "expected KEY=VALUE"),
    (lambda: gnomon.render("cylinder", "pcss", {"sampels": 1}), ValueError, "samples"),
    (lambda: gnomon.render("cylinder", "pcss", {"samples": -1}), ValueError, "'-1'; valid are"),
    (lambda: gnomon.render("cylinder", "pcss", {"samples": None}), TypeError, "samples is None"),
    (lambda: gnomon.render("cylinder", "pcss", {"samples": "many"}), ValueError, "'many'"),
    (lambda: gnomon.render("cylinder", "pcss", {"samples": 2**70}), ValueError, "valid are"),
    (lambda: gnomon.render("cylinder", 7), TypeError, "technique is 7"),
    (lambda: gnomon.render("cylinder", size=(0, 4)), ValueError, r"size is \(0, 4\); expected"),
    (lambda: gnomon.render("cylinder", size=(4,)), ValueError, "width, height"),
    (lambda: gnomon.render("cylinder", size=(10**9, 4)), ValueError, "each 1 to"),
    (lambda: gnomon.render("cylinder", size="4x4"), TypeError, "size is '4x4'"),
    (lambda: gnomon.render("cylinder", size=(4.5, 4)), TypeError, "integer"),
    (lambda: gnomon.render("cylinder", size=SMALL, threads=-1), ValueError, "threads is -1"),
    (lambda: gnomon.render("cylinder", size=SMALL, threads=10**6), ValueError, "0 to 1024"),
    (lambda: gnomon.render("cylinder", size=SMALL, tile=48), ValueError, "16, 32, 64, 128"),
    (lambda: gnomon.render("cylinder", size=SMALL, simd="mmx"), ValueError, "`mmx`.*auto"),
    (lambda: gnomon.render("cylinder", size=SMALL, repeat=0), ValueError, "repeat is 0"),
    (lambda: gnomon.truth("cylinder", 5, size=SMALL), ValueError, "light 5.*has 1"),
    (lambda: gnomon.truth("cylinder", size=SMALL, reference="x"), ValueError, "exact, rays"),
    (lambda: gnomon.compare("cylinder", []), ValueError, "techniques is empty"),
    (lambda: gnomon.compare("cylinder", "pcss"), TypeError, "expected a list"),
    (lambda: gnomon.Trace.open("nowhere.gnt"), FileNotFoundError, "nowhere.gnt"),
    (lambda: gnomon.Trace.from_bytes(b"no trace"), ValueError, "not a trace"),
    (lambda: gnomon.Trace.from_bytes(bytes(TRACE)[:40]), ValueError, "META|not a trace"),
    (lambda: TRACE.pixel(16, 0), ValueError, "valid are columns 0 to 15"),
    (lambda: TRACE.pixel(-1, 0), ValueError, "x is -1"),
    (lambda: TRACE.pixel(0, 0, frame=3), ValueError, "frame 3 is not in the trace"),
    (lambda: TRACE.pixel(0, 0, image="nothing"), ValueError, "it has .*color"),
    (lambda: TRACE.replay(9), ValueError, "frame 9"),
    (lambda: TRACE.traffic("imr"), ValueError, "valid are naive, compulsory"),
    (lambda: TRACE.traffic("imr-2003"), ValueError, "use --set color-format=rgba8"),
    (lambda: TRACE.traffic("nowhere.toml"), FileNotFoundError, "nowhere.toml"),
    (lambda: TRACE.traffic("naive", by="row"), ValueError, "by is 'row'; valid are: pass"),
    (lambda: TRACE.traffic("naive", merged=True), ValueError, "profiles of tilers"),
    (lambda: TRACE.accesses(1), ValueError, "frame 1"),
    (lambda: TRACE.write("/nowhere/at/all.gnt"), FileNotFoundError, "nothing was written"),
]


@pytest.mark.parametrize("number", range(len(BAD)))
def test_bad_input_is_an_error_of_its_kind(number):
    call, kind, words = BAD[number]
    with pytest.raises(kind, match=f"(?s){words}") as caught:
        call()
    # Not one that only looks like it.
    assert type(caught.value).__name__ in {kind.__name__, "FileNotFoundError"}


def test_damaged_traces_are_errors():
    """Each byte of the file turned over, now and then; opened or refused, never more."""
    whole = bytes(TRACE)
    opened = 0
    for at in range(0, len(whole), max(1, len(whole) // 200)):
        data = bytearray(whole)
        data[at] ^= 0x55
        try:
            trace = gnomon.Trace.from_bytes(bytes(data))
            trace.info(), trace.replay(), trace.accesses(), trace.pixel(8, 8)
            opened += 1
        except (ValueError, RuntimeError):
            pass
    assert opened < 20


def test_nothing_outside_the_folder_is_read(tmp_path):
    folder = tmp_path / "scene"
    folder.mkdir()
    (tmp_path / "box.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    scene = folder / "s.toml"
    scene.write_text(
        "[camera]\neye = [0, 2, 5]\ntarget = [0, 0, 0]\n"
        "[[lights]]\nshape.point = { position = [0, 9, 0] }\n"
        '[[objects]]\nmesh.obj = "../box.obj"\ncasts = false\n'
    )
    with pytest.raises(ValueError, match="outside the folder"):
        gnomon.Scene(scene)
    assert gnomon.Scene(scene, allow_outside=True).objects[0].triangles.tolist() == [[0, 1, 2]]
    text = scene.read_text()
    with pytest.raises(ValueError, match="outside the folder"):
        gnomon.Scene.from_toml(text, folder=folder)
    assert gnomon.Scene.from_toml(text, folder=folder, allow_outside=True).objects


@pytest.mark.skipif(os.name != "posix", reason="pipes of POSIX")
def test_pipes_and_folders_are_refused(tmp_path):
    pipe = tmp_path / "pipe.toml"
    os.mkfifo(pipe)
    with pytest.raises(ValueError, match="pipe; only regular files"):
        gnomon.Scene(pipe)
    with pytest.raises((ValueError, OSError)):
        gnomon.Scene(Path("/dev/zero").with_name("zero.toml"))
    folder = tmp_path / "folder.toml"
    folder.mkdir()
    with pytest.raises(ValueError, match="folder; only regular files"):
        gnomon.Scene(folder)


SHORT = """
import resource, gnomon
gnomon.render("cylinder", size=(64, 64), threads=1)
held = 1 << 30
resource.setrlimit(resource.RLIMIT_AS, (held, held))
try:
    gnomon.CALL("cylinder", size=(8192, 8192), threads=1)
except MemoryError as error:
    print("short:", error)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="a limit of Linux")
@pytest.mark.parametrize("call", ["render", "record"])
def test_memory_that_is_short_is_an_error(tmp_path, call):
    line = [sys.executable, "-c", SHORT.replace("CALL", call)]
    done = subprocess.run(line, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("short:") and "which the system does not give" in done.stdout


def test_too_many_threads_of_the_environment(monkeypatch):
    monkeypatch.setenv("RAYON_NUM_THREADS", "100000")
    with pytest.raises(ValueError, match="RAYON_NUM_THREADS is `100000`; expected at most 1024"):
        gnomon.render("cylinder", size=SMALL)
    assert gnomon.render("cylinder", size=SMALL, threads=1).rgba8.shape == (16, 16, 4)
