"""Warnings at the line of whoever called the package."""

import sys
import warnings
from types import FrameType
from typing import Optional

#: Packages whose lines no user wrote: what trimesh calls was called by a user of trimesh.
_INNER = ("gridel", "trimesh")


def warn(text: str) -> None:
    """Issues a UserWarning at the nearest line outside of the package.

    Python shows a warning once for each line that it names. By a line of the package it would be shown once in all.
    """
    level = 1
    frame: Optional[FrameType] = sys._getframe()
    while frame is not None and frame.f_globals.get("__name__", "").partition(".")[0] in _INNER:
        level += 1
        frame = frame.f_back
    warnings.warn(text, UserWarning, stacklevel=level)
