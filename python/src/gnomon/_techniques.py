"""Techniques with typed parameters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal, Union

from gnomon import _gnomon

ParameterType = Literal[
    "switch", "choice", "whole", "power-of-two", "square", "decimal", "list", "images", "technique"
]


@dataclass(frozen=True)
class Parameter:
    """What may be set of a technique."""

    name: str
    #: ``switch`` takes `bool`, ``choice`` one of `choices`, ``whole``, ``power-of-two`` and
    #: ``square`` take `int`, ``decimal`` takes `float`, ``list`` a sequence of `int`.
    type: ParameterType
    default: Union[bool, int, float, str]
    #: Words that are taken, beside numbers.
    choices: tuple[str, ...]
    #: Smallest and largest number; `None` for no end.
    low: float | None
    high: float | None
    #: Whether `low` itself is taken.
    low_included: bool
    unit: str | None
    doc: str
    #: When it has an effect, as a document; `None` for always.
    applies_when: Mapping[str, Any] | None
    #: What is valid, in words.
    valid: str


@dataclass(frozen=True)
class Technique:
    """A way to shade a scene with shadows."""

    name: str
    summary: str
    #: ``none``, ``hard`` or ``soft``.
    shadows: str
    #: Kinds of light that it takes.
    lights: tuple[str, ...]
    #: All that it can do and needs, as a document.
    capabilities: Mapping[str, Any]
    parameters: tuple[Parameter, ...]

    def parameter(self, name: str) -> Parameter:
        """The parameter called `name`."""
        for parameter in self.parameters:
            if parameter.name == name:
                return parameter
        known = ", ".join(p.name for p in self.parameters)
        raise ValueError(f"technique '{self.name}' has no parameter '{name}'; it has: {known}")


@lru_cache(maxsize=1)
def _all() -> tuple[Technique, ...]:
    return tuple(_technique(document) for document in _gnomon.techniques()["techniques"])


def techniques() -> list[Technique]:
    """All techniques, in the order in which the command line lists them.

    >>> pcss = technique("pcss")
    >>> pcss.shadows, pcss.parameter("samples").type
    ('soft', 'square')
    """
    return list(_all())


def technique(name: str) -> Technique:
    """The technique called `name`."""
    for known in _all():
        if known.name == name:
            return known
    names = ", ".join(known.name for known in _all())
    raise ValueError(f"no technique is called '{name}'; there are: {names}")


def _technique(document: dict[str, Any]) -> Technique:
    capabilities = document["capabilities"]
    return Technique(
        name=document["name"],
        summary=document["summary"],
        shadows=capabilities["shadows"],
        lights=tuple(capabilities["lights"]),
        capabilities=capabilities,
        parameters=tuple(_parameter(param) for param in document["params"]),
    )


def _parameter(document: dict[str, Any]) -> Parameter:
    of_type: ParameterType = document["type"]
    default = document["default"]
    ends = document["range"] or {"min": None, "max": None, "min_included": True}
    return Parameter(
        name=document["name"],
        type=of_type,
        default=default == "on" if of_type == "switch" else default,
        choices=tuple(document["choices"]),
        low=ends["min"],
        high=ends["max"],
        low_included=ends["min_included"],
        unit=document["unit"],
        doc=document["summary"],
        applies_when=document["applies_when"],
        valid=document["valid"],
    )
