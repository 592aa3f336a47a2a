"""Checks of arguments: each error names the argument, what it is, and what it must be."""

from __future__ import annotations

import math
import operator
from decimal import Decimal
from numbers import Real
from typing import Any, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._gridel import LATTICE_BITS
from ._warnings import warn

Accel = Union[str, Sequence[str]]

#: The largest number that is an option.
LARGEST = 0xFFFFFFFF

#: Sizes of a mesh from the origin at which it is compiled about a place of its own.
FAR = float(1 << 20)


def names(value: Any, what: str) -> list[str]:
    """One name or several."""
    if isinstance(value, str):
        return [value]
    try:
        found = list(value)
    except TypeError:
        found = [None]
    if not all(isinstance(name, str) for name in found):
        raise TypeError(f"{what} is {value!r}; it must be a name or a sequence of names")
    return found


def structures(value: Optional[Accel]) -> Optional[list[str]]:
    """Structures to build, or None."""
    if value is None:
        return None
    found = names(value, "accel")
    if not found:
        raise ValueError("accel is empty; name a structure, or leave accel out for the default")
    return found


def query(format: Any, accel: Any, count: Any) -> Tuple[str, Optional[str], int]:
    """Number format, structure and threads of a query."""
    if not isinstance(format, str):
        raise TypeError(f"format is {format!r}; it must be a string")
    return format, text(accel, "accel"), threads(count)


def integer(value: Any, what: str, least: int, most: int) -> int:
    """An integer from ``least`` to ``most``."""
    try:
        found = operator.index(value)
    except TypeError:
        raise TypeError(f"{what} is {value!r}; it must be an integer") from None
    if not least <= found <= most:
        raise ValueError(f"{what} is {found}; it must be {least} to {most}")
    return found


def bits(value: Any) -> int:
    """Bits of a lattice."""
    return integer(value, "lattice_bits", *LATTICE_BITS)


def text(value: Any, what: str, *, or_number: bool = False) -> Optional[str]:
    """A text, or None; some options may be a number from 0 in its place."""
    if value is None or isinstance(value, str):
        return value
    try:
        if or_number:
            return str(integer(value, what, 0, LARGEST))
    except TypeError:
        pass
    kinds = "a string or an integer" if or_number else "a string"
    raise TypeError(f"{what} is {value!r}; it must be {kinds}")


def character(value: Any, what: str) -> Optional[str]:
    """A single character, or None."""
    found = text(value, what)
    if found is not None and len(found) != 1:
        raise ValueError(f"{what} is {found!r}; it must be one character")
    return found


def flag(value: Any, what: str) -> bool:
    """True or False."""
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{what} is {value!r}; it must be True or False")
    return bool(value)


def seconds(value: Any, what: str) -> Optional[float]:
    """A time in seconds, or None."""
    if value is None:
        return None
    if not isinstance(value, Real):
        raise TypeError(f"{what} is {value!r}; it must be a number of seconds")
    if not math.isfinite(value):
        raise ValueError(f"{what} is {value}; it must be finite")
    return float(value)


def number(value: Any, what: str) -> float:
    """A number."""
    try:
        if isinstance(value, (str, bytes)) or np.ndim(value) != 0:
            raise TypeError
        return float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{what} is {value!r}; it must be a number") from None


def threads(value: Any, what: str = "threads") -> int:
    """A number of threads, at most as many as the program takes."""
    return integer(value, what, 0, 1024)


def numeric(values: ArrayLike, what: str) -> NDArray:
    """An array of float32 or float64 in C order, without a copy where it is one already."""
    array = np.asarray(values)
    if array.dtype not in (np.float32, np.float64):
        # The values of a DataFrame may be objects, each a number.
        is_numeric = array.dtype.kind in "iufb" or array.dtype == object and all(
            isinstance(value, (Real, Decimal, np.bool_)) for value in array.flat
        )
        if not is_numeric and array.size:
            raise TypeError(f"{what}: the array has the type {array.dtype}; it must be a type of numbers")
        array = array.astype(np.float64)
    return np.require(array, requirements="CA")


