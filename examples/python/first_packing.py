# SPDX-License-Identifier: GPL-3.0-or-later
"""A first packing: 27 soft grains, compressed and sheared from Python, looked at while they move, and reported.

Usage: first_packing.py [OUTPUT]; needs the program boba on PATH (or BOBA_PROGRAM). Under a minute.
"""
import pathlib
import sys

import boba
from boba.report import page_of, report_data

output = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/first")

# %% The scene, as a file would have it (docs/scene.md).
scene = {
    "title": "a first packing",
    "seed": 1,
    "output": {"directory": "out/first", "table": {"every_strain": 0.01}, "trajectory": {"every_strain": 0.1}},
    "template": [{"name": "grain", "nodes": 60}],
    "species": [{"template": "grain", "count": 27, "poisson": 0.1}],
    "stage": [
        {"type": "insert", "packing_fraction": 0.3},
        {"type": "compress", "normalised_pressure": 0.1, "rate": 2e-3},
        {"type": "shear", "rate": 2e-3, "strain": 0.4, "normalised_pressure": 0.1},
    ],
}

# %% The run. Every 500 steps Python looks at it: here at the grain that carries most.
simulation = boba.Simulation(scene, output=output)
for state in simulation.steps(every=500):
    pressure = -state.grain_stress[:, :3].sum(axis=1) / 3
    print(f"step {state.step:6d}  strain {state.strain:.3f}  P {state.pressure:.4f} k/d  most on grain "
          f"{state.grain_numbers[pressure.argmax()]}")  # fmt: skip

# %% What it wrote.
run = simulation.read()
mean, error = run.average("mu", 0.2, 0.4, stage="shear")
print(run)
print(f"mu = {mean:.3f} +- {error:.3f} over 0.2 < strain < 0.4")

# %% One file to look at, or to send.
(output / "report.html").write_text(page_of(report_data([output])))
print(f"open {output / 'report.html'}")
