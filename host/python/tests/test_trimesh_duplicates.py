"""Points in closed meshes that have faces more than once: shared by bodies, or written twice."""

import time

import numpy as np
import pytest

import gridel.trimesh

trimesh = pytest.importorskip("trimesh")

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, 1], [0.2, 0.2, 0.3], [0.3, 0.1, 0.6]])


def tetrahedron(top):
    return [[0, 2, 1], [0, 1, top], [1, 2, top], [2, 0, top]]


def mesh_of(vertices, faces):
    return trimesh.Trimesh(vertices, faces, process=False, validate=False)


def inside(vertices, faces, points):
    return gridel.trimesh.RayMeshIntersector(mesh_of(vertices, faces)).contains_points(points)


def crossed_oddly(triangles, points):
    """Returns for each point true if a ray in float64 from it crosses an odd number of triangles, by brute force."""
    direction = np.array([0.3571, -0.7133, 0.6029])
    base, one, two = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    normal = np.cross(direction, two)
    scale = 1 / (one * normal).sum(1)
    from_base = points[:, None] - base
    u = (from_base * normal).sum(2) * scale
    turned = np.cross(from_base, one)
    v, t = turned @ direction * scale, (turned * two).sum(2) * scale
    return ((u > 0) & (v > 0) & (u + v < 1) & (t > 0)).sum(1) % 2 == 1


@pytest.mark.parametrize("tops", [(3, 4), (3, 4, 5), (4, 3)])
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_bodies_on_one_face_contain_an_odd_number_of_them(tops, sign, axis):
    vertices = np.roll(CORNERS, axis, axis=1) * sign
    bodies = [np.array(tetrahedron(top))[:, ::sign] for top in tops]
    points = np.random.default_rng(axis).uniform(-0.2, 1.1, (5000, 3)) * sign
    each = [crossed_oddly(vertices[faces], points) for faces in bodies]
    assert min(part.sum() for part in each) > 20
    expected = np.bitwise_xor.reduce(each)
    assert np.array_equal(inside(vertices, np.vstack(bodies), points), expected)
    # Each body with vertices of its own.
    apart = np.vstack([faces + len(vertices) * k for k, faces in enumerate(bodies)])
    assert np.array_equal(inside(np.tile(vertices, (len(bodies), 1)), apart, points), expected)


@pytest.mark.parametrize("copied", [1, 2, 3, 5, 6, 7])
def test_faces_written_twice_beside_a_shared_face_count_once(copied):
    faces = np.array(tetrahedron(3) + tetrahedron(4))
    points = np.random.default_rng(copied).uniform(-0.2, 1.1, (5000, 3))
    expected = crossed_oddly(CORNERS[faces[:4]], points) ^ crossed_oddly(CORNERS[faces[4:]], points)
    assert np.array_equal(inside(CORNERS, np.vstack([faces, np.roll(faces[copied : copied + 1], 1, axis=1)]), points), expected)


def test_cylinders_on_one_circle_contain_their_own_points():
    low, high = (trimesh.creation.cylinder(1, height, sections=32) for height in (2, 5))
    for cylinder, height in ((low, 2), (high, 5)):
        cylinder.apply_translation([0, 0, height / 2])
    far = trimesh.creation.box((1, 1, 1)).apply_translation([9, 9, 9])
    points = np.random.default_rng(1).uniform([-1.5, -1.5, -1], [1.5, 1.5, 6], (5000, 3))
    expected = low.contains(points) ^ high.contains(points)
    for parts in ([low, high], [high, low, far], [far, low, high, far]):
        both = trimesh.util.concatenate(parts)
        ray = gridel.trimesh.RayMeshIntersector(both)
        assert np.array_equal(ray.contains_points(points), expected)
        # The plate apart, of which a copy is there or not, is as it was.
        assert ray.contains_points([[9, 9, 9]])[0] == (far in parts)
        both.apply_translation([5, 0, 0])
        assert np.array_equal(ray.contains_points(points + [5, 0, 0]), expected)
        assert not np.array_equal(ray.contains_points(points), expected)


def test_sheets_and_open_boxes_that_are_there_twice_contain_nothing():
    box = trimesh.creation.box()
    points = np.random.default_rng(2).uniform(-1, 1, (2000, 3))
    for faces in (box.faces[:1], box.faces[:4], box.faces[:10]):
        assert not inside(box.vertices, np.vstack([faces, faces]), points).any()
    expected = (np.abs(points) < 0.5).all(axis=1)
    # Three copies are as one; so are two of faces without area.
    flat = [[0, 0, 1]] * 2 + [[2, 2, 2]] * 2
    assert np.array_equal(inside(box.vertices, np.vstack([box.faces] * 3 + [flat]), points), expected)


