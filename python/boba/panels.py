# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of a run's measures, one function a panel; each takes the axes and a list of (label, run)."""
import numpy as np

COLOURS = ["#1b6ca8", "#d1495b", "#3c8d5a", "#8a5aa8", "#d98e04", "#5c6770"]


def has(run, *names):
    """True when the run has all these tables of measures, with rows in them."""
    return all(name in run.measures and len(run.measure(name).get("step", ())) > 0 for name in names)


def _label(axes, x, y, title):
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.set_title(title, fontsize=10, loc="left")


def _abscissa(table):
    """Strain from the start of the shear, or time when nothing shears."""
    if np.ptp(table["strain"]) > 0:
        shears = np.flatnonzero(np.diff(table["strain"]) != 0)
        return slice(max(shears[0], 0), None), "strain", "strain"
    return slice(None), "time_tau", "time (tau)"


def _first_and_last(run, name):
    """Step at the start of the shear (of the run, when nothing shears) and the last step."""
    table = run.measure(name)
    rows = _abscissa(table)[0]
    return int(table["step"][rows][0]), int(table["step"][-1])


def _chosen_steps(run, name, n=4):
    """First, last and some frames between them."""
    steps = run.steps(name)
    return steps[np.unique(np.linspace(0, len(steps) - 1, min(n, len(steps))).astype(int))]


def _when(run, name, step):
    """Where the run was: strain, or time when nothing shears."""
    rows = run.rows(name, step)
    sheared = np.ptp(run.measure(name)["strain"]) > 0
    return f"strain {rows['strain'][0]:.3g}" if sheared else f"time {rows['time_tau'][0]:.4g}"


def compaction(axes, runs):
    """Packing fraction against normalised pressure, with the 3/2 law fitted to its lower part."""
    for (label, run), colour in zip(runs, COLOURS):
        table = {name: values[: _abscissa(run.table)[0].start or None] for name, values in run.table.items()}
        phi, name = table["phi_reference"], "phi of the undeformed grains"
        pressure = table["P_normalised"]
        if not np.isfinite(pressure).any():
            pressure = table["P_k/d"]
        if has(run, "packing_fraction"):
            measured = run.measure("packing_fraction")
            row = {step: k for k, step in enumerate(table["step"])}
            found = [k for k, step in enumerate(measured["step"]) if step in row and pressure[row[step]] > 0]
            if len(found) > 3:
                phi, name = measured["phi"][found], "phi"
                pressure = pressure[[row[measured["step"][k]] for k in found]]
        good = (pressure > 0) & np.isfinite(phi)
        if good.sum() < 2:
            continue
        axes.plot(pressure[good], phi[good], "o-", ms=3, lw=1, color=colour, label=label)
        low = good & (pressure < 1e-2) & (pressure > 1e-4)
        if low.sum() >= 3:
            # P = a (phi - phi_c)^(3/2)  <=>  P^(2/3) is linear in phi.
            slope, offset = np.polyfit(phi[low], pressure[low] ** (2 / 3), 1)
            if slope > 0:
                x = np.geomspace(pressure[good].min(), 1e-1, 200)
                x = x[(x ** (2 / 3) - offset) / slope < phi[good].max()]
                axes.plot(
                    x,
                    (x ** (2 / 3) - offset) / slope,
                    "--",
                    color=colour,
                    lw=1,
                    label=f"3/2 law, phi_c = {-offset / slope:.3f}",
                )
        _label(axes, "normalised pressure", name, "compaction")
    axes.set_xscale("log")
    axes.legend(fontsize=7)


def structure_factor(axes, runs):
    """S(q) of the first, the last and some frames between."""
    for k, (label, run) in enumerate(runs):
        for step, shade in zip(_chosen_steps(run, "scattering"), (1.0, 0.75, 0.5, 0.3)):
            rows = run.rows("scattering", step)
            axes.plot(
                rows["q_1/d"],
                rows["structure"],
                lw=1,
                color=COLOURS[k % 6],
                alpha=shade,
                label=f"{label} {_when(run, 'scattering', step)}",
            )
    _label(axes, "q (1/d)", "S(q)", "structure factor")
    axes.legend(fontsize=7)


