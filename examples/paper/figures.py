# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws figures 2 to 4, S1 to S4, the compaction and the order at nu = -0.5 from the tables alone: figures.py RESULTS RUNS.csv FOLDER."""
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter

POISSON = {"-0.8": 0.4, "0": 0.25, "2": 0.0, "5": -0.25, "12": -0.5}
COLOURS = {"-0.8": "#1b6ca8", "0": "#2a9d8f", "2": "#7a9e2e", "5": "#d98e04", "12": "#c1121f"}
SPHERE_RADIUS = 10.0
GRAIN_KINDS = (
    ("300", ""),
    ("300", "wall"),
    ("5137", ""),
    ("5137", "wall"),
)  # nodes of a grain, surface of its template


class Results:
    """Rows of the tables, found by run; `plan` is runs.csv."""

    def __init__(self, folder, plan):
        self.plan = {row["name"]: row for row in csv.DictReader(open(plan))}
        self.tables = {path.stem: list(csv.DictReader(path.open())) for path in pathlib.Path(folder).glob("*.csv")}

    def rows(self, table, name, **equal):
        return [
            row
            for row in self.tables.get(table, [])
            if row["name"] == name and all(row[key] == value for key, value in equal.items())
        ]

    def columns(self, table, name, *names, **equal):
        rows = [row for row in self.rows(table, name, **equal) if all(row[column] != "" for column in names)]
        return [np.array([float(row[column]) for row in rows]) for column in names]

    def runs(self, **equal):
        """Names of the planned runs with these parameters, in the plan's order; of grains cut out of the bulk unless `surface` says else."""
        equal = {"surface": ""} | equal
        return [name for name, row in self.plan.items() if all(row[key] == str(value) for key, value in equal.items())]

    def peer(self, rate):
        """YADE's run of the rigid spheres at this rate: one row or none."""
        return [row for row in self.tables.get("yade", []) if float(row["rate"]) == float(rate)]

    def reached(self, name):
        rows = self.rows("summary", name)
        return float(rows[0]["strain"]) if rows else 0.0

    def longest(self, alpha, nodes="300", surface=""):
        """Of one alpha's runs the one with the largest strain, of several the one with the most grains; None when there is none."""
        names = [
            name
            for name in self.runs(scene="shear", alpha=alpha, nodes=nodes, surface=surface)
            if self.rows("structure", name)
        ]
        return max(names, key=lambda name: (round(self.reached(name)), int(self.plan[name]["grains"])), default=None)


def mean_of_runs(values, error):
    """Mean of one value a run, and its error; `error` is that of one. Few runs may agree by chance: their mean has the larger error."""
    spread = np.std(values, ddof=1) if len(values) > 1 else np.nan
    return float(np.mean(values)), float(np.fmax(spread, error) / np.sqrt(len(values)))


def main_size(results):
    """Number of grains that most runs of early shear at 300 nodes have; None when there is no run."""
    numbers = [
        results.plan[name]["grains"] for name in results.runs(scene="shear", nodes=300) if results.rows("early", name)
    ]
    return max(numbers, key=lambda number: (numbers.count(number), int(number)), default=None)


def label(alpha):
    return rf"$\nu$ = {POISSON[alpha]:g}"


def kind_text(nodes, surface):
    return f"{nodes} nodes{', smooth' if surface else ''}"


def packing_text(grains, nodes, surface):
    return f"{grains} {'smooth ' if surface else ''}grains of {nodes} nodes"


def save(figure, folder, name):
    figure.tight_layout()
    figure.savefig(folder / f"{name}.png", dpi=100)
    plt.close(figure)


