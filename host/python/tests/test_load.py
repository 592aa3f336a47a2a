"""Options of Scene.load: what each changes, and the errors of those that are invalid or do not apply."""

import base64
import json
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest

import gridel

PAGE = Path(__file__).parents[2] / "docs" / "PYTHON.md"
BALL = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n"
#: A ball that moves along x, by 4 per second.
MOVING = (
    "[[part]]\nname = 'ball'\n[[part.object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n"
    "[[joint]]\nname = 'rail'\n[[instance]]\npart = 'ball'\njoint = 'rail'\n"
    "[[track]]\ntarget = 'joint.rail.shift'\ntimes = [0, 2]\nvalues = [[0, 0, 0], [8, 0, 0]]\n"
)
STILL = MOVING[: MOVING.index("[[joint]]")] + "[[instance]]\npart = 'ball'\n[[instance]]\npart = 'ball'\ntranslate = [9, 0, 0]\n"
#: A value of each option, valid in itself.
OPTIONS = {
    "accel": "bvh",
    "lattice_bits": 24,
    "quality": "fast",
    "without": "shadow",
    "texture_bytes": 4096,
    "camera": "top",
    "animation": 0,
    "time": 0.0,
    "instances": "flatten",
    "normals": "flat",
    "assembly": 1,
    "style": "space-filling",
    "model": 1,
    "altloc": "A",
    "allow_outside": True,
}


def write(folder, name, text):
    path = folder / name
    path.parent.mkdir(exist_ok=True)
    path.write_text(text)
    return path


def atom(number, x, chain="A", altloc=" "):
    return (
        f"HETATM{number:5}  C{number % 10} {altloc}LIG {chain}   1    {x:8.3f}{0:8.3f}{0:8.3f}{1:6.2f}{0:6.2f}           C\n"
    )


def mesh_of(gltf_nodes, **rest):
    """A glTF document with a triangle, whose buffer also has times 0 and 1 and two rows of positions."""
    floats = [0, 0, 0, 1, 0, 0, 0, 1, 0]
    floats += [0, 1] + [0, 0, 0, 4, 0, 0] + [0, 0, 0, 0, 6, 0]
    data = np.array(floats, "<f4").tobytes()
    views = [(0, 36), (36, 8), (44, 24), (68, 24)]
    accessors = [("VEC3", 3, [0, 0, 0], [1, 1, 0]), ("SCALAR", 2, [0], [1]), ("VEC3", 2, [0, 0, 0], [4, 0, 0])]
    accessors.append(("VEC3", 2, [0, 0, 0], [0, 6, 0]))
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    document = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": len(data), "uri": uri}],
        "bufferViews": [{"buffer": 0, "byteOffset": start, "byteLength": length} for start, length in views],
        "accessors": [
            {"bufferView": view, "componentType": 5126, "count": count, "type": kind, "min": low, "max": high}
            for view, (kind, count, low, high) in enumerate(accessors)
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": gltf_nodes,
        "scenes": [{"nodes": list(range(len(gltf_nodes)))}],
        "scene": 0,
    }
    return json.dumps({**document, **rest})


def animation(name, output):
    return {
        "name": name,
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
        "samplers": [{"input": 1, "output": output}],
    }


@pytest.fixture
def ball(tmp_path):
    return write(tmp_path, "ball.toml", BALL)


@pytest.fixture
def blob(ball):
    path = ball.with_suffix(".gridel")
    path.write_bytes(gridel.Scene.load(ball, accel="dual-split").to_blob())
    return path


def test_scene_files_have_the_structure_wide_and_24_bits(ball):
    scene = gridel.Scene.load(ball)
    assert scene.accels[0] == "wide"
    assert scene.to_blob() == gridel.Scene.load(ball, accel="wide", lattice_bits=24).to_blob()
    assert "octree" in gridel.Scene.load(ball, accel=["wide", "octree"]).accels


@pytest.mark.parametrize("option", OPTIONS)
def test_blob_rejects_each_option(blob, option):
    assert gridel.Scene.load(blob).accels[0] == "dual-split"
    with pytest.raises(ValueError) as caught:
        gridel.Scene.load(blob, **{option: OPTIONS[option]})
    sentence = str(caught.value)
    assert sentence.startswith(f"{blob}: `{option}` is for scene files: a blob ")
    assert sentence.endswith(
        f"; leave `{option}` out, or load the scene file that the blob was built from"
    )
    why = {"accel": "holds its structures already", "lattice_bits": "holds its coordinates already"}
    assert why.get(option, "is compiled already") in sentence


