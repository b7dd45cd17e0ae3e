# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of a run's tables and measures, one function for each; it takes the axes and a list of (label, run)."""
import numpy as np

from . import look
from .course import abscissa, compression_rows, turns_back

SHADES = (1.0, 0.75, 0.5, 0.3)


def has(run, *names):
    """True when the run has all these tables of measures, with rows in them."""
    return all(name in run.measures and len(run.measure(name).get("step", ())) > 0 for name in names)


def coloured(runs):
    """(label, run, colour) of every run, in the order of their labels as numbers; a single run needs no label."""
    ordered = sorted(runs, key=lambda pair: look.natural(pair[0]))
    alone = len(ordered) == 1
    return [("" if alone else label, run, colour) for (label, run), colour in zip(ordered, look.colours(len(ordered)))]


def _text(label, what):
    return f"{label}, {what}" if label else what


def _label(axes, x, y, title):
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.set_title(title)


def _first_and_last(run, name):
    """Step at the start of the shear (of the run, when nothing shears) and the last step."""
    table = run.measure(name)
    steps = table["step"][abscissa(run, table)[0]]
    return int(steps[0]), int(steps[-1])


def _chosen_steps(run, name, n=4):
    """First, last and some frames between them."""
    steps = run.steps(name)
    return steps[np.unique(np.linspace(0, len(steps) - 1, min(n, len(steps))).astype(int))]


def _when(run, name, step):
    """Where the run was: strain, or time when nothing shears."""
    rows = run.rows(name, step)
    if np.ptp(run.table["strain"]) > 0:
        return f"$\\gamma$ = {rows['strain'][0]:.3g}"
    return f"$t$ = {rows['time_tau'][0]:.4g} $\\tau$"


def _curve(axes, run, table, column, **how):
    rows, x, label = abscissa(run, table)
    axes.plot(x, table[column][rows], **how)
    return label


def _compaction_points(run):
    """Pressure, packing fraction and the columns' names of a run's compression."""
    table, rows = run.table, compression_rows(run)
    column = "P_normalised" if np.isfinite(table["P_normalised"][rows]).any() else "P_k/d"
    if has(run, "packing_fraction"):
        measured = run.measure("packing_fraction")
        row = {step: k for k, step in zip(rows, table["step"][rows])}
        found = [k for k, step in enumerate(measured["step"]) if step in row]
        if len(found) > 3:
            return table[column][[row[measured["step"][k]] for k in found]], measured["phi"][found], column, "phi"
    return table[column][rows], table["phi_reference"][rows], column, "phi_reference"


def compaction(axes, runs):
    """Packing fraction against pressure, with the 3/2 law fitted to its lower part."""
    for label, run, colour in coloured(runs):
        pressure, phi, column, name = _compaction_points(run)
        axes.plot(pressure, phi, "o-", ms=3, lw=1, color=colour, label=label)
        low = (pressure < 1e-2) & (pressure > 1e-4)
        if column == "P_normalised" and low.sum() >= 3:
            # P = a (phi - phi_c)^(3/2)  <=>  P^(2/3) is linear in phi.
            slope, offset = np.polyfit(phi[low], pressure[low] ** (2 / 3), 1)
            if slope > 0:
                x = np.geomspace(pressure.min(), 1e-2, 200)
                text = _text(label, f"3/2 law, $\\phi_c$ = {-offset / slope:.3f}")
                axes.plot(x, (x ** (2 / 3) - offset) / slope, "--", color=colour, lw=1, label=text)
        _label(axes, look.quantity(column, "pressure"), look.quantity(name, "packing fraction"), "compression")
    axes.set_xscale("log")
    look.legend(axes)


def structure_factor(axes, runs):
    """S(q) of the first, the last and some frames between."""
    for label, run, colour in coloured(runs):
        for step, shade in zip(_chosen_steps(run, "scattering"), SHADES):
            rows = run.rows("scattering", step)
            text = _text(label, _when(run, "scattering", step))
            axes.plot(rows["q_1/d"], rows["structure"], lw=1, color=colour, alpha=shade, label=text)
    _label(axes, look.quantity("q_1/d", "wave number"), "$S(q)$", "structure factor")
    look.legend(axes)


