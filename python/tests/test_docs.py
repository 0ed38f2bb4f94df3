"""What documentation shows is what happens."""

from __future__ import annotations

import doctest
import importlib
import pkgutil

import pytest

import gnomon
from conftest import ROOT

MODULES = ["gnomon", *(f"gnomon.{m.name}" for m in pkgutil.iter_modules(gnomon.__path__))]


@pytest.mark.parametrize("name", [name for name in MODULES if not name.endswith("._gnomon")])
def test_examples_of_modules(name):
    failed, _ = doctest.testmod(importlib.import_module(name), optionflags=doctest.ELLIPSIS)
    assert failed == 0


def test_examples_are_there():
    count = 0
    for name in MODULES:
        found = doctest.DocTestFinder().find(importlib.import_module(name))
        count += sum(len(test.examples) for test in found)
    assert count >= 8


def test_the_guide(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    guide = ROOT / "docs/python.md"
    failed, tried = doctest.testfile(
        str(guide), module_relative=False, optionflags=doctest.ELLIPSIS
    )
    assert failed == 0 and tried > 20


def test_everything_public_has_words():
    for name in gnomon.__all__:
        value = getattr(gnomon, name)
        if callable(value):
            assert value.__doc__, name
            assert value.__module__.startswith("gnomon"), name
    assert len(set(gnomon.__all__)) == len(gnomon.__all__)
