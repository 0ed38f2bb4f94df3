"""Shadow techniques on a software GPU with the same bits everywhere, for Python.

>>> import gnomon
>>> frame = gnomon.render("cylinder", "shadow-volumes", size=(64, 48))
>>> frame.rgba8.shape, frame.rgba8.dtype
((48, 64, 4), dtype('uint8'))

Scenes are named or read (`Scene`), techniques are listed with what may be set (`techniques`),
and `render`, `truth`, `compare` and `record` take both. Whatever takes time gives back
Python's lock, so threads go on. Results are, to the bit, those of the command line.
"""

from gnomon._api import render, truth
from gnomon._comparison import Comparison, Result, compare
from gnomon._gnomon import (
    MAX_SIZE,
    MAX_THREADS,
    Frame,
    Replay,
    Scene,
    SceneObject,
    Truth,
    profiles,
)
from gnomon._gnomon import VERSION as __version__
from gnomon._scenes import SceneInfo, scenes
from gnomon._techniques import Parameter, Technique, technique, techniques
from gnomon._trace import PixelHistory, Trace, Traffic, record

__all__ = [
    "MAX_SIZE",
    "MAX_THREADS",
    "Comparison",
    "Frame",
    "Parameter",
    "PixelHistory",
    "Replay",
    "Result",
    "Scene",
    "SceneInfo",
    "SceneObject",
    "Technique",
    "Trace",
    "Traffic",
    "Truth",
    "__version__",
    "compare",
    "profiles",
    "record",
    "render",
    "scenes",
    "technique",
    "techniques",
    "truth",
]
