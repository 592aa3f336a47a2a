"""Tests the class for Open3D alone, and against Open3D's own where that is installed."""

import copy
import pickle

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
    one = hits["t_hit"][2, 2]
    assert one.numpy() == one.item() == hits["t_hit"].tolist()[2][2]
    assert hits["primitive_uvs"][2, 2].shape == (2,) and one.isfinite() == (one.item() < np.inf)
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


def test_occupancy_is_the_parity_of_all_meshes():
    def answers(scene, convert):
        for scale in (1, 0.5, 0.25):
            vertices = (np.float32(scale) * (TETRAHEDRON - np.float32(0.2))).astype(np.float32)
            scene.add_triangles(convert(vertices), convert(SIDES))
        points = np.random.default_rng(1).uniform(-0.25, 0.5, size=(2000, 3)).astype(np.float32)
        return scene.compute_occupancy(convert(points)).numpy().tolist()

    mine = answers(RaycastingScene(), lambda it: it)
    assert set(mine) == {0.0, 1.0}
    o3d = pytest.importorskip("open3d", reason="Open3D is not installed")
    assert mine == answers(o3d.t.geometry.RaycastingScene(), o3d.core.Tensor)


def test_occupancy_of_two_nested_meshes_is_outside():
    scene = RaycastingScene()
    scene.add_triangles(TETRAHEDRON, SIDES)
    scene.add_triangles(TETRAHEDRON, SIDES[:, ::-1])
    assert scene.compute_occupancy([[0.1, 0.1, 0.1], [np.nan, 0, 0]]).tolist() == [0.0, 0.0]
    scene.add_triangles(TETRAHEDRON, SIDES)
    assert scene.compute_occupancy([[0.1, 0.1, 0.1], [np.nan, 0, 0]]).tolist() == [1.0, 0.0]


def test_tutorial_of_open3d_runs():
    scene = fill(RaycastingScene())
    rays = RaycastingScene.create_rays_pinhole(
        fov_deg=90, center=[0, 0, 2], eye=[2, 3, 0], up=[0, 1, 0], width_px=64, height_px=48
    )
    rays = RaycastingScene.create_rays_pinhole(90, [0.2, 0.2, 0.2], [2, 3, 4], [0, 1, 0], 64, 48)
    found = scene.cast_rays(rays)
    hit = found["t_hit"].isfinite()
    assert hit.numpy().any() and type(hit.numpy()) is np.ndarray
    points = rays[hit][:, :3] + rays[hit][:, 3:] * found["t_hit"][hit].reshape((-1, 1))
    assert points.shape == (hit.sum(), 3)
    assert (found["t_hit"].isinf() == hit.logical_not()).all() and not found["t_hit"].isnan().any()
    assert found["t_hit"].cpu().clone().contiguous().to(np.float64).dtype == np.float64
    assert found["primitive_normals"].abs().num_elements() == 64 * 48 * 3
    o3d = pytest.importorskip("open3d", reason="Open3D is not installed")
    assert len(o3d.t.geometry.PointCloud(points).point.positions) == len(points)
    assert found["t_hit"].to(o3d.core.float64).dtype == np.float64


@pytest.mark.filterwarnings("ignore:.*left out")
def test_far_and_tiny_rays_and_thin_meshes():
    scene = RaycastingScene()
    scene.add_triangles(TETRAHEDRON, SIDES)
    rays = np.array([[0.1, 0.2, -1e9, 0, 0, 1], [0.1, 0.2, -1e9, 0, 0, 1e-308]])
    found = scene.cast_rays(rays)
    assert found["t_hit"].tolist() == [1e9, np.inf] and found["primitive_ids"][1] == scene.INVALID_ID
    assert scene.test_occlusions(rays).tolist() == [True, False]
    assert scene.count_intersections(rays).tolist() == [2, 0]
    assert scene.list_intersections(rays)["ray_splits"].tolist() == [0, 2, 2]
    thin = RaycastingScene()
    thin.add_triangles(TETRAHEDRON * [1, 1, 1e-9], SIDES)
    assert thin.test_occlusions([[0.1, 0.2, -1, 0, 0, 1]]).tolist() == [True]


