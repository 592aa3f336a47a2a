"""Rays for trimesh: in place of ``trimesh.ray.ray_pyembree`` and ``trimesh.ray.ray_triangle``.

>>> mesh.ray = gridel.trimesh.RayMeshIntersector(mesh)  # doctest: +SKIP

No ray slips between two triangles, no surface is counted twice, and there is no most number of hits. Rays may start at
any distance. Directions are rounded to single precision: a ray that is aimed at the border of an open mesh, or at a
silhouette, may pass beside it. Invalid rays, as of :class:`gridel.Scene`, hit nothing. A closed mesh thinner than a step
of the lattice is met as a flat one.

A face that a mesh has more than once counts once: faces with corners in exactly the same three places, in the same
winding, whether or not they share vertices. The first of them has the hits. Two faces in the same places with opposite
windings are two surfaces, as the walls of solids that touch are; a ray crosses both.
"""

from __future__ import annotations

import sys
from typing import Any, Optional, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._scene import Scene, _integer, _numbers, _threads

__all__ = ["RayMeshIntersector"]


def _firsts_of_equal(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> Optional[NDArray[np.int64]]:
    """The numbers of faces without those that an earlier face equals in places and winding; None if all differ."""
    # A hash of each place, so that most meshes need one sort of numbers; -0.0 is where 0.0 is.
    bits = (vertices + 0.0).view(np.uint64)
    factors = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], dtype=np.uint64)
    places = ((bits ^ (bits >> np.uint64(29))) * factors).sum(axis=1, dtype=np.uint64)
    places = (places ^ (places >> np.uint64(32))) * factors[0]
    hashes = places[faces].sum(axis=1, dtype=np.uint64)
    order = np.argsort(hashes, kind="stable")
    is_same = hashes[order[1:]] == hashes[order[:-1]]
    if not is_same.any():
        return None
    suspects = np.sort(order[np.append(is_same, False) | np.append(False, is_same)])
    # Compared exactly, each from its first place in order, so that the winding stays.
    corners = vertices[faces[suspects]] + 0.0
    _, ranks = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    ranks = ranks.reshape(-1, 3)
    turns = (ranks.argmin(axis=1)[:, None] + np.arange(3)) % 3
    _, kept = np.unique(np.take_along_axis(ranks, turns, axis=1), axis=0, return_index=True)
    is_kept = np.ones(len(faces), dtype=bool)
    is_kept[suspects] = False
    is_kept[suspects[kept]] = True
    return None if is_kept.all() else np.flatnonzero(is_kept)


