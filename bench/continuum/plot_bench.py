#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws run time against error of the force from the CSV of continuum_bench and calculix_peer.py.
Usage: plot_bench.py OUT.png FILE.csv ..."""
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

MARKS = {"Q1": "o", "Q2": "s", "Q3": "^", "CAX8": "D"}
PANELS = (
    ("sphere, ν = 0.25, a/R = 0.1", lambda name: name.startswith(("sphere nu=0.25", "CalculiX"))),
    ("other spheres", lambda name: name.startswith("sphere") and "nu=0.25" not in name),
    ("bonded cylinder, R = 7, h = 20", lambda name: name.startswith("bonded")),
)


def read(files):
    """Points (seconds, error) by problem and element."""
    curves = {}
    for name in files:
        with open(name, encoding="utf-8") as stream:
            for row in csv.DictReader(stream):
                if row["error_force"]:
                    curves.setdefault((row["problem"], row["element"]), []).append(
                        (float(row["seconds"]), float(row["error_force"]))
                    )
    return curves


def label_of(problem, element):
    for prefix in ("sphere nu=0.25 a/R=0.1", "sphere ", "bonded cylinder R=7 h=20 "):
        problem = problem.removeprefix(prefix)
    return f"{problem}, {element}".removeprefix(", ").replace("nu=", "ν = ").replace("a/R=", "a/R = ")


def main(picture, files):
    curves = read(files)
    figure, panels = plt.subplots(1, 3, figsize=(13, 4.4), sharey=True, constrained_layout=True)
    for axes, (title, belongs) in zip(panels, PANELS):
        problems = []  # one colour a problem, one mark an element
        for (problem, element), points in curves.items():
            if belongs(problem):
                if problem not in problems:
                    problems.append(problem)
                line = "--" if problem.startswith("CalculiX") else "-"
                axes.loglog(
                    *zip(*points),
                    line,
                    marker=MARKS.get(element, "x"),
                    markersize=4,
                    lw=1.2,
                    color=f"C{problems.index(problem)}",
                    label=label_of(problem, element),
                )
        axes.set_title(title)
        axes.set_xlabel("seconds a load")
        axes.legend(fontsize=7, loc="lower right" if axes is panels[0] else "lower left")
        axes.grid(alpha=0.3)
    panels[0].set_ylabel("relative error of F")
    figure.savefig(picture, dpi=100)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