def test_blob_accepts_defaults(blob):
    scene = gridel.Scene.load(blob, accel=None, lattice_bits=None, allow_outside=False)
    with pytest.raises(KeyError, match="does not hold the structure `wide`"):
        scene.cast([[0, 0, -5, 0, 0, 1.0]], accel="wide")


@pytest.mark.parametrize("bits", [10, 15, 16, 24])
def test_lattice_bits_are_10_to_24(tmp_path, bits):
    rng = np.random.default_rng(5)
    corners = rng.uniform(-1, 1, (40, 3))
    faces = np.arange(39).reshape(13, 3)
    scene = gridel.Scene.from_arrays(corners, faces, lattice_bits=bits)
    step = 4 * 2.0**-bits
    assert 0.05 * step < scene.displacement < 2 * step
    target = corners[faces].mean(axis=1)
    origins = np.broadcast_to([0.1, 0.2, 5.0], target.shape)
    hits = scene.cast(np.hstack([origins, target - origins]))
    weights = np.column_stack([1 - hits.uv.sum(axis=1), hits.uv])
    met = (weights[:, :, None] * corners[faces[hits.primitive]]).sum(axis=1)
    places = origins + hits.t[:, None] * (target - origins)
    assert np.allclose(places, met, atol=4 * step)
    whole = gridel.Scene.from_arrays(corners, faces)
    assert whole.to_blob(lattice_bits=bits) == scene.to_blob()
    rows = ["v %r %r %r" % tuple(corner) for corner in corners.tolist()]
    rows += ["f %d %d %d" % tuple(face) for face in (faces + 1).tolist()]
    loaded = gridel.Scene.load(write(tmp_path, "leaves.obj", "\n".join(rows)), lattice_bits=bits)
    assert loaded.displacement == scene.displacement


@pytest.mark.parametrize("bits", [9, 25])
def test_other_lattice_bits_are_rejected(ball, bits):
    scene = gridel.Scene.load(ball)
    triangle = (np.eye(3), [[0, 1, 2]])
    for call in (
        lambda: gridel.Scene.load(ball, lattice_bits=bits),
        lambda: gridel.Scene.from_arrays(*triangle, lattice_bits=bits),
        lambda: scene.to_blob(lattice_bits=bits),
    ):
        with pytest.raises(ValueError, match=f"lattice_bits is {bits}; it must be 10 to 24"):
            call()


def test_instances_are_kept_or_flattened(tmp_path):
    path = write(tmp_path, "still.toml", STILL)
    kept = gridel.Scene.load(path)
    flat = gridel.Scene.load(path, instances="flatten")
    assert (kept.instances, flat.instances, flat.objects) == (2, 0, 2)
    assert gridel.Scene.load(path, instances="keep").instances == 2
    ray = [[9, 0, -5, 0, 0, 1.0]]
    assert kept.cast(ray).instance.tolist() == [1]
    # An object of no instance has MISS as its instance, and is hit.
    hits = flat.cast(ray)
    assert hits.instance.tolist() == [gridel.MISS] and hits.object.tolist() == [1]


def test_time_places_copies_of_instances(tmp_path):
    path = write(tmp_path, "moving.toml", MOVING)
    with pytest.warns(UserWarning, match="copied where they are at rest"):
        rest = gridel.Scene.load(path, instances="flatten")
    assert rest.bounds[:, 0] == pytest.approx([-1, 1], abs=1e-5)
    for time in (1, 1.0, np.float32(1)):
        moved = gridel.Scene.load(path, instances="flatten", time=time)
        assert moved.bounds[:, 0] == pytest.approx([3, 5], abs=1e-5)


def test_time_warns_of_what_stays_at_rest(tmp_path):
    track = "[[track]]\ntarget = 'camera.orbit'\ntimes = [0, 4]\nvalues = [0, 360]\n"
    path = write(tmp_path, "moving.toml", MOVING + track)
    with pytest.warns(UserWarning, match="moving.toml: `time` places copies of instances alone; camera"):
        gridel.Scene.load(path, instances="flatten", time=1)


