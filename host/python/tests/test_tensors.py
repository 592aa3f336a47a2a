"""The arrays that take the place of Open3D's tensors, alone and together with tensors; meshes and cameras of Open3D."""

import copy
import pickle

import numpy as np
import pytest
from test_open3d import SIDES, TETRAHEDRON

import gridel
from gridel.open3d import Array, RaycastingScene


def array(values, dtype=np.float32):
    return np.asarray(values, dtype=dtype).view(Array)


@pytest.fixture
def o3d():
    return pytest.importorskip("open3d", reason="Open3D is not installed")


def test_operators_take_tensors(o3d):
    plain = np.array([[1, 2, 3], [4, 5, 6]], dtype=np.float32)
    other = np.array([[6, 5, 4], [3, 2, 1]], dtype=np.float32)
    mine, tensor = array(plain.copy()), o3d.core.Tensor(other)
    answers = [
        (mine * tensor, plain * other),
        (mine + tensor, plain + other),
        (mine / tensor, plain / other),
        (mine @ o3d.core.Tensor(other.T.copy()), plain @ other.T),
        (mine > tensor, plain > other),
        (mine == tensor, plain == other),
        (np.maximum(mine, tensor), np.maximum(plain, other)),
        (np.add(tensor, mine), plain + other),
        (mine.add(tensor), plain + other),
        (mine.lt(tensor), plain < other),
        (mine.append(tensor), np.append(plain, other)),
        (mine.append(tensor, 0), np.vstack([plain, other])),
        (mine.matmul(o3d.core.Tensor(other.T.copy())), plain @ other.T),
        (mine.isclose(tensor), np.isclose(plain, other)),
        (np.concatenate([mine, tensor]), np.concatenate([plain, other])),
        (np.where(mine > 2, mine, tensor), np.where(plain > 2, plain, other)),
        (mine.dot(o3d.core.Tensor(other.T.copy())), plain @ other.T),
    ]
    for number, (found, expected) in enumerate(answers):
        assert type(found) is Array and found.dtype == expected.dtype, number
        assert np.array_equal(found.numpy(), expected), number
    assert mine.allclose(o3d.core.Tensor(plain)) is True and mine.allclose(tensor) is False
    mine += tensor
    assert type(mine) is Array and np.array_equal(mine.numpy(), plain + other)


def test_truth_of_tensors_and_arrays_is_combined(o3d):
    left, right = np.array([True, True, False, False]), np.array([True, False, True, False])
    tensor = o3d.core.Tensor(right)
    for name in ("logical_and", "logical_or", "logical_xor"):
        found = getattr(array(left, bool), name)(tensor)
        assert found.dtype == bool and found.tolist() == getattr(np, name)(left, right).tolist()
    assert (array(left, bool) & tensor).tolist() == (left & right).tolist()


def test_arrays_are_indexed_by_tensors(o3d):
    mine = array([[1, 2, 3], [4, 5, 6]])
    assert mine[o3d.core.Tensor(np.array([False, True]))].tolist() == [[4, 5, 6]]
    assert mine[o3d.core.Tensor(np.array([1, 0, 1]))].tolist() == [[4, 5, 6], [1, 2, 3], [4, 5, 6]]
    assert mine[0, o3d.core.Tensor(np.array([2, 0]))].tolist() == [3, 1]
    mine[o3d.core.Tensor(np.array([True, False]))] = o3d.core.Tensor(np.float32([7, 8, 9]))
    assert mine.tolist() == [[7, 8, 9], [4, 5, 6]]


def test_arrays_work_as_those_of_numpy():
    mine = array([[1, 2, 3], [4, 5, 6]])
    for found in (mine + 1, 1 - mine, -mine, mine.sum(0), np.sum(mine), mine[0], mine[0, 0], np.sqrt(mine), mine.mean()):
        assert type(found) is Array
    assert np.allclose(mine, mine) is True and repr(mine).startswith("Array([[1.")
    assert [type(it) for it in np.split(mine, 2)] == [Array, Array]
    total = array([0, 0, 0])
    assert np.sum(mine, axis=0, out=total) is total and total.tolist() == [5, 7, 9]
    np.add.at(total, [0, 0], 1)
    assert np.multiply(total, 2, out=total) is total and total.tolist() == [14, 14, 18]
    for other in (pickle.loads(pickle.dumps(mine)), copy.deepcopy(mine)):
        assert type(other) is gridel.open3d.Array and np.array_equal(other, mine)
    quotient, rest = np.divmod(mine, 2)
    assert quotient.tolist() == [[0, 1, 1], [2, 2, 3]] and type(rest) is Array


