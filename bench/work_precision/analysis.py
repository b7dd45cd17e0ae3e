# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of finished runs against their references, each with an error bar and its processor seconds."""
import csv
import json
import pathlib
import tomllib

import axes
import numpy as np

SOURCE = pathlib.Path(__file__).resolve().parents[2]
COLUMNS = ("axis", "setting", "precision", "quantity", "error", "error_bar", "seconds", "reference", "run")
NODES = 64 * 303


def evaluate(runner, plan):
    """Rows of the table: all axes whose runs are there."""
    rows = []
    for axis in (
        step_rows,
        precision_rows,
        skin_rows,
        rate_rows,
        peer_rows,
        long_rows,
        many_body_rows,
        press_rows,
        fraction_rows,
        facet_rows,
        box_rows,
        tolerance_rows,
        specimen_rows,
    ):
        rows += axis(runner, plan)
    return rows


def write(rows, path):
    """results.csv."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(
            {key: f"{value:.6g}" if isinstance(value, float) else value for key, value in row.items()} for row in rows
        )


def row(*values):
    """One row of the table."""
    return dict(zip(COLUMNS, values))


def read(path):
    """Columns of a table: arrays of numbers, NaN where a field is empty or text."""

    def number(text):
        try:
            return float(text)
        except ValueError:
            return np.nan

    with open(path, encoding="utf-8") as file:
        lines = list(csv.DictReader(file))
    return {key: np.array([number(line[key]) for line in lines]) for key in lines[0]}


def done(runner, run):
    """Record of a run that ended well, or None."""
    record = runner.record(run.name)
    return record if record and record["exit_code"] == 0 else None


def curve(runner, run):
    """The shear stage of a packing's table: strain, P, mu, kinetic energy, volume."""
    if not done(runner, run):
        return None
    table = read(runner.place(run.name) / "result/table.csv")
    keep = np.append(np.diff(table["strain"]) > 0, True)
    return {
        "strain": table["strain"][keep],
        "P": table["P_k/d"][keep],
        "mu": table["mu"][keep],
        "kinetic": table["kinetic_energy_kd2"][keep],
        "volume": (table["Lx_d"] * table["Ly_d"] * table["Lz_d"])[keep],
    }


def blocks(values, count):
    """Mean, and its standard error from so many blocks."""
    means = [part.mean() for part in np.array_split(values, count)]
    return float(np.mean(values)), float(np.std(means, ddof=1) / np.sqrt(count))


def root_mean_square(values, count=5):
    """Root mean square, and its standard error from blocks."""
    mean, error = blocks(values**2, count)
    return float(np.sqrt(mean)), float(error / (2 * np.sqrt(mean))) if mean > 0 else 0.0


def difference(one, other, quantity, first, last):
    """one - other at equal strains in a window; relative for all but mu."""
    strain = np.linspace(first, last, 101)[1:]
    a, b = (np.interp(strain, x["strain"], x[quantity]) for x in (one, other))
    return a - b if quantity == "mu" else (a - b) / np.mean(b)


def path_rows(runner, axis, setting, run, reference, last, precision="double", first=0.0):
    """Root-mean-square distance from the reference's path up to a small strain (from `first`), and the mean distance after it."""
    record, one, other = runner.record(run.name), curve(runner, run), curve(runner, reference)
    if record and record["exit_code"] != 0:
        return [row(axis, setting, precision, "failed", record["exit_code"], "", record["cpu_seconds"], "", run.name)]
    if one is None or other is None or run.name == reference.name:
        return []
    rows = []
    early = min(0.05, last / 4)
    for quantity in ("P", "mu"):
        near = root_mean_square(difference(one, other, quantity, first, early))
        far = blocks(difference(one, other, quantity, early * 2, last), 6)
        for name, (error, bar) in (
            (f"{quantity}, path to strain {early:g}", near),
            (f"{quantity}, mean from strain {2 * early:g}", far),
        ):
            rows.append(
                row(axis, setting, precision, name, error, bar, record["cpu_seconds"], reference.name, run.name)
            )
    return rows


def step_rows(runner, plan):
    """Time step in double and mixed, against the smallest step in double."""
    reference = axes.packing(min(plan.steps), strain=plan.strain)
    rows = []
    for precision, steps in (("double", plan.steps), ("mixed", plan.mixed_steps)):
        for dt in steps:
            rows += path_rows(
                runner,
                "time step",
                dt,
                axes.packing(dt, precision, strain=plan.strain),
                reference,
                plan.strain,
                precision,
            )
    return rows


