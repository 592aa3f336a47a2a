"""Tests the class for Open3D alone, and against Open3D's own where that is installed."""

import numpy as np
import pytest

import gridel
from gridel.open3d import RaycastingScene

TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=np.float32)
SIDES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], dtype=np.uint32)


def grid(count=20):
    """Rays at edges, vertices and faces of the meshes of `fill`."""
    x, y = np.meshgrid(np.linspace(-0.5, 4.5, count), np.linspace(-0.5, 1.5, count))
    rays = np.zeros((count, count, 6), dtype=np.float32)
    rays[..., 0], rays[..., 1], rays[..., 2] = x, y, -3
    rays[..., 3:] = [0.01, 0.02, 2]
    return rays


def fill(scene):
    ids = [scene.add_triangles(TETRAHEDRON, SIDES)]
    ids.append(scene.add_triangles(TETRAHEDRON + np.array([3, 0, 0], dtype=np.float32), SIDES))
    assert ids == [0, 1]
    return scene


def test_keys_shapes_and_types():
    scene = fill(RaycastingScene())
    hits = scene.cast_rays(grid(5))
    assert {key: (value.dtype.name, value.shape) for key, value in hits.items()} == {
        "t_hit": ("float32", (5, 5)),
        "geometry_ids": ("uint32", (5, 5)),
        "primitive_ids": ("uint32", (5, 5)),
        "primitive_uvs": ("float32", (5, 5, 2)),
        "primitive_normals": ("float32", (5, 5, 3)),
    }
    assert type(hits["t_hit"].numpy()) is np.ndarray
    listed = scene.list_intersections(grid(5))
    assert listed["ray_splits"].shape == (26,) and listed["ray_splits"][-1] == len(listed["t_hit"])
    assert scene.count_intersections(grid(5)).dtype == np.int32
    assert RaycastingScene.INVALID_ID == gridel.MISS


def test_scene_without_meshes_has_no_hits():
    scene = RaycastingScene()
    assert np.isinf(scene.cast_rays(grid(3))["t_hit"]).all()
    assert not scene.test_occlusions(grid(3)).any() and not scene.count_intersections(grid(3)).any()
    assert scene.list_intersections(grid(3))["ray_splits"].tolist() == [0] * 10


def test_cube_is_crossed_twice_through_its_center():
    cube = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=np.float32)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))], dtype=np.uint32)
    scene = RaycastingScene()
    scene.add_triangles(cube, faces)
    ray = np.array([[0.5, 0.5, -1, 0, 0, 1]], dtype=np.float32)
    assert scene.count_intersections(ray).tolist() == [2]
    assert scene.list_intersections(ray)["t_hit"].tolist() == [1, 2]
    assert scene.test_occlusions(ray, tnear=1.5).tolist() == [True]
    assert scene.test_occlusions(ray, tnear=1.25, tfar=1.5).tolist() == [False]
    assert scene.compute_occupancy([[[0.5, 0.5, 0.5], [2, 2, 2]]]).tolist() == [[1.0, 0.0]]


def test_answers_are_those_of_open3d():
    o3d = pytest.importorskip("open3d", reason="Open3D is not installed")
    mine, theirs = fill(RaycastingScene()), fill(o3d.t.geometry.RaycastingScene())
    rays = o3d.core.Tensor(grid(37))
    found, expected = mine.cast_rays(rays), theirs.cast_rays(rays)
    assert set(found) == set(expected)
    for key, value in expected.items():
        assert found[key].dtype == value.dtype and found[key].shape == value.shape, key
    same = (found["primitive_ids"] == expected["primitive_ids"]).numpy()
    assert same.mean() > 0.99
    for key in ["t_hit", "primitive_uvs", "primitive_normals"]:
        a, b = found[key].numpy()[same], expected[key].numpy()[same]
        finite = np.isfinite(b)
        assert np.array_equal(finite, np.isfinite(a)) and np.abs(a[finite] - b[finite]).max() < 1e-5, key
    counts = mine.count_intersections(rays)
    assert counts.dtype == theirs.count_intersections(rays).dtype
    assert (counts.numpy() % 2 == 0).all()
    listed, other = mine.list_intersections(rays), theirs.list_intersections(rays)
    assert set(listed) == set(other)
    for key, value in other.items():
        assert listed[key].dtype == value.dtype, key
    for form in [
        dict(fov_deg=70, center=[0, 0.1, 0], eye=[1, 2, 5], up=[0, 1, 0], width_px=7, height_px=5),
        dict(
            intrinsic_matrix=o3d.core.Tensor([[20, 0, 3.5], [0, 21, 2.5], [0, 0, 1]], dtype=o3d.core.float64),
            extrinsic_matrix=o3d.core.Tensor(
                [[0, 1, 0, 1], [-1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]], dtype=o3d.core.float64
            ),
            width_px=7,
            height_px=5,
        ),
    ]:
        given = RaycastingScene.create_rays_pinhole(**form).numpy()
        expected = o3d.t.geometry.RaycastingScene.create_rays_pinhole(**form).numpy()
        assert given.shape == expected.shape and np.abs(given - expected).max() < 1e-6
