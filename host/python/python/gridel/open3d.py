"""Ray casting scenes in place of ``open3d.t.geometry.RaycastingScene``; Open3D need not be installed.

Tensors in, tensors out: where a query is given an Open3D tensor, its results are Open3D tensors. Otherwise they are
NumPy arrays with a method ``numpy()``, so that code for Open3D need not be changed.
"""

from __future__ import annotations

import sys
from typing import Any, Optional, Tuple

import numpy as np

from ._scene import MISS, Scene

__all__ = ["Array", "RaycastingScene"]


class Array(np.ndarray):
    """A NumPy array with Open3D's method ``numpy()``."""

    def numpy(self) -> np.ndarray:
        """Returns the plain array, without a copy."""
        return self.view(np.ndarray)


def _is_tensor(value: Any) -> bool:
    return type(value).__module__.startswith("open3d")


def _array(value: Any) -> np.ndarray:
    return value.numpy() if _is_tensor(value) else np.asarray(value)


def _like(given: Any, result: np.ndarray) -> Any:
    """Returns the result in the form of the argument."""
    if _is_tensor(given):
        return sys.modules["open3d"].core.Tensor(np.ascontiguousarray(result))
    return result.view(Array)


class RaycastingScene:
    """Triangle meshes, each with the number of its geometry, and rays cast through all of them.

    The methods have the names, arguments, keys and dtypes of Open3D's. Rays (..., 6) are origin and direction, float32 or
    float64; ``t_hit`` counts multiples of the direction. Meshes are compiled when the first ray is cast after one was
    added. ``nthreads`` is 0 for one thread per core. A ray through an edge or a vertex is counted once.
    """

    INVALID_ID = MISS

    def __init__(self, nthreads: int = 0, device: Any = None):
        # Open3D's are for building alone.
        del nthreads, device
        self._meshes: list[Tuple[np.ndarray, np.ndarray]] = []
        self._firsts = np.zeros(1, dtype=np.int64)
        self._scene: Optional[Scene] = None

    def add_triangles(self, vertex_positions: Any, triangle_indices: Any = None) -> int:
        """Adds a mesh and returns the number of its geometry.

        Give vertices (n, 3) and triangles (m, 3), or an ``open3d.t.geometry.TriangleMesh`` alone.
        """
        if triangle_indices is None:
            mesh = vertex_positions
            vertex_positions, triangle_indices = mesh.vertex.positions, mesh.triangle.indices
        vertices = np.array(_array(vertex_positions), dtype=np.float64)
        triangles = np.array(_array(triangle_indices), dtype=np.int64)
        for what, array in (("vertex_positions", vertices), ("triangle_indices", triangles)):
            if array.ndim != 2 or array.shape[1] != 3:
                raise ValueError(f"{what}: the array has the shape {array.shape}; it must be (n, 3)")
        if triangles.size and not (0 <= triangles.min() and triangles.max() < len(vertices)):
            raise ValueError(f"triangle_indices: vertices are numbered 0 to {len(vertices) - 1}")
        self._meshes.append((vertices, triangles))
        self._firsts = np.append(self._firsts, self._firsts[-1] + len(triangles))
        self._scene = None
        return len(self._meshes) - 1

    @property
    def scene(self) -> Optional[Scene]:
        """The compiled scene; None without triangles."""
        if self._scene is None and self._firsts[-1] > 0:
            self._scene = Scene._from_meshes(self._meshes)
        return self._scene

    @staticmethod
    def _rays(rays: Any) -> np.ndarray:
        array = _array(rays)
        if array.ndim < 1 or array.shape[-1] != 6:
            raise ValueError(f"rays: the array has the shape {array.shape}; its last axis must be 6")
        return array if array.dtype in (np.float32, np.float64) else array.astype(np.float32)

    def _identify(self, objects: np.ndarray, primitives: np.ndarray) -> np.ndarray:
        """The numbers of triangles in their own meshes."""
        hit = primitives != MISS
        primitives[hit] -= self._firsts[objects[hit]].astype(np.uint32)
        return primitives

    def cast_rays(self, rays: Any, nthreads: int = 0) -> dict[str, Any]:
        """Returns the first hits of rays (..., 6).

        Keys: ``t_hit`` (...) float32, inf on a miss; ``geometry_ids`` and ``primitive_ids`` (...) uint32,
        ``INVALID_ID`` on a miss; ``primitive_uvs`` (..., 2) and ``primitive_normals`` (..., 3) float32, 0 on a miss.
        """
        array = self._rays(rays)
        shape = array.shape[:-1]
        if self.scene is None:
            hits = {
                "t_hit": np.full(shape, np.inf, dtype=np.float32),
                "geometry_ids": np.full(shape, MISS, dtype=np.uint32),
                "primitive_ids": np.full(shape, MISS, dtype=np.uint32),
                "primitive_uvs": np.zeros(shape + (2,), dtype=np.float32),
                "primitive_normals": np.zeros(shape + (3,), dtype=np.float32),
            }
        else:
            t, geometries, primitives, normals, uvs = self.scene._native.cast_rays(
                np.ascontiguousarray(array), nthreads
            )
            hits = {
                "t_hit": t.reshape(shape),
                "geometry_ids": geometries.reshape(shape),
                "primitive_ids": primitives.reshape(shape),
                "primitive_uvs": uvs.reshape(shape + (2,)),
                "primitive_normals": normals.reshape(shape + (3,)),
            }
        return {key: _like(rays, value) for key, value in hits.items()}

    def test_occlusions(
        self, rays: Any, tnear: float = 0.0, tfar: float = float("inf"), nthreads: int = 0
    ) -> Any:
        """Returns whether rays (..., 6) hit anything from ``tnear`` to ``tfar``: (...) bool."""
        array = self._rays(rays)
        if self.scene is None:
            return _like(rays, np.zeros(array.shape[:-1], dtype=bool))
        if tnear != 0.0 or tfar != float("inf"):
            limited = np.empty(array.shape[:-1] + (8,), dtype=array.dtype)
            limited[..., 0:3], limited[..., 4:7] = array[..., 0:3], array[..., 3:6]
            limited[..., 3], limited[..., 7] = tnear, tfar
            array = limited
        return _like(rays, self.scene.any(array, threads=nthreads))

    def count_intersections(self, rays: Any, nthreads: int = 0) -> Any:
        """Returns the number of crossings of rays (..., 6): (...) int32."""
        array = self._rays(rays)
        if self.scene is None:
            return _like(rays, np.zeros(array.shape[:-1], dtype=np.int32))
        counts = self.scene.count(array, format="f32", threads=nthreads)
        return _like(rays, counts.astype(np.int32))

    def list_intersections(self, rays: Any, nthreads: int = 0) -> dict[str, Any]:
        """Returns all crossings of rays (..., 6), ray by ray.

        Keys: ``ray_splits`` (n + 1) uint32, where the hits of each ray begin and end. ``ray_ids``,
        ``geometry_ids`` and ``primitive_ids`` (m) uint32. ``t_hit`` (m) float32. ``primitive_uvs``
        (m, 2) float32.
        """
        array = self._rays(rays).reshape(-1, 6)
        if self.scene is None:
            none = np.zeros(0, dtype=np.uint32)
            splits = np.zeros(len(array) + 1, dtype=np.uint32)
            hits = (splits, none, none, none, np.zeros(0, np.float32), np.zeros((0, 2), np.float32))
        else:
            found = self.scene.all(array, format="f32", threads=nthreads)
            splits = np.searchsorted(found.ray, np.arange(len(array) + 1)).astype(np.uint32)
            hits = (
                splits,
                found.ray.astype(np.uint32),
                found.object,
                self._identify(found.object, found.primitive),
                found.t.astype(np.float32),
                found.uv,
            )
        keys = ("ray_splits", "ray_ids", "geometry_ids", "primitive_ids", "t_hit", "primitive_uvs")
        return {key: _like(rays, value) for key, value in zip(keys, hits)}

    def compute_occupancy(self, query_points: Any, nthreads: int = 0, nsamples: int = 1) -> Any:
        """Returns 1 for points (..., 3) inside of a mesh and 0 for others: (...) float32.

        One ray is enough; ``nsamples`` is taken for its place among the arguments.
        """
        points = _array(query_points)
        if self.scene is None:
            return _like(query_points, np.zeros(points.shape[:-1], dtype=np.float32))
        inside = self.scene.contains(points, closed_only=False, threads=nthreads)
        return _like(query_points, inside.astype(np.float32))

    @staticmethod
    def create_rays_pinhole(*args: Any, **kwargs: Any) -> Any:
        """Returns rays (height_px, width_px, 6) float32 of a pinhole camera; directions are not normalized.

        Two forms, as in Open3D: ``(intrinsic_matrix, extrinsic_matrix, width_px, height_px)`` and ``(fov_deg, center,
        eye, up, width_px, height_px)`` with a horizontal field of view.
        """
        by_field_of_view = ("fov_deg", "center", "eye", "up", "width_px", "height_px")
        by_matrices = ("intrinsic_matrix", "extrinsic_matrix", "width_px", "height_px")
        names = by_field_of_view if len(args) + len(kwargs) == 6 else by_matrices
        given = {**dict(zip(names, args)), **kwargs}
        if set(given) != set(names) or len(args) + len(kwargs) != len(names):
            raise TypeError(f"create_rays_pinhole takes {', '.join(by_matrices)} or {', '.join(by_field_of_view)}")
        width, height = int(given["width_px"]), int(given["height_px"])
        if width < 1 or height < 1:
            raise ValueError("width_px and height_px must be above 0")
        of_tensors = next((value for value in given.values() if _is_tensor(value)), None)
        if names is by_matrices:
            intrinsic = np.asarray(_array(given["intrinsic_matrix"]), dtype=np.float64)
            extrinsic = np.asarray(_array(given["extrinsic_matrix"]), dtype=np.float64)
            turn = extrinsic[:3, :3]
            eye = -turn.T @ extrinsic[:3, 3]
            into = turn.T @ np.linalg.inv(intrinsic)
        else:
            center, eye, up = (
                np.asarray(_array(given[name]), dtype=np.float64) for name in ("center", "eye", "up")
            )
            ahead = center - eye
            ahead = ahead / np.linalg.norm(ahead)
            across = np.cross(up, ahead)
            across = across / np.linalg.norm(across)
            down = np.cross(ahead, across)
            focal = 0.5 * width / np.tan(0.5 * np.deg2rad(float(given["fov_deg"])))
            middle = np.array([0.5 * width, 0.5 * height])
            into = np.stack(
                [across / focal, down / focal, ahead - (across * middle[0] + down * middle[1]) / focal],
                axis=1,
            )
        x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
        pixels = np.stack([x, y, np.ones_like(x)], axis=-1)
        rays = np.empty((height, width, 6), dtype=np.float32)
        rays[..., :3] = eye
        rays[..., 3:] = pixels @ into.T
        return _like(of_tensors, rays)
