"""Errors name the argument, what it is, and what it must be."""

import errno
import os
import pickle

import numpy as np
import pytest
from test_scene import CUBE, FACES, cube  # noqa: F401

import gridel

RAY = [[0.3, 0.6, -2, 0, 0, 1]]


@pytest.fixture
def box():
    trimesh = pytest.importorskip("trimesh")
    return gridel.trimesh.RayMeshIntersector(trimesh.creation.box())


@pytest.mark.parametrize("shape", [(5, 0), (0, 7), (0, 5), (0, 0), (2, 0, 5)])
def test_empty_arrays_have_the_right_width(cube, box, shape):
    empty = np.zeros(shape)
    for query in (cube.cast, cube.any, cube.all, cube.count):
        with pytest.raises(ValueError, match="rays: the array has the shape .*; its last axis must be 6 or 8"):
            query(empty)
    with pytest.raises(ValueError, match="points: the array has the shape"):
        cube.contains(empty)
    with pytest.raises(ValueError, match="rays have the shape"):
        box.intersects_any(empty, empty)
    with pytest.raises(ValueError, match="points have the shape"):
        box.contains_points(empty)
    with pytest.raises(ValueError, match="rays: the array has the shape"):
        gridel.open3d.RaycastingScene().cast_rays(empty)


def test_empty_lists_are_no_rays(cube, box):
    assert cube.cast([]).t.shape == (0,) and cube.cast(np.zeros((0, 6))).t.shape == (0,)
    assert cube.any(np.zeros((0, 8))).shape == (0,) and cube.contains([]).shape == (0,)
    assert cube.cast(np.zeros((3, 0, 6))).normal.shape == (3, 0, 3)
    assert box.intersects_first([], []).shape == (0,) and box.contains_points([]).shape == (0,)
    assert gridel.open3d.RaycastingScene().cast_rays([])["t_hit"].shape == (0,)


def test_structures_to_build_are_names():
    assert gridel.Scene.from_arrays(CUBE, FACES, accel=None, lattice_bits=None).accels[0] == "wide"
    assert gridel.Scene.from_arrays(CUBE, FACES, accel=("bvh", "wide")).accels[:2] == ("wide", "bvh")
    for wrong in (1, 1.5, [1], b"wide", [None]):
        with pytest.raises(TypeError, match="accel is .*; it must be a name or a sequence of names"):
            gridel.Scene.from_arrays(CUBE, FACES, accel=wrong)
    scene = gridel.Scene.from_arrays(CUBE, FACES)
    for wrong in ([], ()):
        with pytest.raises(ValueError, match="accel is empty; name a structure"):
            gridel.Scene.from_arrays(CUBE, FACES, accel=wrong)
        with pytest.raises(ValueError, match="accel is empty"):
            scene.to_blob(accel=wrong)
    with pytest.raises(TypeError, match="accel is 1"):
        scene.to_blob(accel=1)


def test_options_of_files_are_named(tmp_path):
    path = tmp_path / "ball.toml"
    path.write_text("[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n")
    assert gridel.Scene.load(path, without=None, accel=None).objects == 1
    with pytest.raises(TypeError, match="without is 1; it must be a name or a sequence of names"):
        gridel.Scene.load(path, without=1)
    with pytest.raises(TypeError, match="accel is 1; it must be a name"):
        gridel.Scene.load(path, accel=1)
    with pytest.raises(ValueError, match="accel is empty"):
        gridel.Scene.load(path, accel=[])


@pytest.mark.parametrize("name", ["cast", "any", "all", "count", "contains", "render"])
def test_format_and_structure_of_queries_are_named(cube, name):
    query = getattr(cube, name)
    given = {"contains": ([[0.5] * 3],), "render": (4, 4)}.get(name, (RAY,))
    for wrong in (None, 1):
        with pytest.raises(TypeError, match=f"format is {wrong}; it must be a string"):
            query(*given, format=wrong)
    with pytest.raises(TypeError, match=r"accel is \['wide'\]; it must be a string"):
        query(*given, accel=["wide"])
    for error in (ValueError, KeyError, gridel.StructureError):
        with pytest.raises(error) as caught:
            query(*given, accel="octree")
        assert str(caught.value).startswith("accel: the scene does not hold the structure `octree`, but wide, ")


def test_errors_of_files_have_number_and_name(tmp_path):
    with pytest.raises(FileNotFoundError) as caught:
        gridel.Scene.load(tmp_path / "nothing.toml")
    assert caught.value.errno == errno.ENOENT and caught.value.filename == str(tmp_path / "nothing.toml")
    assert caught.value.strerror == "no such file"
    with pytest.raises(IsADirectoryError, match="name a scene file in it") as caught:
        gridel.Scene.load(tmp_path)
    assert caught.value.errno == errno.EISDIR and caught.value.filename == str(tmp_path)
    for empty in ("", b""):
        with pytest.raises(FileNotFoundError, match="the path is empty; give the path of a scene file") as caught:
            gridel.Scene.load(empty)
        assert caught.value.errno == errno.ENOENT and caught.value.filename == ""
    with pytest.raises(NotADirectoryError) as caught:
        (tmp_path / "file").write_text("")
        gridel.Scene.load(tmp_path / "file" / "scene.toml")
    assert caught.value.errno == errno.ENOTDIR
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "pipe")
        with pytest.raises(OSError, match="not a regular file; give its bytes to `from_blob`") as caught:
            gridel.Scene.load(tmp_path / "pipe")
        assert caught.value.filename == str(tmp_path / "pipe")