def compaction_figure(results, folder):
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.6))
    for (nodes, surface), style, at_rest in zip(GRAIN_KINDS, ("-", "--", "-.", ":"), "o^s*"):
        for alpha, colour in COLOURS.items():
            for k, name in enumerate(results.runs(scene="compaction", alpha=alpha, nodes=nodes, surface=surface)):
                phi, pressure, ratio = results.columns("compaction", name, "phi", "P", "phi_reference")
                text = f"{label(alpha)}, {kind_text(nodes, surface)}" if len(phi) and not k else None
                left.plot(phi, pressure, style, color=colour, lw=1, label=text)
                right.plot(ratio, pressure, style, color=colour, lw=1)
            for name in results.runs(scene="jamming", alpha=alpha, nodes=nodes, surface=surface):
                phi, pressure = results.columns("jamming", name, "phi", "P")
                left.plot(phi, pressure, at_rest, color=colour, ms=3)
    left.set_xlabel(r"packing fraction $\phi$ (Monte Carlo)")
    right.set_xlabel("undeformed hull volumes / volume of the cell")
    for axes in (left, right):
        axes.set_yscale("log")
        axes.set_ylim(1e-5, 1)
        axes.set_ylabel(r"$\tilde P$")
    left.legend(fontsize=7)
    save(figure, folder, "compaction")


def spectra(results, axes, column, chosen):
    """Curves of S(q) or P_F(q): chosen is a list of (run, kind, value, colour, style, label)."""
    for name, value, colour, style, text in chosen:
        q, y = results.columns("scattering", name, "q", column, value=value)
        if len(q):
            axes.plot(q, y, style, color=colour, lw=1.2, label=text)
    axes.set_xlabel("q (1/d)")


def compaction_shown(results):
    """The compaction at nu = 0.4 that has the most nodes per grain, of those that have spectra; None when there is none."""
    names = [name for name in results.runs(scene="compaction", alpha="-0.8") if results.rows("scattering", name)]
    return max(names, key=lambda name: int(results.plan[name]["nodes"]), default=None)


def pressure_curves(name):
    values = ["0.01", "0.03", "0.1", "0.2", "0.5"]
    colours = plt.cm.viridis(np.linspace(0, 0.9, len(values)))
    return [(name, v, c, "-", rf"$\tilde P$ = {v}") for v, c in zip(values, colours)]


def strain_curves(results):
    chosen = []
    for alpha in ("-0.8", "2", "12"):
        for nodes in ("5137", "300"):
            name = results.longest(alpha, nodes)
            if name and results.rows("scattering", name, value="3.2"):
                chosen += [
                    (name, "0.0", COLOURS[alpha], "--", None),
                    (name, "3.2", COLOURS[alpha], "-", f"{label(alpha)}, {nodes} nodes"),
                ]
                break
    return chosen


def spectra_panels(results, column):
    """Figure 2's and S1's two panels, one above the other, with the nodes per grain of the upper one."""
    figure, (upper, lower) = plt.subplots(2, 1, figsize=(4.6, 6))
    compaction = compaction_shown(results)
    nodes = int(results.plan[compaction]["nodes"]) if compaction else 300
    spectra(results, upper, column, pressure_curves(compaction))
    upper.set_title(rf"(a) compaction, {label('-0.8')}, {nodes} nodes", fontsize=10, loc="left")
    spectra(results, lower, column, strain_curves(results))
    lower.set_title(r"(b) $\tilde P$ = 0.1; dashed: strain 0, solid: 3.2", fontsize=10, loc="left")
    for axes in (upper, lower):
        axes.set_xlim(0.15, 2)
    return figure, upper, lower, nodes


def figure_2(results, folder):
    figure, upper, lower, _ = spectra_panels(results, "structure")
    for axes in (upper, lower):
        axes.set_ylabel("S(q)")
        axes.legend(fontsize=7)
    save(figure, folder, "figure_2")


def sphere_form_factor(q, n, radius):
    x = q * radius
    return n * (3 * (np.sin(x) - x * np.cos(x)) / x**3) ** 2


def figure_s1(results, folder):
    figure, upper, lower, nodes = spectra_panels(results, "form_factor")
    q = np.linspace(0.1, 2, 400)
    radius = SPHERE_RADIUS * (nodes / 5137) ** (1 / 3)
    upper.plot(q, sphere_form_factor(q, nodes, radius), "k--", lw=1, label=f"sphere, R = {radius:.2f} d")
    for axes in (upper, lower):
        axes.set_yscale("log")
        axes.set_ylim(1e-1, None)
        axes.set_ylabel(r"$P_F(q)$")
        axes.legend(fontsize=7)
    save(figure, folder, "figure_S1")


