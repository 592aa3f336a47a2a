"""Rays for trimesh: in place of ``trimesh.ray.ray_pyembree`` and ``trimesh.ray.ray_triangle``.

>>> mesh.ray = gridel.trimesh.RayMeshIntersector(mesh)  # doctest: +SKIP

No ray slips between two triangles, no surface is counted twice, and there is no most number of hits. Rays may start at
any distance. Directions are rounded to single precision: a ray that is aimed at the border of an open mesh, or at a
silhouette, may pass beside it. Invalid rays, as of :class:`gridel.Scene`, hit nothing. A closed mesh thinner than a step
of the lattice is met as a flat one.
"""

from __future__ import annotations

import sys
from typing import Any, Optional, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._scene import Scene, _integer, _numbers, _threads

__all__ = ["RayMeshIntersector"]


class RayMeshIntersector:
    """Ray queries of a ``trimesh.Trimesh``, with the signatures and dtypes of trimesh's own class.

    ``scale_to_box`` is taken for its place among the arguments and changes nothing: coordinates are always centered and
    scaled. ``threads`` is the number of threads, at most 1024, and 0 for one per core. A mesh that changes is compiled anew when it is
    asked next.
    """

    def __init__(self, geometry: Any, scale_to_box: bool = True, *, threads: int = 0):
        self.mesh = geometry
        self.threads = threads
        self._scale_to_box = scale_to_box
        self._compiled: Optional[Tuple[int, Optional[Scene]]] = None

    @property
    def scene(self) -> Optional[Scene]:
        """The compiled mesh; None of a mesh without faces."""
        key = hash(self.mesh)
        if self._compiled is None or self._compiled[0] != key:
            vertices = np.asarray(self.mesh.vertices, dtype=np.float64)
            faces = np.asarray(self.mesh.faces, dtype=np.int64)
            scene = Scene.from_arrays(vertices, faces) if len(faces) else None
            self._compiled = (key, scene)
        return self._compiled[1]

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

        ``max_hits`` is the most hits of a ray that are returned; all of them by default.
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
        if self.scene is None:
            return np.full(len(origins), -1, dtype=np.int32)
        return self.scene._native.first(origins, directions, "f32", _threads(self.threads))

    def intersects_any(
        self, ray_origins: ArrayLike, ray_directions: ArrayLike
    ) -> NDArray[np.bool_]:
        """Returns whether each ray hits the surface: (n,) bool."""
        origins, directions = self._rays(ray_origins, ray_directions)
        if self.scene is None:
            return np.zeros(len(origins), dtype=bool)
        return self.scene._native.any_of(origins, directions, "f32", _threads(self.threads))

    def contains_points(self, points: ArrayLike) -> NDArray[np.bool_]:
        """Returns whether the mesh contains each point: points (n, 3), the result (n,) bool.

        Right for every closed mesh; of an open one it says how often one ray leaves it. A point nearer to the surface
        than ``scene.displacement`` may be on either side. Points with nan or infinity are in no mesh.
        """
        points = _numbers(points, "points")
        if points.ndim != 2 or points.shape[1] != 3:
            if points.size == 0:
                return np.zeros(0, dtype=bool)
            raise ValueError(f"points have the shape {points.shape}; it must be (n, 3)")
        if self.scene is None:
            return np.zeros(len(points), dtype=bool)
        return self.scene.contains(points, closed_only=False, threads=self.threads)

    def _locations(
        self, origins: NDArray, directions: NDArray, multiple_hits: bool, max_hits: Optional[int]
    ) -> Tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
        if max_hits is not None:
            max_hits = _integer(max_hits, "max_hits", 0, sys.maxsize)
        scene = self.scene
        if scene is None:
            return np.zeros((0, 3)), np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64)
        return scene._native.locations(
            origins, directions, bool(multiple_hits), max_hits, "f32", _threads(self.threads)
        )

    def __getstate__(self) -> dict:
        return {**self.__dict__, "_compiled": None}

    def __copy__(self, *_: Any) -> "RayMeshIntersector":
        return RayMeshIntersector(self.mesh, self._scale_to_box, threads=self.threads)

    __deepcopy__ = __copy__
