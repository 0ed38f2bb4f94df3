"""Frames are those of the command line, to the bit."""

from __future__ import annotations

import hashlib

import numpy as np
import pytest
from PIL import Image

import gnomon
from conftest import ROOT, SIZE

CASES = [
    ("cylinder", "shadow-volumes", {"method": "zfail"}),
    ("parallel-plates", "pcss:samples=16", {}),
    ("columns", "soft-shadow-volumes", {"buffer": "rgba8x2"}),
    ("parallel-plates", "unshadowed", {}),
]


@pytest.mark.parametrize(("scene", "technique", "params"), CASES)
def test_frames_are_those_of_the_command_line(cli, tmp_path, scene, technique, params):
    """Picture, visibility, every counter and every other key but times and files."""
    picture, visibility = tmp_path / "p.png", tmp_path / "v.npy"
    settings = [f"--set={key}={value}" for key, value in params.items()]
    told = cli(
        "render", scene, "--technique", technique, *settings, "--size", "96x64",
        "--out", picture, "--visibility", visibility, "--json",
    )  # fmt: skip
    frame = gnomon.render(scene, technique, params, size=SIZE)
    there, here = (untimed(document) for document in (told, frame.document))
    assert here == there
    shown = np.asarray(Image.open(picture).convert("RGBA"))
    assert np.array_equal(frame.rgba8[..., :3], shown[..., :3])
    of_file = np.load(visibility)
    assert of_file.dtype == frame.visibility.dtype
    assert np.array_equal(frame.visibility.view(np.uint32), of_file.view(np.uint32))


def untimed(document):
    """A document without times and files."""
    left_out = ("time_ms", "files", "reference_ms", "cached")
    return {key: value for key, value in document.items() if key not in left_out}


def test_shapes_types_and_orientation():
    frame = gnomon.render("cylinder", size=SIZE)
    rows, columns = SIZE[1], SIZE[0]
    for name, shape, kind in [
        ("rgba8", (rows, columns, 4), np.uint8),
        ("color", (rows, columns, 3), np.float32),
        ("visibility", (rows, columns), np.float32),
        ("depth", (rows, columns), np.float32),
        ("stencil", (rows, columns), np.uint8),
    ]:
        array = getattr(frame, name)
        assert (array.shape, array.dtype) == (shape, kind), name
        assert array.flags.c_contiguous
    # The floor is below, the background above: row 0 is the top.
    assert frame.depth[0].min() == 1.0 and frame.depth[-1].max() < 1.0
    # Surfaces have a visibility, the background has none.
    assert np.array_equal(np.isnan(frame.visibility), frame.depth == 1.0)
    # Shadow volumes count in the stencil: 0 is lit.
    seen = frame.depth < 1.0
    assert np.array_equal((frame.stencil == 0)[seen], (frame.visibility == 1.0)[seen])
    assert 0.0 < np.nanmean(frame.visibility) < 1.0


def test_channels_are_red_green_blue_alpha():
    """A scene whose background is of three different channels."""
    scene = gnomon.Scene.from_toml(SCENE)
    frame = gnomon.render(scene, "unshadowed", size=(8, 8))
    # sRGB of 1.0, 0.5 and 0.0, by the standard's curve.
    assert frame.rgba8[0, 0].tolist() == [255, 188, 0, 255]
    # Half floats between the shader and here.
    assert frame.color[0, 0].tolist() == [1.0, 0.5, 0.0]


SCENE = """
background = [1.0, 0.5, 0.0]
[camera]
eye = [0, 2, 5]
target = [0, 40, 0]
[[lights]]
shape.point = { position = [0, 9, 0] }
[[objects]]
mesh.box = { size = [1, 1, 1] }
"""


def test_hashes_are_of_what_the_arrays_hold():
    """BLAKE3 of size and contents; without the library for it, equal arrays tell by SHA-256."""
    frames = [gnomon.render("cylinder", t, size=SIZE) for t in ("pcf", "pcf", "shadow-map")]
    digests = [hashlib.sha256(frame.rgba8.tobytes()).hexdigest() for frame in frames]
    hashes = [frame.hash["color"] for frame in frames]
    assert digests[0] == digests[1] != digests[2]
    assert hashes[0] == hashes[1] != hashes[2]
    assert len(hashes[0]) == 64 and set(frames[0].hash) == {"color", "visibility"}