def test_time_without_copies_or_motion_is_rejected(tmp_path):
    path = write(tmp_path, "moving.toml", MOVING)
    for instances in (None, "keep"):
        with pytest.raises(ValueError, match="`time` says where copies of instances stand; add `instances="):
            gridel.Scene.load(path, time=1, instances=instances)
        # What the error says to do works.
        assert gridel.Scene.load(path, instances=instances).primitives == 1
    assert gridel.Scene.load(path, time=1, instances="flatten").primitives == 1
    path = write(tmp_path, "still.toml", STILL)
    for instances in (None, "keep", "flatten"):
        with pytest.raises(ValueError, match="still.toml: no instance moves, so `time` has no effect; leave `time` out"):
            gridel.Scene.load(path, time=1, instances=instances)
        gridel.Scene.load(path, instances=instances)
    with pytest.raises(ValueError, match="time is nan; it must be finite"):
        gridel.Scene.load(path, time=float("nan"), instances="flatten")


@pytest.mark.filterwarnings("ignore:.*several")
def test_animation_is_chosen_by_name_or_number(tmp_path):
    document = mesh_of([{"mesh": 0}], animations=[animation("slide", 2), animation("rise", 3)])
    path = write(tmp_path, "moving.gltf", document)
    for chosen, low in [(None, [4, 0]), ("slide", [4, 0]), (0, [4, 0]), ("rise", [0, 6]), ("1", [0, 6]), (1, [0, 6])]:
        scene = gridel.Scene.load(path, animation=chosen, instances="flatten", time=1.0)
        assert scene.bounds[0, :2] == pytest.approx(low, abs=1e-5), chosen
    with pytest.raises(ValueError, match="moving.gltf.*slide, rise"):
        gridel.Scene.load(path, animation="spin")


@pytest.mark.filterwarnings("ignore:.*several")
def test_camera_is_chosen_by_name(tmp_path):
    cameras = [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}]
    nodes = [{"mesh": 0}]
    nodes += [{"name": name, "camera": 0, "translation": [0.3, 0.3, z]} for name, z in (("near", 2), ("far", 20))]
    path = write(tmp_path, "cameras.gltf", mesh_of(nodes, cameras=cameras))

    def seen(camera):
        picture = gridel.Scene.load(path, camera=camera).render(32, 32, samples=1)
        return (picture != picture[0, 0]).any(axis=2).sum()

    assert seen(None) == seen("near") > 10 * max(seen("far"), 1)
    with pytest.raises(ValueError, match="cameras.gltf.*side.*near, far"):
        gridel.Scene.load(path, camera="side")


def test_normals_shade_pictures(tmp_path):
    roof = (
        "[[light]]\nkind = 'point'\nposition = [3, 2, 9]\ncolor = [1, 1, 1]\n"
        "[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\n[[object]]\nkind = 'mesh'\nsmooth = 90\n"
        "vertices = [[-1, -1, 0], [0, -1, 0.4], [1, -1, 0], [-1, 1, 0], [0, 1, 0.4], [1, 1, 0]]\n"
        "faces = [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]]\n"
    )
    path = write(tmp_path, "roof.toml", roof)

    def shaded(normals):
        scene = gridel.Scene.load(path, normals=normals)
        return scene.render(48, 48, samples=1), scene.cast([[0.5, 0.1, 5, 0, 0, -1.0]]).normal

    (usual, hit), (flat, same), (file, _) = shaded(None), shaded("flat"), shaded("file")
    assert np.array_equal(usual, file) and not np.array_equal(usual, flat)
    assert np.array_equal(shaded("smooth=90")[0], usual) and np.array_equal(shaded("smooth=10")[0], flat)
    # The normals of hits are geometric.
    assert np.array_equal(hit, same)
    for wrong in ("round", "smooth", "smooth=200", "smooth=nan"):
        with pytest.raises(ValueError, match=f"unknown normals `{wrong}`; write file, flat, or smooth= and an angle"):
            shaded(wrong)


def test_assembly_is_chosen_by_number_or_name(tmp_path):
    rows = [("1.000000  0.000000", 0), ("1.000000  0.000000", 50)]
    remarks = "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n"
    for number, (_, shift) in enumerate(rows, 1):
        for axis in range(3):
            row = "".join(f"{float(axis == column):10.6f}" for column in range(3))
            moved = shift if axis == 0 else 0
            remarks += f"REMARK 350   BIOMT{axis + 1} {number:3}{row}     {moved:10.5f}\n"
    path = write(tmp_path, "pair.pdb", remarks + atom(1, 0.0))
    assert gridel.Scene.load(path).bounds[1, 0] < 10
    for name in ("1", 1):
        scene = gridel.Scene.load(path, assembly=name)
        assert scene.bounds[1, 0] > 50 and scene.instances == 2
    with pytest.raises(ValueError, match="pair.pdb.*7.*1"):
        gridel.Scene.load(path, assembly=7)