class RayMeshIntersector:
    """Ray queries of a ``trimesh.Trimesh``, with the signatures and dtypes of trimesh's own class.

    ``scale_to_box`` is taken for its place among the arguments and changes nothing: coordinates are always centered and
    scaled. trimesh's two classes name the mesh ``geometry`` and ``mesh``; both names are right. ``threads`` is the number of
    threads, at most 1024, and 0 for one per core. A mesh that changes is compiled anew when it is asked next. A face that
    the mesh has more than once, in the same winding, counts once.
    """

    def __init__(self, geometry: Any = None, scale_to_box: bool = True, *, mesh: Any = None, threads: int = 0):
        if (geometry is None) == (mesh is None):
            raise TypeError("RayMeshIntersector takes one mesh, as geometry or as mesh")
        self.mesh = mesh if geometry is None else geometry
        self.threads = threads
        self._scale_to_box = scale_to_box
        self._compiled: Optional[Tuple[int, Optional[Scene], Optional[NDArray[np.int64]]]] = None

    def _compile(self) -> Tuple[int, Optional[Scene], Optional[NDArray[np.int64]]]:
        """The mesh's hash, the compiled mesh, and the numbers of its faces where they are not the mesh's own."""
        key = hash(self.mesh)
        if self._compiled is None or self._compiled[0] != key:
            vertices = np.array(self.mesh.vertices, dtype=np.float64, order="C")
            faces = np.asarray(self.mesh.faces, dtype=np.int64)
            kept = _firsts_of_equal(vertices, faces) if len(faces) else None
            if kept is not None:
                faces = faces[kept]
            scene = Scene.from_arrays(vertices, faces) if len(faces) else None
            self._compiled = (key, scene, kept)
        return self._compiled

    @property
    def scene(self) -> Optional[Scene]:
        """The compiled mesh; None of a mesh without faces.

        Its primitives are the mesh's faces without those that it has more than once.
        """
        return self._compile()[1]

    @staticmethod
    def _rays(origins: ArrayLike, directions: ArrayLike) -> Tuple[NDArray, NDArray]:
        """Rays as arrays (n, 3)."""
        arrays = [_numbers(origins, "ray_origins"), _numbers(directions, "ray_directions")]
        if arrays[0].shape != arrays[1].shape:
            raise ValueError("Ray origin and direction don't match!")
        if arrays[0].size == 0:
            return np.zeros((0, 3)), np.zeros((0, 3))
        if arrays[0].ndim != 2 or arrays[0].shape[1] != 3:
            raise ValueError(f"rays have the shape {arrays[0].shape}; it must be (n, 3)")
        return arrays[0], arrays[1]

    def intersects_location(
        self, ray_origins: ArrayLike, ray_directions: ArrayLike, multiple_hits: bool = True
    ) -> Tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
        """Returns where rays (n, 3) hit: locations (m, 3) float64, and of each its ray and its triangle, (m,) int64.

        Hits come ray by ray, in the order in which the ray meets them, and no location lies before the one before it.
        With ``multiple_hits`` they are all crossings; else the first hit of each ray.
        """
        origins, directions = self._rays(ray_origins, ray_directions)
        return self._locations(origins, directions, multiple_hits, None)

    def intersects_id(
        self,
        ray_origins: ArrayLike,
        ray_directions: ArrayLike,
        multiple_hits: bool = True,
        max_hits: Optional[int] = None,
        return_locations: bool = False,
    ) -> Union[
        Tuple[NDArray[np.int64], NDArray[np.int64]],
        Tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]],
    ]:
        """Returns the triangle and the ray of each hit, (m,) int64, and with ``return_locations`` its place (m, 3).

        ``max_hits`` is the most hits of a ray that are returned, the first ones; all of them by default. It saves the time
        of the others.
        """
        origins, directions = self._rays(ray_origins, ray_directions)
        locations, rays, triangles = self._locations(origins, directions, multiple_hits, max_hits)
        if return_locations:
            return triangles, rays, locations
        return triangles, rays

    def intersects_first(
        self, ray_origins: ArrayLike, ray_directions: ArrayLike
    ) -> NDArray[np.int32]:
        """Returns the first triangle of each ray: (n,) int32, -1 for none."""
        origins, directions = self._rays(ray_origins, ray_directions)
        _, scene, kept = self._compile()
        if scene is None:
            return np.full(len(origins), -1, dtype=np.int32)
        first = scene._native.first(origins, directions, "f32", _threads(self.threads))
        if kept is None:
            return first
        return np.where(first < 0, first, kept[first]).astype(np.int32)

    def intersects_any(
        self, ray_origins: ArrayLike, ray_directions: ArrayLike
    ) -> NDArray[np.bool_]:
        """Returns whether each ray hits the surface: (n,) bool."""
        origins, directions = self._rays(ray_origins, ray_directions)
        scene = self.scene
        if scene is None:
            return np.zeros(len(origins), dtype=bool)
        return scene._native.any_of(origins, directions, "f32", _threads(self.threads))

    def contains_points(self, points: ArrayLike) -> NDArray[np.bool_]:
        """Returns whether the mesh contains each point: points (n, 3), the result (n,) bool.

        Right for every closed mesh, also where it has faces twice; of an open one it says how often one ray leaves it. A
        point nearer to the surface than ``scene.displacement`` may be on either side. Points with nan or infinity are in
        no mesh.
        """
        points = _numbers(points, "points")
        if points.ndim != 2 or points.shape[1] != 3:
            if points.size == 0:
                return np.zeros(0, dtype=bool)
            raise ValueError(f"points have the shape {points.shape}; it must be (n, 3)")
        scene = self.scene
        if scene is None:
            return np.zeros(len(points), dtype=bool)
        return scene.contains(points, closed_only=False, threads=self.threads)

    def _locations(
        self, origins: NDArray, directions: NDArray, multiple_hits: bool, max_hits: Optional[int]
    ) -> Tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
        if max_hits is not None:
            max_hits = _integer(max_hits, "max_hits", 0, sys.maxsize)
        _, scene, kept = self._compile()
        if scene is None:
            return np.zeros((0, 3)), np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64)
        places, rays, triangles = scene._native.locations(
            origins, directions, bool(multiple_hits), max_hits, "f32", _threads(self.threads)
        )
        return places, rays, triangles if kept is None else kept[triangles]

    def __getstate__(self) -> dict:
        return {**self.__dict__, "_compiled": None}

    def __copy__(self, *_: Any) -> "RayMeshIntersector":
        other = type(self).__new__(type(self))
        other.__dict__.update(self.__getstate__())
        return other

    __deepcopy__ = __copy__
