"""Traces: files of the command line, histories and traffic as it prints them."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import gnomon
from conftest import ROOT, SIZE

GOLDEN = sorted((ROOT / "traces/tests/golden/v1").glob("*.gnt"))
TECHNIQUE = "shadow-volumes"


@pytest.fixture(scope="module")
def recorded(cli, tmp_path_factory):
    """A trace of the command line, and the same of Python."""
    path = tmp_path_factory.mktemp("trace") / "t.gnt"
    cli("record", "cylinder", "--technique", TECHNIQUE, "--size", "96x64", "--out", path, "--json")
    return path, gnomon.record("cylinder", TECHNIQUE, size=SIZE)


def test_files_are_those_of_the_command_line(recorded, tmp_path):
    path, trace = recorded
    assert bytes(trace) == path.read_bytes()
    trace.write(tmp_path / "w.gnt")
    assert (tmp_path / "w.gnt").read_bytes() == path.read_bytes()
    assert [p.name for p in tmp_path.iterdir()] == ["w.gnt"]
    assert bytes(gnomon.Trace.from_bytes(bytes(trace))) == bytes(trace)


def test_threads_write_one_file(recorded, tmp_path):
    """Each writes it whole, under a name as long as names may be."""
    _, trace = recorded
    path = tmp_path / ("n" * 251 + ".gnt")
    with ThreadPoolExecutor(8) as pool:
        list(pool.map(lambda _: trace.write(path), range(200)))
    assert path.read_bytes() == bytes(trace)
    assert list(tmp_path.iterdir()) == [path]


def test_what_a_trace_says(cli, recorded):
    path, _ = recorded
    trace = gnomon.Trace.open(path)
    assert trace.info() == cli("info", path, "--json")
    assert (len(trace), trace.frames, trace.lost) == (1, 1, None)
    assert "cylinder" in repr(trace)


@pytest.mark.parametrize("place", [(48, 40), (0, 0), (95, 63), (40, 50)])
def test_histories_are_those_of_the_command_line(cli, recorded, place):
    path, trace = recorded
    x, y = map(str, place)
    history = trace.pixel(*place)
    assert history.document == cli("pixel", path, x, y, "--json")
    unskipped = trace.pixel(*place, skip=False)
    assert unskipped.document == cli("pixel", path, x, y, "--no-skip", "--json")


def test_events_are_what_the_document_tells(recorded):
    _, trace = recorded
    history = trace.pixel(48, 40, skip=False)
    told = history.document["events"]
    assert len(history.events) == len(told) > 4
    for event, of in zip(history.events, told, strict=True):
        assert history.KINDS[event["kind"]] == of["kind"]
        assert (event["event"], event["pass"]) == (of["event"], of["pass"])
        if of["kind"] == "fragment":
            assert event["draw"] == of["draw"] and event["primitive"] == of["primitive"]
            assert history.ENDS[event["end"]] == of["end"]
            assert bool(event["front"]) == of["front"]
            assert event["depth"] == of["depth"]["fragment"]
        else:
            assert event["draw"] == 2**32 - 1
    assert len(history.fragments) == sum(of["kind"] == "fragment" for of in told)
    assert set(np.unique(history.fragments["end"])) <= set(range(len(history.ENDS)))


def test_values_are_before_and_after(recorded):
    _, trace = recorded
    history = trace.pixel(48, 40)
    told = history.document
    assert history.values.shape == (len(told["events"]) + 1, len(told["attachments"]), 4)
    depth = next(i for i, v in enumerate(told["final"]) if isinstance(v, dict))
    for number, of in enumerate(told["events"]):
        before, after = history.values[number], history.values[number + 1]
        for color in of["color"]:
            assert before[color["attachment"]].tolist() == color["before"]
            assert after[color["attachment"]].tolist() == color["after"]
        assert before[depth, 0] == of["depth"]["before"]
        assert after[depth, :2].tolist() == [of["depth"]["after"], of["stencil"]["after"]]
    last = [v if isinstance(v, list) else [v["depth"], v["stencil"], 0, 0] for v in told["final"]]
    assert history.values[-1].tolist() == last
    # The pixel of the picture is what the history ends with.
    outputs = trace.replay().outputs
    stencil = next(a for name, a in outputs.items() if name.endswith(":stencil"))
    assert stencil[40, 48] == history.values[-1, depth, 1]


@pytest.mark.parametrize("by", ["pass", "draw", "client", "tile", "pixel"])
def test_traffic_is_that_of_the_command_line(cli, recorded, tmp_path, by):
    path, _ = recorded
    trace = gnomon.Trace.open(path)
    for profile in ("imr-2008", "tbr-mali"):
        found = trace.traffic(profile, by=by)
        told = cli("traffic", path, "--profile", profile, "--by", by, "--json")
        assert found.document == told and found.totals == told["totals"]
        if by in ("tile", "pixel"):
            array = tmp_path / f"{profile}.npy"
            cli("traffic", path, "--profile", profile, "--by", by, "--out", array)
            assert np.array_equal(found.dram_bytes.astype(np.float32), np.load(array))
            assert found.dram_bytes.shape == ((64, 96) if by == "pixel" else (8, 12))
        else:
            assert found.dram_bytes is None
    merged = trace.traffic("tbr-mali", by=by, merged=True)
    assert merged.document["merges"] and merged.profile.startswith("tbr-mali")


def test_traffic_of_a_profile_of_ones_own(recorded, tmp_path):
    _, trace = recorded
    mine = tmp_path / "mine.toml"
    mine.write_bytes((ROOT / "traces/src/profile/naive.toml").read_bytes())
    assert trace.traffic(mine).rows == trace.traffic("naive").rows
    assert "naive" in gnomon.profiles()


def test_accesses_add_up_to_the_counters(recorded):
    _, trace = recorded
    accesses = trace.accesses()
    frame = gnomon.render("cylinder", TECHNIQUE, size=SIZE, skip=False)
    bits = np.bitwise_count if hasattr(np, "bitwise_count") else popcount
    count = {name: int(bits(accesses[name]).sum()) for name in accesses.dtype.names if
             accesses[name].dtype == np.uint64}  # fmt: skip
    fragments, traffic = frame.counters["fragments"], frame.counters["traffic"]
    assert count["covered"] == fragments["generated"]
    assert count["stencil_failed"] == fragments["stencil_failed"]
    assert count["depth_failed"] == fragments["depth_failed"]
    assert count["z_read"] == traffic["z"]["read_accesses"]
    assert count["z_write"] == traffic["z"]["write_accesses"]
    assert count["stencil_write"] == traffic["stencil"]["write_accesses"]
    assert len(accesses) == trace.info()["contents"][0]["events"]
    assert accesses["block"].max(axis=0).tolist() == [11, 7]
    # Clipping makes a few pieces of a primitive; volumes have many, and show both sides.
    assert accesses["piece"].max() < 8 < accesses["primitive"].max()
    assert accesses["front"].any() and not accesses["front"].all()
    assert not accesses["hiz_killed"].any()
    for number, of in enumerate(frame.passes):
        here = accesses[accesses["pass"] == number]
        assert int(bits(here["covered"]).sum()) == of["fragments"]["generated"]
    assert (accesses["span"][:, 0] <= accesses["span"][:, 1]).all()


def popcount(words: np.ndarray) -> np.ndarray:
    flat = np.ascontiguousarray(words).view(np.uint8)
    return np.unpackbits(flat, axis=-1 if words.ndim > 1 else None)


@pytest.mark.parametrize("path", GOLDEN, ids=lambda p: p.stem)
def test_golden_traces_replay(path):
    trace = gnomon.Trace.open(path)
    for deep in (False, True):
        replay = trace.replay(deep=deep)
        assert replay.equal and replay.difference is None and replay.attachments > 0
        assert (replay.draws > 0) == deep


@pytest.mark.parametrize("technique", ["shadow-volumes", "pcss", "soft-shadow-volumes"])
def test_replays_are_what_rendering_gives(technique):
    """The same arrays by another way, in the same orientation and order of channels."""
    frame = gnomon.render("cylinder", technique, size=SIZE)
    replay = gnomon.record("cylinder", technique, size=SIZE).replay()
    assert replay.rgba8 is not None and (replay.rgba8[..., 3] == 255).all()
    assert np.array_equal(replay.rgba8[..., :3], frame.rgba8[..., :3])
    color = replay.outputs["color"]
    assert color.dtype == np.float16
    assert np.array_equal(color[..., :3].astype(np.float32), frame.color)
    depth, stencil = (replay.outputs[f"depth-stencil:{aspect}"] for aspect in ("depth", "stencil"))
    assert np.array_equal(stencil, frame.stencil)
    # Integers of 24 bits.
    assert depth.dtype == np.uint32 and depth.shape == frame.depth.shape
    assert np.array_equal(depth == 2**24 - 1, frame.depth == 1.0)
    assert np.abs(depth / (2.0**24 - 1) - frame.depth).max() < 1e-7


def test_frozen_and_bare_traces():
    bare = gnomon.record("cylinder", size=SIZE, traffic=False)
    full = gnomon.record("cylinder", size=SIZE)
    frozen = gnomon.record("cylinder", size=SIZE, frozen=True)
    assert len(bytes(bare)) < len(bytes(full)) and frozen.replay().equal
    assert frozen.info()["mode"] == "frozen"
    with pytest.raises(ValueError, match="no section TRAF"):
        bare.accesses()