def test_to_takes_devices_types_and_copies():
    mine = array([1.5, 2])
    assert mine.to(np.float32) is mine and mine.to("CPU:0") is mine and mine.to("cpu") is mine
    for made in (mine.to(np.float32, True), mine.to("CPU:0", copy=True), mine.to("CPU:0", np.float32, True)):
        assert made is not mine and not np.shares_memory(made, mine) and made.dtype == np.float32
    for made in (
        mine.to("CPU:0", np.float64), mine.to("float64"), mine.to("CPU:0", dtype=np.float64),
        mine.to(device="CPU:0", dtype=np.float64), mine.to("CPU:0", np.float64, False),
    ):
        assert type(made) is Array and made.dtype == np.float64 and made.tolist() == [1.5, 2]
    for wrong in (1, "yes", 2.0):
        with pytest.raises(TypeError, match="copy is .*; it must be True or False"):
            mine.to(np.float64, wrong)
    with pytest.raises(TypeError, match="dtype is 'nonsense'; it must be a type"):
        mine.to("nonsense")
    with pytest.raises(TypeError, match="device is 'disk'; it must be a device"):
        mine.to(device="disk")
    for wrong in ((), (np.float64, True, True), ("CPU:0", np.float64, True, True)):
        with pytest.raises(TypeError, match="a dtype, a device or both"):
            mine.to(*wrong)


def test_to_takes_what_tensors_take(o3d):
    mine, tensor = array([1.5, 2]), o3d.core.Tensor(np.float32([1.5, 2]))
    device = o3d.core.Device("CPU:0")
    for arguments in [
        (o3d.core.float64,), (device,), (device, o3d.core.int32), ("CPU:0", o3d.core.int32, True), (o3d.core.int64, True),
        (device, True),
    ]:
        found, expected = mine.to(*arguments), tensor.to(*arguments).numpy()
        assert found.dtype == expected.dtype and found.tolist() == expected.tolist()


def test_flatten_takes_dimensions():
    mine = array(np.arange(24).reshape(2, 3, 4))
    assert mine.flatten().shape == (24,) and mine.flatten(1).shape == (2, 12) and mine.flatten(0, 1).shape == (6, 4)
    assert mine.flatten(start_dim=-2, end_dim=-1).shape == (2, 12) and mine.flatten(1, 1).shape == (2, 3, 4)
    assert mine.flatten(0, 1).tolist() == mine.numpy().reshape(6, 4).tolist()
    assert not np.shares_memory(mine.flatten(), mine) and array(3).flatten().tolist() == [3]
    assert mine.flatten("F").tolist() == mine.numpy().flatten("F").tolist()
    with pytest.raises(ValueError, match="start_dim is 1, which is behind end_dim, 0"):
        mine.flatten(1, 0)
    with pytest.raises(ValueError, match="end_dim is 3; it must be -3 to 2"):
        mine.flatten(0, 3)


def test_vertices_of_legacy_meshes_are_taken(o3d):
    mesh = o3d.geometry.TriangleMesh.create_box()
    scene = RaycastingScene()
    assert scene.add_triangles(mesh.vertices, mesh.triangles) == 0
    assert scene.count_intersections([[0.3, 0.4, -1, 0, 0, 1]]).tolist() == [2]
    with pytest.raises(TypeError, match="it must be an open3d.t.geometry.TriangleMesh.*mesh.vertices"):
        scene.add_triangles(mesh)


