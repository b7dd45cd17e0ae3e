#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Plots of docs/stability.md from the tables of bench_stability. Usage: plot.py TABLES PICTURES"""
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np


def number(text):
    try:
        return float(text)
    except ValueError:
        return text


def table(folder, name):
    """Rows as dictionaries; none when the sweep was not run."""
    path = folder / f"{name}.csv"
    if not path.exists():
        return []
    with open(path, newline="") as file:
        return [{key: number(value) for key, value in row.items()} for row in csv.DictReader(file)]


def curve(rows, x, y, **wanted):
    points = [(row[x], row[y]) for row in rows if all(row[key] == value for key, value in wanted.items())]
    points = [p for p in points if np.isfinite(p[0]) and np.isfinite(p[1])]
    return np.array(points).T if points else np.empty((2, 0))


def values(rows, key):
    return sorted({row[key] for row in rows})


def plot_time_step(folder):
    grain, packing, pair = (table(folder, f"time_step_{name}") for name in ("grain", "packing", "contact"))
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), constrained_layout=True)
    for gamma, colour in ((1.0, "C0"), (0.0, "C1")):
        for n, sign in ((60.0, "--"), (300.0, "-"), (5137.0, ":")):
            axes[0].plot(
                *curve(grain, "alpha_kd", "linear_tau", nodes=n, gamma=gamma),
                sign,
                color=colour,
                lw=1,
                label=f"operator, {n:.0f} nodes, gamma = {gamma:.0f}",
            )
        axes[0].plot(
            *curve(grain, "alpha_kd", "experiment_tau", nodes=300.0, gamma=gamma),
            "o",
            color=colour,
            ms=4,
            label=f"experiment, 300 nodes, gamma = {gamma:.0f}",
        )
    axes[0].axhline(0.1, color="k", lw=0.8)
    axes[0].set(xlabel="alpha (k d)", ylabel="largest stable dt (tau)", title="free grains", ylim=(0, None))
    axes[0].legend(fontsize=6)
    for k, alpha in enumerate(values(packing, "alpha_kd")):
        axes[1].plot(*curve(packing, "overlap_d", "linear_tau", alpha_kd=alpha, gamma=1.0), "-", color=f"C{k}", lw=1)
        axes[1].plot(
            *curve(packing, "overlap_d", "experiment_tau", alpha_kd=alpha, gamma=1.0),
            "o",
            color=f"C{k}",
            ms=4,
            label=f"alpha = {alpha:g}",
        )
    axes[1].plot(*curve(pair, "overlap_d", "pair_tau", gamma=1.0), "k--", lw=0.8, label="two nodes alone")
    axes[1].axhline(0.1, color="k", lw=0.8)
    axes[1].set(
        xlabel="deepest overlap in the packing (d)",
        title="packings, damped: operator (lines), experiment",
        ylim=(0, 0.5),
    )
    axes[1].legend(fontsize=6)
    return figure