def form_factor(axes, runs, radius=None):
    """P_F(q), with that of a uniform ball of the undeformed volume."""
    for k, (label, run) in enumerate(runs):
        for step, shade in zip(_chosen_steps(run, "scattering", 3), (1.0, 0.6, 0.35)):
            rows = run.rows("scattering", step)
            axes.plot(
                rows["q_1/d"],
                rows["form_factor"],
                lw=1,
                color=COLOURS[k % 6],
                alpha=shade,
                label=f"{label} {_when(run, 'scattering', step)}",
            )
        if radius is None and has(run, "shape"):
            volume = run.measure("shape")["undeformed_volume_d3"][0]
            radius = (3 * volume / (4 * np.pi)) ** (1 / 3) if np.isfinite(volume) else None
    rows = run.rows("scattering", run.steps("scattering")[0])
    q = np.linspace(rows["q_1/d"].min(), rows["q_1/d"].max(), 400)
    if radius:
        x = q * radius
        ball = (3 * (np.sin(x) - x * np.cos(x)) / x**3) ** 2
        axes.plot(q, ball * rows["form_factor"].max() / ball[0], "k--", lw=0.8, label=f"ball of radius {radius:.3g} d")
    axes.set_yscale("log")
    axes.set_ylim(bottom=1e-2)
    _label(axes, "q (1/d)", "P_F(q)", "form factor")
    axes.legend(fontsize=7)


def stress_ratio(axes, runs):
    for (label, run), colour in zip(runs, COLOURS):
        rows = _abscissa(run.table)[0]
        axes.plot(run.table["strain"][rows], run.table["mu"][rows], lw=0.8, color=colour, label=label)
    _label(axes, "strain", "mu", "stress ratio")
    axes.legend(fontsize=7)


def density(axes, runs):
    """Packing fraction: of the undeformed grains' volumes, and the measured one where there is one."""
    for (label, run), colour in zip(runs, COLOURS):
        rows, column, name = _abscissa(run.table)
        axes.plot(
            run.table[column][rows],
            run.table["phi_reference"][rows],
            "--",
            lw=0.8,
            color=colour,
            label=f"{label}: undeformed volumes",
        )
        if has(run, "packing_fraction"):
            phi = run.measure("packing_fraction")
            inside = phi["step"] >= run.table["step"][rows].min()
            axes.errorbar(
                phi[column][inside],
                phi["phi"][inside],
                phi["phi_error"][inside],
                fmt="o-",
                ms=3,
                lw=1,
                color=colour,
                label=f"{label}: nodes and hulls",
            )
        _label(axes, name, "phi", "packing fraction")
    axes.legend(fontsize=7)


def pressure(axes, runs):
    for (label, run), colour in zip(runs, COLOURS):
        rows, column, name = _abscissa(run.table)
        known = np.isfinite(run.table["P_normalised"]).any()
        axes.plot(
            run.table[column][rows],
            run.table["P_normalised" if known else "P_k/d"][rows],
            lw=0.8,
            color=colour,
            label=label,
        )
        _label(axes, name, "normalised pressure" if known else "P (k/d)", "pressure")
    axes.legend(fontsize=7)


def _ribbon(axes, runs, mean, deviation, trace, undeformed):
    for (label, run), colour in zip(runs, COLOURS):
        shape = run.measure("shape")
        rows, column, name = _abscissa(shape)
        x, y, s = (shape[key][rows] for key in (column, mean, deviation))
        axes.fill_between(x, y - s, y + s, color=colour, alpha=0.2, lw=0)
        axes.plot(x, y, "-", color=colour, lw=1.2, label=label)
        axes.plot(x, run.grain_traces(trace)[1][rows, 0], "--", color=colour, lw=0.8)
        axes.set_xlabel(name)
        if np.isfinite(shape[undeformed][0]):
            axes.axhline(shape[undeformed][0], color=colour, lw=0.6, ls=":")
    axes.legend(fontsize=7)


def volume(axes, runs):
    """Mean grain volume: ribbon one standard deviation, dashed one grain, dotted undeformed."""
    _ribbon(axes, runs, "volume_mean_d3", "volume_deviation_d3", "volume_d3", "undeformed_volume_d3")
    _label(axes, axes.get_xlabel(), "grain volume (d^3)", "volume (dashed: one grain, dotted: undeformed)")