def form_factor(axes, runs, radius=None):
    """P_F(q), with that of a uniform ball of the undeformed volume."""
    for label, run, colour in coloured(runs):
        for step, shade in zip(_chosen_steps(run, "scattering", 3), SHADES):
            rows = run.rows("scattering", step)
            text = _text(label, _when(run, "scattering", step))
            axes.plot(rows["q_1/d"], rows["form_factor"], lw=1, color=colour, alpha=shade, label=text)
        if radius is None and has(run, "shape"):
            volume = run.measure("shape")["undeformed_volume_d3"][0]
            radius = (3 * volume / (4 * np.pi)) ** (1 / 3) if np.isfinite(volume) else None
    rows = runs[0][1].rows("scattering", runs[0][1].steps("scattering")[0])
    q = np.linspace(rows["q_1/d"].min(), rows["q_1/d"].max(), 400)
    if radius:
        x = q * radius
        ball = (3 * (np.sin(x) - x * np.cos(x)) / x**3) ** 2
        text = f"ball, $R$ = {radius:.3g} $d$"
        axes.plot(q, ball * rows["form_factor"].max() / ball[0], "k--", lw=0.8, label=text)
    axes.set_yscale("log")
    axes.set_ylim(bottom=1e-2)
    _label(axes, look.quantity("q_1/d", "wave number"), "$P_F(q)$", "form factor")
    look.legend(axes)


def stress_ratio(axes, runs):
    for label, run, colour in coloured(runs):
        name = _curve(axes, run, run.table, "mu", lw=0.9, color=colour, label=label)
    if any(turns_back(run.table["strain"]) for _, run in runs):
        axes.axhline(0.0, color="0.6", lw=0.6)
    _label(axes, name, r"stress ratio $\mu = \sigma_{xy}/P$", "stress ratio")
    look.legend(axes)


def density(axes, runs):
    """Packing fraction: of the undeformed grains' volumes, and the measured one where there is one."""
    for label, run, colour in coloured(runs):
        measured = has(run, "packing_fraction")
        text = _text(label, "undeformed volumes") if measured else label
        name = _curve(axes, run, run.table, "phi_reference", ls="--", lw=0.9, color=colour, label=text)
        if measured:
            phi = run.measure("packing_fraction")
            rows, x, _ = abscissa(run, phi)
            text = _text(label, "nodes and hulls")
            axes.errorbar(x, phi["phi"][rows], phi["phi_error"][rows], fmt="o-", ms=3, lw=1, color=colour, label=text)
    both = any(has(run, "packing_fraction") for _, run in runs)
    _label(axes, name, look.quantity("phi" if both else "phi_reference", "packing fraction"), "packing fraction")
    look.legend(axes)


def pressure(axes, runs):
    known = all(np.isfinite(run.table["P_normalised"]).any() for _, run in runs)
    column = "P_normalised" if known else "P_k/d"
    for label, run, colour in coloured(runs):
        name = _curve(axes, run, run.table, column, lw=0.9, color=colour, label=label)
    _label(axes, name, look.quantity(column, "pressure"), "pressure")
    look.legend(axes)


def press(axes, runs):
    """Force on the ends of a pressed specimen against their distance."""
    for label, run, colour in coloured(runs):
        axes.plot(run.table["end_gap_d"], run.table["end_force_kd"], lw=1, color=colour, label=label)
    axes.invert_xaxis()
    _label(axes, look.quantity("end_gap_d", "distance of the ends"), look.quantity("end_force_kd", "force"), "press")
    look.legend(axes)


def _ribbon(axes, runs, name, unit=""):
    """Mean over the grains with one standard deviation, one grain (dashed), the undeformed grain (dotted)."""
    for label, run, colour in coloured(runs):
        shape = run.measure("shape")
        rows, x, axis = abscissa(run, shape)
        y, s = shape[f"{name}_mean{unit}"][rows], shape[f"{name}_deviation{unit}"][rows]
        axes.fill_between(x, y - s, y + s, color=colour, alpha=0.2, lw=0)
        axes.plot(x, y, "-", color=colour, lw=1.2, label=label)
        traces = run.grain_traces(f"{name}{unit}")[1]
        if len(traces) == len(shape["step"]):
            axes.plot(x, traces[rows, 0], "--", color=colour, lw=0.8)
        if np.isfinite(shape[f"undeformed_{name}{unit}"][0]):
            axes.axhline(shape[f"undeformed_{name}{unit}"][0], color=colour, lw=0.6, ls=":")
    _label(axes, axis, look.quantity(f"{name}{unit}", name), f"{name}; one grain dashed, undeformed dotted")
    look.legend(axes)