def histogram(results, axes, name, quantity, window, style, colour):
    centre, count = results.columns("distributions", name, "centre", "count", quantity=quantity, window=window)
    if not len(centre):
        return
    step = {"volume": 0.02, "asphericity": 0.01}.get(quantity, 1.0)
    grid = np.arange(round((centre.max() - centre.min()) / step) + 3) * step + centre.min() - step
    full = np.zeros(len(grid))
    full[np.rint((centre - grid[0]) / step).astype(int)] = count / count.sum() / step
    axes.plot(grid, full, style, color=colour, lw=1.2, drawstyle="steps-mid")


def figure_3(results, folder):
    figure, axes = plt.subplots(2, 2, figsize=(9, 6), width_ratios=(3, 2))
    for alpha in ("-0.8", "2", "12"):
        name = results.longest(alpha)
        if not name:
            continue
        colour = COLOURS[alpha]
        for row, (mean, deviation, trace) in enumerate(
            (
                ("volume_mean_d3", "volume_deviation_d3", "volume_d3"),
                ("asphericity_mean", "asphericity_deviation", "asphericity"),
            )
        ):
            strain, m, s = results.columns("structure", name, "strain", mean, deviation)
            axes[row, 0].fill_between(strain, m - s, m + s, color=colour, alpha=0.25, lw=0)
            axes[row, 0].plot(strain, m, color=colour, lw=1.3, label=label(alpha))
            axes[row, 0].plot(*results.columns("traces", name, "strain", trace), "--", color=colour, lw=0.5)
            for window, style in (("early", ":"), ("late", "-")):
                histogram(results, axes[row, 1], name, ("volume", "asphericity")[row], window, style, colour)
    for k, text in enumerate(("hull volume (d^3)", "asphericity")):
        axes[k, 0].set_xlabel("strain")
        axes[k, 0].set_xscale("symlog", linthresh=1)
        axes[k, 0].set_ylabel(text)
        axes[k, 1].set_xlabel(("hull volume / undeformed", "asphericity")[k])
        axes[k, 1].set_ylabel("probability density")
        axes[k, 1].set_title(f"({'bd'[k]}) dotted: strain 2 to 4.5, solid: last fifth", fontsize=9, loc="left")
        axes[k, 0].set_title(f"({'ac'[k]})", fontsize=9, loc="left")
    axes[0, 0].legend(fontsize=8)
    save(figure, folder, "figure_3")


def window_mean(results, name, column, window):
    """Mean over the frames of a window: early or late, as in collect.py's distributions."""
    low, high = (2.0, 4.5) if window == "early" else (0.8 * results.reached(name), np.inf)
    strain, values = results.columns("structure", name, "strain", column)
    inside = (strain > low) & (strain < high)
    return values[inside].mean() if inside.any() else np.nan


