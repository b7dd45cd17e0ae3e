# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a trajectory of small_packing.h with MDAnalysis and h5py and compares it with the formulas given there.

Usage: read_trajectory.py FILE STEP [STEP ...]
"""
import sys
import warnings

warnings.filterwarnings("ignore")
import h5py
import MDAnalysis
import numpy as np

path, steps = sys.argv[1], [int(step) for step in sys.argv[2:]]
n = 5
i = np.arange(n)


def unwrapped(s):
    return np.stack([1.7 * i + 0.01 * s, 3.0 * i - 20.0, 0.5 - 2.0 * i], axis=1)


def cell(s):
    return np.array([[10 + 0.1 * s, 0, 0], [2.5, 9, 0], [-1.5, 0.75, 8]])


universe = MDAnalysis.Universe.empty(n, trajectory=True, velocities=True)
universe.load_new(path, format="H5MD", convert_units=False)
assert len(universe.trajectory) == len(steps), (len(universe.trajectory), steps)
origin = np.array([0.5, -2, 1])
for step, frame in zip(steps, universe.trajectory):
    assert frame.data["step"] == step and np.isclose(frame.time, 0.1 * step)
    # MDAnalysis keeps lengths and angles; those of the cell vectors do not depend on how it turns them.
    a, b, c = cell(step)
    lengths = [np.linalg.norm(vector) for vector in (a, b, c)]
    angles = [np.degrees(np.arccos(p @ q / np.linalg.norm(p) / np.linalg.norm(q))) for p, q in ((b, c), (a, c), (a, b))]
    assert np.allclose(frame.dimensions, lengths + angles, rtol=1e-5), frame.dimensions
    s = (frame.positions - origin) @ np.linalg.inv(cell(step))
    assert (s > -1e-5).all() and (s < 1 + 1e-5).all(), "positions are not wrapped"
    shift = (unwrapped(step) - frame.positions) @ np.linalg.inv(cell(step))
    assert np.allclose(shift, np.round(shift), atol=1e-5), "positions differ by more than lattice vectors"
    assert np.allclose(frame.velocities, np.stack([i, np.full(n, 0.1 * step), -i], axis=1))
    assert np.isclose(frame.data["strain"], 0.001 * step)
    x = unwrapped(step)
    assert np.allclose(frame.data["grain_centre"], [x[:3].mean(axis=0), x[3:].mean(axis=0)])
    assert np.allclose(frame.data["grain_stress"][1], [-1, -2, -3, -4, -5, -step])

with h5py.File(path, "r") as f:
    assert list(f["h5md"].attrs["version"]) == [1, 1]
    assert list(f["particles"]) == ["all"]
    everything = f["particles/all"]
    assert everything["box"].attrs["dimension"] == 3
    assert [bytes(b) for b in everything["box"].attrs["boundary"]] == [b"periodic"] * 3
    assert list(everything["id"]) == [11, 7, 3, 8, 2] and list(everything["grain"]) == [4, 4, 4, 9, 9]
    assert list(everything["species"]) == [1, 1, 1, 0, 0] and list(everything["mass"]) == [1] * n
    assert f["connectivity/bonds"][()].tolist() == [[11, 7], [7, 3], [8, 2]]
    assert f["connectivity/bonds_r0"][()].tolist() == [1.01, 0.97, 1.3]
    assert f[f["connectivity/bonds"].attrs["particles_group"]].name == "/particles/all"
    assert f["parameters/scene"][()].decode() == "# a scene\nseed = 12 # \u00e9\n"
    assert f["parameters/seed"][()].decode() == "18446744073709551615"
    assert f["parameters/git_hash"][()].decode() == "0123abc" and f["parameters/version"][()].decode() == "0.1.0"
    for k, step in enumerate(steps):
        rebuilt = everything["position/value"][k] + everything["image/value"][k] @ everything["box/edges/value"][k]
        assert np.allclose(rebuilt, unwrapped(step), atol=1e-12), "images do not restore the unwrapped positions"
        assert np.array_equal(everything["box/edges/value"][k], cell(step))
        assert np.array_equal(everything["box/boba_origin/value"][k], origin)

    def check_units(name, item):
        assert "unit" not in item.attrs, name
        if name.endswith("/value") and "image" not in name:
            assert "boba_unit" in item.attrs, name
        if isinstance(item, h5py.Group) and "value" in item:
            assert len(item["value"]) == len(item["step"]) == len(item["time"]) == len(steps), name

    f.visititems(check_units)
print("as it should be")