def volume(axes, runs):
    _ribbon(axes, runs, "volume", "_d3")


def asphericity(axes, runs):
    _ribbon(axes, runs, "asphericity")


def _distribution(axes, runs, column, bins=25, as_share=False):
    for label, run, colour in coloured(runs):
        steps = _first_and_last(run, "grains")
        for step, style in zip(dict.fromkeys(steps), (":", "-") if steps[0] != steps[1] else ("-",)):
            counts, edges = np.histogram(run.rows("grains", step)[column], bins=bins)
            counts = counts / max(counts.sum(), 1) if as_share else counts
            text = _text(label, _when(run, "grains", step))
            axes.stairs(counts, edges, color=colour, ls=style, lw=1.2, label=text)
    look.legend(axes)


def volume_distribution(axes, runs):
    _distribution(axes, runs, "volume_d3")
    _label(axes, look.quantity("volume_d3", "volume"), "grains", "distribution of volume")


def asphericity_distribution(axes, runs):
    _distribution(axes, runs, "asphericity")
    _label(axes, look.quantity("asphericity", "asphericity"), "grains", "distribution of asphericity")


def facet_shares(axes, runs):
    """Faceted and curved share of the surface at the first and last frame, by the robust rule."""
    labels, shares, base = [], [], []
    for label, run, _ in coloured(runs):
        shape = run.measure("shape")
        for step in dict.fromkeys(_first_and_last(run, "shape")):
            k = int(np.flatnonzero(shape["step"] == step)[0])
            labels.append(_text(label, _when(run, "shape", step)).replace(", ", "\n"))
            shares.append(shape["faceted_share"][k])
            base.append(shape["undeformed_faceted_share"][k])
    x = np.arange(len(labels))
    axes.bar(x, shares, color=look.COLOURS[2], width=0.6, label="faceted")
    axes.bar(x, 1 - np.array(shares), bottom=shares, color=look.COLOURS[3], width=0.6, label="curved")
    axes.plot(x, base, "k_", ms=18, label="undeformed")
    axes.set_xticks(x, labels, fontsize=7)
    _label(axes, "", "share of the surface", "facets")
    look.legend(axes)


def facet_counts(axes, runs):
    most = max(run.measure("grains")["facets"].max() for _, run in runs)
    _distribution(axes, runs, "facets", np.arange(-0.5, max(25.0, most + 2.0)), as_share=True)
    axes.axvline(12, color="k", lw=0.5, ls="--")
    _label(axes, "facets of a grain", "share of grains", "number of facets")


def crystal_classes(axes, runs):
    for label, run, colour in coloured(runs):
        order = run.measure("order")
        # Tables written before there were templates hold the classes by bond order alone.
        prefix = "template_" if "template_fcc_share" in order else ""
        for lattice, style in (("fcc", "-"), ("hcp", "--"), ("bcc", ":")):
            text = _text(label, lattice + ("" if prefix else " (bond order)"))
            name = _curve(axes, run, order, f"{prefix}{lattice}_share", ls=style, color=colour, lw=1, label=text)
        if "solid_share" in order:
            _curve(axes, run, order, "solid_share", color=colour, lw=0.5, alpha=0.6, label=_text(label, "solid-like"))
    axes.set_ylim(-0.02, 1.02)
    _label(axes, name, "share of grains", "crystals")
    look.legend(axes)