def figure_4(results, folder):
    """Facets: in early shear of the grains with the most nodes, cut and smooth; in the last fifth of the longest runs."""
    nodes = "5137" if any(results.longest(alpha, "5137") for alpha in POISSON) else "300"
    sets = [
        (f"strain 2 to 4.5, {nodes} nodes", "early", -0.27, 0.4, "s", lambda alpha: results.longest(alpha, nodes)),
        ("the same, smooth", "early", 0.0, 0.7, "^", lambda alpha: results.longest(alpha, nodes, "wall")),
        ("last fifth, 300 nodes", "late", 0.27, 1.0, "o", results.longest),
    ]
    figure = plt.figure(figsize=(10, 7))
    grid = figure.add_gridspec(5, 3, width_ratios=(1.1, 1.2, 1.2))
    shares, twelve = figure.add_subplot(grid[:2, 0]), figure.add_subplot(grid[3:, 0])
    for text, window, shift, opacity, marker, choose in sets:
        for k, alpha in enumerate(COLOURS):
            name = choose(alpha)
            if not name:
                continue
            share = window_mean(results, name, "faceted_share", window)
            shares.bar(k + shift, share, 0.25, color="#4c956c", alpha=opacity)
            shares.bar(k + shift, 1 - share, 0.25, bottom=share, color="#8d6a9f", alpha=opacity)
            twelve.plot(
                POISSON[alpha],
                window_mean(results, name, "twelve_facets_share", window),
                marker,
                color=COLOURS[alpha],
                mfc="white" if marker == "s" else None,
            )
    shares.set_xticks(np.arange(5), [f"{POISSON[alpha]:g}" for alpha in COLOURS])
    shares.set_ylabel("share of the surface")
    shares.set_xlabel(r"$\nu$")
    shares.set_title(
        "(a) facets (green), curved (purple);\n"
        + "\n".join(f"{shade}: {text}" for shade, (text, *_) in zip(("light", "middle", "full"), sets)),
        fontsize=8,
        loc="left",
    )
    twelve.set_xlabel(r"$\nu$")
    twelve.set_ylabel("grains with 12 facets")
    twelve.set_ylim(0, None)
    twelve.set_title("(c) squares, triangles and circles: as light, middle and full in (a)", fontsize=8, loc="left")
    for k, alpha in enumerate(COLOURS):
        left, right = figure.add_subplot(grid[k, 1]), figure.add_subplot(grid[k, 2])
        for axes, (_, window, *_, choose), style in zip((left, left, right), sets, ("bar", "outline", "bar")):
            name = choose(alpha)
            if not name:
                continue
            centre, count = results.columns("distributions", name, "centre", "count", quantity="facets", window=window)
            ordered = 1 - window_mean(results, name, "disordered", window) > 0.5
            if len(centre) and style == "bar":
                axes.bar(centre, count / count.sum(), 0.85, color="#e76f51" if ordered else "#2a9d8f")
            elif len(centre):
                axes.step(centre, count / count.sum(), "k", where="mid", lw=1)
        for axes in (left, right):
            axes.axvline(12, color="k", lw=0.5, ls=":")
            axes.set_xlim(3.5, 55.5)
            axes.tick_params(labelsize=7)
        left.set_ylabel(label(alpha), fontsize=8)
        if k == 0:
            left.set_title(f"(b) {sets[0][0]}; line: smooth", fontsize=8, loc="left")
            right.set_title(f"{sets[2][0]}; orange: ordered", fontsize=8, loc="left")
    figure.axes[-1].set_xlabel("facets of a grain (robust rule)", fontsize=8)
    save(figure, folder, "figure_4")


def figure_s2(results, folder):
    figure, axes = plt.subplots(figsize=(5.5, 3.8))
    for alpha, colour in COLOURS.items():
        names = [
            n
            for n in results.runs(scene="shear", alpha=alpha, nodes=300, seed=1, remap="positions")
            if results.rows("early", n)
        ]
        for name in sorted(names, key=lambda n: float(results.plan[n]["rate"]))[:1]:
            strain, mu = results.columns("series", name, "strain", "mu")
            axes.plot(
                strain[strain < 5],
                mu[strain < 5],
                color=colour,
                lw=1,
                label=f"{label(alpha)}, rate {results.plan[name]['rate']}",
            )
    axes.set_ylabel(r"$\mu$")
    axes.set_xlabel(r"strain (300 nodes, $\tilde P$ = 0.1)")
    axes.legend(fontsize=7, ncols=3, loc="lower left", bbox_to_anchor=(0.0, 1.0), frameon=False)
    save(figure, folder, "figure_S2")