def plot_energy(folder):
    alone, loops, spectrum, twin = (
        table(folder, name) for name in ("energy_left_alone", "energy_loops", "spectrum", "rounding_left_alone")
    )
    figure, axes = plt.subplots(1, 3 if spectrum else 2, figsize=(14 if spectrum else 10, 4), constrained_layout=True)
    shown = [a for a in values(alone, "alpha_kd") if a in (-0.8, 0.0, 2.0, 12.0)]
    for k, alpha in enumerate(shown):
        for precision, sign in (("double", "-"), ("mixed", ":")):
            axes[0].semilogy(
                *curve(alone, "time_tau", "kinetic_kd2", alpha_kd=alpha, precision=precision),
                sign,
                color=f"C{k}",
                lw=1,
                label=f"alpha = {alpha:g}, {precision}",
            )
        if values(twin, "alpha_kd") and alpha in values(twin, "alpha_kd"):
            axes[0].semilogy(
                *curve(twin, "time_tau", "kinetic_kd2", alpha_kd=alpha),
                "--",
                color=f"C{k}",
                lw=1,
                label=f"alpha = {alpha:g}, long double",
            )
    axes[0].set(xlabel="time (tau)", ylabel="kinetic energy (k d^2)", title="undamped grain of 100 nodes at rest")
    axes[0].legend(fontsize=6)
    if spectrum:
        for n in values(spectrum, "nodes"):
            axes[1].plot(
                *curve(spectrum, "alpha_kd", "rate_per_tau", nodes=n), "o-", ms=3, lw=1, label=f"{n:.0f} nodes"
            )
        axes[1].set(
            xlabel="alpha (k d)", ylabel="growth rate without damping (1/tau)", title="spectrum of the linearised law"
        )
        axes[1].legend(fontsize=7)
    for k, alpha in enumerate([a for a in values(loops, "alpha_kd") if a in (-0.8, 0.0, 2.0, 5.0, 12.0)]):
        for sense, sign in ((1.0, "o-"), (-1.0, "s--")):
            x, y = curve(loops, "amplitude", "many_body_kd2", alpha_kd=alpha, gamma=1.0, sense=sense, period_tau=500.0)
            axes[-1].loglog(
                x, np.abs(y), sign, color=f"C{k}", ms=3, lw=1, label=f"alpha = {alpha:g}" if sense > 0 else None
            )
    axes[-1].set(
        xlabel="amplitude of the strain loop",
        ylabel="|work of the many-body force| (k d^2)",
        title="bulk, one closed loop, damped",
    )
    axes[-1].legend(fontsize=7)
    return figure


def plot_rounding(folder):
    growth, momenta = (table(folder, name) for name in ("rounding_growth", "conservation"))
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), constrained_layout=True)
    for k, (alpha, gamma) in enumerate(sorted({(row["alpha_kd"], row["gamma"]) for row in growth})):
        for precision, sign in (("double", "-"), ("mixed", ":")):
            axes[0].semilogy(
                *curve(growth, "time_tau", "distance_d", alpha_kd=alpha, gamma=gamma, precision=precision),
                sign,
                color=f"C{k}",
                lw=1,
                label=f"alpha = {alpha:g}, gamma = {gamma:.0f}, {precision}",
            )
    axes[0].set(
        xlabel="time (tau)", ylabel="distance from the long double twin (d)", title="error growth in a shaken packing"
    )
    axes[0].legend(fontsize=6)
    for k, case in enumerate(sorted({(row["alpha_kd"], row["gamma"], row["precision"]) for row in momenta})):
        wanted = dict(zip(("alpha_kd", "gamma", "precision"), case))
        label = f"alpha = {case[0]:g}, gamma = {case[1]:.0f}, {case[2]}"
        axes[1].loglog(*curve(momenta, "steps", "momentum_error", **wanted), "-", color=f"C{k}", lw=1, label=label)
        axes[1].loglog(*curve(momenta, "steps", "angular_error", **wanted), "--", color=f"C{k}", lw=1)
    axes[1].set(xlabel="steps", ylabel="relative change", title="momentum (-), angular momentum (--)")
    axes[1].legend(fontsize=6)
    return figure


def plot_barostat(folder):
    step, shear = table(folder, "barostat_step"), table(folder, "barostat_shear")
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), constrained_layout=True)
    cap = 1e-3
    axes[0].loglog(*curve(step, "gain", "expected_time_tau", rate_cap=cap), "k--", lw=0.8, label="1 / (3 g K)")
    axes[0].loglog(*curve(step, "gain", "time_tau", rate_cap=cap), "o", ms=3, label="63 % of a step of 1 % (tau)")
    axes[0].loglog(*curve(step, "gain", "rms_at_end", rate_cap=cap), "s-", ms=3, lw=1, label="deviation left, rms")
    axes[0].set(xlabel="gain (d / k tau)", title="a step of the target")
    axes[0].legend(fontsize=7)
    for k, rate in enumerate(values(shear, "rate_per_tau")):
        x, y = curve(shear, "gain", "rms", rate_per_tau=rate)
        order = np.argsort(x)
        axes[1].loglog(x[order], y[order], "o-", color=f"C{k}", ms=3, lw=1, label=f"rate {rate:g} / tau")
        default = curve(shear, "gain", "rms", rate_per_tau=rate, is_default="true")
        axes[1].loglog(*default, "*", color=f"C{k}", ms=11, label="default gain" if default.size else None)
    axes[1].axhline(1e-3, color="k", lw=0.8)
    axes[1].set(xlabel="gain (d / k tau)", ylabel="rms of P / P_target - 1", title="under shear")
    axes[1].legend(fontsize=7)
    return figure