def test_scenes_are_not_made_of_numbers():
    for wrong in (3, None, "scene.toml"):
        with pytest.raises(TypeError, match="use Scene.load, from_arrays or from_blob"):
            gridel.Scene(wrong)


def test_intersectors_are_made_of_meshes(box):
    with pytest.raises(TypeError, match="geometry is a str; it must be a trimesh.Trimesh"):
        gridel.trimesh.RayMeshIntersector("abc")
    with pytest.raises(TypeError, match="mesh is a list; it must be a trimesh.Trimesh"):
        gridel.trimesh.RayMeshIntersector(mesh=[1])
    with pytest.raises(TypeError, match="threads is 'x'; it must be an integer"):
        gridel.trimesh.RayMeshIntersector(box.mesh, threads="x")
    with pytest.raises(ValueError, match="threads is 1025; it must be 0 to 1024"):
        gridel.trimesh.RayMeshIntersector(box.mesh, threads=1025)


class Named(gridel.Scene):
    """A scene with a name."""


def test_constructors_and_pickles_keep_subclasses(tmp_path):
    made = Named.from_arrays(CUBE, FACES)
    (tmp_path / "cube.gridel").write_bytes(made.to_blob())
    loaded, taken = Named.load(tmp_path / "cube.gridel"), Named.from_blob(memoryview(made.to_blob()))
    for number, scene in enumerate((made, loaded, taken)):
        scene.name = f"scene {number}"
        other = pickle.loads(pickle.dumps(scene))
        assert type(scene) is type(other) is Named and other.name == scene.name
        assert other.to_blob() == scene.to_blob()
    assert type(pickle.loads(pickle.dumps(gridel.Scene.from_arrays(CUBE, FACES)))) is gridel.Scene
    for name in ("load", "from_arrays", "from_blob"):
        assert getattr(gridel.Scene, name).__annotations__["return"] == "Self"


def test_star_import_keeps_the_modules_of_the_user():
    names = {}
    exec("import json as trimesh, csv as open3d\nfrom gridel import *", names)
    assert names["trimesh"].__name__ == "json" and names["open3d"].__name__ == "csv"
    assert names["Scene"] is gridel.Scene and names["StructureError"] is gridel.StructureError


def test_errors_name_the_argument(cube):
    with pytest.raises(ValueError, match="width is 0; it must be 1 to 65535"):
        cube.render(0, 5)
    with pytest.raises(ValueError, match="height is 70000"):
        cube.render(5, 70000)
    with pytest.raises(ValueError, match="samples is -1"):
        cube.render(5, 5, samples=-1)
    with pytest.raises(ValueError, match="depth is 300"):
        cube.render(5, 5, depth=300)
    with pytest.raises(ValueError, match="lattice_bits is -1; it must be 10 to 24"):
        gridel.Scene.from_arrays(CUBE, FACES, lattice_bits=-1)
    with pytest.raises(TypeError, match="vertices: the array has the type complex128"):
        gridel.Scene.from_arrays(CUBE.astype(complex), FACES)
    with pytest.raises(ValueError, match="18446744073709551615.*numbered 0 to 7"):
        gridel.Scene.from_arrays(CUBE, np.array([[0, 1, 2**64 - 1]], dtype=np.uint64))


def test_load_takes_bytes_and_names_directories(tmp_path):
    with pytest.raises(IsADirectoryError, match="a directory"):
        gridel.Scene.load(tmp_path)
    path = tmp_path / "cube.gridel"
    path.write_bytes(gridel.Scene.from_arrays(CUBE, FACES).to_blob())
    assert gridel.Scene.load(str(path).encode()).primitives == 12


def test_errors_of_blobs_name_the_file_and_the_remedy(tmp_path):
    path = tmp_path / "cube.gridel"
    whole = gridel.Scene.from_arrays(CUBE, FACES).to_blob()
    path.write_bytes(whole[:-16])
    with pytest.raises(ValueError, match="copy the file again") as caught:
        gridel.Scene.load(path)
    assert str(caught.value).startswith(f"{path}: invalid scene blob: ")
    with pytest.raises(ValueError, match="invalid scene blob: .*; copy the file again"):
        gridel.Scene.from_blob(whole[:-16])


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="every file can be read")
def test_errors_of_blobs_that_cannot_be_read_name_the_file(tmp_path):
    path = tmp_path / "cube.gridel"
    path.write_bytes(gridel.Scene.from_arrays(CUBE, FACES).to_blob())
    path.chmod(0)
    with pytest.raises(PermissionError) as caught:
        gridel.Scene.load(path)
    assert caught.value.errno == errno.EACCES and caught.value.filename == str(path)


def test_from_blob_takes_bytes_alone():
    for wrong in ("scene.gridel", 10**9):
        with pytest.raises(TypeError, match="bytes-like"):
            gridel.Scene.from_blob(wrong)
