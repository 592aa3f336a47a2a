"""Ray casting scenes in place of ``open3d.t.geometry.RaycastingScene``; Open3D need not be installed.

Tensors in, tensors out: where a query is given an Open3D tensor, its results are Open3D tensors. Otherwise they are
an :class:`Array`, a NumPy array with methods of tensors such as ``numpy()`` and ``isfinite()``, so that code for Open3D
need not be changed.
"""

from __future__ import annotations

import operator
import sys
from typing import Any, Optional, Tuple

import numpy as np

from ._scene import MISS, Scene, _integer, _mesh, _rows

__all__ = ["Array", "RaycastingScene"]


def _of_elements(function: Any, says: str) -> Any:
    """A method that is a function of each number, or of each pair of numbers."""

    def method(self: "Array", *values: Any) -> "Array":
        # One number is a tensor too.
        return np.asarray(function(self, *values)).view(Array)

    method.__doc__ = f"Returns {says}."
    return method


def _over_dimensions(name: str, says: str) -> Any:
    """A method of NumPy's over ``axis``, which takes Open3D's ``dim`` and ``keepdim`` as well."""
    inner = getattr(np.ndarray, name)

    def method(
        self: "Array", axis: Any = None, *args: Any, dim: Any = None, keepdim: bool = False, **kwargs: Any
    ) -> "Array":
        axis = axis if dim is None else dim
        if axis is not None:
            axis = axis if np.ndim(axis) == 0 or name.startswith("arg") else tuple(axis)
            axis = axis[0] if isinstance(axis, (list, tuple)) and len(axis) == 1 else axis
        if keepdim:
            kwargs["keepdims"] = True
        found = inner(self, axis, *args, **kwargs)
        return found if isinstance(found, np.ndarray) else np.asarray(found).view(Array)

    method.__name__ = name
    method.__doc__ = f"Returns {says}, of all numbers or along dimensions."
    return method