def asphericity(axes, runs):
    _ribbon(axes, runs, "asphericity_mean", "asphericity_deviation", "asphericity", "undeformed_asphericity")
    _label(axes, axes.get_xlabel(), "asphericity", "asphericity (dashed: one grain, dotted: undeformed)")


def _distribution(axes, runs, column, bins=25):
    for (label, run), colour in zip(runs, COLOURS):
        steps = _first_and_last(run, "grains")
        for step, style in zip(steps, (":", "-")):
            values = run.rows("grains", step)[column]
            counts, edges = np.histogram(values, bins=bins)
            axes.stairs(counts, edges, color=colour, ls=style, lw=1.2, label=f"{label} {_when(run, 'grains', step)}")
            if steps[0] == steps[-1]:
                break
    axes.legend(fontsize=7)


def volume_distribution(axes, runs):
    _distribution(axes, runs, "volume_d3")
    _label(axes, "grain volume (d^3)", "grains", "distribution of volume")


def asphericity_distribution(axes, runs):
    _distribution(axes, runs, "asphericity")
    _label(axes, "asphericity", "grains", "distribution of asphericity")


def facet_shares(axes, runs):
    """Faceted and curved share of the surface at the first and last frame, by the robust rule."""
    labels, shares, base = [], [], []
    for label, run in runs:
        shape = run.measure("shape")
        for k in sorted({_abscissa(shape)[0].start or 0, len(shape["step"]) - 1}):
            labels.append(f"{label}\n{_when(run, 'shape', shape['step'][k])}")
            shares.append(shape["faceted_share"][k])
            base.append(shape["undeformed_faceted_share"][k])
    x = np.arange(len(labels))
    axes.bar(x, shares, color="#3c8d5a", width=0.6, label="faceted")
    axes.bar(x, 1 - np.array(shares), bottom=shares, color="#8a5aa8", width=0.6, label="curved")
    axes.plot(x, base, "k_", ms=18, label="undeformed grain")
    axes.set_xticks(x, labels, fontsize=7)
    _label(axes, "", "share of surface", "facets (seed rule, at least 1 % of the area)")
    axes.legend(fontsize=7)


def facet_counts(axes, runs):
    most = max(run.measure("grains")["facets"].max() for _, run in runs)
    bins = np.arange(-0.5, max(25.0, most + 2.0))
    for (label, run), colour in zip(runs, COLOURS):
        steps = _first_and_last(run, "grains")
        for step, style in zip(steps, (":", "-")):
            counts, edges = np.histogram(run.rows("grains", step)["facets"], bins=bins)
            axes.stairs(
                counts / max(counts.sum(), 1),
                edges,
                color=colour,
                ls=style,
                lw=1.2,
                label=f"{label} {_when(run, 'grains', step)}",
            )
            if steps[0] == steps[-1]:
                break
    axes.axvline(12, color="k", lw=0.5, ls="--")
    _label(axes, "facets", "share of grains", "number of facets")
    axes.legend(fontsize=7)


def crystal_classes(axes, runs):
    for (label, run), colour in zip(runs, COLOURS):
        order = run.measure("order")
        rows, x, name = _abscissa(order)
        # Tables written before there were templates hold the classes by bond order alone.
        prefix = "template_" if "template_fcc_share" in order else ""
        for lattice, style in (("fcc", "-"), ("hcp", "--"), ("bcc", ":")):
            axes.plot(
                order[x][rows],
                order[f"{prefix}{lattice}_share"][rows],
                style,
                color=colour,
                lw=1,
                label=f"{label} {lattice}" + ("" if prefix else " (bond order)"),
            )
        if "solid_share" in order:
            axes.plot(
                order[x][rows],
                order["solid_share"][rows],
                color=colour,
                lw=0.5,
                alpha=0.6,
                label=f"{label} 7 solid bonds",
            )
    axes.set_ylim(-0.02, 1.02)
    _label(axes, name, "share of grains", "crystals (template matching)")
    axes.legend(fontsize=7)