def test_cameras_of_legacy_open3d_are_rejected_by_name(o3d):
    camera = o3d.camera.PinholeCameraIntrinsic(4, 3, 5.0, 5.0, 2.0, 1.5)
    with pytest.raises(TypeError, match="intrinsic_matrix is a .*PinholeCameraIntrinsic; it must be an array or a tensor"):
        RaycastingScene.create_rays_pinhole(camera, np.eye(4), 4, 3)
    rays = RaycastingScene.create_rays_pinhole(camera.intrinsic_matrix, np.eye(4), 4, 3)
    assert rays.shape == (3, 4, 6)


def test_what_is_no_array_is_named():
    scene = RaycastingScene()
    with pytest.raises(TypeError, match="vertex_positions is a builtins.object"):
        scene.add_triangles(object(), SIDES)
    scene.add_triangles(TETRAHEDRON, SIDES)
    with pytest.raises(TypeError, match="rays is a builtins.object; it must be an array or a tensor"):
        scene.cast_rays(object())
    with pytest.raises(TypeError, match="query_points is a builtins.NoneType"):
        scene.compute_occupancy(None)


FIELD_OF_VIEW = dict(fov_deg=60, center=[0, 0, 0], eye=[0, 0, 3], up=[0, 1, 0], width_px=4, height_px=3)
MATRICES = dict(intrinsic_matrix=np.eye(3), extrinsic_matrix=np.eye(4), width_px=4, height_px=3)


@pytest.mark.parametrize(
    "form, change, error, words",
    [
        (FIELD_OF_VIEW, {"width_px": 4.5}, TypeError, "width_px is 4.5; it must be an integer"),
        (FIELD_OF_VIEW, {"height_px": 0}, ValueError, "height_px is 0; it must be 1 to"),
        (FIELD_OF_VIEW, {"fov_deg": "wide"}, TypeError, "fov_deg is 'wide'; it must be a number"),
        (FIELD_OF_VIEW, {"fov_deg": [60]}, TypeError, r"fov_deg is \[60\]; it must be a number"),
        (FIELD_OF_VIEW, {"fov_deg": 180}, ValueError, "fov_deg is 180.0; it must be above 0 and below 180"),
        (FIELD_OF_VIEW, {"fov_deg": np.nan}, ValueError, "fov_deg is nan"),
        (FIELD_OF_VIEW, {"eye": [0, 0, 0]}, ValueError, "center and eye are the same place"),
        (FIELD_OF_VIEW, {"up": [0, 0, -2]}, ValueError, "up is parallel to the view"),
        (FIELD_OF_VIEW, {"up": [0, 0, 0]}, ValueError, "up is zero"),
        (FIELD_OF_VIEW, {"up": ["a", "b", "c"]}, TypeError, "up: the array has the type"),
        (FIELD_OF_VIEW, {"eye": [0, np.inf, 0]}, ValueError, "eye: a number is not finite"),
        (MATRICES, {"intrinsic_matrix": np.zeros((3, 3))}, ValueError, "intrinsic_matrix is singular"),
        (MATRICES, {"intrinsic_matrix": [[1, 2, 3], [2, 4, 6], [0, 0, 1]]}, ValueError, "intrinsic_matrix is singular"),
        (MATRICES, {"extrinsic_matrix": np.full((4, 4), np.nan)}, ValueError, "extrinsic_matrix: a number is not finite"),
        (MATRICES, {"width_px": "4"}, TypeError, "width_px is '4'; it must be an integer"),
    ],
)
def test_cameras_are_checked(form, change, error, words):
    with np.errstate(all="raise"):
        assert np.isfinite(RaycastingScene.create_rays_pinhole(**form)).all()
        with pytest.raises(error, match=words):
            RaycastingScene.create_rays_pinhole(**{**form, **change})


def test_scenes_check_what_they_are_made_of():
    with pytest.raises(TypeError, match="nthreads is 'four'; it must be an integer"):
        RaycastingScene("four")
    with pytest.raises(TypeError, match="device is 'nonsense'; it must be a device of Open3D's"):
        RaycastingScene(4, "nonsense")
    RaycastingScene(4, "CPU:0"), RaycastingScene(-1, device=None)


def test_attributes_that_are_missing_are_missing_to_type_checkers():
    import ast
    import inspect

    (scene,) = (it for it in ast.parse(inspect.getsource(gridel.open3d)).body if getattr(it, "name", "") == "RaycastingScene")
    assert "__getattr__" not in [getattr(it, "name", None) for it in scene.body]
    with pytest.raises(AttributeError, match="use open3d"):
        RaycastingScene().compute_distance