def plot_contacts(folder):
    """Share of the bonds' largest step that pressed packings leave."""
    packing = table(folder, "time_step_packing")
    for row in packing:
        row["operator"] = row["linear_tau"] / row["bonds_tau"]
        row["experiment"] = row["experiment_tau"] / row["bonds_tau"]
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), constrained_layout=True, sharey=True)
    for axis, gamma, title in ((axes[0], 1.0, "damped, gamma = 1"), (axes[1], 0.0, "undamped")):
        for k, alpha in enumerate(values(packing, "alpha_kd")):
            axis.plot(*curve(packing, "overlap_d", "operator", alpha_kd=alpha, gamma=gamma), "-", color=f"C{k}", lw=1)
            axis.plot(
                *curve(packing, "overlap_d", "experiment", alpha_kd=alpha, gamma=gamma),
                "o",
                color=f"C{k}",
                ms=4,
                label=f"alpha = {alpha:g}",
            )
        axis.axhline(0.6, color="k", lw=0.8, ls=":", label='dt = "auto"')
        axis.set(xlabel="deepest overlap (d)", title=title, ylim=(0, 1.1), xlim=(0, 0.5))
    axes[0].set(ylabel="largest stable dt / that of the bonds")
    axes[0].legend(fontsize=7)
    return figure


def plot_spectrum(folder):
    spectrum = table(folder, "spectrum")
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), constrained_layout=True)
    for n in values(spectrum, "nodes"):
        axes[0].plot(*curve(spectrum, "alpha_kd", "rate_per_tau", nodes=n), "o-", ms=3, lw=1, label=f"{n:.0f} nodes")
    axes[0].set(xlabel="alpha (k d)", ylabel="growth without damping (1/tau)", title="spectrum of the linearised law")
    axes[0].legend(fontsize=7)
    axes[1].semilogy(*curve(spectrum, "alpha_kd", "sufficient_gamma", nodes=40.0), "o-", ms=3, lw=1)
    axes[1].axhline(1.0, color="k", lw=0.8, ls=":")
    axes[1].set(xlabel="alpha (k d)", ylabel="gamma", title="least damping, 40 nodes (dotted: published)")
    return figure


def plot_rest(folder):
    rest = table(folder, "rest") + table(folder, "rest_mixed")
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), constrained_layout=True)
    for precision, colour in (("double", "C0"), ("mixed", "C1")):
        axes[0].loglog(*curve(rest, "steps", "kinetic_kd2", precision=precision), color=colour, lw=1, label=precision)
        axes[1].loglog(*curve(rest, "steps", "moved_d", precision=precision), color=colour, lw=1, label=precision)
    axes[0].set(xlabel="steps", ylabel="kinetic energy (k d^2)", title="packing at rest, alpha = 2, damped")
    axes[1].set(xlabel="steps", ylabel="farthest node (d)", title="moved since step 10 000")
    axes[0].legend(fontsize=7)
    return figure


PICTURES = {
    "time-step": (plot_time_step, ("time_step_grain", "time_step_packing", "time_step_contact")),
    "contacts": (plot_contacts, ("time_step_packing",)),
    "spectrum": (plot_spectrum, ("spectrum",)),
    "energy": (plot_energy, ("energy_left_alone", "energy_loops")),
    "rounding": (plot_rounding, ("rounding_growth", "conservation")),
    "rest": (plot_rest, ("rest", "rest_mixed")),
    "barostat": (plot_barostat, ("barostat_step", "barostat_shear")),
}


def main(tables, pictures):
    for name, (plot, needed) in PICTURES.items():
        if all(table(pathlib.Path(tables), part) for part in needed):
            plot(pathlib.Path(tables)).savefig(pathlib.Path(pictures) / f"stability-{name}.png", dpi=80)


if __name__ == "__main__":
    main(*sys.argv[1:])
