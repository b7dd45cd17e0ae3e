# SPDX-License-Identifier: GPL-3.0-or-later
"""Stress, E and nu against strain. Usage: plot_strain.py CURVE.csv PICTURE.png"""
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def main(table, picture):
    with open(table, newline="") as file:
        rows = list(csv.DictReader(file))
    strain = [float(row["strain"]) for row in rows]
    figure, axes = plt.subplots(1, 3, figsize=(12, 3.6), constrained_layout=True)
    labels = {
        "stress_k_per_d": r"nominal stress $d/k$",
        "young_k_per_d": r"tangent $E\,d/k$",
        "poisson": r"incremental $\nu$",
    }
    for axis, (name, label) in zip(axes, labels.items()):
        axis.plot(strain, [float(row[name]) for row in rows], "o-", ms=3, lw=1)
        axis.set_xlabel("strain (tension positive)")
        axis.set_ylabel(label)
        axis.grid(alpha=0.3)
    figure.savefig(picture, dpi=150)


if __name__ == "__main__":
    main(*sys.argv[1:3])
