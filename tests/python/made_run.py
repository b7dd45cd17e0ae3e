# SPDX-License-Identifier: GPL-3.0-or-later
"""Small output folders made here, number by number, that the tests know everything about."""
import pathlib

import h5py
import numpy as np

SCENE = """title = "made by a test"
[[template]]
name = "grain"
nodes = 10
[[species]]
count = 2
alpha = 1.0
[[stage]]
type = "insert"
[[stage]]
type = "shear"
name = "forth"
[[stage]]
type = "shear"
name = "back"
[[stage]]
type = "hold"
time = 1
# --set stage.3.time=7
"""

BOX = np.array([[4.0, 1.0, -0.5], [0.0, 5.0, 2.0], [0.0, 0.0, 6.0]])
ORIGIN = np.array([1.0, 2.0, 3.0])
STEPS, TIMES, STRAINS = [0, 7, 9], [0.0, 0.7, 0.9], [0.0, 0.5, 0.6]
IDS = np.arange(20)[::-1] * 3 + 5  # neither sorted nor from 0
MOLECULES = np.array([11, 4])


def write_table(path, columns):
    rows = zip(*columns.values())
    lines = [",".join(columns)] + [",".join("" if v is None else repr(v) for v in row) for row in rows]
    path.write_text("\n".join(lines) + "\n")


def unwrapped(frame):
    """Positions of the two grains of ten nodes in frame 0, 1 or 2, far outside the cell."""
    start = ORIGIN + np.random.default_rng(1).normal(size=(20, 3)) * 8
    return start + 0.25 * frame


def velocities(frame):
    return np.stack([np.arange(20), np.full(20, frame), -np.arange(20)], axis=1) * 0.5


def make_trajectory(path, with_velocities=True):
    with h5py.File(path, "w") as file:
        all_frames = [unwrapped(k) for k in range(3)]
        images = [np.floor(np.linalg.solve(BOX, (x - ORIGIN).T).T).astype(np.int32) for x in all_frames]
        file["particles/all/position/value"] = np.array([x - i @ BOX.T for x, i in zip(all_frames, images)])
        file["particles/all/position/step"] = np.array(STEPS)
        file["particles/all/position/time"] = np.array(TIMES)
        file["particles/all/image/value"] = np.array(images)
        if with_velocities:
            file["particles/all/velocity/value"] = np.array([velocities(k) for k in range(3)])
        file["particles/all/box/edges/value"] = np.array([BOX.T] * 3)
        file["particles/all/box/boba_origin/value"] = np.array([ORIGIN] * 3)
        file["particles/all/id"] = IDS
        file["particles/all/mass"] = np.ones(20)
        file["observables/strain/value"] = np.array(STRAINS)
        file["observables/grain_centre/value"] = np.array([[x[:10].mean(0), x[10:].mean(0)] for x in all_frames])
        file["observables/grain_stress/value"] = np.arange(36.0).reshape(3, 2, 6)
        file["parameters/grains/first_node"] = np.array([0, 10, 20])
        file["parameters/grains/species"] = np.array([0, 1])
        file["parameters/grains/molecule"] = MOLECULES
        file["connectivity/bonds"] = np.array([[IDS[0], IDS[3]], [IDS[19], IDS[10]]])


def make_run(folder):
    """A run that shears forth (mu = 0.2) to strain 1 and back (mu = -0.3), then rests (mu = 0.05)."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scene.toml").write_text(SCENE)
    forth = [0.01 * k for k in range(101)]
    strain = forth + forth[::-1] + [0.5] * 11
    step = list(range(101)) + list(range(100, 201)) + list(range(200, 211))
    n = len(strain)
    write_table(
        folder / "table.csv",
        {
            "step": step,
            "time_tau": [10.0 * s for s in step],
            "stage": [1] * 101 + [2] * 101 + [3] * 11,
            "strain": strain,
            "mu": [0.2] * 101 + [-0.3] * 101 + [0.05] * 11,
            "P_k/d": [0.1] * n,
            "P_normalised": [None] * n,
            "kinetic_energy_kd2": [1.0] * n,
        },
    )
    (folder / "measures").mkdir()
    measured = [0, 50, 100, 150, 200, 205]
    write_table(
        folder / "measures" / "coordination.csv",
        {
            "step": measured,
            "time_tau": [10.0 * s for s in measured],
            "strain": [0.0, 0.5, 1.0, 0.5, 0.0, 0.5],
            "contacts_per_grain": [0.0, 5.0, 6.0, 7.0, 8.0, 9.0],
        },
    )
    write_table(
        folder / "measures" / "contacts.csv",
        {"step": [50, 50], "time_tau": [500.0] * 2, "strain": [0.5] * 2, "grain": [4, 11], "other": [11, 4]},
    )
    make_trajectory(folder / "trajectory.h5")
    return folder
