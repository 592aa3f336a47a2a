"""Beside trimesh's own intersectors, on the same calls, and on the cases of trimesh's open issues."""

import copy
import inspect
import pickle
import time

import numpy as np
import pytest

import gridel.trimesh

trimesh = pytest.importorskip("trimesh")
embree = pytest.importorskip("trimesh.ray.ray_pyembree", reason="embreex is not installed")


def ours(mesh):
    return gridel.trimesh.RayMeshIntersector(mesh)


@pytest.fixture(scope="module")
def ball():
    return trimesh.creation.icosphere(subdivisions=4)


@pytest.fixture(scope="module")
def random_rays():
    rng = np.random.default_rng(5)
    return rng.uniform(-1.5, 1.5, (20_000, 3)), rng.normal(size=(20_000, 3))


def signature(of, name):
    """The parameters of a method, behind the decorator by which trimesh logs times."""
    method = getattr(of, name)
    inner = inspect.getclosurevars(method).nonlocals.get("method", method)
    return list(inspect.signature(inner).parameters)


def test_signatures_are_those_of_trimesh():
    for name in ["intersects_location", "intersects_id", "intersects_first", "intersects_any", "contains_points"]:
        mine = signature(gridel.trimesh.RayMeshIntersector, name)
        assert mine == signature(embree.RayMeshIntersector, name), name


def test_answers_are_those_of_trimesh_with_its_types(ball, random_rays):
    mine, theirs = ours(ball), embree.RayMeshIntersector(ball)
    origins, directions = random_rays
    first, expected = mine.intersects_first(origins, directions), theirs.intersects_first(origins, directions)
    assert first.dtype == expected.dtype and (first == expected).mean() > 0.9999
    hit, expected = mine.intersects_any(origins, directions), theirs.intersects_any(origins, directions)
    assert hit.dtype == expected.dtype and (hit == expected).mean() > 0.9999
    for multiple in (True, False):
        found = mine.intersects_location(origins, directions, multiple_hits=multiple)
        expected = theirs.intersects_location(origins, directions, multiple_hits=multiple)
        for a, b in zip(found, expected):
            assert a.dtype == b.dtype and a.ndim == b.ndim
            assert abs(len(a) - len(b)) <= 4
        pairs = set(zip(found[1].tolist(), found[2].tolist()))
        theirs_pairs = set(zip(expected[1].tolist(), expected[2].tolist()))
        assert len(pairs ^ theirs_pairs) <= 8
        places = ball.triangles_cross[found[2]]
        off = ((found[0] - ball.triangles[found[2], 0]) * places).sum(1) / np.linalg.norm(places, axis=1)
        assert np.abs(off).max() < 1e-12
    triangles, rays, places = mine.intersects_id(origins, directions, return_locations=True)
    assert triangles.dtype == rays.dtype == np.int64 and places.shape == (len(rays), 3)
    assert (np.bincount(mine.intersects_id(origins, directions, max_hits=1)[1]) <= 1).all()
    points = origins[:5000]
    inside = mine.contains_points(points)
    assert inside.dtype == theirs.contains_points(points).dtype
    assert (inside == theirs.contains_points(points)).mean() > 0.999


def test_edges_of_the_interface(ball):
    mine = ours(ball)
    none = mine.intersects_location(np.zeros((0, 3)), np.zeros((0, 3)))
    assert [len(it) for it in none] == [0, 0, 0] and none[0].shape == (0, 3)
    away = mine.intersects_location([[0, 0, 5.0]], [[0, 0, 1.0]])
    assert away[0].shape == (0, 3) and away[1].dtype == np.int64
    assert mine.intersects_first([[0, 0, 5]], [[0, 0, 0]]).tolist() == [-1]
    with pytest.raises(ValueError, match="match"):
        mine.intersects_any(np.zeros((2, 3)), np.zeros((3, 3)))
    assert mine.contains_points([[0, 0, 0]]).tolist() == [True]
    for other in (copy.copy(mine), copy.deepcopy(mine), pickle.loads(pickle.dumps(mine))):
        assert other.intersects_any([[0, 0, 5]], [[0, 0, -1]]).tolist() == [True]
    empty = ours(trimesh.Trimesh())
    assert empty.intersects_first([[0, 0, 5]], [[0, 0, -1]]).tolist() == [-1]
    assert empty.contains_points([[0, 0, 5]]).tolist() == [False]


