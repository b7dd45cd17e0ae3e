# SPDX-License-Identifier: GPL-3.0-or-later
"""E of particle cylinders over the network's, against their radius. Usage: plot_specimen.py SPECIMEN.csv PICTURE.png"""
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

RULES = {
    "young": "area by bonds",
    "young_by_density": "by number of nodes",
    "young_by_centres": "outermost centre",
    "young_by_centres_plus_half": "outermost centre + d/2",
}


def main(table, picture):
    with open(table, newline="") as file:
        rows = list(csv.DictReader(file))
    radius = [float(row["radius_d"]) for row in rows]
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.6), constrained_layout=True)
    for name, label in RULES.items():
        axes[0].plot(
            radius, [float(row[name]) / float(row["network_young"]) for row in rows], "o-", ms=4, lw=1, label=label
        )
    axes[0].axhspan(0.97, 1.03, color="0.9", zorder=0)
    axes[0].set_ylabel("E / E of the network")
    axes[0].legend(fontsize=8)
    axes[1].plot(radius, [float(row["poisson"]) - float(row["network_poisson"]) for row in rows], "o-", ms=4, lw=1)
    axes[1].axhline(0, color="k", lw=0.6)
    axes[1].set_ylabel(r"$\nu - \nu$ of the network")
    for axis in axes:
        axis.set_xlabel("R / d")
        axis.grid(alpha=0.3)
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:3])
