"""Blobs that do not fit in memory."""

import subprocess
import sys

import pytest

CODE = """
import resource, sys
import numpy as np, gridel
side = 300
x, y = np.meshgrid(np.arange(side), np.arange(side))
vertices = np.column_stack([x.ravel(), y.ravel(), (x * y % 7).ravel()])
first = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
faces = np.vstack([first[:, None] + [0, 1, side], first[:, None] + [1, side + 1, side]])
scene = gridel.Scene.from_arrays(vertices, faces, accel="list")
assert len(scene.to_blob()) > 2_000_000
used = int(open("/proc/self/statm").read().split()[0]) * 4096
resource.setrlimit(resource.RLIMIT_AS, (used + 1_000_000,) * 2)
kept = []
try:
    while len(kept) < 1000:
        kept.append(scene.to_blob())
except MemoryError:
    sys.exit(7)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="limits memory as Linux does")
def test_blobs_that_do_not_fit_in_memory_are_an_error():
    run = subprocess.run([sys.executable, "-c", CODE], capture_output=True, text=True, timeout=120)
    assert run.returncode == 7, run.stderr