def test_mesh_ray_is_all_that_a_user_changes(ball):
    mesh = ball.copy()
    mesh.ray = gridel.trimesh.RayMeshIntersector(mesh)
    assert mesh.contains([[0, 0, 0], [2, 0, 0]]).tolist() == [True, False]
    mesh.apply_translation([2, 0, 0])
    assert mesh.ray.contains_points([[0, 0, 0], [2, 0, 0]]).tolist() == [False, True]


def test_issue_242_contains_is_right_everywhere():
    # "Inaccuracies in mesh.contains": points near surfaces, and meshes of any scale and place.
    ball = trimesh.creation.icosphere(subdivisions=3)
    rng = np.random.default_rng(242)
    for scale, offset in [(1e-6, 0.0), (1.0, 0.0), (1e7, 0.0), (1.0, 1e7), (1e-3, 50.0)]:
        mesh = trimesh.Trimesh(ball.vertices * scale + offset, ball.faces, process=False)
        inner = mesh.triangles[rng.integers(len(mesh.faces), size=20_000)]
        weights = rng.dirichlet(np.ones(3), size=len(inner))
        normal = np.cross(inner[:, 1] - inner[:, 0], inner[:, 2] - inner[:, 0])
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        ray = ours(mesh)
        # Farther from the surface than it was moved, and than float64 places points there.
        depth = 1.1 * ray.scene.displacement + 4e-16 * abs(offset)
        assert depth < 2.5e-7 * scale + 1e-15 * abs(offset)
        surface = (inner * weights[:, :, None]).sum(1)
        assert ray.contains_points(surface - depth * normal).all()
        assert not ray.contains_points(surface + depth * normal).any()


