"""Which meshes of trimesh's ``RayMeshIntersector`` takes, and when it looks at them."""

from types import SimpleNamespace

import numpy as np
import pytest

import gridel.trimesh

trimesh = pytest.importorskip("trimesh")

DOWN = ([[0.1, 0.2, 50.0]], [[0, 0, -1.0]])


@pytest.fixture(params=["ray_pyembree", "ray_triangle"])
def patched(request, monkeypatch):
    """trimesh with gridel's class in place of one of its own, which it uses."""
    module = pytest.importorskip(f"trimesh.ray.{request.param}", reason="embreex is not installed")
    monkeypatch.setattr(module, "RayMeshIntersector", gridel.trimesh.RayMeshIntersector)
    monkeypatch.setattr(trimesh.ray, "has_embree", request.param == "ray_pyembree")
    return trimesh


@pytest.mark.parametrize("name", ["Box", "Sphere", "Cylinder", "Capsule", "Extrusion"])
def test_primitives_take_the_class_that_replaces_trimesh_own(patched, name):
    polygon = []
    if name == "Extrusion":
        polygon = [pytest.importorskip("shapely.geometry").Polygon([(-1, -1), (1, -1), (1, 1), (-1, 1)])]
    primitive = getattr(patched.primitives, name)(*polygon)
    assert type(primitive.ray) is gridel.trimesh.RayMeshIntersector
    assert primitive.ray.intersects_any(*DOWN).tolist() == [True]
    assert type(primitive.copy().ray) is gridel.trimesh.RayMeshIntersector


@pytest.mark.parametrize(
    "name", ["bounding_box", "bounding_box_oriented", "bounding_sphere", "bounding_cylinder", "bounding_primitive"]
)
def test_bounds_of_meshes_take_the_class_that_replaces_trimesh_own(patched, name):
    around = getattr(patched.creation.box(), name)
    assert around.ray.contains_points([[0, 0, 0], [9, 0, 0]]).tolist() == [True, False]


def test_primitives_that_change_are_compiled_again(patched):
    ball = patched.primitives.Sphere(radius=1)
    assert ball.ray.contains_points([[0, 0, 0], [1.5, 0, 0]]).tolist() == [True, False]
    ball.primitive.radius = 2
    assert ball.ray.contains_points([[0, 0, 0], [1.5, 0, 0]]).tolist() == [True, True]


def test_mesh_is_not_looked_at_before_the_first_query():
    class Later(trimesh.Trimesh):
        @property
        def vertices(self):
            raise RuntimeError("vertices are not there yet")

    assert gridel.trimesh.RayMeshIntersector(Later.__new__(Later)).mesh is not None


@pytest.mark.parametrize("given", [SimpleNamespace(vertices=np.eye(3), faces=np.array([[0, 1, 2]])), "mesh", np.eye(3)])
def test_other_objects_are_rejected_at_once(given):
    kind = type(given).__name__
    for name in ("geometry", "mesh"):
        with pytest.raises(TypeError, match=f"{name} is a {kind}; it must be a trimesh.Trimesh"):
            gridel.trimesh.RayMeshIntersector(**{name: given})
