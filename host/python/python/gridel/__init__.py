"""Exact, watertight ray queries for NumPy arrays.

A :class:`Scene` is compiled once and queried many times, on all cores. Rays are rows of six numbers
(origin and direction) or of eight (origin, tmin, direction, tmax). ``t`` counts multiples of the
direction, which may have any length. No ray slips between two triangles that share an edge.
:meth:`Scene.all`, :meth:`Scene.count` and :meth:`Scene.contains` count no surface twice.

>>> import numpy, gridel
>>> corners = numpy.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
>>> faces = numpy.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
>>> scene = gridel.Scene.from_arrays(corners, faces)
>>> scene.contains([[0.1, 0.1, 0.1], [1.0, 1.0, 1.0]])
array([ True, False])
>>> scene.count([[0.1, 0.2, -5.0, 0, 0, 1]])
array([2], dtype=uint32)

``gridel.trimesh.RayMeshIntersector`` and ``gridel.open3d.RaycastingScene`` take the places of the classes of those
names in trimesh and Open3D.
"""

from . import open3d, trimesh
from ._errors import StructureError
from ._gridel import VERSION as __version__
from ._scene import MISS, AllHits, Hits, Scene

# Without the two modules: they would replace trimesh and open3d where all of this is imported.
__all__ = ["__version__", "MISS", "AllHits", "Hits", "Scene", "StructureError"]
