# SPDX-License-Identifier: GPL-3.0-or-later
"""How the stress ratio mu depends on the inertial number I: one packing sheared at three rates, with error bars.

Usage: stress_ratio.py [OUTPUT]; needs the program boba on PATH (or BOBA_PROGRAM). About a minute.
"""
import pathlib
import sys

import boba

output = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/stress_ratio")
RATES = (1e-3, 2e-3, 4e-3)

# %% One packing, compressed once.
scene = {
    "title": "stress ratio",
    "seed": 2,
    "output": {"directory": "out/packed", "table": {"every_strain": 0.002}, "trajectory": {"every_time": 1e6}},
    "template": [{"name": "grain", "nodes": 60}],
    "species": [{"template": "grain", "count": 16, "alpha": 2.0}],
    "stage": [
        {"type": "insert", "packing_fraction": 0.3},
        {"type": "compress", "normalised_pressure": 0.1, "rate": 2e-3},
        {"type": "shear", "name": "flow", "rate": 1e-3, "strain": 0.4, "normalised_pressure": 0.1},
    ],
}

# %% Three runs that differ in the rate alone.
print("   rate       I               mu")
for rate in RATES:
    settings = {"stage.flow.rate": rate}
    run = boba.Simulation(scene, set=settings, output=output / f"rate_{rate:g}").run()
    inertial, _ = run.average("inertial_number", 0.2, 0.4, stage="flow")
    mu, error = run.average("mu", 0.2, 0.4, stage="flow")
    print(f"{rate:8.0e}  {inertial:8.5f}  {mu:.4f} +- {error:.4f}")

print(f"boba report {output} draws them over each other, with mu against the rate")
