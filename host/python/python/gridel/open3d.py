"""Ray casting scenes in place of ``open3d.t.geometry.RaycastingScene``; Open3D need not be installed.

Tensors in, tensors out: where a query is given an Open3D tensor, its results are Open3D tensors. Otherwise they are
an :class:`Array`, a NumPy array with methods of tensors such as ``numpy()`` and ``isfinite()``, so that code for Open3D
need not be changed.
"""

from __future__ import annotations

import math
import sys
from typing import TYPE_CHECKING, Any, Optional, Tuple

import numpy as np

from ._arguments import far_place, finite_faces, indexed, integer, mesh as checked_mesh, number, rows
from ._cameras import pinhole
from ._scene import MISS, Scene
from ._slots import restore, slots_of, state_of
from ._tensors import Array, array_of, is_device, like

__all__ = ["Array", "RaycastingScene"]


#: The greatest t that is finite in single precision, to which it is rounded.
_FARTHEST = float(np.nextafter(2.0**128 - 2.0**103, 0.0))


def _nthreads(value: Any) -> int:
    """A number of threads: as in Open3D one below 0 means all cores, and there is no greatest."""
    return min(max(integer(value, "nthreads", -sys.maxsize, sys.maxsize), 0), 1024)


def _between(limit: float, toward: float) -> float:
    """The farthest number that is the limit in single precision, on the side where hits are."""
    with np.errstate(over="ignore"):
        single = np.float32(limit)
        beyond = np.nextafter(single, np.float32(toward))
    if not np.isfinite(single) or single == 0.0:
        return float(single)
    if not np.isfinite(beyond):
        return math.copysign(_FARTHEST, limit)
    return float(single) + 0.5 * (float(beyond) - float(single))


def _limited(rays: np.ndarray, tmin: float, tmax: float) -> np.ndarray:
    """Rays (..., 6) with limits: (..., 8)."""
    limited = np.empty(rays.shape[:-1] + (8,))
    limited[..., 0:3], limited[..., 4:7] = rays[..., 0:3], rays[..., 3:6]
    limited[..., 3], limited[..., 7] = tmin, tmax
    return limited


