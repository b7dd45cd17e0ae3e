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


COLOURS = {"finite_layer": "tab:blue", "finite": "tab:orange"}


def main(picture, folders):
    points = {}
    for folder in folders:
        document = json.loads((pathlib.Path(folder) / "comparison.json").read_text())
        for case in document["cases"]:
            seconds = sum(case["seconds"]) / len(case["seconds"])
            for row in document["rows"]:
                if row["alpha"] != case["alpha"] or row["quantity"] != "force" or row["load"] != 0.1:
                    continue
                for model, value in row["continuum"].items():
                    if model in COLOURS:
                        points.setdefault((row["alpha"], model), []).append(
                            (seconds, abs(row["particles"] / value - 1), (row["particles_error"] or 0.0) / value)
                        )
    figure, axis = plt.subplots(figsize=(6.5, 4.3), constrained_layout=True)
    for (alpha, model), curve in points.items():
        seconds, error, scatter = zip(*sorted(curve))
        down = [min(s, 0.9 * e) for e, s in zip(error, scatter)]
        axis.errorbar(
            seconds,
            error,
            yerr=(down, scatter),
            fmt=("o-" if alpha == 0 else "s--"),
            color=COLOURS[model],
            ms=4,
            lw=1,
            capsize=2,
            label=f"nodes, alpha = {alpha:g}, against {model.replace('_', ' + ')}",
        )
    axis.plot(*zip(*CONTINUUM), "k^-", ms=4, lw=1, label="continuum, linear, against the exact series")
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_xlabel("processor seconds of a body or a load")
    axis.set_ylabel("relative error in F at approach / R = 0.1")
    axis.grid(alpha=0.3, which="both")
    axis.legend(fontsize=7)
    figure.savefig(picture, dpi=90)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
