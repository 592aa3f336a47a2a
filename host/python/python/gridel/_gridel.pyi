"""Native code of the package gridel: see :class:`gridel.Scene`."""

from typing import Optional, Tuple, TypedDict

import numpy as np
from numpy.typing import NDArray

_HitArrays = Tuple[
    NDArray[np.float64],
    NDArray[np.uint32],
    NDArray[np.uint32],
    NDArray[np.uint32],
    NDArray[np.float32],
    NDArray[np.float32],
]

#: The version of the package.
VERSION: str

#: Fewest and most bits of a lattice.
LATTICE_BITS: Tuple[int, int]

class LoadOptions(TypedDict):
    """Options of :meth:`gridel.Scene.load`; None where none is given. A type for checkers alone."""

    accel: Optional[list[str]]
    lattice_bits: Optional[int]
    quality: Optional[str]
    without: list[str]
    texture_bytes: Optional[int]
    camera: Optional[str]
    animation: Optional[str]
    time: Optional[float]
    instances: Optional[str]
    normals: Optional[str]
    assembly: Optional[str]
    style: Optional[str]
    model: Optional[int]
    altloc: Optional[str]
    allow_outside: bool

class NativeScene:
    @staticmethod
    def load(path: str, given: LoadOptions) -> NativeScene: ...
    @staticmethod
    def from_blob(bytes: bytes) -> NativeScene: ...
    @staticmethod
    def from_meshes(
        meshes: list[Tuple[NDArray[np.float64], NDArray[np.int64]]],
        accel: list[str],
        lattice_bits: int,
    ) -> NativeScene: ...
    def given(
        self,
    ) -> Optional[
        Tuple[list[Tuple[NDArray[np.float64], NDArray[np.int64]]], list[str], int]
    ]: ...
    def cast(
        self, rays: NDArray, format: str, accel: Optional[str], threads: int
    ) -> _HitArrays: ...
    def cast_rays(
        self, rays: NDArray, threads: int
    ) -> Tuple[
        NDArray[np.float32],
        NDArray[np.uint32],
        NDArray[np.uint32],
        NDArray[np.float32],
        NDArray[np.float32],
    ]: ...
    def first(
        self, origins: NDArray, directions: NDArray, format: str, threads: int
    ) -> NDArray[np.int32]: ...
    def any_of(
        self, origins: NDArray, directions: NDArray, format: str, threads: int
    ) -> NDArray[np.bool_]: ...
    def any(
        self, rays: NDArray, format: str, accel: Optional[str], threads: int
    ) -> NDArray[np.bool_]: ...
    def count(
        self, rays: NDArray, format: str, accel: Optional[str], threads: int
    ) -> NDArray[np.uint32]: ...
    def all(
        self, rays: NDArray, format: str, accel: Optional[str], threads: int
    ) -> Tuple[NDArray[np.int64], _HitArrays, NDArray[np.bool_]]: ...
    def locations(
        self,
        origins: NDArray,
        directions: NDArray,
        multiple_hits: bool,
        max_hits: Optional[int],
        format: str,
        threads: int,
    ) -> Tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]: ...
    def contains(
        self,
        points: NDArray,
        within: str,
        format: str,
        accel: Optional[str],
        threads: int,
    ) -> NDArray[np.bool_]: ...
    def render(
        self,
        size: Optional[list[int]],
        samples: Optional[int],
        depth: Optional[int],
        format: str,
        accel: Optional[str],
        threads: int,
    ) -> NDArray[np.uint8]: ...
    def to_blob(self, accel: Optional[list[str]], lattice_bits: Optional[int]) -> bytes: ...
    @property
    def accels(self) -> list[str]: ...
    @property
    def counts(self) -> Tuple[int, int, int]: ...
    @property
    def displacement(self) -> float: ...
    @property
    def bounds(self) -> Tuple[list[float], list[float]]: ...