class Array(np.ndarray):
    """A NumPy array with the methods of Open3D's tensors that code for ray casting calls.

    Open3D takes it where it takes a tensor or an array. What both have is NumPy's where they differ: ``T`` is an
    attribute, ``shape`` a tuple, and ``dtype`` a NumPy type, which Open3D's types cannot be compared with.
    """

    isfinite = _of_elements(np.isfinite, "which numbers are finite")
    isinf = _of_elements(np.isinf, "which numbers are infinite")
    isnan = _of_elements(np.isnan, "which numbers are nan")
    logical_not = _of_elements(np.logical_not, "which numbers are 0 or false")
    abs = _of_elements(np.abs, "absolute values")
    neg = _of_elements(np.negative, "numbers with the other sign")
    sqrt = _of_elements(np.sqrt, "square roots")
    exp = _of_elements(np.exp, "powers of e")
    sin = _of_elements(np.sin, "sines")
    cos = _of_elements(np.cos, "cosines")
    floor = _of_elements(np.floor, "numbers rounded down")
    ceil = _of_elements(np.ceil, "numbers rounded up")
    trunc = _of_elements(np.trunc, "numbers rounded towards 0")
    logical_and = _of_elements(np.logical_and, "where both are true")
    logical_or = _of_elements(np.logical_or, "where either is true")
    logical_xor = _of_elements(np.logical_xor, "where one of both is true")
    add = _of_elements(np.add, "sums")
    sub = _of_elements(np.subtract, "differences")
    mul = _of_elements(np.multiply, "products")
    div = _of_elements(np.divide, "quotients")
    eq = _of_elements(np.equal, "where numbers are equal")
    ne = _of_elements(np.not_equal, "where numbers differ")
    lt = _of_elements(np.less, "where numbers are less")
    le = _of_elements(np.less_equal, "where numbers are less or equal")
    gt = _of_elements(np.greater, "where numbers are greater")
    ge = _of_elements(np.greater_equal, "where numbers are greater or equal")
    min = _over_dimensions("min", "the least number")
    max = _over_dimensions("max", "the greatest number")
    sum = _over_dimensions("sum", "the sum")
    mean = _over_dimensions("mean", "the mean")
    prod = _over_dimensions("prod", "the product")
    any = _over_dimensions("any", "whether any number is true")
    all = _over_dimensions("all", "whether all numbers are true")
    argmin = _over_dimensions("argmin", "where the least number is")
    argmax = _over_dimensions("argmax", "where the greatest number is")

    def numpy(self) -> np.ndarray:
        """Returns the plain array, without a copy."""
        return self.view(np.ndarray)

    def matmul(self, value: Any) -> "Array":
        """Returns the matrix product."""
        return np.asarray(np.matmul(self, value)).view(Array)

    def isclose(self, other: Any, rtol: float = 1e-5, atol: float = 1e-8) -> "Array":
        """Returns where numbers are nearly equal."""
        return np.isclose(self, other, rtol, atol)

    def allclose(self, other: Any, rtol: float = 1e-5, atol: float = 1e-8) -> bool:
        """Returns whether all numbers are nearly equal."""
        return np.allclose(self, other, rtol, atol)

    def append(self, values: Any, axis: Optional[int] = None) -> "Array":
        """Returns the array with others behind it, all in one row where there is no axis."""
        return np.append(self, values, axis).view(Array)

    def num_elements(self) -> int:
        """Returns how many numbers there are."""
        return self.size

    def clone(self) -> "Array":
        """Returns a copy."""
        return self.copy()

    def cpu(self) -> "Array":
        """Returns itself: arrays are in the memory of the processor."""
        return self

    def contiguous(self) -> "Array":
        """Returns the array in C order, without a copy where it is so."""
        return np.require(self, requirements="C").view(Array)

    def is_contiguous(self) -> bool:
        """Returns whether the array is in C order."""
        return self.flags.c_contiguous

    def to(self, dtype: Any = None, copy: bool = False, *, device: Any = None) -> "Array":
        """Converts to a type of NumPy's or Open3D's. A device of Open3D's in its place, or beside it, changes nothing."""
        if dtype is None:
            if device is None:
                raise TypeError("to takes a dtype, a device or both")
            return self.copy() if copy else self
        if not _is_tensor(dtype):
            return self.astype(dtype, copy=copy)
        if type(dtype).__name__ == "Device":
            return self.copy() if copy else self
        return self.astype(str(dtype).lower(), copy=copy)

    def __getitem__(self, key: Any) -> "Array":
        # One number is a tensor too.
        return np.asarray(super().__getitem__(key)).view(Array)


def _is_tensor(value: Any) -> bool:
    return type(value).__module__.startswith("open3d")


def _array(value: Any) -> np.ndarray:
    return value.numpy() if _is_tensor(value) else np.asarray(value)


def _like(given: Any, result: np.ndarray) -> Any:
    """Returns the result in the form of the argument."""
    if _is_tensor(given):
        # Not by `ascontiguousarray`, which makes a row of one number.
        return sys.modules["open3d"].core.Tensor(np.require(result, requirements="C"))
    return result.view(Array)


def _nthreads(value: Any) -> int:
    """A number of threads: as in Open3D one below 0 means all cores, and there is no greatest."""
    return min(max(_integer(value, "nthreads", -sys.maxsize, sys.maxsize), 0), 1024)


def _limit(value: Any, what: str) -> float:
    """A limit of rays."""
    try:
        if isinstance(value, (str, bytes)) or np.ndim(value) != 0:
            raise TypeError
        return float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{what} is {value!r}; it must be a number") from None


