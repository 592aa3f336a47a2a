"""Copies and pickles of subclasses keep what the subclasses add, also in ``__slots__``."""

import copy
import pickle

import numpy as np
import pytest
from test_scene import CUBE, FACES

import gridel

OUTSIDE, INSIDE = [9.0, 9.0, 9.0], [0.5, 0.5, 0.5]


class WithDict(gridel.Scene):
    pass


class WithSlots(gridel.Scene):
    __slots__ = ("tag", "unset")


class WithPrivateSlots(WithSlots):
    __slots__ = "__hidden"

    @property
    def hidden(self):
        return self.__hidden

    @hidden.setter
    def hidden(self, value):
        self.__hidden = value


class WithBoth(WithPrivateSlots):
    __slots__ = ("__dict__", "more")


class Mixin:
    __slots__ = ()


class Mixed(Mixin, WithSlots):
    pass


class Intersector(gridel.trimesh.RayMeshIntersector):
    __slots__ = ("tag",)


class Casting(gridel.open3d.RaycastingScene):
    __slots__ = ("tag",)


KINDS = {
    WithDict: ["tag", "more"],
    WithSlots: ["tag"],
    WithPrivateSlots: ["tag", "hidden"],
    WithBoth: ["tag", "hidden", "more", "other"],
    Mixed: ["tag", "other"],
}


def copies(value):
    pickled = [pickle.loads(pickle.dumps(value, protocol)) for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1)]
    return [copy.copy(value), copy.deepcopy(value), *pickled]


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
@pytest.mark.parametrize("is_blob", [False, True], ids=["arrays", "blob"])
def test_scenes_keep_attributes_in_slots(kind, is_blob):
    scene = kind.from_arrays(CUBE, FACES)
    if is_blob:
        scene = kind.from_blob(scene.to_blob())
    for name in KINDS[kind]:
        setattr(scene, name, [name])
    for other in copies(scene):
        assert type(other) is kind and [getattr(other, name) for name in KINDS[kind]] == [[name] for name in KINDS[kind]]
        assert not hasattr(other, "unset")
        assert other.contains([INSIDE, OUTSIDE]).tolist() == [True, False]


def test_scenes_without_attributes_have_no_state():
    assert gridel.Scene.from_arrays(CUBE, FACES).__reduce__()[2] is None
    assert WithBoth.from_arrays(CUBE, FACES).__reduce__()[2] is None


def test_intersectors_keep_attributes_in_slots():
    trimesh = pytest.importorskip("trimesh")
    mine = Intersector(trimesh.Trimesh(CUBE, FACES, process=False))
    mine.tag, mine.other = "slot", "dict"
    for other in copies(mine):
        assert type(other) is Intersector and (other.tag, other.other) == ("slot", "dict")
        assert other.contains_points([INSIDE, OUTSIDE]).tolist() == [True, False]


def test_casting_scenes_keep_attributes_in_slots():
    mine = Casting()
    mine.add_triangles(np.array(CUBE), np.array(FACES))
    mine.tag, mine.other = "slot", "dict"
    for other in copies(mine):
        assert type(other) is Casting and (other.tag, other.other) == ("slot", "dict")
        assert other.compute_occupancy([INSIDE, OUTSIDE]).tolist() == [1, 0]
        other.add_triangles(np.array(CUBE) + 20, np.array(FACES))
    assert mine.compute_occupancy([[20.5] * 3]).tolist() == [0]
