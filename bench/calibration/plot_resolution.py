#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Error of a sphere of nodes against processor time. Usage: plot_resolution.py PICTURE DIR... (of `boba-calibrate compare sphere`)"""
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

# Seconds a load and relative error in F of boba-continuum: docs/performance-continuum.md, sphere nu = 0.25, a/R = 0.1, Q2.
CONTINUUM = [(0.0211, 1.549e-3), (0.0237, 2.525e-4), (0.0369, 1.425e-4), (0.0683, 4.429e-5), (0.1384, 4.065e-5)]


def main(picture, folders):
    points = {}
    for folder in folders:
        document = json.loads((pathlib.Path(folder) / "comparison.json").read_text())
        case = document["cases"][0]
        seconds = sum(case["seconds"]) / len(case["seconds"])
        for row in document["rows"]:
            for model, sign in (("finite_layer", "o-"), ("finite", "s--")):
                if row["quantity"] == "force" and row["load"] == 0.1 and model in row["continuum"]:
                    points.setdefault((row["alpha"], model, sign), []).append((seconds, abs(row["particles"] / row["continuum"][model] - 1)))
    figure, axis = plt.subplots(figsize=(6, 4), constrained_layout=True)
    for (alpha, model, sign), curve in points.items():
        axis.loglog(*zip(*sorted(curve)), sign, ms=4, lw=1, label=f"nodes, alpha = {alpha:g}, against {model.replace('_', ' + ')}")
    axis.loglog(*zip(*CONTINUUM), "k^-", ms=4, lw=1, label="continuum, linear, against the exact series")
    axis.set_xlabel("processor seconds")
    axis.set_ylabel("relative error in F")
    axis.grid(alpha=0.3, which="both")
    axis.legend(fontsize=7)
    figure.savefig(picture, dpi=90)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