def figure_s3(results, folder):
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.8))
    size = main_size(results)
    for alpha, colour in COLOURS.items():
        for nodes, grains, remap, surface, style in (
            ("300", size, "positions", "", "o-"),
            ("300", size, "velocities", "", "x"),
            ("300", "256", "positions", "", "D"),
            ("300", "64", "positions", "wall", "v:"),
            ("5137", "16", "positions", "", "s"),
            ("5137", "64", "positions", "", "P"),
            ("5137", "64", "positions", "wall", "*"),
        ):
            points = {}
            for name in results.runs(
                scene="shear", alpha=alpha, nodes=nodes, grains=grains, remap=remap, surface=surface
            ):
                for row in results.rows("early", name):
                    points.setdefault(results.plan[name]["rate"], []).append(row)
            curve = []
            for rows in points.values():
                number = np.mean([float(row["inertial_number"]) for row in rows])
                mu, error = mean_of_runs([float(row["mu"]) for row in rows], float(rows[0]["mu_error"]))
                phi = np.mean([float(row["phi"] or "nan") for row in rows])
                curve.append((number, mu, error, phi))
            if curve:
                number, mu, error, phi = np.array(sorted(curve)).T
                text = f"{label(alpha)}" if style == "o-" else None
                left.errorbar(number, mu, error, fmt=style, color=colour, ms=4, lw=1, label=text)
                right.plot(number, phi, style, color=colour, ms=4, lw=1)
    left.set_ylabel(r"$\mu$ (1 < strain < 5)")
    right.set_ylabel(r"$\phi$")
    left.set_title(
        f"300 nodes: circles {size} grains (crosses: remap velocities), diamonds 256, triangles smooth grains;\n5137 nodes: squares 16 grains, plus 64, stars 64 smooth ones",
        fontsize=8,
        loc="left",
    )
    for axes in (left, right):
        axes.set_xscale("log")
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.set_xlabel("inertial number I")
    left.legend(fontsize=8)
    save(figure, folder, "figure_S3")


def order_curve(results, axis, name, **style):
    strain, disordered = results.columns("structure", name, "strain", "disordered")
    if len(strain):
        axis.plot(strain, 1 - disordered, **style)


def figure_s4(results, folder):
    figure, axes = plt.subplots(5, 1, figsize=(6, 8), sharex=True, sharey=True)
    for axis, (alpha, colour) in zip(axes, COLOURS.items()):
        blacks = iter(("0.0", "0.35", "0.55", "0.7"))
        for name in results.runs(scene="shear", alpha=alpha, nodes=300, rate="2.048e-3"):
            grains, seed = results.plan[name]["grains"], results.plan[name]["seed"]
            shade = next(blacks) if grains == "256" else "#6a0dad" if grains == "1024" else colour
            order_curve(
                results,
                axis,
                name,
                color=shade,
                lw={"27": 0.7, "1024": 2.0}.get(grains, 1.3),
                alpha=0.5 if grains == "64" and seed != "1" else 1.0,
                ls="--" if grains == "27" else "-",
                label=f"{grains} grains, seed {seed}{' (AVX-512)' if 'avx512' in name else ''}",
            )
        axis.set_ylabel(f"{label(alpha)}\nordered share", fontsize=8)
        if axis.lines:
            axis.legend(fontsize=6, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, frameon=False, borderpad=0.1)
    axes[-1].set_xlabel("strain (300 nodes per grain, rate 2.048e-3)")
    save(figure, folder, "figure_S4")


def reduction_figure(results, folder):
    """Order at nu = -0.5: one panel for each size, resolution, rate and surface, a curve for each seed."""
    kinds = {}
    for surface in ("", "wall"):
        for name in results.runs(scene="shear", alpha="12", remap="positions", surface=surface):
            row = results.plan[name]
            if results.reached(name) > 10 and row["grains"] != "27":
                kinds.setdefault((row["grains"], row["nodes"], row["rate"], surface), []).append(name)
    panels = max(len(kinds), 1)
    figure, axes = plt.subplots(panels, 1, figsize=(6, 0.6 + 1.3 * panels), sharex=True, sharey=True, squeeze=False)
    for axis, ((grains, nodes, rate, surface), names) in zip(axes[:, 0], kinds.items()):
        for name, shade in zip(names, plt.cm.inferno(np.linspace(0.15, 0.75, len(names)))):
            order_curve(results, axis, name, color=shade, lw=1.2)
        axis.set_title(f"{packing_text(grains, nodes, surface)}, rate {rate}", fontsize=8, loc="left")
        axis.set_ylabel("ordered share", fontsize=8)
    axes[-1, 0].set_xlabel("strain (nu = -0.5)")
    save(figure, folder, "reduction")


FIGURES = [
    compaction_figure,
    figure_2,
    figure_3,
    figure_4,
    figure_s1,
    figure_s2,
    figure_s3,
    figure_s4,
    reduction_figure,
]


def main(results, plan, folder):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    tables = Results(results, plan)
    for draw in FIGURES:
        draw(tables, folder)


if __name__ == "__main__":
    main(*sys.argv[1:4])
