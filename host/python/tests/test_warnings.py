"""Warnings name the line of the user, and come once for each such line."""

import warnings

import numpy as np
import pytest
from test_scene import CUBE, FACES

import gridel

trimesh = pytest.importorskip("trimesh")

#: Two of its cubes are too small for the lattice.
VERTICES = np.vstack([CUBE, 5000 * CUBE + [10, 0, 0], 1e-5 * CUBE + [5, 0, 0]])
TRIANGLES = np.vstack([FACES, FACES + 8, FACES + 16])


def load(tmp_path):
    gridel.Scene.load(tmp_path / "lines.obj")


def from_arrays(_):
    gridel.Scene.from_arrays(VERTICES, TRIANGLES)


def in_place_of_trimesh(_):
    mesh = trimesh.Trimesh(VERTICES, TRIANGLES, process=False)
    gridel.trimesh.RayMeshIntersector(mesh).intersects_any([[0, 0, 9]], [[0, 0, -1]])


def by_trimesh(_):
    mesh = trimesh.Trimesh(VERTICES, TRIANGLES, process=False)
    mesh.ray = gridel.trimesh.RayMeshIntersector(mesh)
    mesh.contains([[0.5, 0.5, 0.5]])


def in_place_of_open3d(_):
    scene = gridel.open3d.RaycastingScene()
    scene.add_triangles(VERTICES, TRIANGLES)
    scene.cast_rays([[0, 0, 9, 0, 0, -1]])


def broken_of_open3d(_):
    gridel.open3d.RaycastingScene().add_triangles([[0, 0, 0], [1, 0, 0], [np.nan, 1, 0]], [[0, 1, 2]])


@pytest.mark.parametrize(
    "work", [load, from_arrays, in_place_of_trimesh, by_trimesh, in_place_of_open3d, broken_of_open3d]
)
def test_warnings_name_the_line_of_the_user(work, tmp_path):
    (tmp_path / "lines.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\n")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("default")
        for _ in range(2):
            work(tmp_path)
    (warning,) = (it for it in caught if it.category is UserWarning)
    assert warning.filename == __file__


def test_each_line_of_the_user_is_warned_once():
    scenes = [gridel.open3d.RaycastingScene() for _ in range(4)]
    for scene in scenes:
        scene.add_triangles(VERTICES, TRIANGLES)
    ray = [[0, 0, 9, 0, 0, -1]]
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("default")
        for scene in scenes[:2]:
            scene.cast_rays(ray)
        scenes[2].count_intersections(ray)
        scenes[3].test_occlusions(ray)
    assert len(caught) == 3 and {warning.filename for warning in caught} == {__file__}