def precision_rows(runner, plan):
    """Mixed against double at the same step or rate, and over the long run."""
    cases = [(f"dt {dt:g}", {"dt": dt, "strain": plan.strain}) for dt in plan.mixed_steps]
    cases += [(f"rate {rate:g}", {"rate": rate, "strain": plan.rate_strain}) for rate in plan.mixed_rates]
    cases += [(f"strain {plan.long_strain:g}", {"strain": plan.long_strain})]
    return [
        r
        for setting, values in cases
        for r in path_rows(
            runner,
            "precision",
            setting,
            axes.packing(precision="mixed", **values),
            axes.packing(**values),
            values["strain"],
            "mixed",
        )
    ]


def skin_rows(runner, plan):
    """Skin, against the default: the skin must not change the path, so what is left is its cost."""
    reference = axes.packing(strain=plan.strain)
    return [
        r
        for skin in plan.skins
        for r in path_rows(runner, "skin", skin, axes.packing(skin=skin, strain=plan.strain), reference, plan.strain)
        + cost_row(runner, "skin", skin, axes.packing(skin=skin, strain=plan.strain))
    ]


def cost_row(runner, axis, setting, run):
    """Seconds alone, for the reference and all others."""
    record = done(runner, run)
    return [row(axis, setting, "double", "cost", 0.0, "", record["cpu_seconds"], "", run.name)] if record else []


def rate_rows(runner, plan):
    """Shear rate, against the slowest that is there in double."""
    rates = [rate for rate in plan.rates if done(runner, axes.packing(rate=rate, strain=plan.rate_strain))]
    if len(rates) < 2:
        return []
    reference = curve(runner, axes.packing(rate=min(rates), strain=plan.rate_strain))
    rows = []
    for precision, values in (("double", plan.rates), ("mixed", plan.mixed_rates)):
        for rate in values:
            run = axes.packing(rate=rate, precision=precision, strain=plan.rate_strain)
            record, one = done(runner, run), curve(runner, run)
            if one is None:
                continue
            for quantity in () if rate == min(rates) else ("P", "mu"):
                error, bar = blocks(difference(one, reference, quantity, plan.rate_strain / 5, plan.rate_strain), 5)
                rows.append(
                    row(
                        "shear rate",
                        rate,
                        precision,
                        f"{quantity}, mean",
                        error,
                        bar,
                        record["cpu_seconds"],
                        f"rate {min(rates):g}",
                        run.name,
                    )
                )
            kinetic = one["kinetic"][one["strain"] > plan.rate_strain / 5]
            rows.append(
                row(
                    "shear rate",
                    rate,
                    precision,
                    "kinetic energy",
                    *blocks(kinetic, 5),
                    record["cpu_seconds"],
                    "none: the value",
                    run.name,
                )
            )
    return rows


def peer_rows(runner, plan):
    """Runs at held pressure and LAMMPS's recorded one, against the engine's smallest step."""
    reference = curve(runner, axes.packing(min(plan.steps), held=True))
    if reference is None:
        return []
    peer = json.loads((SOURCE / "bench/work_precision/peer.json").read_text())
    recorded = read(SOURCE / "tests/data/packing64/shear_a0.csv")
    recorded["volume"] = recorded["vol"]
    seconds = recorded["step"][-1] * NODES * 1e-9 * peer["nanoseconds_per_node_step"]["alpha 0, many-body pass off"][0]
    found = [("LAMMPS, recorded", "double", recorded, float(seconds), "tests/data/packing64/shear_a0.csv")]
    for precision in ("double", "mixed"):
        run = axes.packing(precision=precision, held=True)
        if done(runner, run):
            found.append(
                ("engine, dt 0.1", precision, curve(runner, run), runner.record(run.name)["cpu_seconds"], run.name)
            )
    return [
        row(
            "peer",
            setting,
            precision,
            f"{quantity}, path to strain 0.1",
            *root_mean_square(difference(one, reference, quantity, 0, 0.1)),
            cost,
            "engine, smallest dt",
            name,
        )
        for setting, precision, one, cost, name in found
        for quantity in ("P", "mu", "volume")
    ]


def long_rows(runner, plan):
    """Means of long runs in double and mixed, with block errors: values, not differences."""
    return [
        r
        for precision in ("double", "mixed")
        for r in mean_rows(
            runner,
            plan,
            "long run",
            plan.long_strain,
            axes.packing(strain=plan.long_strain, precision=precision),
            precision,
        )
    ]


def mean_rows(runner, plan, axis, setting, run, precision):
    """Means of one long run."""
    one = curve(runner, run)
    if one is None:
        return []
    late = one["strain"] > plan.long_strain / 10
    return [
        row(
            axis,
            setting,
            precision,
            f"{quantity}, value",
            *blocks(one[quantity][late], 9),
            done(runner, run)["cpu_seconds"],
            "none: the value",
            run.name,
        )
        for quantity in ("P", "mu", "kinetic")
    ]


