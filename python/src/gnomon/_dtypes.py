"""Rows of the native half as NumPy's records; the words are laid out there in this order."""

from __future__ import annotations

import numpy as np

#: What an event of a pixel is, by number.
KINDS = ("load", "fragment", "store")
#: How a fragment ended, by number.
ENDS = ("hiz", "bounds", "stencil", "depth", "discarded", "written")
#: What stands where an event has no such value.
NONE = 2**32 - 1

#: An event of a pixel.
EVENT = np.dtype(
    [
        (name, "<u4")
        for name in (
            "event",
            "kind",
            "pass",
            "draw",
            "primitive",
            "piece",
            "front",
            "end",
            "depth",
        )
    ]
)

#: What one primitive did to one block of 8x8 pixels; bit 8*row + column of a mask is a pixel.
ACCESS = np.dtype(
    [
        ("pass", "<u4"),
        ("draw", "<u4"),
        ("primitive", "<u4"),
        ("piece", "<u4"),
        ("block", "<u2", (2,)),
        ("front", "?"),
        ("hiz_read", "?"),
        ("hiz_write", "?"),
        ("hiz_killed", "?"),
        ("covered", "<u8"),
        ("z_read", "<u8"),
        ("z_write", "<u8"),
        ("stencil_read", "<u8"),
        ("stencil_write", "<u8"),
        ("color_read", "<u8", (4,)),
        ("color_write", "<u8", (4,)),
        ("bounds_failed", "<u8"),
        ("stencil_failed", "<u8"),
        ("depth_failed", "<u8"),
        ("discarded", "<u8"),
        ("span", "<u4", (2,)),
        ("stored", "<u4", (2,)),
    ]
)