def test_issue_1180_no_ray_is_lost():
    # "missing hit location": 1024 x 512 rays from inside, one location each.
    sphere = trimesh.creation.uv_sphere(radius=2.0, count=[32, 32])
    theta, phi = np.meshgrid(np.linspace(0, np.pi, 512), np.linspace(0, 2 * np.pi, 1024, endpoint=False))
    directions = np.stack(
        [np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1
    ).reshape(-1, 3)
    locations, rays, _ = ours(sphere).intersects_location(
        np.zeros_like(directions), directions, multiple_hits=False
    )
    assert locations.shape == (1024 * 512, 3)
    assert np.array_equal(rays, np.arange(len(directions)))


def test_issue_1496_any_and_id_agree():
    # Rays through vertices and edges of the small box, from its middle.
    small = trimesh.creation.box(extents=np.full(3, 40.0)).subdivide_to_size(20)
    big = trimesh.creation.box(extents=np.full(3, 60.0)).subdivide_to_size(20)
    origins = np.zeros_like(big.vertices)
    mine = ours(small)
    assert mine.intersects_any(origins, big.vertices).all()
    for multiple in (True, False):
        rays = mine.intersects_id(origins, big.vertices, multiple_hits=multiple)[1]
        assert np.array_equal(rays, np.arange(len(origins)))


def test_issue_1766_border_between_triangles_is_hit():
    mesh = trimesh.Trimesh(
        vertices=[[-1, -1, 0], [-1, 1, 0], [1, 1, 0], [1, -1, 0]], faces=[(0, 1, 2), (2, 3, 0)]
    )
    for multiple in (True, False):
        places, _, _ = ours(mesh).intersects_location([[0, 0, 1]], [[0, 0, -1]], multiple_hits=multiple)
        assert places.tolist() == [[0, 0, 0]]


def test_issue_2317_edges_and_vertices_count_once(ball):
    # From inside, at every vertex and at the middle of every edge: one hit each.
    edges = ball.vertices[ball.edges_unique].mean(axis=1)
    targets = np.concatenate([ball.vertices, edges, ball.triangles_center])
    origins = np.zeros_like(targets)
    locations, rays, _ = ours(ball).intersects_location(origins, targets)
    assert np.array_equal(rays, np.arange(len(targets)))
    assert np.abs(locations - targets).max() < 1e-6
    # Through the whole ball, and from outside: an even number.
    outside = ours(ball).intersects_id(-3 * targets, targets)[1]
    assert (np.bincount(outside, minlength=len(targets)) == 2).all()


def test_thin_walls_are_told_apart():
    # A wall of four steps of the lattice.
    outer = trimesh.creation.box(extents=[1.0, 1.0, 1.0])
    wall = 4 * 2.0**-24
    inner = trimesh.creation.box(extents=np.full(3, 1.0 - 2 * wall))
    inner.invert()
    shell = trimesh.util.concatenate([outer, inner])
    rng = np.random.default_rng(4)
    across = rng.uniform(-0.4, 0.4, (3000, 2))
    points = lambda x: np.column_stack([np.full(3000, x), across])  # noqa: E731
    mine = ours(shell)
    assert mine.contains_points(points(0.5 - 0.5 * wall)).all()
    assert not mine.contains_points(points(0.5 - 1.6 * wall)).any()
    assert not mine.contains_points(points(0.5 + 0.6 * wall)).any()


def test_contains_points_of_nan_is_false(ball):
    assert ours(ball).contains_points([[np.nan, 0, 0], [0, np.inf, 0], [0, 0, 0]]).tolist() == [False, False, True]


def test_rays_from_far_away_hit(ball):
    for distance in (1e7, 1e9, 1e12):
        origins, directions = [[0.1, 0.2, distance], [5, 0, distance]], [[0, 0, -1.0]] * 2
        mine = ours(ball)
        assert mine.intersects_first(origins, directions)[0] >= 0
        assert mine.intersects_any(origins, directions).tolist() == [True, False]
        for multiple in (True, False):
            places, rays, triangles = mine.intersects_location(origins, directions, multiple_hits=multiple)
            assert rays.tolist() == [0] * (1 + multiple)
            off = ((places - ball.triangles[triangles, 0]) * ball.face_normals[triangles]).sum(1)
            assert np.abs(off).max() < 1e-12 and np.allclose(places[:, :2], [0.1, 0.2])


@pytest.mark.filterwarnings("ignore:.*left out")
def test_thin_boxes_are_met_as_flat_ones():
    box = trimesh.creation.box()
    thin = trimesh.Trimesh(box.vertices * [1, 1, 1e-9], box.faces, process=False)
    mine = ours(thin)
    assert mine.intersects_any([[0.1, 0.2, 5]], [[0, 0, -1]]).tolist() == [True]
    places, rays, _ = mine.intersects_location([[0.1, 0.2, 5]], [[0, 0, -1]])
    assert np.allclose(places, [[0.1, 0.2, 0]] * 2) and rays.tolist() == [0, 0]
    assert mine.contains_points([[0.1, 0.2, 1.0]]).tolist() == [False]


def test_rays_with_tiny_directions_hit_nothing(ball):
    origins, directions = [[0.1, 0.2, 5.0], [0.1, 0.2, 5]], [[0, 0, -1e-308], [0, 0, -1]]
    mine = ours(ball)
    for multiple in (True, False):
        triangles, rays = mine.intersects_id(origins, directions, multiple_hits=multiple)
        assert rays.tolist() == [1] * (1 + multiple) and triangles.max() < len(ball.faces)
    assert mine.intersects_any(origins, directions).tolist() == [False, True]
    assert mine.intersects_first(origins, directions)[0] == -1


def test_locations_come_in_the_order_of_the_ray():
    square = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0.0]])
    vertices = np.concatenate([square + [0, 0, 1e-9 * k] for k in range(3)])
    faces = np.concatenate([np.array([[0, 1, 2], [0, 2, 3]]) + 4 * k for k in range(3)])
    mine = ours(trimesh.Trimesh(vertices, faces, process=False))
    for side in (1, -1):
        places, rays, _ = mine.intersects_location([[0.1, 0.2, side]], [[0, 0, -side]])
        assert len(rays) == 3 and (np.diff(-side * places[:, 2]) >= 0).all()
    # None lies before the origin.
    corners = np.array([[-1, -1, 1 / 3], [1, -1, 1 / 3], [0, 1, 1 / 3], [0, 0, -1]])
    mine = ours(trimesh.Trimesh(corners, [[0, 1, 2], [0, 1, 3]], process=False))
    origins = np.column_stack([np.full((301, 2), 0.1), 1 / 3 + np.linspace(-3e-7, 3e-7, 301)])
    places, rays, _ = mine.intersects_location(origins, np.tile([0, 0, -1.0], (301, 1)))
    assert (places[:, 2] <= origins[rays, 2]).all()


