"""Rays for trimesh: in place of ``trimesh.ray.ray_pyembree`` and ``trimesh.ray.ray_triangle``.

>>> mesh.ray = gridel.trimesh.RayMeshIntersector(mesh)  # doctest: +SKIP

The signatures are those of ``ray_pyembree``, which trimesh uses with embreex; ``ray_triangle`` has other arguments and
another order. trimesh makes a ray object of its own for each new mesh, also for those of ``mesh.copy()`` and
``mesh.submesh()``: set ``ray`` of these as well. With embreex, this sets it for all meshes that are made later:

>>> trimesh.ray.ray_pyembree.RayMeshIntersector = gridel.trimesh.RayMeshIntersector  # doctest: +SKIP

No ray slips between two triangles, no surface is counted twice, and there is no most number of hits. Rays may start at
any distance. Directions are rounded to single precision: a ray that is aimed at the border of an open mesh, or at a
silhouette, may pass beside it. Invalid rays, as of :class:`gridel.Scene`, hit nothing. A closed mesh thinner than a step
of the lattice is met as a flat one.

A face that a mesh has more than once counts once: faces with corners in exactly the same three places, in the same
winding, whether or not they share vertices. The first of them has the hits. Only ``contains_points`` leaves such a face
out where this closes the mesh: see there. Two faces in the same places with opposite windings are two surfaces, as the
walls of solids that touch are; a ray crosses both.
"""

from __future__ import annotations

import sys
from typing import Any, Literal, NamedTuple, Optional, Tuple, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arguments import far_place, finite_faces, indexed, integer, numeric, threads as checked_threads
from ._duplicates import bounding, firsts_of_equal
from ._scene import Scene
from ._slots import restore, slots_of, state_of

__all__ = ["RayMeshIntersector"]


class _Compiled(NamedTuple):
    """A mesh as it was compiled."""

    #: The mesh's hash.
    key: int
    #: None without faces.
    scene: Optional[Scene]
    #: The numbers of faces that are compiled; None of all.
    kept: Optional[NDArray[np.int64]]
    #: The place from which coordinates count; None for the origin.
    place: Optional[NDArray[np.float64]]
    #: Of a mesh with faces twice: vertices, the faces that are compiled, and how often each is there.
    repeated: Optional[Tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]]

    def moved(self, places: NDArray) -> NDArray:
        """Places (n, 3) as the scene has them."""
        return places if self.place is None else places - self.place


