"""Meshes with vertices that are not finite, and small meshes far from the origin, in the classes for other libraries."""

import copy
import pickle
import warnings

import numpy as np
import pytest

import gridel
from gridel.open3d import RaycastingScene

trimesh = pytest.importorskip("trimesh")

#: A place on a map, in meters.
PLACE = np.array([5e5, 5e6, 100.0])


def ours(mesh):
    return gridel.trimesh.RayMeshIntersector(mesh)


@pytest.fixture(scope="module")
def ball():
    return trimesh.creation.icosphere(3, radius=0.005)


@pytest.fixture(scope="module")
def rays():
    origins = np.random.default_rng(3).normal(size=(3000, 3)) * 0.01
    return origins, np.random.default_rng(4).normal(size=(3000, 3)) * 0.003 - origins


def far(mesh):
    """The mesh far away, and near with the same rounding of its vertices."""
    vertices = mesh.vertices + PLACE
    return (trimesh.Trimesh(places, mesh.faces, process=False) for places in (vertices, vertices - PLACE))


def test_small_meshes_on_maps_are_met_as_near_ones(ball, rays):
    there, here = (ours(mesh) for mesh in far(ball))
    # Origins have the bits of the far place.
    origins = rays[0] + PLACE
    near = origins - PLACE
    assert np.array_equal(there.intersects_first(origins, rays[1]), here.intersects_first(near, rays[1]))
    assert np.array_equal(there.intersects_any(origins, rays[1]), here.intersects_any(near, rays[1]))
    for multiple in (True, False):
        found = there.intersects_location(origins, rays[1], multiple_hits=multiple)
        expected = here.intersects_location(near, rays[1], multiple_hits=multiple)
        assert len(found[0]) > 1000 and np.abs(found[0] - (expected[0] + PLACE)).max() < 2e-9
        assert np.array_equal(found[1], expected[1]) and np.array_equal(found[2], expected[2])
    points = origins * 0.5 + PLACE * 0.5
    inside = there.contains_points(points)
    assert np.array_equal(inside, here.contains_points(points - PLACE)) and 0.1 < inside.mean() < 0.9
    assert there.scene.displacement < 1e-8 and np.abs(there.scene_origin - PLACE).max() < 0.01
    assert np.abs(there.scene.bounds).max() < 0.01 and here.scene_origin.tolist() == [0, 0, 0]


@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_scenes_on_maps_are_met_as_near_ones(ball, rays, kind):
    there, here = RaycastingScene(), RaycastingScene()
    for scene, mesh in zip((there, here), far(ball)):
        scene.add_triangles(mesh.vertices, mesh.faces)
    moved = np.hstack([rays[0] + PLACE, rays[1]]).astype(kind)
    near = moved.astype(np.float64)
    near[:, :3] -= PLACE
    for scene in (there, copy.copy(there), pickle.loads(pickle.dumps(there))):
        for name in ("cast_rays", "list_intersections"):
            for key, value in getattr(scene, name)(moved).items():
                expected = getattr(here, name)(near)[key]
                assert value.dtype == expected.dtype and np.allclose(value, expected, rtol=1e-6, atol=1e-6), key
        for name in ("count_intersections", "test_occlusions"):
            assert np.array_equal(getattr(scene, name)(moved), getattr(here, name)(near)), name
        assert np.array_equal(scene.compute_occupancy(moved[:, :3]), here.compute_occupancy(near[:, :3]))
        assert np.array_equal(scene.test_occlusions(moved, tfar=0.5), here.test_occlusions(near, tfar=0.5))
    assert np.abs(there.scene_origin - PLACE).max() < 0.01
    # With a mesh at the origin, the scene is large and its own.
    there.add_triangles(ball.vertices * 1e4, ball.faces)
    with pytest.warns(UserWarning, match="left out"):
        assert there.scene_origin.tolist() == [0, 0, 0]
    assert there.count_intersections([[1, 2, 1000, 0, 0, -1]]).tolist() == [2]


