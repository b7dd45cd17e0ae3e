#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws run time against error of the force from the CSV of continuum_bench and calculix_peer.py.
Usage: plot_bench.py OUT.png FILE.csv ..."""
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

curves = {}
for name in sys.argv[2:]:
    with open(name, encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            if row["error_force"]:
                curves.setdefault((row["problem"], row["element"]), []).append(
                    (float(row["seconds"]), float(row["error_force"])))
figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.5), sharey=True, constrained_layout=True)
for (problem, element), points in curves.items():
    axes = left if problem.startswith(("sphere nu=0.25", "CalculiX")) else right
    style = "s--" if problem.startswith("CalculiX") else "o-"
    axes.loglog(*zip(*points), style, markersize=4, label=f"{problem}, {element}")
left.set_title("sphere, ν = 0.25, a/R = 0.1")
right.set_title("other spheres, bonded cylinder")
for axes in (left, right):
    axes.set_xlabel("seconds a load")
    axes.legend(fontsize=6)
    axes.grid(alpha=0.3)
left.set_ylabel("relative error of F")
figure.savefig(sys.argv[1], dpi=110)