def largest_clusters(axes, runs):
    for (label, run), colour in zip(runs, COLOURS):
        order = run.measure("order")
        rows, x, name = _abscissa(order)
        axes.plot(order[x][rows], order["largest_cluster"][rows], color=colour, lw=1, label=label)
        axes.plot(order[x][rows], order["largest_finite_cluster"][rows], ":", color=colour, lw=1)
    axes.axhline(15, color="k", lw=0.5, ls="--")
    axes.set_yscale("symlog", linthresh=10)
    axes.set_ylim(bottom=0)
    _label(axes, name, "grains", "largest cluster of ordered grains (dotted: not percolating)")
    axes.legend(fontsize=7)


def coordination(axes, runs):
    for (label, run), colour in zip(runs, COLOURS):
        table = run.measure("coordination")
        rows, x, name = _abscissa(table)
        axes.plot(table[x][rows], table["contacts_per_grain"][rows], color=colour, lw=1, label=label)
        axes.plot(table[x][rows], table["contacts_without_rattlers"][rows], "--", color=colour, lw=1)
    _label(axes, name, "contacts a grain", "coordination (dashed: without rattlers)")
    axes.legend(fontsize=7)


def non_affine(axes, runs):
    for (label, run), colour in zip(runs, COLOURS):
        table = run.measure("motion")
        rows, x, name = _abscissa(table)
        axes.plot(table[x][rows], table["non_affine_square_d2"][rows], color=colour, lw=1, label=label)
    _label(axes, name, "mean square displacement (d^2)", "non-affine motion")
    axes.legend(fontsize=7)


def rheology(axes, runs, window):
    """mu (and phi) against the inertial number, one point a run, averaged over a window of strain."""
    second = axes.twinx()
    for (label, run), colour in zip(runs, COLOURS * 3):
        try:
            mu, error = run.average("mu", *window)
            inertial, _ = run.average("inertial_number", *window)
        except ValueError:
            continue
        axes.errorbar(inertial, mu, error, fmt="o", color=colour, ms=5, capsize=2, label=label)
        if has(run, "packing_fraction"):
            phi, phi_error = run.average("phi", *window, name="packing_fraction")
            second.errorbar(inertial, phi, phi_error, fmt="s", mfc="none", color=colour, ms=5, capsize=2)
    axes.set_xscale("log")
    second.set_ylabel("phi (open)")
    _label(axes, "inertial number I", "mu", f"rheology, mean over {window[0]:g} < strain < {window[1]:g}")
    axes.legend(fontsize=7)


def available(runs, window):
    """The panels whose data at least one run has, as (name, function of the axes)."""

    def with_tables(*names):
        return [(label, run) for label, run in runs if has(run, *names)]

    chosen = []

    def offer(name, draw, some):
        if some:
            chosen.append((name, lambda axes: draw(axes, some)))

    tables = [
        (label, run)
        for label, run in runs
        if (run.folder / "table.csv").exists() and len(run.table.get("strain", ())) > 0
    ]
    sheared = [(label, run) for label, run in tables if np.ptp(run.table["strain"]) > 0]
    compressed = [(label, run) for label, run in tables if np.ptp(run.table["phi_reference"]) > 0.02]
    offer("compaction", compaction, compressed)
    offer("stress_ratio", stress_ratio, sheared)
    offer("packing_fraction", density, tables)
    offer("pressure", pressure, tables)
    offer("structure_factor", structure_factor, with_tables("scattering"))
    offer("form_factor", form_factor, with_tables("scattering"))
    offer("volume", volume, with_tables("shape", "grains"))
    offer("volume_distribution", volume_distribution, with_tables("grains"))
    offer("asphericity", asphericity, with_tables("shape", "grains"))
    offer("asphericity_distribution", asphericity_distribution, with_tables("grains"))
    offer("facet_shares", facet_shares, with_tables("shape"))
    offer("facet_counts", facet_counts, with_tables("grains"))
    offer("crystal_classes", crystal_classes, with_tables("order"))
    offer(
        "largest_clusters",
        largest_clusters,
        [(label, run) for label, run in with_tables("order") if "largest_cluster" in run.measure("order")],
    )
    offer("coordination", coordination, with_tables("coordination"))
    offer("non_affine", non_affine, with_tables("motion"))
    inside = [
        (label, run)
        for label, run in sheared
        if ((run.table["strain"] > window[0]) & (run.table["strain"] < window[1])).sum() > 1
    ]
    if inside:
        chosen.append(("rheology", lambda axes: rheology(axes, inside, window)))
    return chosen
