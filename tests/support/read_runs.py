# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads trajectories with MDAnalysis and compares their frames with those of a run that was left alone.

Usage: read_runs.py same|first WHOLE TRAJECTORY ...
  same   the very same frames: none missing, none twice
  first  the first ones of them, of a run that was killed
"""
import sys
import warnings

warnings.filterwarnings("ignore")
import h5py
import MDAnalysis
import numpy as np


def frames(path):
    with h5py.File(path, "r") as file:
        n = len(file["particles/all/id"])
        velocities = "velocity" in file["particles/all"]
        if len(file["particles/all/position/step"]) == 0:
            return []  # killed before its first frame: MDAnalysis does not open a file without any
    universe = MDAnalysis.Universe.empty(n, trajectory=True, velocities=velocities)
    universe.load_new(path, format="H5MD", convert_units=False)
    return [
        (
            frame.data["step"],
            frame.positions.copy(),
            frame.velocities.copy() if velocities else None,
            frame.dimensions.copy(),
        )
        for frame in universe.trajectory
    ]


how, whole, others = sys.argv[1], frames(sys.argv[2]), sys.argv[3:]
assert others and len(whole) > 3, (len(others), len(whole))
steps = [frame[0] for frame in whole]
assert all(b > a for a, b in zip(steps, steps[1:])), f"steps do not rise: {steps}"
for path in others:
    found = frames(path)
    assert [frame[0] for frame in found] == steps[: len(found)], f"{path}: {[frame[0] for frame in found]}, not {steps}"
    assert how == "first" or len(found) == len(whole), f"{path}: {len(found)} of {len(whole)} frames"
    for mine, right in zip(found, whole):
        for a, b in zip(mine[1:], right[1:]):
            assert np.array_equal(a, b), f"{path}: step {mine[0]} differs"
print(f"{len(others)} trajectories as they should be")