def test_add_triangles_rejects_what_is_no_mesh():
    scene = RaycastingScene()
    with pytest.raises(TypeError, match="triangle_indices.*integers"):
        scene.add_triangles(TETRAHEDRON, SIDES.astype(float))
    with pytest.raises(ValueError, match=r"vertex_positions: the array has the shape \(4, 2\)"):
        scene.add_triangles(TETRAHEDRON[:, :2], SIDES)
    with pytest.raises(ValueError, match="triangle_indices: face 0 .*numbered 0 to 3"):
        scene.add_triangles(TETRAHEDRON, [[0, 1, 4]])
    for bad in (TETRAHEDRON, object()):
        with pytest.raises(TypeError, match="must be an open3d.t.geometry.TriangleMesh"):
            scene.add_triangles(bad)
    with pytest.raises(TypeError, match="vertex_positions and triangle_indices, or mesh"):
        scene.add_triangles()
    assert scene.scene is None
    assert scene.add_triangles(TETRAHEDRON, SIDES) == 0
    assert scene.test_occlusions([[0.1, 0.2, -1, 0, 0, 1]]).tolist() == [True]
    o3d = pytest.importorskip("open3d", reason="Open3D is not installed")
    with pytest.raises(TypeError, match="open3d.*TriangleMesh.*it must be"):
        scene.add_triangles(o3d.geometry.TriangleMesh.create_box())
    assert scene.add_triangles(mesh=o3d.t.geometry.TriangleMesh.create_box()) == 1


def test_arguments_are_checked_in_empty_scenes_too():
    for scene in (RaycastingScene(), fill(RaycastingScene())):
        with pytest.raises(ValueError, match="query_points.*shape"):
            scene.compute_occupancy(np.zeros((2, 4)))
        with pytest.raises(TypeError, match="nthreads is 'two'; it must be an integer"):
            scene.cast_rays(grid(3), nthreads="two")
        for limits in (dict(tfar=None), dict(tnear=None), dict(tfar="2"), dict(tfar=[1.0, 2.0])):
            with pytest.raises(TypeError, match="(tfar|tnear) is .*; it must be a number"):
                scene.test_occlusions(grid(3), **limits)
        assert scene.test_occlusions(grid(3), tfar=np.float32(2)).shape == (3, 3)
    for threads in (-1, -5, 1025, 10**6):
        assert np.isfinite(scene.cast_rays(grid(9), nthreads=threads)["t_hit"]).any()