class RaycastingScene:
    """Triangle meshes, each with the number of its geometry, and rays cast through all of them.

    The methods have the names, arguments, keys and dtypes of Open3D's. Rays (..., 6) are origin and direction, float32 or
    float64; ``t_hit`` counts multiples of the direction. Meshes are compiled when the first ray is cast after one was
    added. ``nthreads`` below 1 is one thread per core, and above 1024 it is 1024. A ray through an edge or a vertex is
    counted once.
    Directions are rounded to single precision: a ray that is aimed at the border of an open mesh, or at a silhouette, may
    pass beside it. Rays may start at any distance. Invalid rays, as of :class:`gridel.Scene`, hit nothing. A closed mesh
    thinner than a step of the lattice is met as a flat one. A triangle that was added twice counts twice. Meshes may lie
    far from the origin: they are compiled about a place near them. There are no queries of distances.
    """

    INVALID_ID = MISS

    def __init__(self, nthreads: int = 0, device: Any = None):
        # Open3D's are for building alone.
        _nthreads(nthreads)
        if device is not None and not is_device(device):
            raise TypeError(f"device is {device!r}; it must be a device of Open3D's, or its name, such as 'CPU:0'")
        self._meshes: list[Tuple[np.ndarray, np.ndarray]] = []
        # Of each mesh the numbers of its triangles that are compiled; None of all.
        self._kept: list[Optional[np.ndarray]] = []
        self._firsts = np.zeros(1, dtype=np.int64)
        self._scene: Optional[Scene] = None
        self._place: Optional[np.ndarray] = None

    def add_triangles(
        self, vertex_positions: Any = None, triangle_indices: Any = None, *, mesh: Any = None
    ) -> int:
        """Adds a mesh and returns the number of its geometry.

        Give vertices (n, 3) and triangles (m, 3), as tensors, arrays or the vectors of a legacy mesh, or an
        ``open3d.t.geometry.TriangleMesh`` alone. Triangles with a vertex that is not finite are left out, with a warning;
        the others keep their numbers. Raises ValueError for triangles that name no vertex, and TypeError for indices that
        are no integers.
        """
        if mesh is None and triangle_indices is None:
            mesh, vertex_positions = vertex_positions, None
        if (mesh is None) == (vertex_positions is None):
            raise TypeError("add_triangles takes vertex_positions and triangle_indices, or mesh")
        if mesh is not None:
            try:
                vertex_positions, triangle_indices = mesh.vertex.positions, mesh.triangle.indices
            except KeyError as key:
                raise ValueError(f"mesh has no vertex positions or no triangle indices: {key.args[0]}") from None
            except AttributeError:
                kind = f"{type(mesh).__module__}.{type(mesh).__qualname__}"
                raise TypeError(
                    f"mesh is a {kind}; it must be an open3d.t.geometry.TriangleMesh. "
                    "Give vertices and triangles of other meshes: add_triangles(mesh.vertices, mesh.triangles)"
                ) from None
        names = ("vertex_positions", "triangle_indices")
        vertices, triangles = array_of(vertex_positions, names[0]), array_of(triangle_indices, names[1])
        vertices, triangles = indexed(vertices, triangles, names)
        kept = finite_faces(vertices, triangles, names[0])
        vertices, triangles = checked_mesh(vertices, triangles if kept is None else triangles[kept])
        # Copies, as they are compiled later.
        self._meshes.append((vertices.copy(), triangles.copy()))
        self._kept.append(kept)
        self._firsts = np.append(self._firsts, self._firsts[-1] + len(triangles))
        self._scene = None
        return len(self._meshes) - 1

    @property
    def scene(self) -> Optional[Scene]:
        """The compiled scene; None without triangles. Its coordinates count from :attr:`scene_origin`."""
        if self._scene is None and self._firsts[-1] > 0:
            place, meshes = far_place(self._meshes), self._meshes
            if place is not None:
                meshes = [(vertices - place, triangles) for vertices, triangles in meshes]
            self._scene, self._place = Scene._from_meshes(meshes), place
        return self._scene

    @property
    def scene_origin(self) -> np.ndarray:
        """(3,) float64: the place from which coordinates of :attr:`scene` count.

        It is 0, or near the meshes where they are farther from the origin than 2^20 times their size.
        """
        is_moved = self.scene is not None and self._place is not None
        return self._place.copy() if is_moved else np.zeros(3)

    def _moved(self, values: np.ndarray) -> np.ndarray:
        """Rays or points (..., 3 or more) as :attr:`scene` has them."""
        if self.scene is None or self._place is None:
            return values
        values = values.astype(np.float64)
        values[..., :3] -= self._place
        return values

    def _rays(self, rays: Any) -> np.ndarray:
        return self._moved(rows(array_of(rays, "rays"), (6,), "rays"))

    def _may_leave_single_precision(self, rays: np.ndarray) -> bool:
        """Returns true if a hit of any ray (..., 6) can have a t beyond single precision."""
        if rays.size == 0:
            return False
        rays = rays if rays.dtype.kind == "f" else rays.astype(np.float64)
        directions = rays[..., 3:6].reshape(-1, 3)
        shortest = np.sqrt(float(np.einsum("ij,ij->i", directions, directions).min()))
        farthest = max(float(rays.max()), -float(rays.min()), *np.abs(self.scene.bounds).ravel().tolist())
        # Not a number where a ray is not of numbers.
        return not 4.0 * farthest < shortest * float(np.finfo(np.float32).max)

    def _identify(self, objects: np.ndarray, primitives: np.ndarray) -> np.ndarray:
        """The numbers of triangles in their own meshes, given those among all that are compiled."""
        hit = primitives != MISS
        primitives[hit] -= self._firsts[objects[hit]].astype(np.uint32)
        return self._numbered(objects, primitives)

    def _numbered(self, objects: np.ndarray, primitives: np.ndarray) -> np.ndarray:
        """The numbers of triangles as they were given, given those among the compiled ones of their meshes."""
        for geometry, kept in enumerate(self._kept):
            if kept is not None:
                of_mesh = objects == geometry
                primitives[of_mesh] = kept[primitives[of_mesh]]
        return primitives

    def cast_rays(self, rays: Any, nthreads: int = 0) -> dict[str, Any]:
        """Returns the first hits of rays (..., 6).

        Keys: ``t_hit`` (...) float32, inf on a miss; ``geometry_ids`` and ``primitive_ids`` (...) uint32,
        ``INVALID_ID`` on a miss and where t leaves single precision; ``primitive_uvs`` (..., 2) and ``primitive_normals``
        (..., 3) float32, 0 on a miss.
        """
        array, threads = self._rays(rays), _nthreads(nthreads)
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
            t, geometries, primitives, normals, uvs = self.scene._native.cast_rays(array, threads)
            hits = {
                "t_hit": t.reshape(shape),
                "geometry_ids": geometries.reshape(shape),
                "primitive_ids": self._numbered(geometries, primitives).reshape(shape),
                "primitive_uvs": uvs.reshape(shape + (2,)),
                "primitive_normals": normals.reshape(shape + (3,)),
            }
        return {key: like(rays, value) for key, value in hits.items()}

    def test_occlusions(
        self, rays: Any, tnear: float = 0.0, tfar: float = float("inf"), nthreads: int = 0
    ) -> Any:
        """Returns whether rays (..., 6) hit anything from ``tnear`` to ``tfar``: (...) bool.

        Hits at the limits count. They are compared in single precision, with the t that :meth:`cast_rays` returns. A
        ``tnear`` of 0 is the origin: whether a ray hits the surface on which it starts is not certain.
        """
        array = self._rays(rays)
        tnear, tfar = number(tnear, "tnear"), number(tfar, "tfar")
        threads = _nthreads(nthreads)
        if self.scene is None:
            return like(rays, np.zeros(array.shape[:-1], dtype=bool))
        far = _between(tfar, np.inf)
        if far == np.inf and self._may_leave_single_precision(array):
            # Beyond it nothing is met.
            far = _FARTHEST
        if tnear != 0.0 or far != np.inf:
            array = _limited(array, _between(tnear, -np.inf), far)
        return like(rays, self.scene.any(array, threads=threads))

    def count_intersections(self, rays: Any, nthreads: int = 0) -> Any:
        """Returns the number of crossings of rays (..., 6): (...) int32."""
        array, threads = self._rays(rays), _nthreads(nthreads)
        if self.scene is None:
            return like(rays, np.zeros(array.shape[:-1], dtype=np.int32))
        if self._may_leave_single_precision(array):
            # Beyond it nothing is met.
            array = _limited(array, 0.0, _FARTHEST)
        counts = self.scene.count(array, format="f32", threads=threads)
        return like(rays, counts.astype(np.int32))

    def list_intersections(self, rays: Any, nthreads: int = 0) -> dict[str, Any]:
        """Returns all crossings of rays (..., 6), ray by ray.

        Keys: ``ray_splits`` (n + 1) uint32, where the hits of each ray begin and end. ``ray_ids``,
        ``geometry_ids`` and ``primitive_ids`` (m) uint32. ``t_hit`` (m) float32. ``primitive_uvs``
        (m, 2) float32.
        """
        array, threads = self._rays(rays).reshape(-1, 6), _nthreads(nthreads)
        if self.scene is None:
            none = np.zeros(0, dtype=np.uint32)
            splits = np.zeros(len(array) + 1, dtype=np.uint32)
            hits = (splits, none, none, none, np.zeros(0, np.float32), np.zeros((0, 2), np.float32))
        else:
            found = self.scene.all(array, format="f32", threads=threads)
            # Beyond single precision nothing is met.
            kept = found.t <= _FARTHEST
            ray, objects, primitives, t, uv = (
                column if kept.all() else column[kept]
                for column in (found.ray, found.object, found.primitive, found.t, found.uv)
            )
            splits = np.searchsorted(ray, np.arange(len(array) + 1)).astype(np.uint32)
            hits = (
                splits,
                ray.astype(np.uint32),
                objects,
                self._identify(objects, primitives),
                t.astype(np.float32),
                uv,
            )
        keys = ("ray_splits", "ray_ids", "geometry_ids", "primitive_ids", "t_hit", "primitive_uvs")
        return {key: like(rays, value) for key, value in zip(keys, hits)}

    def compute_occupancy(self, query_points: Any, nthreads: int = 0, nsamples: int = 1) -> Any:
        """Returns 1 for points (..., 3) that all meshes together enclose an odd number of times, else 0: (...) float32.

        A point in two meshes is outside, as in Open3D. A mesh whose triangles are all there twice contains nothing. One
        ray is enough: ``nsamples``, an odd number, changes nothing.
        Points with nan or infinity are outside.
        """
        nsamples = integer(nsamples, "nsamples", -sys.maxsize, sys.maxsize)
        if nsamples < 1 or nsamples % 2 == 0:
            raise ValueError(f"nsamples is {nsamples}; it must be odd and at least 1")
        points, threads = rows(array_of(query_points, "query_points"), (3,), "query_points"), _nthreads(nthreads)
        if self.scene is None:
            return like(query_points, np.zeros(points.shape[:-1], dtype=np.float32))
        inside = self.scene._native.contains(self._moved(points), "scene", "f64", None, threads)
        return like(query_points, inside.reshape(points.shape[:-1]).astype(np.float32))

    def __getstate__(self) -> Any:
        return state_of({**self.__dict__, "_scene": None, "_place": None}, slots_of(self, RaycastingScene))

    def __copy__(self) -> "RaycastingScene":
        other = type(self).__new__(type(self))
        # Meshes do not change, nor does what was compiled of them; the list does.
        own = {**self.__dict__, "_meshes": list(self._meshes), "_kept": list(self._kept)}
        restore(other, state_of(own, slots_of(self, RaycastingScene)))
        return other

    # Type checkers would believe that every attribute is there.
    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            if name in ("compute_distance", "compute_signed_distance", "compute_closest_points"):
                raise AttributeError(
                    f"{name} is not part of gridel.open3d, which has no queries of distances; "
                    "use open3d.t.geometry.RaycastingScene for it"
                )
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")

    @staticmethod
    def create_rays_pinhole(*args: Any, **kwargs: Any) -> Any:
        """Returns rays (height_px, width_px, 6) float32 of a pinhole camera; directions are not normalized.

        Two forms, as in Open3D: ``(intrinsic_matrix, extrinsic_matrix, width_px, height_px)`` and ``(fov_deg, center,
        eye, up, width_px, height_px)`` with a horizontal field of view in degrees. Raises ValueError for an
        intrinsic matrix that is singular, and for a view without a direction or along ``up``.
        """
        return pinhole(args, kwargs)
