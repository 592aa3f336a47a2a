"""Scenes and their queries."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arguments import LARGEST, Accel, bits, character, flag, integer, mesh, names, query, rows, seconds, structures, text
from ._gridel import NativeScene
from ._slots import slots_of, state_of

if sys.version_info >= (3, 11):
    from typing import Self
elif TYPE_CHECKING:
    from typing_extensions import Self

#: Stands for "none": the object, primitive and instance of a ray that hits nothing, and also the instance of a hit on an
#: object that is part of no instance. ``instance == MISS`` therefore does not mean that the ray missed.
MISS = 0xFFFFFFFF

class Hits(NamedTuple):
    """The first hits of n rays, as :meth:`Scene.cast` returns them; arrays have the shape of the rays."""

    #: (n,) float64: multiples of the direction; inf on a miss, nan for a ray that is invalid.
    t: NDArray[np.float64]
    #: (n,) uint32: the object, in the order of the scene file; :data:`MISS` on a miss.
    object: NDArray[np.uint32]
    #: (n,) uint32: the primitive, counted over all objects; :data:`MISS` on a miss.
    primitive: NDArray[np.uint32]
    #: (n,) uint32: the instance; :data:`MISS` on a miss, and on a hit where the object is part of no instance.
    instance: NDArray[np.uint32]
    #: (n, 3) float32: the geometric normal, of length 1: outward, or to where corners run counter-clockwise.
    normal: NDArray[np.float32]
    #: (n, 2) float32: barycentric weights of a triangle's second and third corner; the first one's weight is 1 - u - v.
    #: These are no texture coordinates. 0 on a miss. nan where the scene's meshes are not available (scenes from blobs,
    #: instances), and for other shapes.
    uv: NDArray[np.float32]


class AllHits(NamedTuple):
    """All m hits of some rays, as :meth:`Scene.all` returns them: ray by ray, in the order of t."""

    #: (m,) int64: the number of the ray.
    ray: NDArray[np.int64]
    #: (m,) float64: multiples of the direction.
    t: NDArray[np.float64]
    #: (m,) uint32: the object, in the order of the scene file.
    object: NDArray[np.uint32]
    #: (m,) uint32: the primitive, counted over all objects.
    primitive: NDArray[np.uint32]
    #: (m,) uint32: the instance; :data:`MISS` where the object is part of no instance.
    instance: NDArray[np.uint32]
    #: (m, 3) float32: the geometric normal.
    normal: NDArray[np.float32]
    #: (m, 2) float32: barycentric weights, as of :class:`Hits`.
    uv: NDArray[np.float32]
    #: (m,) bool: whether the ray leaves a solid such as a sphere; never of triangles.
    leaves: NDArray[np.bool_]


class Scene:
    """A scene, compiled for queries. Make one by :meth:`load`, :meth:`from_arrays` or :meth:`from_blob`.

    A scene does not change, and copies of it are the scene itself. Queries release the GIL and run on all cores, or on
    ``threads`` of them: 1 to 1024, or 0 for all. The results are the same, bit for bit, with any number of threads, and in
    a forked process. Arrays of float32 and float64 in C order are read in place.

    ``format`` is the number format of a query: ``"f32"``, ``"f64"`` or ``"fixed"`` (integers). ``accel`` is the name of
    an acceleration structure that the scene holds; the default is the fastest. It changes no result. A structure that the
    scene does not hold is a :class:`gridel.StructureError`, which is a ValueError and a KeyError.

    Rays may start at any distance. A ray is invalid if its direction is zero or a number of it is nan. It is invalid if
    its origin or direction is infinite, or if its tmin is greater than its tmax. It is also invalid if the t of the scene
    leaves double precision, as of directions of length 1e-308. In a scene with planes, a ray that passes the scene at more
    than about 2^21 times its size is invalid as well. Invalid rays hit nothing; :meth:`cast` gives them t = nan.

    Scenes pickle. A scene of arrays is compiled again from them and gives the same answers. Other scenes pickle as their
    blob, so that ``uv`` is nan and t is that of the blob.
    """

    __slots__ = ("_native", "__weakref__")

    def __init__(self, native: NativeScene):
        if not isinstance(native, NativeScene):
            raise TypeError(f"Scene takes no {type(native).__name__}; use Scene.load, from_arrays or from_blob")
        self._native = native

    @classmethod
    def load(
        cls,
        path: Union[str, bytes, os.PathLike],
        *,
        accel: Optional[Accel] = None,
        lattice_bits: Optional[int] = None,
        quality: Optional[str] = None,
        without: Union[str, Sequence[str], None] = (),
        texture_bytes: Optional[int] = None,
        camera: Optional[str] = None,
        animation: Union[str, int, None] = None,
        time: Optional[float] = None,
        instances: Optional[str] = None,
        normals: Optional[str] = None,
        assembly: Union[str, int, None] = None,
        style: Optional[str] = None,
        model: Optional[int] = None,
        altloc: Optional[str] = None,
        allow_outside: bool = False,
    ) -> Self:
        """Reads a scene file of any format that ``gridel`` reads, or a scene blob.

        A scene file is compiled. The options are those of the command line; for a blob, each of them is a ValueError.

        :param accel: the structures to build, one name or several. Default: ``"wide"``.
        :param lattice_bits: bits of the lattice for coordinates, 10 to 24. Default: 24.
        :param quality: how long to search for a better ``wide`` structure: ``"fast"``, ``"good"`` or ``"best"``. It changes
            no result. Default: ``"good"``.
        :param without: effects that :meth:`render` leaves out, one name or several, such as ``"shadow"``. Default: none.
        :param texture_bytes: most bytes of all textures; they are stored with fewer colors or texels to fit. Default: no
            limit.
        :param camera: camera of a glTF file, by its name or that of its node. Default: the first with a perspective.
        :param animation: animation of a glTF file, by its name or its number from 0; ``"none"`` for no animation. Default:
                the first.
        :param time: seconds at which copies of instances that move stand; needs ``instances="flatten"``. Camera, lights,
            materials and vertices stay as they are at rest. Default: the instances at rest.
        :param instances: ``"keep"`` keeps parts that are placed several times as instances; ``"flatten"`` copies their
            objects. Default: ``"keep"``.
        :param normals: normals with which :meth:`render` shades meshes: ``"file"``, ``"flat"``, or smooth where faces meet
            at less than an angle in degrees, such as ``"smooth=40"``. Normals of hits do not change. Default: ``"file"``.
        :param assembly: biological assembly of a PDB or mmCIF file, by its number or name. Default: the atoms that
            the file lists.
        :param style: style of molecules: ``"space-filling"`` or ``"ball-and-stick"``. Default: ``"space-filling"``.
        :param model: model of a molecule file, counted from 1. Default: 1.
        :param altloc: alternate location of atoms, one character. Default: the first of each residue.
        :param allow_outside: whether the scene file may name files outside of its folder. Default: False.

        Warns (UserWarning) of what the file's importer leaves out, and of primitives that are too small for the lattice.
        Raises FileNotFoundError, IsADirectoryError and other OSErrors with ``errno`` and ``filename``, and ValueError with
        file, place, cause and remedy. ``camera``, ``animation``, ``assembly``, ``style``, ``model`` and ``altloc`` are a
        ValueError as well if they do not apply to the file; so are ``time`` if no instance moves, and ``quality`` without
        the structure ``wide``. Every scene file takes the other options, also if they change nothing.
        """
        given = {
            "accel": structures(accel),
            "lattice_bits": None if lattice_bits is None else bits(lattice_bits),
            "quality": text(quality, "quality"),
            "without": [] if without is None else names(without, "without"),
            "texture_bytes": None if texture_bytes is None else integer(texture_bytes, "texture_bytes", 0, LARGEST),
            "camera": text(camera, "camera"),
            "animation": text(animation, "animation", or_number=True),
            "time": seconds(time, "time"),
            "instances": text(instances, "instances"),
            "normals": text(normals, "normals"),
            "assembly": text(assembly, "assembly", or_number=True),
            "style": text(style, "style"),
            "model": None if model is None else integer(model, "model", 1, LARGEST),
            "altloc": character(altloc, "altloc"),
            "allow_outside": flag(allow_outside, "allow_outside"),
        }
        return cls(NativeScene.load(os.fsdecode(path), given))

    @classmethod
    def from_arrays(
        cls,
        vertices: ArrayLike,
        faces: ArrayLike,
        *,
        accel: Optional[Accel] = "wide",
        lattice_bits: Optional[int] = 24,
    ) -> Self:
        """Compiles a triangle mesh: vertices (n, 3) of numbers, faces (m, 3) of integers.

        Vertices are centered in float64 and then rounded to the lattice, which has 10 to 24 ``lattice_bits``. At 24 bits
        its step is about 1e-7 of the mesh's size; :attr:`displacement` says how far surfaces moved. The mesh may lie within
        2.6e8 times its size of the origin. Farther away, subtract a place near the mesh from vertices and rays, or use
        fewer ``lattice_bits``. Its size is 1e-250 to 1e250. Vertices that no face uses are ignored. A face that the array
        has twice counts twice. A closed mesh thinner than a step becomes flat: rays hit it, and it contains nothing. Warns
        (UserWarning) of triangles that are too small for the lattice. Raises ValueError for faces that name no vertex, or
        one that is not finite, and for meshes that lie too far away. Such faces can be left out:
        ``faces[numpy.isfinite(vertices).all(axis=1)[faces].all(axis=1)]``.
        """
        return cls._from_meshes([(vertices, faces)], accel, lattice_bits)

    @classmethod
    def _from_meshes(
        cls,
        meshes: Sequence[Tuple[ArrayLike, ArrayLike]],
        accel: Optional[Accel] = "wide",
        lattice_bits: Optional[int] = 24,
    ) -> Self:
        built = structures(accel) or ["wide"]
        lattice_bits = bits(24 if lattice_bits is None else lattice_bits)
        arrays = [mesh(vertices, faces) for vertices, faces in meshes]
        return cls(NativeScene.from_meshes(arrays, built, lattice_bits))

    @classmethod
    def from_blob(cls, blob: Union[bytes, bytearray, memoryview]) -> Self:
        """Takes a scene blob, as ``gridel build`` and :meth:`to_blob` make them, as any bytes-like object.

        Raises ValueError if it is invalid.
        """
        return cls(NativeScene.from_blob(bytes(memoryview(blob))))

    def cast(
        self, rays: ArrayLike, *, format: str = "f32", accel: Optional[str] = None, threads: int = 0
    ) -> Hits:
        """Returns the first hit of each ray: rays (..., 6) or (..., 8), hits of shape (...).

        A ray that touches an edge or a vertex hits it. This holds for rays and vertices as the query has them: it
        rounds directions to the number format, and vertices to the lattice. So a ray that is aimed at a silhouette, or at
        the border of an open mesh, may pass beside it. At an edge it hits the triangle with the least t, as the number
        format rounds it, and of equal t the primitive that comes first: number formats can name different neighbors.

        ``t``, ``uv`` and ``normal`` of triangles are computed from the vertices as they were given, in float64; those of
        instances and of blobs are computed from the lattice. ``t`` is never outside of tmin and tmax. A hit lies within a
        few times :attr:`displacement` of its triangle, except for rays almost in the triangle's plane.

        tmin and tmax are compared with the ``t`` that is returned. A hit at a limit counts, so a ray whose tmax is the t of
        its hit still hits. There are two exceptions, in which a ray may hit or miss:

        - tmin is 0, and the ray starts at a surface. Here tmin is compared with the surface on the lattice. The result is
          uncertain if the origin is nearer to the surface than :attr:`displacement`, divided by the cosine between ray and
          normal. Give rays that start on surfaces a small tmin above 0.
        - The angle between ray and surface is less than one degree, and the t of the hit is near tmin or tmax: within the
          same distance, measured along the ray.
        """
        rays = rows(rays, (6, 8), "rays")
        shape = rays.shape[:-1]
        t, obj, primitive, instance, normal, uv = self._native.cast(rays, *query(format, accel, threads))
        return Hits(
            t.reshape(shape),
            obj.reshape(shape),
            primitive.reshape(shape),
            instance.reshape(shape),
            normal.reshape(shape + (3,)),
            uv.reshape(shape + (2,)),
        )

    def any(
        self, rays: ArrayLike, *, format: str = "f32", accel: Optional[str] = None, threads: int = 0
    ) -> NDArray[np.bool_]:
        """Returns whether each ray hits anything: rays (..., 6) or (..., 8), the result (...) bool.

        Rays at edges and vertices are rounded as those of :meth:`cast` are.
        """
        rays = rows(rays, (6, 8), "rays")
        return self._native.any(rays, *query(format, accel, threads)).reshape(rays.shape[:-1])

    def all(
        self, rays: ArrayLike, *, format: str = "f64", accel: Optional[str] = None, threads: int = 0
    ) -> AllHits:
        """Returns every crossing of each ray: rays (n, 6) or (n, 8), m hits ray by ray in the order of t.

        Nothing is listed twice, capped or lost: a ray through an edge or a vertex of a closed mesh crosses as many
        triangles as a ray beside it. Where a ray only touches a silhouette, or the border of an open mesh, it has no
        crossing, or two, or one at a border; :meth:`cast` may report a hit there. Surfaces nearer to each other than
        :attr:`displacement` come in the order in which the lattice has them. A t that is less than the one before it is
        raised to that. tmin and tmax are compared with the t of each surface before it is raised, so limits at such a t can
        leave out hits that are listed with it without limits.
        """
        rays = rows(rays, (6, 8), "rays")
        ray, hits, leaves = self._native.all(rays, *query(format, accel, threads))
        return AllHits(ray, *hits, leaves)

    def count(
        self, rays: ArrayLike, *, format: str = "f64", accel: Optional[str] = None, threads: int = 0
    ) -> NDArray[np.uint32]:
        """Returns the number of crossings of each ray, as :meth:`all` lists them: (...) uint32.

        tmin and tmax are compared with the t of each surface, as in :meth:`all`: before a t is raised to the one before it.
        """
        rays = rows(rays, (6, 8), "rays")
        return self._native.count(rays, *query(format, accel, threads)).reshape(rays.shape[:-1])

    def contains(
        self,
        points: ArrayLike,
        *,
        closed_only: bool = True,
        format: str = "f64",
        accel: Optional[str] = None,
        threads: int = 0,
    ) -> NDArray[np.bool_]:
        """Returns whether each point lies in a closed object: points (..., 3), the result (...) bool.

        Solids are closed, and so are meshes each of whose edges an even number of triangles share. A point nearer to a
        surface than :attr:`displacement` may be on either side of it. With ``format="f32"`` the points themselves are
        rounded, by up to 3e-8 of the scene's size. No object contains nan or infinity. Raises ValueError if no object is
        closed; with ``closed_only=False`` open meshes contain what one ray leaves through an odd number of their
        triangles.
        """
        points = rows(points, (3,), "points")
        within = "closed" if closed_only else "object"
        inside = self._native.contains(points, within, *query(format, accel, threads))
        return inside.reshape(points.shape[:-1])

    def render(
        self,
        width: Optional[int] = None,
        height: Optional[int] = None,
        *,
        samples: Optional[int] = None,
        depth: Optional[int] = None,
        format: str = "f32",
        accel: Optional[str] = None,
        threads: int = 0,
    ) -> NDArray[np.uint8]:
        """Renders the scene from its camera: (height, width, 3) uint8 in sRGB, the first row at the top.

        Defaults are those of the scene; give both ``width`` and ``height`` (1 to 65535) or neither; the picture is at
        most 64 times as wide as high. Raises MemoryError for a picture that does not fit in memory. ``samples`` is 1 to
        4096 and ``depth`` 0 to 32. The pixels are those of ``gridel render`` with the same settings. A scene without a
        camera is compiled anew where the ratio of the sides is not its own, because its framing depends on it.
        """
        if (width is None) != (height is None):
            raise ValueError("give both width and height, or neither")
        size = None
        if width is not None:
            size = [integer(width, "width", 1, 65535), integer(height, "height", 1, 65535)]
        if samples is not None:
            samples = integer(samples, "samples", 1, 4096)
        if depth is not None:
            depth = integer(depth, "depth", 0, 32)
        return self._native.render(size, samples, depth, *query(format, accel, threads))

    def to_blob(
        self, *, accel: Optional[Accel] = None, lattice_bits: Optional[int] = None
    ) -> bytes:
        """Returns the scene blob, for files and for devices; compiled anew if structures or bits are given.

        The scene's own structures and bits are the defaults.
        """
        return self._native.to_blob(structures(accel), None if lattice_bits is None else bits(lattice_bits))

    @property
    def accels(self) -> Tuple[str, ...]:
        """The structures that the scene holds, the fastest first."""
        return tuple(self._native.accels)

    @property
    def objects(self) -> int:
        """Number of objects."""
        return self._native.counts[0]

    @property
    def primitives(self) -> int:
        """Number of primitives of all objects, those that have no area included."""
        return self._native.counts[1]

    @property
    def instances(self) -> int:
        """Number of instances."""
        return self._native.counts[2]

    @property
    def displacement(self) -> float:
        """The farthest that rounding to the lattice moved a surface, in the scene's units; nan of a blob.

        At least a step of the lattice where primitives are smaller than that and left out.
        """
        return self._native.displacement

    @property
    def bounds(self) -> NDArray[np.float64]:
        """(2, 3) float64: the lowest and the highest corner of a box around the scene.

        Of a scene of meshes without instances and morph targets it is the box of the vertices that faces use, as they were
        given. Other boxes are those of blobs, wider by up to 2^-15 of their longest side.
        """
        return np.array(self._native.bounds)

    def __copy__(self, *_: Any) -> Self:
        return self

    __deepcopy__ = __copy__

    def __reduce__(self) -> Tuple[Any, ...]:
        given = self._native.given()
        # What a subclass has of its own.
        state = state_of(getattr(self, "__dict__", {}), slots_of(self, Scene))
        if given is None:
            return type(self).from_blob, (self.to_blob(),), state
        return type(self)._from_meshes, given, state

    def __repr__(self) -> str:
        objects, primitives, instances = self._native.counts
        return f"<gridel.Scene: {objects} objects, {primitives} primitives, {instances} instances>"