def _between(limit: float, toward: float) -> float:
    """The farthest number that is the limit in single precision, on the side where hits are."""
    with np.errstate(over="ignore"):
        single = np.float32(limit)
        beyond = np.nextafter(single, np.float32(toward))
    if not np.isfinite(single) or single == 0.0:
        return float(single)
    return float(single) + 0.5 * (float(beyond) - float(single)) if np.isfinite(beyond) else float(single)


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
    thinner than a step of the lattice is met as a flat one. A triangle that was added twice counts twice. There are no
    queries of distances.
    """

    INVALID_ID = MISS

    def __init__(self, nthreads: int = 0, device: Any = None):
        # Open3D's are for building alone.
        del nthreads, device
        self._meshes: list[Tuple[np.ndarray, np.ndarray]] = []
        self._firsts = np.zeros(1, dtype=np.int64)
        self._scene: Optional[Scene] = None

    def add_triangles(
        self, vertex_positions: Any = None, triangle_indices: Any = None, *, mesh: Any = None
    ) -> int:
        """Adds a mesh and returns the number of its geometry.

        Give vertices (n, 3) and triangles (m, 3), or an ``open3d.t.geometry.TriangleMesh`` alone. Raises ValueError for
        triangles that name no vertex, or one that is not finite, and TypeError for indices that are no integers.
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
                    "Give vertices and triangles of other meshes"
                ) from None
        names = ("vertex_positions", "triangle_indices")
        given = _mesh(_array(vertex_positions), _array(triangle_indices), names)
        # Copies, as they are compiled later.
        vertices, triangles = (array.copy() for array in given)
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
        return _rows(_array(rays), (6,), "rays")

    def _may_leave_single_precision(self, rays: np.ndarray) -> bool:
        """Whether a hit of any ray (..., 6) can have a t beyond single precision."""
        if rays.size == 0:
            return False
        rays = rays if rays.dtype.kind == "f" else rays.astype(np.float64)
        directions = rays[..., 3:6].reshape(-1, 3)
        shortest = np.sqrt(float(np.einsum("ij,ij->i", directions, directions).min()))
        farthest = max(float(rays.max()), -float(rays.min()), *np.abs(self.scene.bounds).ravel().tolist())
        # Not a number where a ray is not of numbers.
        return not 4.0 * farthest < shortest * float(np.finfo(np.float32).max)

    def _identify(self, objects: np.ndarray, primitives: np.ndarray) -> np.ndarray:
        """The numbers of triangles in their own meshes."""
        hit = primitives != MISS
        primitives[hit] -= self._firsts[objects[hit]].astype(np.uint32)
        return primitives

    def cast_rays(self, rays: Any, nthreads: int = 0) -> dict[str, Any]:
        """Returns the first hits of rays (..., 6).

        Keys: ``t_hit`` (...) float32, inf on a miss; ``geometry_ids`` and ``primitive_ids`` (...) uint32,
        ``INVALID_ID`` on a miss and where t leaves single precision; ``primitive_uvs`` (..., 2) and ``primitive_normals`` (..., 3) float32, 0 on a miss.
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
                "primitive_ids": primitives.reshape(shape),
                "primitive_uvs": uvs.reshape(shape + (2,)),
                "primitive_normals": normals.reshape(shape + (3,)),
            }
        return {key: _like(rays, value) for key, value in hits.items()}

    def test_occlusions(
        self, rays: Any, tnear: float = 0.0, tfar: float = float("inf"), nthreads: int = 0
    ) -> Any:
        """Returns whether rays (..., 6) hit anything from ``tnear`` to ``tfar``: (...) bool.

        Hits at the limits count. They are compared in single precision, with the t that :meth:`cast_rays` returns. A
        ``tnear`` of 0 is the origin: whether a ray hits the surface on which it starts is not certain.
        """
        array = self._rays(rays)
        tnear, tfar = _limit(tnear, "tnear"), _limit(tfar, "tfar")
        threads = _nthreads(nthreads)
        if self.scene is None:
            return _like(rays, np.zeros(array.shape[:-1], dtype=bool))
        if tfar == float("inf") and self._may_leave_single_precision(array):
            # Beyond it nothing is met.
            tfar = float(np.finfo(np.float32).max)
        if tnear != 0.0 or tfar != float("inf"):
            array = _limited(array, _between(tnear, -np.inf), _between(tfar, np.inf))
        return _like(rays, self.scene.any(array, threads=threads))

    def count_intersections(self, rays: Any, nthreads: int = 0) -> Any:
        """Returns the number of crossings of rays (..., 6): (...) int32."""
        array, threads = self._rays(rays), _nthreads(nthreads)
        if self.scene is None:
            return _like(rays, np.zeros(array.shape[:-1], dtype=np.int32))
        if self._may_leave_single_precision(array):
            # Beyond it nothing is met.
            array = _limited(array, 0.0, float(np.finfo(np.float32).max))
        counts = self.scene.count(array, format="f32", threads=threads)
        return _like(rays, counts.astype(np.int32))

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
            kept = found.t <= np.finfo(np.float32).max
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
        return {key: _like(rays, value) for key, value in zip(keys, hits)}

    def compute_occupancy(self, query_points: Any, nthreads: int = 0, nsamples: int = 1) -> Any:
        """Returns 1 for points (..., 3) that all meshes together enclose an odd number of times, else 0: (...) float32.

        A point in two meshes is outside, as in Open3D. A mesh whose triangles are all there twice contains nothing. One
        ray is enough: ``nsamples``, an odd number, changes nothing.
        Points with nan or infinity are outside.
        """
        try:
            nsamples = operator.index(nsamples)
        except TypeError:
            raise TypeError(f"nsamples is {nsamples!r}; it must be an integer") from None
        if nsamples < 1 or nsamples % 2 == 0:
            raise ValueError(f"nsamples is {nsamples}; it must be odd and at least 1")
        points, threads = _rows(_array(query_points), (3,), "query_points"), _nthreads(nthreads)
        if self.scene is None:
            return _like(query_points, np.zeros(points.shape[:-1], dtype=np.float32))
        inside = self.scene._native.contains(points, "scene", "f64", None, threads)
        return _like(query_points, inside.reshape(points.shape[:-1]).astype(np.float32))

    def __getstate__(self) -> dict:
        return {**self.__dict__, "_scene": None}

    def __copy__(self) -> "RaycastingScene":
        other = type(self).__new__(type(self))
        # Meshes do not change, nor does what was compiled of them; the list does.
        other.__dict__.update(self.__dict__, _meshes=list(self._meshes))
        return other

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
        eye, up, width_px, height_px)`` with a horizontal field of view.
        """
        by_field_of_view = ("fov_deg", "center", "eye", "up", "width_px", "height_px")
        by_matrices = ("intrinsic_matrix", "extrinsic_matrix", "width_px", "height_px")
        names = by_field_of_view if len(args) + len(kwargs) == 6 else by_matrices
        given = {**dict(zip(names, args)), **kwargs}
        if set(given) != set(names) or len(args) + len(kwargs) != len(names):
            raise TypeError(f"create_rays_pinhole takes {', '.join(by_matrices)} or {', '.join(by_field_of_view)}")
        width, height = (operator.index(given[name]) for name in ("width_px", "height_px"))
        if width < 1 or height < 1:
            raise ValueError("width_px and height_px must be above 0")

        def numbers(name: str, shape: Tuple[int, ...]) -> np.ndarray:
            array = np.asarray(_array(given[name]), dtype=np.float64)
            if array.shape != shape:
                raise ValueError(f"{name}: the array has the shape {array.shape}; it must be {shape}")
            return array

        of_tensors = next((value for value in given.values() if _is_tensor(value)), None)
        if names is by_matrices:
            intrinsic = numbers("intrinsic_matrix", (3, 3))
            extrinsic = numbers("extrinsic_matrix", (4, 4))
            turn = extrinsic[:3, :3]
            eye = -turn.T @ extrinsic[:3, 3]
            into = turn.T @ np.linalg.inv(intrinsic)
        else:
            center, eye, up = (numbers(name, (3,)) for name in ("center", "eye", "up"))
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
