# SPDX-License-Identifier: GPL-3.0-or-later
"""nu and E against alpha with the published points. Usage: plot_table.py TABLE.csv PICTURE.png"""
import csv
import math
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def column(rows, name):
    return [float(row[name]) if row[name] else float("nan") for row in rows]


def main(table, picture):
    with open(table, newline="") as file:
        rows = sorted(csv.DictReader(file), key=lambda row: float(row["alpha"]))
    alpha = column(rows, "alpha")
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.6), constrained_layout=True)
    for axis, name, label in ((axes[0], "poisson", r"Poisson ratio $\nu$"), (axes[1], "young", r"$E\,d/k$")):
        # One box alone has no error: no bar then.
        error = [e if math.isfinite(e) else 0.0 for e in column(rows, name + "_error")]
        axis.errorbar(alpha, column(rows, name), yerr=error, fmt="o-", ms=4, lw=1, label="network")
        axis.plot(alpha, column(rows, "published_" + name), "kx", ms=8, label="published")
        axis.set_xlabel(r"$\alpha / (k d)$")
        axis.set_ylabel(label)
        axis.grid(alpha=0.3)
        axis.legend()
    figure.savefig(picture, dpi=150)


if __name__ == "__main__":
    main(*sys.argv[1:3])