def largest_clusters(axes, runs):
    for label, run, colour in coloured(runs):
        order = run.measure("order")
        name = _curve(axes, run, order, "largest_cluster", color=colour, lw=1, label=label)
        _curve(axes, run, order, "largest_finite_cluster", ls=":", color=colour, lw=1)
    axes.axhline(15, color="k", lw=0.5, ls="--")
    axes.set_yscale("symlog", linthresh=10)
    axes.set_ylim(bottom=0)
    _label(axes, name, "grains", "largest ordered cluster; not percolating dotted")
    look.legend(axes)


def coordination(axes, runs):
    for label, run, colour in coloured(runs):
        table = run.measure("coordination")
        name = _curve(axes, run, table, "contacts_per_grain", color=colour, lw=1, label=label)
        _curve(axes, run, table, "contacts_without_rattlers", ls="--", color=colour, lw=1)
    _label(axes, name, "contacts per grain", "coordination; without rattlers dashed")
    look.legend(axes)


def non_affine(axes, runs):
    for label, run, colour in coloured(runs):
        name = _curve(axes, run, run.measure("motion"), "non_affine_square_d2", color=colour, lw=1, label=label)
    _label(axes, name, "mean square displacement ($d^2$)", "non-affine motion")
    look.legend(axes)


def _stage_tables(run, column):
    """The tables of stages that have this column, and more than one row."""
    return [(n, t) for n, t in sorted(run.stage_tables.items()) if column in t and len(t["step"]) > 1]


def cycles(axes, runs):
    """Storage and loss modulus of each cycle of strain."""
    for label, run, colour in coloured(runs):
        for number, table in _stage_tables(run, "storage_modulus_k/d"):
            what = f"stage {number}" if len(_stage_tables(run, "storage_modulus_k/d")) > 1 else ""
            for column, marker, symbol in (("storage_modulus_k/d", "o-", "$G'$"), ("loss_modulus_k/d", "s--", "$G''$")):
                text = ", ".join(part for part in (label, what, symbol) if part)
                axes.plot(table["cycle"], table[column], marker, ms=3, lw=1, color=colour, label=text)
    _label(axes, "cycle", "modulus ($k/d$)", "moduli of the cycles")
    axes.set_ylim(bottom=0)
    axes.xaxis.get_major_locator().set_params(integer=True)
    look.legend(axes)


def cycle_return(axes, runs):
    """How far grains are from where they were a cycle before, beside the cell's motion."""
    for label, run, colour in coloured(runs):
        for number, table in _stage_tables(run, "nonaffine_d"):
            axes.plot(table["cycle"], table["nonaffine_d"], "o-", ms=3, lw=1, color=colour, label=label)
    _label(axes, "cycle", "rms displacement in a cycle ($d$)", "does the packing come back?")
    axes.set_ylim(bottom=0)
    axes.xaxis.get_major_locator().set_params(integer=True)
    look.legend(axes)


def loops(axes, runs):
    """Shear stress against shear strain where the strain goes to and fro."""
    for label, run, colour in coloured(runs):
        for number, _ in _stage_tables(run, "storage_modulus_k/d"):
            rows = run.of_stage(run.table, number)
            axes.plot(rows["strain"], rows["stress_xy_k/d"], lw=0.7, color=colour, label=label)
    _label(axes, look.quantity("strain", "strain"), "stress $\\sigma_{xy}$ ($k/d$)", "stress in cycles of strain")
    look.legend(axes)


def quasistatic(axes, runs):
    """Stress of the strained component at rest, step by step of strain."""
    for label, run, colour in coloured(runs):
        for number, table in _stage_tables(run, "largest_net_force_kd"):
            stresses = [name for name in table if name.startswith("stress_")]
            moving = max(stresses, key=lambda name: np.ptp(table[name]))
            text = _text(label, f"stage {number}") if len(run.stage_tables) > 1 else label
            axes.plot(table["strain"], table[moving], "o-", ms=3, lw=1, color=colour, label=text)
    _label(axes, look.quantity("strain", "strain"), "stress ($k/d$)", "steps of strain at rest")
    look.legend(axes)