@pytest.mark.filterwarnings("ignore:.*2 models")
def test_molecule_options_choose_style_model_and_location(tmp_path):
    path = write(tmp_path, "two.xyz", "2\n\nC 0 0 0\nC 1.5 0 0\n")
    assert gridel.Scene.load(path).objects == gridel.Scene.load(path, style="space-filling").objects == 2
    assert gridel.Scene.load(path, style="ball-and-stick").objects > 2
    models = "".join(f"MODEL     {number:4}\n{atom(1, 30.0 * number)}ENDMDL\n" for number in (1, 2))
    path = write(tmp_path, "models.pdb", models)
    middles = [gridel.Scene.load(path, model=model).bounds[:, 0].mean() for model in (None, 1, 2)]
    assert middles == pytest.approx([30, 30, 60], abs=1e-3)
    with pytest.raises(ValueError, match="models.pdb.*3"):
        gridel.Scene.load(path, model=3)
    path = write(tmp_path, "places.pdb", atom(1, 0.0, altloc="A") + atom(1, 40.0, altloc="B"))
    middles = [gridel.Scene.load(path, altloc=altloc).bounds[:, 0].mean() for altloc in (None, "A", "B")]
    assert middles == pytest.approx([0, 0, 40], abs=1e-3)


def test_files_outside_of_the_folder_need_permission(tmp_path):
    write(tmp_path, "leaf.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    path = write(tmp_path, "scenes/tree.toml", "[[object]]\nkind = 'import'\nfile = '../leaf.obj'\n")
    with pytest.raises(ValueError, match="outside"):
        gridel.Scene.load(path)
    assert gridel.Scene.load(path, allow_outside=True).primitives == 1


@pytest.mark.parametrize(
    "option, kind",
    [
        ("camera", "glTF files"),
        ("animation", "glTF files"),
        ("assembly", "PDB and mmCIF files"),
        ("style", "molecules"),
        ("model", "molecules"),
        ("altloc", "molecules"),
    ],
)
def test_options_that_do_not_apply_to_the_file_are_rejected(ball, option, kind):
    with pytest.raises(ValueError) as caught:
        gridel.Scene.load(ball, **{option: OPTIONS[option]})
    sentence = str(caught.value)
    assert sentence.startswith(f"{ball}: `{option}` is for {kind}")
    assert sentence.endswith(f", and the file is none of these; leave `{option}` out")


@pytest.mark.parametrize("option", OPTIONS)
def test_page_says_which_options_are_checked(tmp_path, option):
    checked = {"camera", "animation", "assembly", "style", "model", "altloc", "time", "quality"}
    given = {"accel": "bvh", option: OPTIONS[option]}
    path = write(tmp_path, "ball.toml", BALL + "[[light]]\nkind = 'point'\nposition = [0, 9, 0]\n")
    if option in checked:
        with pytest.raises(ValueError, match=f"`{option}`"):
            gridel.Scene.load(path, **given)
    elif option == "without":
        with pytest.warns(UserWarning, match="without shadow"):
            gridel.Scene.load(path, **given)
    else:
        assert gridel.Scene.load(path, **given).primitives == 1
    page = PAGE.read_text(encoding="utf-8").partition("they do not apply:\n")[2]
    says, _, others = page.partition("\nEvery scene file takes the other options")
    assert (f"`{option}`" in says) == (option in checked or option == "instances")
    assert f"| `{option}` |" in others


@pytest.mark.parametrize(
    "option, value, error, words",
    [
        ("instances", "copy", ValueError, "unknown instances `copy`; use keep or flatten"),
        ("style", "cartoon", ValueError, "unknown style `cartoon`; use space-filling or ball-and-stick"),
        ("model", 0, ValueError, "model is 0; it must be 1 to"),
        ("quality", "great", ValueError, "unknown quality `great`; use fast or good or best"),
        ("without", "noise", ValueError, "unknown effect `noise`; the effects are .*shadow, "),
        ("texture_bytes", -1, ValueError, "texture_bytes is -1; it must be 0 to"),
        ("altloc", "AB", ValueError, "altloc is 'AB'; it must be one character"),
        ("altloc", "", ValueError, "altloc is ''; it must be one character"),
        ("animation", -1, ValueError, "animation is -1; it must be 0 to"),
        ("accel", "octopus", ValueError, "unknown structure `octopus`; the structures are list, "),
        ("camera", 3, TypeError, "camera is 3; it must be a string"),
        ("assembly", 1.5, TypeError, "assembly is 1.5; it must be a string or an integer"),
        ("time", "1", TypeError, "time is '1'; it must be a number of seconds"),
        ("allow_outside", "no", TypeError, "allow_outside is 'no'; it must be True or False"),
        ("model", "1", TypeError, "model is '1'; it must be an integer"),
    ],
)
def test_invalid_values_are_rejected(ball, option, value, error, words):
    with pytest.raises(error, match=words):
        gridel.Scene.load(ball, **{option: value})


def test_quality_is_for_the_structure_wide(ball):
    with pytest.raises(ValueError, match="`quality` is for the structure wide, which is not built"):
        gridel.Scene.load(ball, accel="bvh", quality="best")
    rays = np.random.default_rng(8).normal(size=(200, 6))
    hits = [gridel.Scene.load(ball, quality=quality).cast(rays) for quality in ("fast", "good", "best")]
    for other in hits[1:]:
        np.testing.assert_array_equal(other.t, hits[0].t)


def test_effects_are_left_out_with_a_warning(tmp_path):
    lamp = "[camera]\neye = [0, 3, 9]\ntarget = [0, 0, 0]\n[[light]]\nkind = 'point'\nposition = [0, 9, 0]\n"
    floor = "[[object]]\nkind = 'box'\nmin = [-9, -3, -9]\nmax = [9, -2, 9]\n"
    path = write(tmp_path, "lit.toml", lamp + BALL + floor)
    size = {"width": 40, "height": 30}
    with pytest.warns(UserWarning, match="lit.toml: without shadow: lights shine through all objects"):
        bright = gridel.Scene.load(path, without="shadow").render(**size)
    assert (bright > gridel.Scene.load(path).render(**size)).any()
    with pytest.warns(UserWarning, match="lit.toml: the scene does not call for glass"):
        gridel.Scene.load(path, without=["glass"])


def png(side):
    """A PNG file of random colors."""

    def chunk(kind, data):
        checked = kind + data
        return struct.pack(">I", len(data)) + checked + struct.pack(">I", zlib.crc32(checked))

    pixels = np.random.default_rng(2).integers(0, 256, (side, side * 3), dtype=np.uint8)
    rows = np.hstack([np.zeros((side, 1), np.uint8), pixels])
    head = struct.pack(">IIBBBBB", side, side, 8, 2, 0, 0, 0)
    chunks = [(b"IHDR", head), (b"IDAT", zlib.compress(rows.tobytes())), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunk(*each) for each in chunks)


def test_textures_fit_into_their_bytes(tmp_path):
    (tmp_path / "noise.png").write_bytes(png(64))
    path = write(
        tmp_path,
        "noise.toml",
        "[material.noise]\ntexture = 'noise.png'\n[[object]]\nkind = 'triangle'\nmaterial = 'noise'\n"
        "vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\ncoordinates = [[0, 0], [1, 0], [0, 1]]\n",
    )
    whole, small = (gridel.Scene.load(path, texture_bytes=most) for most in (None, 4096))
    # A scene that is compiled again keeps to the limit, too.
    for again in ({}, {"lattice_bits": 20}, {"accel": ["bvh"]}):
        sizes = [len(scene.to_blob(**again)) for scene in (whole, small)]
        assert sizes[0] - sizes[1] >= 3 * 64 * 64 - 4096
        assert sizes[1] > 1024


def test_errors_of_the_compiler_name_the_file(tmp_path):
    far = BALL.replace("[0, 0, 0]", "[1e12, 0, 0]")
    path = write(tmp_path, "far.toml", far)
    with pytest.raises(ValueError, match="far.toml: .*nearer to the origin, or use fewer `lattice_bits`"):
        gridel.Scene.load(path)


def test_sentences_name_options_as_python_does(tmp_path):
    models = "".join(f"MODEL     {number:4}\n{atom(1, 30.0 * number)}ENDMDL\n" for number in (1, 2))
    path = write(tmp_path, "models.pdb", models)
    with pytest.warns(UserWarning, match="`model=N` chooses another"):
        gridel.Scene.load(path)
    write(tmp_path, "leaf.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    path = write(tmp_path, "scenes/tree.toml", "[[object]]\nkind = 'import'\nfile = '../leaf.obj'\n")
    with pytest.raises(ValueError, match="`allow_outside`"):
        gridel.Scene.load(path)