def rows(values: ArrayLike, widths: Tuple[int, ...], what: str) -> NDArray:
    """Rows of numbers."""
    array = numeric(values, what)
    # An empty list.
    if array.shape == (0,):
        return np.zeros((0, widths[0]))
    if array.ndim == 0 or array.shape[-1] not in widths:
        expected = " or ".join(str(width) for width in widths)
        raise ValueError(f"{what}: the array has the shape {array.shape}; its last axis must be {expected}")
    return array


def indexed(
    vertices: ArrayLike, faces: ArrayLike, what: Tuple[str, str]
) -> Tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices (n, 3), and faces (m, 3) that name them."""
    vertices = np.require(numeric(vertices, what[0]), np.float64, "CA")
    faces = np.asarray(faces)
    if faces.size and faces.dtype.kind not in "iu":
        raise TypeError(f"{what[1]}: the array has the type {faces.dtype}; it must be a type of integers")
    for name, array in zip(what, (vertices, faces)):
        if array.ndim != 2 or array.shape[1] != 3:
            raise ValueError(f"{name}: the array has the shape {array.shape}; it must be (n, 3)")
    is_valid = ((faces >= 0) & (faces < len(vertices))).all(axis=1)
    if not is_valid.all():
        place = int(np.argmin(is_valid))
        raise ValueError(
            f"{what[1]}: face {place} is {faces[place].tolist()}; "
            f"vertices are numbered 0 to {len(vertices) - 1}"
        )
    return vertices, np.require(faces, np.int64, "CA")


def mesh(
    vertices: ArrayLike, faces: ArrayLike, what: Tuple[str, str] = ("vertices", "faces")
) -> Tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices and faces as they are compiled. Vertices of faces are finite."""
    vertices, faces = indexed(vertices, faces, what)
    is_finite = np.isfinite(vertices).all(axis=1)
    if is_finite.all():
        return vertices, faces
    is_broken = np.zeros(len(vertices), bool)
    is_broken[faces] = True
    is_broken &= ~is_finite
    if is_broken.any():
        raise ValueError(
            f"{what[0]}: vertex {int(np.argmax(is_broken))} is not finite; give it a place, or leave out the faces "
            "that use it: faces[numpy.isfinite(vertices).all(axis=1)[faces].all(axis=1)]"
        )
    # Those that no face names mean nothing.
    return np.where(is_finite[:, None], vertices, 0.0), faces


def finite_faces(
    vertices: NDArray[np.float64], faces: NDArray[np.int64], what: str
) -> Optional[NDArray[np.int64]]:
    """The numbers of faces whose vertices are all finite; None if all are. Warns of the others."""
    is_finite = np.isfinite(vertices).all(axis=1)
    if is_finite.all():
        return None
    is_kept = is_finite[faces].all(axis=1)
    left_out = len(faces) - int(is_kept.sum())
    if left_out == 0:
        return None
    noun = "triangle" if left_out == 1 else "triangles"
    warn(f"{what}: {left_out} {noun} left out: a vertex of each is not finite; give such vertices places")
    return np.flatnonzero(is_kept)


def far_place(meshes: Sequence[Tuple[NDArray[np.float64], NDArray[np.int64]]]) -> Optional[NDArray[np.float64]]:
    """A place near meshes that are far from the origin in terms of their size; None of others.

    Of each axis it is the middle of the meshes, or 0 where that is nearer than their size: so nothing is rounded when it
    is subtracted from vertices.
    """
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for vertices, faces in meshes:
        is_used = np.zeros(len(vertices), bool)
        is_used[faces] = True
        used = vertices if is_used.all() else vertices[is_used]
        if len(used):
            low, high = np.minimum(low, used.min(axis=0)), np.maximum(high, used.max(axis=0))
    with np.errstate(over="ignore", invalid="ignore"):
        sides = high - low
        middle = low + 0.5 * sides
        is_far = np.abs(middle).max() > FAR * sides.max() > 0.0
    return np.where(np.abs(middle) > sides.max(), middle, 0.0) if is_far else None