def many_body_rows(runner, plan):
    """Time step and precision at other alphas. The state was at rest at alpha = 0: how it finds its new pressure is left out."""
    rows = []
    start = min(0.01, plan.strain / 8)
    for alpha in plan.alphas:

        def run(**values):
            return axes.packing(alpha=alpha, **values)

        reference, default = run(dt=min(plan.alpha_steps), strain=plan.strain), run(strain=plan.strain)
        for dt in plan.alpha_steps:
            rows += path_rows(
                runner,
                f"time step, alpha {alpha:g}",
                dt,
                run(dt=dt, strain=plan.strain),
                reference,
                plan.strain,
                first=start,
            )
        rows += cost_row(runner, f"time step, alpha {alpha:g}", min(plan.alpha_steps), reference)
        rows += path_rows(
            runner,
            f"precision, alpha {alpha:g}",
            f"dt {axes.STEP:g}",
            run(precision="mixed", strain=plan.strain),
            default,
            plan.strain,
            "mixed",
            start,
        )
        for dt in plan.twin_steps[alpha]:
            for precision in ("double", "mixed"):
                rows += mean_rows(
                    runner,
                    plan,
                    f"long run, alpha {alpha:g}",
                    f"dt {dt:g}",
                    run(dt=dt, precision=precision, strain=plan.long_strain),
                    precision,
                )
    return rows


def force(runner, run):
    """Shortening over height and force of a pressed sphere; force over its squared half height."""
    if not done(runner, run):
        return None
    table = read(runner.place(run.name) / "result/table.csv")
    at = table["end_gap_d"] > 0
    gap, height = table["end_gap_d"][at], table["end_gap_d"][at].max()
    return 1 - gap / height, table["end_force_kd"][at] / (height / 2) ** 2


def force_error(runner, run, reference):
    """Root-mean-square relative difference of the force between shortenings of 3 and 5.8 %."""
    one, other = force(runner, run), force(runner, reference)
    at = np.linspace(0.03, 0.058, 57)
    a, b = (np.interp(at, *x) for x in (one, other))
    return root_mean_square(a / b - 1)


def press_rows(runner, plan):
    """Force of a pressed sphere: time step and precision, and speed of the walls."""
    cases = [
        ("specimen, time step", dt, p, axes.press(dt, p), axes.press(min(plan.press_steps)))
        for p in ("double", "mixed")
        for dt in plan.press_steps
    ]
    slowest = min((v for v in plan.velocities if done(runner, axes.press(velocity=v))), default=plan.velocities[-1])
    cases += [
        ("specimen, wall speed", v, "double", axes.press(velocity=v), axes.press(velocity=slowest))
        for v in plan.velocities
    ]
    rows = []
    for axis, setting, precision, run, reference in cases:
        if done(runner, run) and done(runner, reference) and run.name != reference.name:
            error, bar = force_error(runner, run, reference)
            rows.append(
                row(
                    axis,
                    setting,
                    precision,
                    "force",
                    error,
                    bar,
                    runner.record(run.name)["cpu_seconds"],
                    reference.name,
                    run.name,
                )
            )
        elif runner.record(run.name) and not done(runner, run):
            rows.append(
                row(
                    axis,
                    setting,
                    precision,
                    "failed",
                    runner.record(run.name)["exit_code"],
                    "",
                    runner.record(run.name)["cpu_seconds"],
                    "",
                    run.name,
                )
            )
    return rows


def fraction_rows(runner, plan):
    """Packing fraction against random points: root mean square over seeds."""

    def value(points, seed):
        run = axes.fraction(points, seed)
        if not done(runner, run):
            return None
        return (
            read(runner.place(run.name) / "result/packing_fraction.csv")["phi"][-1],
            runner.record(run.name)["cpu_seconds"],
        )

    reference = value(plan.reference_points, 99)
    rows = []
    for points in plan.points if reference else ():
        found = [x for x in (value(points, seed) for seed in plan.point_seeds) if x]
        if found:
            error = float(np.sqrt(np.mean([(phi - reference[0]) ** 2 for phi, _ in found])))
            rows.append(
                row(
                    "random points",
                    points,
                    "double",
                    "phi",
                    error,
                    error / np.sqrt(2 * len(found)),
                    float(np.mean([s for _, s in found])),
                    f"{plan.reference_points} points",
                    f"{len(found)} seeds",
                )
            )
    return rows


