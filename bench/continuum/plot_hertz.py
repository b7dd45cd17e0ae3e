#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws F / F_Hertz at equal approach against a / R for several Poisson ratios, from boba-continuum.
Usage: plot_hertz.py PROGRAM OUT.png"""
import json
import pathlib
import subprocess
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

# a / R from 0.003 to 0.3, through Hertz's a^2 = R d with d half the approach of the plates.
approaches = 2 * np.geomspace(0.003, 0.3, 15) ** 2
figure, axes = plt.subplots(figsize=(6, 4.2), constrained_layout=True)
for poisson in (-0.5, -0.25, 0, 0.25, 0.4, 0.49):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(
            [
                sys.argv[1],
                "sphere",
                "--radius",
                "1",
                "--young",
                "1",
                "--poisson",
                str(poisson),
                "--approach",
                ",".join(f"{d:.6g}" for d in approaches),
                "--no-fields",
                "--output",
                folder,
            ],
            check=True,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        loads = json.loads((pathlib.Path(folder) / "summary.json").read_text())["loads"]
    axes.semilogx(
        [load["contact_radius"] for load in loads],
        [load["force"] / load["hertz_force"] for load in loads],
        "o-",
        markersize=3,
        label=f"ν = {poisson}",
    )
axes.axhline(1, color="k", linewidth=0.8, linestyle="--")
axes.set_xlabel("a / R")
axes.set_ylabel("F / F$_{Hertz}$ at equal approach")
axes.legend(fontsize=8)
axes.grid(alpha=0.3)
figure.savefig(sys.argv[2], dpi=110)