def test_the_golden_hash():
    """What the first version drew: neither Python nor the machine may change it."""
    frame = gnomon.render("cylinder", "shadow-volumes", size=(64, 48))
    golden = (ROOT / "python/tests/golden.txt").read_text().split()
    assert [frame.hash["color"], frame.hash["visibility"]] == golden


@pytest.mark.parametrize("technique", ["shadow-volumes", "penumbra-wedges", "pcss"])
def test_execution_changes_no_bit(technique):
    first = gnomon.render("parallel-plates", technique, size=SIZE)
    for execution in [
        {"threads": 1},
        {"threads": 3, "tile": 16},
        {"simd": "scalar", "threads": 2},
    ]:
        other = gnomon.render("parallel-plates", technique, size=SIZE, **execution)
        assert other.hash == first.hash
        assert np.array_equal(other.rgba8, first.rgba8)
        # Workers aside, nothing of the document changes either.
        assert other.counters == first.counters
    unskipped = gnomon.render("parallel-plates", technique, size=SIZE, skip=False)
    assert unskipped.hash == first.hash
    assert unskipped.counters["tiles"]["culled"] == 0


def test_counters_are_exact_integers_and_add_up():
    frame = gnomon.render("cylinder", "shadow-volumes", size=SIZE)
    counted = frame.counters["fragments"]
    assert all(type(number) is int for number in counted.values())
    ends = "hiz_killed bounds_failed stencil_failed depth_failed discarded written".split()
    assert counted["generated"] == sum(counted[end] for end in ends) > 0
    of_passes = sum(p["fragments"]["written"] for p in frame.passes)
    assert of_passes == counted["written"]
    assert frame.time_ms == frame.document["time_ms"]["frame"] > 0.0


def test_warnings_are_told():
    """A setting that changes nothing, beside the others, and one that does."""
    vain = gnomon.render("cylinder", "pcss", {"sampling": "all", "seed": 3}, size=(32, 24))
    assert vain.warnings == vain.document["warnings"]
    assert [w["code"] for w in vain.warnings] == ["setting-without-effect"]
    assert "seed=3 has no effect here" in vain.warnings[0]["message"]
    assert gnomon.render("cylinder", "pcss", {"seed": 3}, size=(32, 24)).warnings == []


def test_moments_of_a_scene():
    walk = gnomon.Scene("walk", time=0.25)
    assert walk.time == 0.25 and walk.at(1.5).time == 1.5
    hashes = [gnomon.render(s, size=SIZE).hash["color"] for s in (walk, walk.at(1.5))]
    assert hashes[0] != hashes[1]
    assert gnomon.render(walk.at(0.25), size=SIZE).hash["color"] == hashes[0]


def test_scenes_of_files(tmp_path):
    path = tmp_path / "box.toml"
    path.write_text(SCENE)
    of_file = gnomon.Scene.from_file(path)
    assert of_file.name == "box" and of_file.lights == [
        {"kind": "point", "color": of_file.lights[0]["color"]}
    ]
    of_text = gnomon.Scene.from_toml(SCENE)
    pictures = [gnomon.render(s, size=(8, 8)).rgba8 for s in (of_file, of_text, path, str(path))]
    assert all(np.array_equal(p, pictures[0]) for p in pictures)
    assert gnomon.Scene.from_toml("size = [24, 16]\n" + SCENE).size == (24, 16)
    sized = gnomon.render(gnomon.Scene.from_toml("size = [24, 16]\n" + SCENE), "unshadowed")
    assert sized.rgba8.shape == (16, 24, 4)


def test_objects_are_meshes():
    scene = gnomon.Scene("cylinder")
    cylinder = next(o for o in scene.objects if o.casts)
    positions, triangles = cylinder.positions, cylinder.triangles
    assert positions.shape[1] == triangles.shape[1] == 3
    assert (positions.dtype, triangles.dtype) == (np.float32, np.uint32)
    assert triangles.max() == len(positions) - 1
    # Closed and counter-clockwise seen from outside: the signed volume is that of a solid.
    a, b, c = (positions[triangles[:, k]].astype(float) for k in range(3))
    assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6 > 0
    assert "cylinder" in repr(scene) and "triangles" in repr(cylinder)


def test_built_in_scenes_are_listed(cli):
    listed = cli("scenes", "--json")["scenes"]
    assert [scene.name for scene in gnomon.scenes()] == [scene["name"] for scene in listed]
    assert [scene.__dict__ for scene in gnomon.scenes()] == listed