#: Corners of the six sides of a cell, counter-clockwise from outside.
SIDES = [
    (axis, side, [np.roll([side, *corner], axis) for corner in [(0, 0), (1, 0), (1, 1), (0, 1)][:: 1 if side else -1]])
    for axis in range(3)
    for side in (0, 1)
]


def soup(cells):
    """The boundary of some cells of a grid, as triangles of grid points."""
    triangles = []
    for cell in np.argwhere(cells):
        for axis, side, corners in SIDES:
            beyond = cell + np.eye(3, dtype=int)[axis] * (2 * side - 1)
            if not cells[tuple(beyond)]:
                quad = cell + np.array(corners)
                start = int(quad.sum(axis=1).argmin())
                a, b, c, d = np.roll(quad, -start, axis=0)
                triangles += [[a, b, c], [a, c, d]]
    return np.array(triangles)


def check_bodies_of_cells(rng, size=4, bodies=2, share=0.3):
    """Bodies of cells that share faces, and faces written twice, against parity over every side of every cell."""
    each = []
    for _ in range(bodies):
        cells = np.zeros((size + 2,) * 3, dtype=bool)
        cells[1:-1, 1:-1, 1:-1] = rng.random((size,) * 3) < share
        each.append(cells)
    triangles = np.concatenate([soup(cells) for cells in each if cells.any()] or [np.zeros((0, 3, 3), dtype=int)])
    if not len(triangles):
        return None
    # Faces that bodies share are written as often as there are bodies.
    _, kind, copies = np.unique(triangles.reshape(-1, 9), axis=0, return_inverse=True, return_counts=True)
    twice = (copies[kind.reshape(-1)] == 1) & (rng.random(len(triangles)) < rng.choice([0, 0.05, 0.5]))
    triangles = np.concatenate([triangles, np.roll(triangles[twice], 1, axis=1)])
    triangles = triangles[rng.permutation(len(triangles))]
    steps = np.indices((size + 2,) * 3).reshape(3, -1).T
    found = inside(triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3), steps + [0.47, 0.52, 0.49])
    found = found.reshape((size + 2,) * 3)
    # A triangle by its sorted corners, and each of its windings.
    number = {}
    for triangle in triangles:
        corners = [tuple(corner) for corner in triangle.tolist()]
        start = corners.index(min(corners))
        turned = tuple(corners[start:] + corners[:start])
        number.setdefault(tuple(sorted(corners)), {}).setdefault(turned, 0)
        number[tuple(sorted(corners))][turned] += 1
    for axis in range(3):
        changes = np.diff(found.astype(int), axis=axis) != 0
        for cell in np.ndindex(changes.shape):
            low = cell + np.eye(3, dtype=int)[axis]
            corners = [tuple((low + np.roll([0, *c], axis)).tolist()) for c in [(0, 0), (1, 0), (1, 1), (0, 1)]]
            halves = [number.get(tuple(sorted(corners[k] for k in half)), {}) for half in ((0, 1, 2), (0, 2, 3))]
            for half in halves:
                # Two copies may count or not, others by their number.
                if not any(copies % 2 == 0 for copies in half.values()):
                    assert changes[cell] == len(half) % 2
    return np.array_equal(found, np.bitwise_xor.reduce(each))


def test_bodies_of_cells_with_shared_and_doubled_faces_are_closed():
    rng = np.random.default_rng(3)
    found = [check_bodies_of_cells(rng, int(rng.integers(2, 5)), int(rng.integers(1, 4))) for _ in range(60)]
    # Where bodies share no closed surface, these are the points in an odd number of them.
    assert sum(it is True for it in found) > 20


def test_time_of_a_mesh_that_is_there_twice_grows_with_its_faces():
    ball = trimesh.creation.icosphere(subdivisions=5)
    faces = np.vstack([ball.faces, ball.faces[:-1]])
    begin = time.process_time()
    assert inside(ball.vertices, faces, [[0, 0, 0], [2, 0, 0]]).tolist() == [True, False]
    open_twice = np.vstack([ball.faces[:-1]] * 2)
    assert not inside(ball.vertices, open_twice, [[0, 0, 0], [2, 0, 0]]).any()
    assert time.process_time() - begin < 20