def test_meshes_near_the_origin_keep_their_bits(ball, rays):
    for offset in ([0, 0, 0], [100, 0, -50]):
        vertices = ball.vertices + offset
        mine, scene = ours(trimesh.Trimesh(vertices, ball.faces, process=False)), gridel.Scene.from_arrays(vertices, ball.faces)
        assert mine.scene_origin.tolist() == [0, 0, 0] and mine.scene.to_blob() == scene.to_blob()
        found = mine.intersects_location(rays[0] + offset, rays[1])[0]
        every = scene.all(np.hstack([rays[0] + offset, rays[1]]), format="f32")
        assert np.array_equal(found, rays[0][every.ray] + offset + every.t[:, None] * rays[1][every.ray])


@pytest.fixture
def broken(ball):
    """A ball with vertices that are not finite, which of its faces use them, and the rest of it alone."""
    vertices = ball.vertices.copy()
    vertices[[5, 77]] = [[np.nan, 0, 0], [0, np.inf, 0]]
    is_left_out = np.isin(ball.faces, [5, 77]).any(axis=1)
    rest = trimesh.Trimesh(ball.vertices, ball.faces[~is_left_out], process=False)
    return trimesh.Trimesh(vertices, ball.faces, process=False), is_left_out, rest


def test_faces_of_broken_vertices_are_left_out_of_meshes(broken, rays):
    mesh, is_left_out, rest = broken
    mine, numbers = ours(mesh), np.flatnonzero(~is_left_out)
    with pytest.warns(UserWarning, match=rf"vertices: {is_left_out.sum()} triangles left out: a vertex of each is not finite"):
        first = mine.intersects_first(*rays)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found, expected = mine.intersects_id(*rays), ours(rest).intersects_id(*rays)
        assert np.array_equal(found[0], numbers[expected[0]]) and np.array_equal(found[1], expected[1])
        other = ours(rest).intersects_first(*rays)
    assert np.array_equal(first, np.where(other < 0, -1, numbers[other]))
    assert (~is_left_out).sum() == mine.scene.primitives


def test_faces_of_broken_vertices_are_left_out_of_scenes(broken, rays, ball):
    mesh, is_left_out, rest = broken
    mine, expected = RaycastingScene(), RaycastingScene()
    with pytest.warns(UserWarning, match=f"vertex_positions: {is_left_out.sum()} triangles left out"):
        assert mine.add_triangles(mesh.vertices, mesh.faces) == 0
    expected.add_triangles(rest.vertices, rest.faces)
    for scene in (mine, expected):
        assert scene.add_triangles(ball.vertices + [0.02, 0, 0], ball.faces) == 1
    rows, numbers = np.hstack(rays), np.flatnonzero(~is_left_out)
    for scene in (mine, copy.copy(mine), pickle.loads(pickle.dumps(mine))):
        for name in ("cast_rays", "list_intersections"):
            found, other = getattr(scene, name)(rows), getattr(expected, name)(rows)
            ids, geometries = other.pop("primitive_ids").numpy(), other["geometry_ids"].numpy()
            is_first = geometries == 0
            assert is_first.any() and (geometries == 1).any()
            ids[is_first] = numbers[ids[is_first]]
            assert np.array_equal(found.pop("primitive_ids"), ids)
            for key in other:
                assert np.array_equal(found[key], other[key]), key


def test_meshes_with_nothing_but_broken_vertices_hit_nothing():
    vertices, ray = np.full((3, 3), np.nan), ([[0, 0, 5.0]], [[0, 0, -1.0]])
    mine = ours(trimesh.Trimesh(vertices, [[0, 1, 2]], process=False, validate=False))
    scene = RaycastingScene()
    with pytest.warns(UserWarning, match="1 triangle left out"):
        assert mine.intersects_first(*ray).tolist() == [-1] and mine.scene is None
    with pytest.warns(UserWarning, match="1 triangle left out"):
        scene.add_triangles(vertices, [[0, 1, 2]])
    assert scene.count_intersections(np.hstack(ray)).tolist() == [0]


def test_from_arrays_names_the_remedy_for_broken_vertices(broken):
    mesh, is_left_out, rest = broken
    vertices, faces = np.asarray(mesh.vertices), np.asarray(mesh.faces)
    with pytest.raises(ValueError, match="vertices: vertex 5 is not finite; give it a place, or leave out the faces") as caught:
        gridel.Scene.from_arrays(vertices, faces)
    remedy = str(caught.value).split("use it: ")[1]
    kept = eval(remedy, {"numpy": np, "vertices": vertices, "faces": faces})
    assert gridel.Scene.from_arrays(vertices, kept).primitives == len(rest.faces)
