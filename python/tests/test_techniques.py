"""Techniques are those that the command line lists, with types."""

from __future__ import annotations

import pytest

import gnomon
from gnomon._arguments import technique_of, text_of


def test_all_are_listed_with_all_parameters(cli):
    told = cli("techniques", "--json")["techniques"]
    known = gnomon.techniques()
    assert [t.name for t in known] == [t["name"] for t in told]
    for technique, document in zip(known, told, strict=True):
        assert dict(technique.capabilities) == document["capabilities"]
        assert [p.name for p in technique.parameters] == [p["name"] for p in document["params"]]
        for parameter, of in zip(technique.parameters, document["params"], strict=True):
            assert (parameter.doc, parameter.valid) == (of["summary"], of["valid"])


def test_defaults_have_the_type_that_is_told():
    types = {"switch": bool, "choice": str, "images": str, "technique": str}
    seen = set()
    for technique in gnomon.techniques():
        for parameter in technique.parameters:
            seen.add(parameter.type)
            if parameter.type in types:
                assert type(parameter.default) is types[parameter.type], parameter
            if isinstance(parameter.default, (int, float)) and parameter.low is not None:
                assert parameter.default >= parameter.low
    assert {"switch", "choice", "whole", "decimal"} <= seen


def test_every_default_may_be_given(monkeypatch):
    """Each parameter at its default, as Python has it, changes no bit."""
    for technique in ("pcss", "shadow-volumes", "soft-shadow-volumes", "penumbra-wedges"):
        known = gnomon.technique(technique)
        given = {p.name: p.default for p in known.parameters}
        plain = gnomon.render("parallel-plates", technique, size=(32, 24))
        told = gnomon.render("parallel-plates", technique, given, size=(32, 24))
        assert told.hash == plain.hash
        assert told.document["params"] == plain.document["params"]


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (True, "on"),
        (False, "off"),
        (8, "8"),
        (8.0, "8"),
        (0.25, "0.25"),
        (1e-7, "1e-07"),
        (1e300, "1e+300"),
        ("zfail", "zfail"),
        ([0, 3], "0+3"),
        ((2,), "2"),
    ],
)
def test_values_are_written_as_the_command_line_has_them(value, text):
    assert text_of("p", value) == text


def test_numbers_of_numpy_are_numbers():
    numpy = pytest.importorskip("numpy")
    assert text_of("p", numpy.int64(8)) == "8"
    assert text_of("p", numpy.float64(0.5)) == text_of("p", numpy.float32(0.5)) == "0.5"
    assert text_of("p", numpy.bool_(True)) == "on"


def test_names_carry_settings():
    assert technique_of(" pcss : samples = 4", {"bias": 2}) == ("pcss", ["samples = 4", "bias=2"])
    plain = gnomon.render("cylinder", "pcss", {"samples": 4}, size=(32, 24))
    named = gnomon.render("cylinder", "pcss:samples=4", size=(32, 24))
    assert plain.hash == named.hash and named.document["params"]["samples"] == "4"
    # What comes later counts.
    both = gnomon.render("cylinder", "pcss:samples=64", {"samples": 4}, size=(32, 24))
    assert both.hash == plain.hash


def test_parameters_by_name():
    samples = gnomon.technique("pcss").parameter("samples")
    assert samples.low is not None and samples.low >= 1 and samples.doc
    with pytest.raises(ValueError, match="has no parameter 'sampels'; it has: .*samples"):
        gnomon.technique("pcss").parameter("sampels")
    with pytest.raises(ValueError, match="no technique is called 'pcs'; there are: .*pcss"):
        gnomon.technique("pcs")
