# SPDX-License-Identifier: GPL-3.0-or-later
"""Particles against the continuum: curves and profiles. Usage: plot_compare.py DIR (with comparison.json)"""
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

STYLE = {
    "linear": ("-", "0.5"),
    "finite": ("-.", "tab:orange"),
    "linear_layer": ("--", "tab:green"),
    "finite_layer": ("-", "tab:red"),
    "neo_layer": (":", "tab:purple"),
    "linear_springs": (":", "0.5"),
}


def curves(axis, rows, quantity, scale):
    points = [row for row in rows if row["quantity"] == quantity]
    load = [row["load"] for row in points]
    error = [(row["particles_error"] or 0.0) * scale(row) for row in points]
    for model, (line, colour) in STYLE.items():
        known = [row for row in points if model in row["continuum"]]
        if known:
            axis.plot(
                [row["load"] for row in known],
                [row["continuum"][model] * scale(row) for row in known],
                line,
                color=colour,
                lw=1.2,
                label=model.replace("_", " + "),
            )
    if any("hertz" in row for row in points):
        axis.plot(load, [row["hertz"] * scale(row) for row in points], "k:", lw=1, label="Hertz")
    axis.errorbar(
        load, [row["particles"] * scale(row) for row in points], yerr=error, fmt="ko", ms=4, label="particles"
    )
    axis.grid(alpha=0.3)


def profile(axis, case):
    entry = case["profiles"][-1]
    best = "finite_layer" if "finite_layer" in entry["continuum"] else "finite"
    if best not in entry["continuum"]:
        best = "linear"
    along = entry.get("z") or entry["angle"]
    for name, colour in (("u_r", "tab:red"), ("u_z", "tab:blue")):
        if name in entry:
            axis.plot(along, entry[name], "o", ms=4, color=colour, label=f"{name} particles")
            if best in entry["continuum"]:
                model = entry["continuum"][best]
                axis.plot(model.get("z", along), model[name], "-", lw=1, color=colour, label=f"{name} {best}")
    axis.set_xlabel("z / d" if "z" in entry else "angle from the equator")
    axis.set_title(f"side at load {entry['load']:g}", fontsize=9)
    axis.grid(alpha=0.3)


def main(folder):
    folder = pathlib.Path(folder)
    document = json.loads((folder / "comparison.json").read_text())
    cases = document["cases"]
    sphere = document["problem"] == "sphere"
    figure, axes = plt.subplots(len(cases), 3, figsize=(12, 3.1 * len(cases)), constrained_layout=True, squeeze=False)
    for axis, case in zip(axes, cases):
        rows = [row for row in document["rows"] if row["alpha"] == case["alpha"] and row["setup"] == case["setup"]]
        if sphere:
            modulus = case["young"] / (1 - case["poisson"] ** 2)
            radius = case["surface"]["radius"]
            curves(axis[0], rows, "force", lambda row: 1 / (modulus * radius**2 * row["load"] ** 1.5))
            axis[0].set_ylabel(r"$F / (E^* R^2 (\delta/R)^{3/2})$")
            curves(axis[1], rows, "bulge_number", lambda row: 1)
            axis[1].set_ylabel(r"$u_{eq} E R / F$")
        else:
            curves(axis[0], rows, "apparent_modulus", lambda row: 1 / case["young"])
            axis[0].set_ylabel(r"$F / (\pi R^2 \epsilon E)$")
            curves(axis[1], rows, "poisson", lambda row: 1)
            axis[1].set_ylabel(r"$\nu$ at mid-height")
        axis[0].set_title(rf"$\alpha$ = {case['alpha']:g}, $\nu$ = {case['poisson']:.2f}, {case['setup']}", fontsize=9)
        for one in axis[:2]:
            one.set_xlabel(r"$\delta / R$ of one contact" if sphere else "strain")
        profile(axis[2], case)
    axes[0][0].legend(fontsize=6)
    axes[0][2].legend(fontsize=6)
    figure.savefig(folder / "comparison.png", dpi=80)


if __name__ == "__main__":
    main(sys.argv[1])