def facet_rows(runner, plan):
    """Faceted share against the hull's threshold: a definition, so the difference from the default and not an error."""

    def value(cosine):
        run = axes.facets(cosine, 0.01)
        return read(runner.place(run.name) / "result/shape.csv") if done(runner, run) else None

    default = value(0.99)
    rows = []
    for cosine in plan.cosines if default else ():
        found = value(cosine)
        if found:
            for name in (n for n in found if n in ("faceted_share", "facets_mean")):
                rows.append(
                    row(
                        "hull threshold",
                        cosine,
                        "double",
                        name + " minus default's",
                        float(found[name][-1] - default[name][-1]),
                        "",
                        runner.record(axes.facets(cosine, 0.01).name)["cpu_seconds"],
                        f"{default[name][-1]:.4g} at 0.99",
                        axes.facets(cosine, 0.01).name,
                    )
                )
    return rows


def constants(entry):
    """E and nu of each box of a table's entry, from K and G."""
    bulk, shear = (np.array([s[key] for s in entry["samples"]]) for key in ("bulk", "shear"))
    return {"E": 9 * bulk * shear / (3 * bulk + shear), "nu": (3 * bulk - 2 * shear) / (6 * bulk + 2 * shear)}


def boxes(runner, run):
    """Entries of a table by alpha, or None."""
    if not done(runner, run):
        return None
    return {
        entry["alpha"]: constants(entry)
        for entry in json.loads((runner.place(run.name) / "result/table.json").read_text())["entries"]
    }


def box_rows(runner, plan):
    """E and nu against nodes of the box: mean over boxes minus the installed table, which other boxes made."""
    installed = {e["alpha"]: e for e in tomllib.loads((SOURCE / "calibration/table.toml").read_text())["entry"]}
    rows = []
    scatter = {}  # of one box times the root of its nodes, for a size of which there is one box
    for nodes, seeds in plan.boxes.items():
        run = axes.table(nodes, seeds)
        for alpha, found in (boxes(runner, run) or {}).items():
            for name, key, scale in (("E", "young", installed[alpha]["young"]), ("nu", "poisson", 1)):
                values = (found[name] - installed[alpha][key]) / scale
                if seeds > 1:
                    scatter[alpha, name] = np.std(values, ddof=1) * np.sqrt(nodes)
                own = scatter.get((alpha, name), np.nan) / np.sqrt(nodes * seeds)
                bar = np.hypot(own, installed[alpha].get(key + "_error", 0) / scale)
                rows.append(
                    row(
                        "nodes of the box",
                        nodes,
                        "double",
                        f"{name}, alpha {alpha:g}",
                        float(values.mean()),
                        float(bar),
                        runner.record(run.name)["cpu_seconds"] / seeds,
                        "installed table",
                        run.name,
                    )
                )
    return rows


def tolerance_rows(runner, plan):
    """E and nu against the residual of the solves, same boxes, against the smallest residual."""
    reference = boxes(runner, axes.table(*plan.tolerance_box, min(plan.tolerances)))
    rows = []
    for tolerance in plan.tolerances if reference else ():
        run = axes.table(*plan.tolerance_box, tolerance)
        if tolerance == min(plan.tolerances) or not done(runner, run):
            continue
        for name in ("E", "nu"):
            gap = boxes(runner, run)[2.0][name] - reference[2.0][name]
            error = float(np.sqrt(np.mean((gap / (reference[2.0]["E"] if name == "E" else 1)) ** 2)))
            rows.append(
                row(
                    "residual of the solves",
                    tolerance,
                    "double",
                    f"{name}, alpha 2",
                    error,
                    error / np.sqrt(2 * len(gap)),
                    runner.record(run.name)["cpu_seconds"],
                    f"residual {min(plan.tolerances):g}",
                    run.name,
                )
            )
    return rows


def specimen_rows(runner, plan):
    """E and nu of cylinders over those of the network they were cut from."""
    run = axes.specimen(plan.radii)
    if not done(runner, run):
        return []
    table = read(runner.place(run.name) / "result/specimen.csv")
    rows = []
    for i, nodes in enumerate(table["nodes"]):
        E, nu = table["network_young"][i], table["network_poisson"][i]
        for name, error, bar in (
            ("E", table["young"][i] / E - 1, table["young_error"][i] / E),
            ("nu", table["poisson"][i] - nu, table["poisson_error"][i]),
        ):
            rows.append(
                row(
                    "cylinder, nodes",
                    int(nodes),
                    "double",
                    name,
                    float(error),
                    float(bar),
                    float(table["seconds"][i]),
                    "periodic network",
                    run.name,
                )
            )
    return rows
