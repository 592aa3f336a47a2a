"""Rays from any distance."""

import numpy as np
import pytest
from test_scene import CUBE, FACES, cube  # noqa: F401

import gridel


@pytest.mark.parametrize("format", ["fixed", "f32", "f64"])
@pytest.mark.parametrize("distance", [1e6, 1e7, 1e9, 1e12, 1e15, 1e100, 1e300])
def test_rays_from_any_distance_hit(cube, format, distance):
    # At 1 above the x-y plane's face, through (0.25, 0.5): the bits of x and y survive the distance.
    rays = [[0.25, 0.5, -distance, 0, 0, 2.0], [0.25, 0.5, distance, 0, 0, 1.0], [0.25, 5.0, -distance, 0, 0, 1.0]]
    hits = cube.cast(rays, format=format)
    assert hits.t.tolist() == [distance / 2, np.inf, np.inf]
    assert np.allclose(hits.t[0] * 2 - distance, 0) and np.isfinite(hits.uv).all()
    corners = CUBE[FACES[hits.primitive[0]]]
    u, v = hits.uv[0]
    assert np.allclose((1 - u - v) * corners[0] + u * corners[1] + v * corners[2], [0.25, 0.5, 0])
    assert cube.any(rays, format=format).tolist() == [True, False, False]
    assert cube.count(rays, format=format).tolist() == [2, 0, 0]
    every = cube.all(rays, format=format)
    assert every.ray.tolist() == [0, 0]
    assert np.allclose(every.t, [distance / 2, distance / 2 + 0.5], rtol=1e-15)
    limited = np.array([[0.25, 0.5, -distance, 0, 0, 0, 1, 0.5 * distance], [0.25, 0.5, -distance, 2 * distance, 0, 0, 1, np.inf]])
    assert np.isinf(cube.cast(limited, format=format).t).all()
    # It passes by, whichever axis is farthest.
    aside = [[distance, 0.5, 0.5, 0, 0, 1], [distance, -distance, 3 * distance, 1, 0.5, 0.25]]
    assert np.isinf(cube.cast(aside, format=format).t).all() and not cube.any(aside, format=format).any()


@pytest.mark.parametrize("format", ["fixed", "f32", "f64"])
@pytest.mark.parametrize("distance", [1e7, 1e9, 1e12])
def test_slanted_rays_from_far_away_cross_twice(cube, format, distance):
    rng = np.random.default_rng(7)
    directions = rng.normal(size=(5000, 3))
    origins = rng.uniform(0.05, 0.95, size=(5000, 3)) - distance * directions
    rays = np.hstack([origins, directions])
    assert (cube.count(rays, format=format) == 2).all()
    hits = cube.cast(rays, format=format)
    assert np.isfinite(hits.t).all() and np.isfinite(hits.uv).all()
    assert np.allclose(hits.t, distance, rtol=1e-5)


def plane_and_ball(folder):
    plane = "[[object]]\nkind = 'plane'\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n"
    ball = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 2]\nradius = 1\n"
    (folder / "scene.toml").write_text(plane + ball)
    return gridel.Scene.load(folder / "scene.toml", accel="bvh")


@pytest.mark.parametrize("format", ["fixed", "f32", "f64"])
def test_far_rays_meet_planes_or_are_invalid(tmp_path, format):
    scene = plane_and_ball(tmp_path)
    # At the ball, beside it at the plane, and so far beside it that no number of the core holds the place.
    rays = [[0, 0, 1e9, 0, 0, -1], [5, 0, 1e9, 0, 0, -1], [1e9, 0, 1e9, 0, 0, -1.0]]
    assert np.allclose(scene.cast(rays, format=format).t, [1e9 - 3, 1e9, np.nan], rtol=1e-12, equal_nan=True)
    assert scene.count(rays, format=format).tolist() == [3, 1, 0]


@pytest.mark.parametrize("format", ["fixed", "f32", "f64"])
def test_count_leaves_out_what_all_leaves_out(tmp_path, format):
    scene = plane_and_ball(tmp_path)
    # The direction is so short that t of the plane is no number of double precision.
    rays = np.array([[0, 0, 9.0, 0, 0, -4e-308], [0, 0, 9.0, 0, 0, -1.0]])
    limited = np.insert(rays, 3, 0.0, axis=1)
    limited = np.insert(limited, 7, np.finfo(float).max, axis=1)
    for rows in (rays, limited):
        every = np.bincount(scene.all(rows, format=format).ray, minlength=2)
        assert every[0] < 3 and every[1] == 3
        assert scene.count(rows, format=format).tolist() == every.tolist()


def test_near_rays_keep_their_bits_beside_far_ones(cube):
    rays = np.random.default_rng(6).normal(size=(4000, 6))
    rays[:, :3] -= 64 * rays[:, 3:]
    mixed = rays.copy()
    mixed[::2, :3] -= 1e9 * mixed[::2, 3:]
    a, b = cube.cast(rays), cube.cast(mixed)
    for one, other in zip(a, b):
        assert np.array_equal(one[1::2], other[1::2], equal_nan=True)
    same = a.primitive[::2] == b.primitive[::2]
    assert same.mean() > 0.99