def test_numbers_out_of_range_name_the_argument(ball):
    mine = ours(ball)
    with pytest.raises(ValueError, match="max_hits is -1"):
        mine.intersects_id([[0, 0, 5]], [[0, 0, -1]], max_hits=-1)
    with pytest.raises(ValueError, match="threads is -1; it must be 0 to 1024"):
        gridel.trimesh.RayMeshIntersector(ball, threads=-1).intersects_any([[0, 0, 5]], [[0, 0, -1]])
    misaligned = np.zeros(3 * 8 + 1, dtype=np.uint8)[1:].view(np.float64).reshape(1, 3)
    assert mine.intersects_any(misaligned, [[0, 0, -1]]).tolist() == [True]


def boxes_with_faces_twice():
    """Boxes some faces of which are there twice: with the same vertices, with turned corners, and with vertices of their
    own."""
    box = trimesh.creation.box()
    for count in (1, 2, 12):
        more = box.faces[:count]
        for faces in (more, np.roll(more, 1, axis=1)):
            yield trimesh.Trimesh(box.vertices, np.vstack([box.faces, faces]), process=False)
        vertices = np.vstack([box.vertices, box.vertices * 1.0])
        yield trimesh.Trimesh(vertices, np.vstack([more + 8, box.faces]), process=False)


def test_faces_that_a_mesh_has_twice_count_once():
    points = np.random.default_rng(8).uniform(-0.7, 0.7, (2000, 3))
    inside = (np.abs(points) < 0.5).all(axis=1)
    across = np.tile([0.3, 0.5, 1.0], (2000, 1))
    for mesh in boxes_with_faces_twice():
        mine = ours(mesh)
        assert np.array_equal(mine.contains_points(points), inside)
        places, rays, triangles = mine.intersects_location(points[inside], across[inside])
        assert np.array_equal(rays, np.arange(inside.sum()))
        assert (triangles == mine.intersects_first(points[inside], across[inside])).all()
        # The numbers are those of the mesh, and of equal faces the first.
        normals = mesh.face_normals[triangles]
        assert np.abs(((places - mesh.triangles[triangles, 0]) * normals).sum(axis=1)).max() < 1e-12
        first = np.abs(mesh.triangles_center[:, None] - mesh.triangles_center).max(axis=2).argmin(axis=1)
        assert np.array_equal(first[triangles], triangles)
        assert (mine.intersects_first([[5, 5, 5.0]], [[1, 0, 0]]) == -1).all()