@pytest.mark.parametrize("name", ["sum", "mean", "prod", "min", "max"])
def test_reductions_take_keepdim_by_position(name):
    plain = np.array([[5, 2, 3], [4, 1, 6]], dtype=np.float32)
    reduced = getattr(np, name)
    for dims, axis in (([0], 0), ([1], 1), ([-1], -1), (0, 0), ((0, 1), (0, 1)), ([1, 0], None), (None, None)):
        for keep in (True, False, 1, np.False_):
            found = getattr(array(plain), name)(dims, keep)
            expected = reduced(plain, axis=axis, keepdims=bool(keep))
            assert type(found) is Array and found.shape == expected.shape and np.array_equal(found, expected)
    is_large = array(plain > 2, bool)
    assert is_large.any([0], True).tolist() == [[True, False, True]] == is_large.all([0], True).tolist()
    # NumPy's own arguments are taken as before.
    assert array(plain).sum(0, np.float64).dtype == np.float64
    out = np.zeros(3, dtype=np.float32)
    assert array(plain).min(0, out).tolist() == [4, 1, 3] == out.tolist()


def test_places_of_extremes_are_found_in_one_dimension_or_all():
    mine = array([[5, 2, 3], [4, 1, 6]])
    for dims, least, greatest in [
        ([0], [1, 1, 0], [0, 0, 1]),
        ([-1], [1, 1], [0, 2]),
        (1, [1, 1], [0, 2]),
        ([0, 1], 4, 5),
        ((1, 0), 4, 5),
        ([-2, -1], 4, 5),
        (None, 4, 5),
    ]:
        assert mine.argmin(dims).tolist() == mine.argmin(dim=dims).tolist() == least
        assert mine.argmax(dims).tolist() == greatest
    for dims in ([], [0, 0], [0, 1]):
        with pytest.raises(ValueError, match="argmin takes one dimension or all"):
            array(np.zeros((2, 3, 4))).argmin(dims)


def test_quotients_of_integers_are_truncated():
    plain = np.array([7, -7, 2, -1], dtype=np.int32)
    for other in (2, -2, True, np.int32(3), np.array([2, 2, -3, 5], dtype=np.int32)):
        found = array(plain, np.int32).div(other)
        assert found.dtype == np.int32 and found.tolist() == np.trunc(plain / other).tolist()
    large = array([2**62 + 1, -(2**62) - 3], np.int64).div(2)
    assert large.tolist() == [2**61, -(2**61) - 1]
    assert array([200, 7], np.uint8).div(3).tolist() == [66, 2]
    for whole in (array([3, 4]), array([True, False], bool)):
        assert whole.div(2).dtype.kind == "f" and whole.div(2).tolist() == (whole / 2).tolist()
    assert array([3, 4], np.int32).div(2.5).tolist() == [3 / 2.5, 4 / 2.5]


def test_reductions_and_quotients_are_those_of_open3d(o3d):
    plain, whole = np.array([[5, 2, 3], [4, 1, 6]], dtype=np.float32), np.array([7, -7, 2, -1], dtype=np.int32)
    for name in ("sum", "mean", "prod", "min", "max", "argmin", "argmax"):
        for dims in ([0], [1], [-1], [1, 0], (0, 1), None):
            for keep in ([], [True]) if not name.startswith("arg") else ([],):
                found = getattr(array(plain), name)(dims, *keep)
                expected = getattr(o3d.core.Tensor(plain), name)(dims, *keep).numpy()
                assert found.dtype == expected.dtype and found.shape == expected.shape, (name, dims, keep)
                assert np.allclose(found, expected, rtol=1e-6), (name, dims, keep)
    for other in (2, -2, np.array([2, 2, -3, 5], dtype=np.int32)):
        value = o3d.core.Tensor(other) if isinstance(other, np.ndarray) else other
        expected = o3d.core.Tensor(whole).div(value).numpy()
        found = array(whole, np.int32).div(value)
        assert found.dtype == expected.dtype and np.array_equal(found, expected)