class RayMeshIntersector:
    """Ray queries of a ``trimesh.Trimesh``, with the signatures and dtypes of ``trimesh.ray.ray_pyembree``.

    ``scale_to_box`` is taken for its place among the arguments and changes nothing: coordinates are always centered and
    scaled. trimesh's two classes name the mesh ``geometry`` and ``mesh``; both names are right. ``threads`` is the number of
    threads, at most 1024, and 0 for one per core. A mesh that changes is compiled anew when it is asked next. A face that
    the mesh has more than once, in the same winding, has one hit per ray. Faces with a vertex that is not finite are left out, with
    a warning; the others keep their numbers. A mesh may lie far from the origin: it is compiled about a place near it.
    """

    def __init__(self, geometry: Any = None, scale_to_box: bool = True, *, mesh: Any = None, threads: int = 0):
        if (geometry is None) == (mesh is None):
            raise TypeError("RayMeshIntersector takes one mesh, as geometry or as mesh")
        what = "mesh" if geometry is None else "geometry"
        given = mesh if geometry is None else geometry
        # By its class alone: trimesh makes ray objects of primitives before these can compute vertices.
        base = sys.modules.get("trimesh.base")
        if base is None or not isinstance(given, base.Trimesh):
            raise TypeError(f"{what} is a {type(given).__name__}; it must be a trimesh.Trimesh")
        self.mesh = given
        self.threads = checked_threads(threads)
        self._scale_to_box = scale_to_box
        self._compiled: Optional[_Compiled] = None
        # The faces that bound the inside, and the mesh for which they were found.
        self._inside: Optional[Tuple[_Compiled, Optional[Scene]]] = None

    def _compile(self) -> _Compiled:
        key = hash(self.mesh)
        if self._compiled is None or self._compiled.key != key:
            vertices = np.array(self.mesh.vertices, dtype=np.float64, order="C")
            faces = np.asarray(self.mesh.faces, dtype=np.int64)
            if len(faces):
                vertices, faces = indexed(vertices, faces, ("vertices", "faces"))
            kept = finite_faces(vertices, faces, "vertices") if len(faces) else None
            if kept is not None:
                faces = faces[kept]
            equal = firsts_of_equal(vertices, faces) if len(faces) else None
            repeated = None
            if equal is not None:
                firsts, copies = equal
                faces = faces[firsts]
                kept = firsts if kept is None else kept[firsts]
            place = far_place([(vertices, faces)])
            if place is not None:
                vertices = vertices - place
            if equal is not None and (copies % 2 == 0).any():
                repeated = vertices, faces, copies
            scene = Scene.from_arrays(vertices, faces) if len(faces) else None
            self._compiled = _Compiled(key, scene, kept, place, repeated)
        return self._compiled

    def _compile_inside(self, compiled: _Compiled) -> Optional[Scene]:
        """The faces that bound the inside of the mesh; None if there are none."""
        if compiled.repeated is None:
            return compiled.scene
        inside = self._inside
        if inside is None or inside[0] is not compiled:
            vertices, faces, copies = compiled.repeated
            is_counted = bounding(vertices, faces, copies)
            scene = compiled.scene
            if is_counted is not None:
                scene = Scene.from_arrays(vertices, faces[is_counted]) if is_counted.any() else None
            inside = self._inside = compiled, scene
        return inside[1]

    @property
    def scene(self) -> Optional[Scene]:
        """The compiled mesh; None of a mesh without faces.

        Its primitives are the mesh's faces without those that it has more than once, and those with a vertex that is not
        finite. Its coordinates count from :attr:`scene_origin`.
        """
        return self._compile().scene

    @property
    def scene_origin(self) -> NDArray[np.float64]:
        """(3,) float64: the place from which coordinates of :attr:`scene` count.

        It is 0, or near the mesh where that is farther from the origin than 2^20 times its size.
        """
        place = self._compile().place
        return np.zeros(3) if place is None else place.copy()

    @staticmethod
    def _rays(origins: ArrayLike, directions: ArrayLike) -> Tuple[NDArray, NDArray]:
        """Rays as arrays (n, 3)."""
        arrays = [numeric(origins, "ray_origins"), numeric(directions, "ray_directions")]
        if arrays[0].shape != arrays[1].shape:
            raise ValueError("Ray origin and direction don't match!")
        # Empty lists.
        if arrays[0].shape == (0,):
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

    @overload
    def intersects_id(
        self,
        ray_origins: ArrayLike,
        ray_directions: ArrayLike,
        multiple_hits: bool = ...,
        max_hits: Optional[int] = ...,
        return_locations: Literal[False] = ...,
    ) -> Tuple[NDArray[np.int64], NDArray[np.int64]]: ...

    @overload
    def intersects_id(
        self,
        ray_origins: ArrayLike,
        ray_directions: ArrayLike,
        multiple_hits: bool = ...,
        max_hits: Optional[int] = ...,
        *,
        return_locations: Literal[True],
    ) -> Tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]: ...

    @overload
    def intersects_id(
        self,
        ray_origins: ArrayLike,
        ray_directions: ArrayLike,
        multiple_hits: bool,
        max_hits: Optional[int],
        return_locations: Literal[True],
    ) -> Tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]: ...

    @overload
    def intersects_id(
        self,
        ray_origins: ArrayLike,
        ray_directions: ArrayLike,
        multiple_hits: bool = ...,
        max_hits: Optional[int] = ...,
        return_locations: bool = ...,
    ) -> Union[
        Tuple[NDArray[np.int64], NDArray[np.int64]],
        Tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]],
    ]: ...

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
        compiled = self._compile()
        if compiled.scene is None:
            return np.full(len(origins), -1, dtype=np.int32)
        native, count = compiled.scene._native, checked_threads(self.threads)
        first = native.first(compiled.moved(origins), directions, "f32", count)
        if compiled.kept is None:
            return first
        return np.where(first < 0, first, compiled.kept[first]).astype(np.int32)

    def intersects_any(
        self, ray_origins: ArrayLike, ray_directions: ArrayLike
    ) -> NDArray[np.bool_]:
        """Returns whether each ray hits the surface: (n,) bool."""
        origins, directions = self._rays(ray_origins, ray_directions)
        compiled = self._compile()
        if compiled.scene is None:
            return np.zeros(len(origins), dtype=bool)
        native, count = compiled.scene._native, checked_threads(self.threads)
        return native.any_of(compiled.moved(origins), directions, "f32", count)

    def contains_points(self, points: ArrayLike) -> NDArray[np.bool_]:
        """Returns whether the mesh contains each point: points (n, 3), the result (n,) bool.

        A closed mesh contains the points from which a ray crosses its faces an odd number of times. A face that is there an
        even number of times counts once, or not at all, such that every edge has an even number of faces. So a box with a
        face twice contains what it does without it, and of two bodies that stand on the same face, each with a copy of it,
        a point in one of them alone is inside. Where both ways close the mesh, such faces count once. Of an open mesh the
        result says whether one ray leaves it an odd number of times. A point nearer to the surface than
        ``scene.displacement`` may be on either side. Points with nan or infinity are in no mesh.
        """
        points = numeric(points, "points")
        # An empty list.
        if points.shape == (0,):
            return np.zeros(0, dtype=bool)
        if points.ndim != 2 or points.shape[1] != 3:
            raise ValueError(f"points have the shape {points.shape}; it must be (n, 3)")
        compiled = self._compile()
        scene = self._compile_inside(compiled)
        if scene is None:
            return np.zeros(len(points), dtype=bool)
        return scene.contains(compiled.moved(points), closed_only=False, threads=self.threads)

    def _locations(
        self, origins: NDArray, directions: NDArray, multiple_hits: bool, max_hits: Optional[int]
    ) -> Tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
        if max_hits is not None:
            max_hits = integer(max_hits, "max_hits", 0, sys.maxsize)
        compiled = self._compile()
        if compiled.scene is None:
            return np.zeros((0, 3)), np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64)
        native, count = compiled.scene._native, checked_threads(self.threads)
        places, rays, triangles = native.locations(
            compiled.moved(origins), directions, bool(multiple_hits), max_hits, "f32", count
        )
        if compiled.place is not None:
            places += compiled.place
        return places, rays, triangles if compiled.kept is None else compiled.kept[triangles]

    def __getstate__(self) -> Any:
        return state_of({**self.__dict__, "_compiled": None, "_inside": None}, slots_of(self, RayMeshIntersector))

    def __copy__(self, *_: Any) -> "RayMeshIntersector":
        other = type(self).__new__(type(self))
        restore(other, self.__getstate__())
        return other

    __deepcopy__ = __copy__