def test_scenes_pickle_and_copy_after_their_first_query():
    scene = fill(RaycastingScene())
    expected = scene.cast_rays(grid(9))
    for other in (copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
        for key, value in other.cast_rays(grid(9)).items():
            assert np.array_equal(value, expected[key])


def test_a_copy_and_its_original_are_apart():
    for is_compiled in (False, True):
        scene = RaycastingScene()
        scene.add_triangles(TETRAHEDRON, SIDES)
        rays = np.array([[0.1, 0.2, -1, 0, 0, 1], [3.1, 0.2, -1, 0, 0, 1]], dtype=np.float32)
        if is_compiled:
            scene.cast_rays(rays)
        other = copy.copy(scene)
        assert other.add_triangles(TETRAHEDRON + np.float32([3, 0, 0]), SIDES) == 1
        assert scene.count_intersections(rays).tolist() == [2, 0]
        assert other.count_intersections(rays).tolist() == [2, 2]
        assert scene.add_triangles(TETRAHEDRON + np.float32([6, 0, 0]), SIDES) == 1
        assert scene.count_intersections(rays).tolist() == [2, 0]
        assert other.cast_rays(rays)["geometry_ids"].tolist() == [0, 1]


def test_queries_of_distances_are_named_as_missing():
    for name in ("compute_distance", "compute_signed_distance", "compute_closest_points"):
        assert not hasattr(RaycastingScene, name)
        with pytest.raises(AttributeError, match=f"{name} is not part of gridel.open3d.*use open3d"):
            getattr(RaycastingScene(), name)
    with pytest.raises(AttributeError, match="'RaycastingScene' object has no attribute 'cast'"):
        RaycastingScene().cast


def test_occlusions_at_the_t_of_hits():
    # Vertices that are not on the lattice, in single precision.
    vertices = (TETRAHEDRON / 3 + np.float32([0.1, 0.2, 0.3])).astype(np.float32)
    rng = np.random.default_rng(13)
    for kind in (np.float32, np.float64):
        scene = RaycastingScene()
        scene.add_triangles(vertices, SIDES)
        origins = rng.normal(size=(400, 3)) + np.array([0.2, 0.3, 0.4])
        rays = np.hstack([origins, np.array([0.2, 0.3, 0.4]) - origins]).astype(kind)
        rays = rays[np.linalg.norm(rays[:, 3:], axis=1) > 1]
        found = scene.cast_rays(rays)["t_hit"].numpy()
        hit = np.isfinite(found)
        assert hit.sum() > 100
        for ray, t in zip(rays[hit], found[hit]):
            before, behind = np.nextafter(t, np.float32(0)), np.nextafter(t, np.float32(9))
            for limits, expected in (
                [(0.0, t), True], [(t, behind), True], [(t, t), True], [(0.0, before), False], [(-1.0, t), True]
            ):
                assert scene.test_occlusions(ray[None], *map(float, limits)).tolist() == [expected]


def test_one_ray_gives_results_without_rows():
    scene = fill(RaycastingScene())
    ray = np.array([0.1, 0.2, -1, 0, 0, 1], dtype=np.float32)

    def shapes(convert):
        given = convert(ray)
        results = list(scene.cast_rays(given).values())
        results += [scene.count_intersections(given), scene.test_occlusions(given)]
        results.append(scene.compute_occupancy(convert(ray[:3])))
        return [tuple(it.shape) for it in results]

    expected = [(), (), (), (2,), (3,)] + [()] * 3
    assert shapes(lambda it: it) == expected
    o3d = pytest.importorskip("open3d", reason="Open3D is not installed")
    assert shapes(o3d.core.Tensor) == expected


def test_arrays_have_the_methods_of_tensors():
    rays = grid(4)
    found = fill(RaycastingScene()).cast_rays(rays)["primitive_normals"].reshape((-1, 3))
    plain = found.numpy()
    assert np.array_equal(found.min(dim=[0]), plain.min(0)) and np.array_equal(found.max(dim=0), plain.max(0))
    assert found.sum(dim=[1], keepdim=True).shape == (16, 1) and found.mean(dim=(0, 1)) == plain.mean()
    assert found.argmax(dim=[0]).tolist() == plain.argmax(0).tolist() and found.prod().item() == plain.prod()
    assert found.gt(0).any(dim=[1]).tolist() == (plain > 0).any(1).tolist() and not found.lt(-2).all()
    assert found.max().numpy() == plain.max() and f"{found.sum():.3f}" == f"{plain.sum():.3f}"
    assert np.sum(found, axis=0).shape == (3,) and np.min(found) == plain.min() and found.sum(0).shape == (3,)
    assert found.isclose(found).all() and found.allclose(found) is True
    for name, function in dict(add=np.add, sub=np.subtract, mul=np.multiply, eq=np.equal, ne=np.not_equal, le=np.less_equal, ge=np.greater_equal).items():
        assert np.array_equal(getattr(found, name)(0.5), function(plain, 0.5))
    for name in ("exp", "floor", "ceil", "trunc", "sin", "cos"):
        assert np.array_equal(getattr(found, name)(), getattr(np, name)(plain))
    assert np.array_equal(found.abs().sqrt().neg(), -np.sqrt(np.abs(plain)))
    assert np.array_equal(found.matmul(found.T), plain @ plain.T) and not found.T.is_contiguous()
    assert found.T.contiguous().is_contiguous() and found.append(found).shape == (96,)
    assert found.append(found, axis=0).shape == (32, 3) and found[0, 0].floor().item() == np.floor(plain[0, 0])


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


def test_hits_beyond_single_precision_are_misses():
    scene = fill(RaycastingScene())
    ray = np.array([[0.1, 0.1, -3, 0, 0, 1e-39]], dtype=np.float32)
    hits = scene.cast_rays(ray)
    assert hits["t_hit"][0] == np.inf
    assert hits["primitive_ids"][0] == hits["geometry_ids"][0] == RaycastingScene.INVALID_ID
    assert (hits["primitive_normals"] == 0).all() and (hits["primitive_uvs"] == 0).all()
    listed = scene.list_intersections(ray)
    assert listed["ray_splits"].tolist() == [0, 0] and len(listed["t_hit"]) == 0


@pytest.mark.parametrize("nsamples", [2, 0, -1])
def test_occupancy_takes_odd_numbers_of_samples(nsamples):
    with pytest.raises(ValueError, match="nsamples"):
        RaycastingScene().compute_occupancy(np.zeros((1, 3), np.float32), nsamples=nsamples)


def test_cameras_of_wrong_shapes_are_rejected():
    pinhole = RaycastingScene.create_rays_pinhole
    with pytest.raises(ValueError, match="center"):
        pinhole(60, [[0], [0], [0]], [0, 0, 3], [0, 1, 0], 4, 3)
    with pytest.raises(ValueError, match="extrinsic_matrix"):
        pinhole(np.eye(3), np.eye(4)[:3], 4, 3)
    with pytest.raises(TypeError):
        pinhole(np.eye(3), np.eye(4), 4.7, 3)


def test_nothing_is_met_beyond_single_precision():
    scene = RaycastingScene()
    scene.add_triangles(TETRAHEDRON, SIDES)
    # Of 3.4e38, the greatest number, the second hit alone is beyond.
    rays = np.array([[0.1, 0.2, -1, 0, 0, length] for length in (1.0, 1e-38, 4e-39, 1e-39)], dtype=np.float32)
    counts = scene.count_intersections(rays)
    assert counts.tolist() == [2, 2, 1, 0]
    assert np.diff(scene.list_intersections(rays)["ray_splits"].astype(int)).tolist() == counts.tolist()
    assert np.isfinite(scene.cast_rays(rays)["t_hit"]).tolist() == (counts > 0).tolist()
    for tfar in (float("inf"), 3.4e38):
        assert scene.test_occlusions(rays, tfar=tfar).tolist() == (counts > 0).tolist()


def test_limits_beyond_single_precision_leave_out_what_cast_rays_does():
    scene = RaycastingScene()
    scene.add_triangles(TETRAHEDRON, SIDES)
    # One hit each, the last two beyond the greatest number: the first of them is rounded to it.
    rays = np.array([[0.1, 0.2, 0.1, 0, 0, -0.1 / t] for t in (1.0, 3.4e38, 3.40282351e38, 3.40282358e38, 1e39, 1e300)])
    found = scene.cast_rays(rays)["t_hit"]
    is_met = [True, True, True, False, False, False]
    assert np.isfinite(found).tolist() == is_met and found[2] == np.finfo(np.float32).max
    assert scene.count_intersections(rays).tolist() == is_met
    assert scene.list_intersections(rays)["t_hit"].tolist() == found[is_met].tolist()
    for tfar in (3.40282347e38, 3.4028236e38, 1e39, 1e300, float("inf")):
        assert scene.test_occlusions(rays, tfar=tfar).tolist() == is_met
        assert scene.test_occlusions(rays, 2.0, tfar).tolist() == [False] + is_met[1:]
        assert not scene.test_occlusions(rays, 1e39, tfar).any()


def test_copies_of_subclasses_keep_their_class_and_attributes():
    class Named(RaycastingScene):
        pass

    scene = Named()
    scene.name = "tetrahedron"
    scene.add_triangles(TETRAHEDRON, SIDES)
    other = copy.copy(scene)
    assert type(other) is Named and other.name == "tetrahedron"
    assert other.count_intersections([[0.1, 0.2, -1, 0, 0, 1]]).tolist() == [2]


def test_numbers_of_samples_are_integers():
    scene = RaycastingScene()
    scene.add_triangles(TETRAHEDRON, SIDES)
    for wrong in (1.0, 1.5, None, "1"):
        with pytest.raises(TypeError, match="nsamples"):
            scene.compute_occupancy([[0.1, 0.1, 0.1]], nsamples=wrong)
    with pytest.raises(ValueError, match="odd"):
        scene.compute_occupancy([[0.1, 0.1, 0.1]], nsamples=2)


def test_arrays_take_devices_by_name_and_dimensions_in_a_list():
    array = gridel.open3d.Array.__new__(gridel.open3d.Array, (2, 3))
    array[...] = [[1, 2, 3], [4, 5, 6]]
    assert array.to(device=None, dtype=np.float32).dtype == np.float32
    assert array.to(device="CPU:0") is array
    assert array.sum([0]).tolist() == [5, 7, 9] and array.max([0, 1]) == 6
    with pytest.raises(TypeError, match="a dtype, a device or both"):
        array.to()
