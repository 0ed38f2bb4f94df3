"""Comparisons and truths are those of the command line."""

from __future__ import annotations

import numpy as np
import pytest

import gnomon
from conftest import SIZE
from test_render import untimed

TECHNIQUES = ["shadow-volumes", "pcss:samples=16", "soft-shadow-volumes"]


@pytest.mark.parametrize("reference", ["exact", "rays"])
def test_figures_are_those_of_the_command_line(cli, reference):
    told = cli(
        "compare", "parallel-plates", "--techniques", ",".join(TECHNIQUES),
        "--size", "48x32", "--reference", reference, "--json",
    )  # fmt: skip
    found = gnomon.compare("parallel-plates", TECHNIQUES, size=(48, 32), reference=reference)
    assert untimed(found.document).keys() == untimed(told).keys()
    for here, there in zip(found.document["results"], told["results"], strict=True):
        assert untimed(here) == untimed(there)
    for key in ("scene", "light", "size", "reference", "soft", "warnings"):
        assert found.document[key] == told[key], key


def test_principal_techniques_are_the_default(cli):
    told = cli("compare", "parallel-plates", "--size", "32x24", "--json")
    found = gnomon.compare("parallel-plates", size=(32, 24))
    assert [r.technique for r in found.results] == [r["technique"] for r in told["results"]]
    assert [r.rmse for r in found.results] == [r["rmse"] for r in told["results"]]


def test_results_are_what_their_arrays_say():
    found = gnomon.compare("parallel-plates", ["shadow-volumes", ("pcss", {"samples": 16})], size=SIZE)
    hard, soft = found.results
    assert (hard.technique, soft.params["samples"]) == ("shadow-volumes", "16")
    assert hard.rmse_umbra == 0.0 and hard.rmse_penumbra > soft.rmse_penumbra > 0.0
    assert found.truth.visibility.shape == (SIZE[1], SIZE[0])
    # Where truth and picture show the same surface, errors are differences of arrays.
    off = np.abs(hard.frame.visibility - found.truth.visibility)
    assert np.nanmax(off) >= hard.max
    assert hard.document["hash"] == hard.frame.hash
    assert hard.bytes == hard.document["bytes"] and type(hard.bytes) is int


def test_other_lights(cli):
    told = cli(
        "compare", "peer-b", "--techniques", "pcf", "--light", "0", "--size", "32x24", "--json"
    )
    found = gnomon.compare("peer-b", ["pcf"], light=0, size=(32, 24))
    assert untimed(found.document["results"][0]) == untimed(told["results"][0])
    lights = len(gnomon.Scene("peer-b").lights)
    with pytest.raises(ValueError, match=f"light {lights} was asked for; the scene has {lights}"):
        gnomon.compare("peer-b", ["pcf"], light=lights, size=(32, 24))


def test_truths_have_no_noise_and_are_kept(tmp_path):
    first = gnomon.truth("parallel-plates", size=SIZE, cache=tmp_path)
    again = gnomon.truth("parallel-plates", size=SIZE, cache=tmp_path, threads=1)
    assert (first.cached, again.cached) == (False, True)
    assert first.soft and first.reference == "exact" and first.light == 0
    assert np.array_equal(first.visibility, again.visibility, equal_nan=True)
    seen = first.visibility[~np.isnan(first.visibility)]
    assert seen.min() == 0.0 and seen.max() == 1.0
    rays = gnomon.truth("parallel-plates", size=SIZE, reference="rays")
    assert 0.0 < np.nanmax(np.abs(rays.visibility - first.visibility)) < 0.02
    # Visibility is in rows from the top: below is floor, above is nothing.
    frame = gnomon.render("parallel-plates", "unshadowed", size=SIZE)
    apart = np.isnan(first.visibility) != (frame.depth == 1.0)
    assert apart.mean() < 0.02


def test_one_light_at_a_time():
    for entry in ("pcf:light=0", ("pcf", {"light": 0})):
        with pytest.raises(ValueError, match="choose it with light=N"):
            gnomon.compare("cylinder", [entry], size=(32, 24))
