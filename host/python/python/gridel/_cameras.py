"""Rays of pinhole cameras."""

from __future__ import annotations

import sys
from typing import Any, Tuple

import numpy as np

from ._arguments import integer, number, numeric
from ._tensors import array_of, is_tensor, like

_BY_FIELD_OF_VIEW = ("fov_deg", "center", "eye", "up", "width_px", "height_px")
_BY_MATRICES = ("intrinsic_matrix", "extrinsic_matrix", "width_px", "height_px")


def _numbers(value: Any, name: str, shape: Tuple[int, ...]) -> np.ndarray:
    """An array of finite numbers."""
    array = numeric(array_of(value, name), name).astype(np.float64)
    if array.shape != shape:
        raise ValueError(f"{name}: the array has the shape {array.shape}; it must be {shape}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name}: a number is not finite")
    return array


def _by_matrices(intrinsic: np.ndarray, extrinsic: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """Returns where rays begin, and the matrix that turns pixels into directions."""
    if np.linalg.matrix_rank(intrinsic) < 3:
        raise ValueError("intrinsic_matrix is singular; its focal lengths and its last number must not be 0")
    turn = extrinsic[:3, :3]
    return -turn.T @ extrinsic[:3, 3], turn.T @ np.linalg.inv(intrinsic)


def _by_field_of_view(
    degrees: float, places: Tuple[np.ndarray, np.ndarray, np.ndarray], size: Tuple[int, int]
) -> np.ndarray:
    """Returns the matrix that turns pixels into directions."""
    if not 0.0 < degrees < 180.0:
        raise ValueError(f"fov_deg is {degrees}; it must be above 0 and below 180")
    center, eye, up = places
    ahead = center - eye
    if not ahead.any():
        raise ValueError("center and eye are the same place; center must be where the camera looks")
    ahead = ahead / np.linalg.norm(ahead)
    if not up.any():
        raise ValueError("up is zero; it must be a direction")
    across = np.cross(up / np.linalg.norm(up), ahead)
    if np.linalg.norm(across) < 1e-12:
        raise ValueError("up is parallel to the view from eye to center; give another direction")
    across = across / np.linalg.norm(across)
    down = np.cross(ahead, across)
    focal = 0.5 * size[0] / np.tan(0.5 * np.deg2rad(degrees))
    corner = ahead - (across * (0.5 * size[0]) + down * (0.5 * size[1])) / focal
    return np.stack([across / focal, down / focal, corner], axis=1)


def pinhole(args: Tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
    """The rays of ``RaycastingScene.create_rays_pinhole``."""
    names = _BY_FIELD_OF_VIEW if len(args) + len(kwargs) == 6 else _BY_MATRICES
    given = {**dict(zip(names, args)), **kwargs}
    if set(given) != set(names) or len(args) + len(kwargs) != len(names):
        raise TypeError(f"create_rays_pinhole takes {', '.join(_BY_MATRICES)} or {', '.join(_BY_FIELD_OF_VIEW)}")
    width, height = (integer(given[name], name, 1, sys.maxsize) for name in ("width_px", "height_px"))
    if names is _BY_MATRICES:
        intrinsic = _numbers(given["intrinsic_matrix"], "intrinsic_matrix", (3, 3))
        eye, into = _by_matrices(intrinsic, _numbers(given["extrinsic_matrix"], "extrinsic_matrix", (4, 4)))
    else:
        center, eye, up = (_numbers(given[name], name, (3,)) for name in ("center", "eye", "up"))
        into = _by_field_of_view(number(given["fov_deg"], "fov_deg"), (center, eye, up), (width, height))
    x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    pixels = np.stack([x, y, np.ones_like(x)], axis=-1)
    rays = np.empty((height, width, 6), dtype=np.float32)
    rays[..., :3] = eye
    rays[..., 3:] = pixels @ into.T
    return like(next((value for value in given.values() if is_tensor(value)), None), rays)