def rheology(axes, runs, window):
    """mu (and phi) against the inertial number, one point for each run, averaged over a window of strain."""
    second = None
    for label, run, colour in coloured(runs):
        mu, error = run.average("mu", *window)
        inertial, _ = run.average("inertial_number", *window)
        axes.errorbar(inertial, mu, error, fmt="o", color=colour, ms=5, capsize=2, label=label)
        if has(run, "packing_fraction"):
            second = second or axes.twinx()
            try:
                phi, phi_error = run.average("phi", *window, name="packing_fraction")
            except ValueError:
                continue
            second.errorbar(inertial, phi, phi_error, fmt="s", mfc="none", color=colour, ms=5, capsize=2)
    axes.set_xscale("log")
    if second:
        second.spines["right"].set_visible(True)
        second.set_ylabel(look.quantity("phi", "packing fraction") + ", open squares")
    title = f"means over {window[0]:g} < $\\gamma$ < {window[1]:g}"
    _label(axes, look.quantity("inertial_number", "inertial number"), look.quantity("mu", "stress ratio"), title)
    if not second:
        look.legend(axes)


def _can_average(run, window):
    try:
        return np.isfinite(run.average("mu", *window)[0]) and run.average("inertial_number", *window)[0] > 0
    except (ValueError, KeyError):
        return False


def _varies(run, column):
    values = run.table[column][abscissa(run)[0]] if column in run.table else np.array([])
    values = values[np.isfinite(values)]
    return len(values) > 1 and np.ptp(values) > 1e-9 * max(abs(values).max(), 1e-300)


def _is_pressed(run):
    return "end_gap_d" in run.table and np.isfinite(run.table["end_gap_d"]).sum() > 1


def available(runs, window):
    """The panels that have something to show for at least one run, as (name, function of the axes)."""
    chosen = []

    def offer(name, draw, some):
        if some:
            chosen.append((name, lambda axes: draw(axes, some)))

    def with_tables(*names):
        return [(label, run) for label, run in tables if has(run, *names)]

    tables = [
        (label, run)
        for label, run in runs
        if (run.folder / "table.csv").exists() and len(run.table.get("strain", ())) > 0
    ]
    packings = [(label, run) for label, run in tables if not _is_pressed(run)]
    sheared = [(label, run) for label, run in tables if np.ptp(run.table["strain"]) > 0]
    offer("compaction", compaction, [pair for pair in packings if len(compression_rows(pair[1])) > 3])
    offer("stress_ratio", stress_ratio, [pair for pair in sheared if _varies(pair[1], "mu")])
    offer("packing_fraction", density, [pair for pair in packings if _varies(pair[1], "phi_reference")])
    offer("pressure", pressure, [pair for pair in packings if _varies(pair[1], "P_k/d")])
    offer("press", press, [pair for pair in tables if _is_pressed(pair[1])])
    cyclic = [pair for pair in tables if _stage_tables(pair[1], "storage_modulus_k/d")]
    offer("cycles", cycles, cyclic)
    offer("cycle_return", cycle_return, cyclic)
    offer("loops", loops, [pair for pair in cyclic if _varies(pair[1], "stress_xy_k/d")])
    at_rest = [pair for pair in tables if _stage_tables(pair[1], "largest_net_force_kd")]
    offer("quasistatic", quasistatic, at_rest)
    offer("structure_factor", structure_factor, with_tables("scattering"))
    offer("form_factor", form_factor, with_tables("scattering"))
    offer("volume", volume, with_tables("shape", "grains"))
    offer("volume_distribution", volume_distribution, with_tables("grains"))
    offer("asphericity", asphericity, with_tables("shape", "grains"))
    offer("asphericity_distribution", asphericity_distribution, with_tables("grains"))
    offer("facet_shares", facet_shares, with_tables("shape"))
    offer("facet_counts", facet_counts, with_tables("grains"))
    offer("crystal_classes", crystal_classes, with_tables("order"))
    clustered = [pair for pair in with_tables("order") if "largest_cluster" in pair[1].measure("order")]
    offer("largest_clusters", largest_clusters, clustered)
    offer("coordination", coordination, with_tables("coordination"))
    offer("non_affine", non_affine, with_tables("motion"))
    averaged = [pair for pair in sheared if _can_average(pair[1], window)]
    if len(averaged) > 1:
        chosen.append(("rheology", lambda axes: rheology(axes, averaged, window)))
    return chosen