def test_faces_in_one_place_with_opposite_windings_are_two():
    # Eight cubes that touch: each wall inside is there twice.
    cubes = [trimesh.creation.box(bounds=[corner, np.add(corner, 1)]) for corner in np.ndindex(2, 2, 2)]
    touching = trimesh.util.concatenate(cubes)
    points = np.random.default_rng(9).uniform(-0.5, 2.5, (2000, 3))
    inside = ((points > 0) & (points < 2)).all(axis=1)
    mine = ours(touching)
    assert np.array_equal(mine.contains_points(points), inside)
    assert len(mine.intersects_id([[-1, 0.3, 0.4]], [[1, 0, 0]])[0]) == 4
    box = trimesh.creation.box()
    both = trimesh.Trimesh(box.vertices, np.vstack([box.faces, box.faces[:, ::-1]]), process=False)
    assert ours(both).scene.primitives == 24
    negative = box.vertices.copy()
    negative[negative == -0.5] = -0.0
    positive = np.where(negative == 0, 0.0, negative)
    zeros = trimesh.Trimesh(np.vstack([negative, positive]), np.vstack([box.faces, box.faces + 8]), process=False)
    assert ours(zeros).scene.primitives == 12


def test_max_hits_are_the_first_and_save_the_others():
    height, most = 3000, 3
    square = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0.0]])
    vertices = np.concatenate([square + [0, 0, k] for k in range(height)])
    faces = np.concatenate([np.array([[0, 1, 2], [0, 2, 3]]) + 4 * k for k in range(height)])
    mine = ours(trimesh.Trimesh(vertices, faces, process=False))
    origins, directions = np.tile([0.1, 0.2, 2.0 * height], (200, 1)), np.tile([0, 0, -1.0], (200, 1))

    def seconds(**arguments):
        begin = time.process_time()
        found = mine.intersects_id(origins, directions, **arguments)
        return time.process_time() - begin, found

    mine.intersects_id(origins[:1], directions[:1])
    some, (triangles, rays) = seconds(max_hits=most)
    every, (all_triangles, _) = seconds()
    assert np.array_equal(rays, np.repeat(np.arange(200), most))
    assert np.array_equal(triangles.reshape(200, most), all_triangles.reshape(200, height)[:, :most])
    assert some < every / 10
    for multiple in (True, False):
        assert len(mine.intersects_id(origins, directions, multiple_hits=multiple, max_hits=0)[0]) == 0
    for most in (16, 17, 64, 65, 300):
        triangles, rays = mine.intersects_id(origins, directions, max_hits=most)
        assert np.array_equal(triangles.reshape(200, most), all_triangles.reshape(200, height)[:, :most])


def test_numbers_in_objects_and_booleans_are_numbers(ball):
    mine, theirs = ours(ball), embree.RayMeshIntersector(ball)
    origins, directions = np.array([[0, 0, 5]], dtype=object), np.array([[0, 0.0, -1]], dtype=object)
    assert mine.intersects_any(origins, directions).tolist() == theirs.intersects_any(origins, directions).tolist() == [True]
    assert mine.contains_points(np.zeros((1, 3), dtype=object)).tolist() == [True]
    assert mine.intersects_any([[False, False, True]], [[False, False, True]]).tolist() == [True]
    for bad in ("1", None, 1j, [0]):
        with pytest.raises(TypeError, match="ray_origins: the array has the type object"):
            mine.intersects_any(np.array([[0, 0, bad]], dtype=object), directions)


def test_mesh_is_taken_by_both_of_its_names(ball):
    for named in ({"mesh": ball}, {"geometry": ball}):
        assert gridel.trimesh.RayMeshIntersector(**named).contains_points([[0, 0, 0]]).tolist() == [True]
    for wrong in ({}, {"mesh": ball, "geometry": ball}):
        with pytest.raises(TypeError, match="one mesh, as geometry or as mesh"):
            gridel.trimesh.RayMeshIntersector(**wrong)


def test_copies_of_subclasses_keep_their_class_and_attributes(ball):
    class Named(gridel.trimesh.RayMeshIntersector):
        pass

    mine = Named(ball)
    mine.name = "ball"
    for other in (copy.copy(mine), copy.deepcopy(mine)):
        assert type(other) is Named and other.name == "ball"
        assert other.contains_points([[0, 0, 0]]).tolist() == [True]
