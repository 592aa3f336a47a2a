"""The examples of the package's README and of the page on Python run as they are printed."""

import json
import struct
from pathlib import Path

import numpy as np
import pytest
from test_load import mesh_of
from test_scene import CUBE, FACES

import gridel

HOST = Path(__file__).parents[2]
PAGES = [HOST / "python" / "README.md", HOST / "docs" / "PYTHON.md"]


def examples(page):
    blocks = page.read_text(encoding="utf-8").split("```python\n")[1:]
    return [block.split("```")[0] for block in blocks]


@pytest.fixture
def trimesh(monkeypatch):
    trimesh = pytest.importorskip("trimesh")
    embree = pytest.importorskip("trimesh.ray.ray_pyembree", reason="embreex is not installed")
    # An example replaces it.
    monkeypatch.setattr(embree, "RayMeshIntersector", embree.RayMeshIntersector)
    return trimesh


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_examples_run_as_printed(page, trimesh, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    document = json.dumps(json.loads(mesh_of([{"mesh": 0}]))).encode()
    document += b" " * (-len(document) % 4)
    header = struct.pack("<4sIIII", b"glTF", 2, 20 + len(document), len(document), 0x4E4F534A)
    Path("robot.glb").write_bytes(header + document)
    Path("scene.gridel").write_bytes(gridel.Scene.from_arrays(CUBE, FACES).to_blob())
    origins, directions = np.array([[0.3, 0.6, -2.0]]), np.array([[0, 0, 1.0]])
    names = {"vertices": CUBE, "faces": FACES, "origins": origins, "directions": directions, "points": [[0.5] * 3]}
    names.update(trimesh=trimesh, mesh=trimesh.creation.box(), rays=np.hstack([origins, directions]))
    blocks = examples(page)
    assert blocks
    for block in blocks:
        exec(compile(block, page.name, "exec"), names)
    assert names["hits"].t.tolist() == [2] and names["inside"].tolist() == [True]
    assert type(names["mesh"].ray) is gridel.trimesh.RayMeshIntersector


def test_line_of_the_page_sets_the_class_of_copies(trimesh):
    (line,) = (block for block in examples(PAGES[1]) if block.startswith("trimesh.ray"))
    exec(line, {"trimesh": trimesh, "gridel": gridel})
    mesh = trimesh.creation.box()
    for other in (mesh, mesh.copy(), mesh.submesh([[0, 1, 2]])[0]):
        assert type(other.ray) is gridel.trimesh.RayMeshIntersector
        assert len(other.ray.intersects_first([[0, 0, 5]], [[0, 0, -1]])) == 1


def test_readme_links_the_page_that_pip_does_not_install():
    readme = PAGES[0].read_text(encoding="utf-8")
    assert "https://github.com/gridel/gridel/blob/main/host/docs/PYTHON.md" in readme and "pip does not install" in readme


def test_signatures_are_stated_to_be_those_of_embree():
    assert "signatures are those of ``ray_pyembree``" in gridel.trimesh.__doc__
    assert "`ray_pyembree`" in PAGES[1].read_text(encoding="utf-8")


def test_arity_of_intersects_id_is_known_to_type_checkers():
    typing = pytest.importorskip("typing")
    if not hasattr(typing, "get_overloads"):
        pytest.skip("Python 3.10 keeps no overloads")
    overloads = typing.get_overloads(gridel.trimesh.RayMeshIntersector.intersects_id)
    arity = {it.__annotations__["return_locations"]: it.__annotations__["return"].count("NDArray") for it in overloads}
    assert arity["Literal[False]"] == 2 and arity["Literal[True]"] == 3
