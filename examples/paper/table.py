# SPDX-License-Identifier: GPL-3.0-or-later
"""Published | Boba | difference, from the tables alone: table.py RESULTS RUNS.csv PAGE.

Replaces what stands between the markers of the page; without a page file it writes one that holds the table alone.
"""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
from boba import blocked_mean, crystallisation
from figures import GRAIN_KINDS, POISSON, Results, kind_text, mean_of_runs, packing_text

BEGIN, END = "<!-- numbers: written by examples/paper/table.py -->", "<!-- end of numbers -->"


def value_text(value, error):
    return f"{value:.3f} +- {error:.3f}" if np.isfinite(error) else f"{value:.3f}"


class Table:
    """Rows of the comparison; `published` may be a number or a text."""

    def __init__(self):
        self.lines = [
            "| what | published | Boba +- error | difference in errors | why |",
            "| --- | --- | --- | --- | --- |",
        ]

    def number(self, what, published, values, error, why):
        """`values` and `error` as in mean_of_runs."""
        if not len(values):
            self.lines.append(f"| {what} | {published:g} | not afforded | | {why} |")
            return
        mean, error = mean_of_runs(values, error)
        apart = f"{(mean - published) / error:+.0f}" if np.isfinite(error) and error > 0 else "no error known"
        runs = f" ({len(values)} runs)" if len(values) > 1 else ""
        self.lines.append(f"| {what} | {published:g} | {value_text(mean, error)}{runs} | {apart} | {why} |")

    def text(self, what, published, found, why):
        self.lines.append(f"| {what} | {published} | {found} | | {why} |")


def at_pressure(results, name, pressure):
    """phi where the compaction passes this P~, linear in log P~."""
    p, phi = results.columns("compaction", name, "P", "phi")
    order = np.argsort(p)
    if not len(p) or not p.min() <= pressure <= 1.05 * p.max():
        return None
    return float(np.interp(np.log(pressure), np.log(p[order]), phi[order]))


def power_law(p, phi):
    """phi_c from P~^(2/3) extrapolated to zero, and the exponent of P~ ~ (phi - phi_c)^b with phi_c free; None of few points."""
    if len(p) < 5:
        return None
    slope, offset = np.polyfit(p ** (2 / 3), phi, 1)
    best = (np.inf, 0.0, 0.0)
    for critical in np.linspace(phi.min() - 0.15, phi.min() - 1e-4, 600):
        x = np.log(phi - critical)
        power, constant = np.polyfit(x, np.log(p), 1)
        residual = np.sum((np.log(p) - power * x - constant) ** 2)
        best = min(best, (residual, critical, power))
    return offset, best[2]


def jamming_rows(table, results, scene, nodes, surface, low, high, why):
    """phi_c and the exponent between two pressures, from the runs of one scene and kind of grains."""
    fits = []
    for name in results.runs(scene=scene, nodes=nodes, surface=surface):
        p, phi = results.columns(scene, name, "P", "phi")
        inside = (p > low) & (p < high)
        fits.append(power_law(p[inside], phi[inside]))
    fits = [fit for fit in fits if fit]
    if not fits and (nodes, surface) != GRAIN_KINDS[0]:
        return
    kind = f"{kind_text(nodes, surface)}, {'ramp' if scene == 'compaction' else 'at rest'}"
    table.number(f"phi_c, from P~^(2/3) in {low:g} .. {high:g}, {kind}", 0.6, [f[0] for f in fits], np.nan, why)
    table.number(f"exponent of P~ against phi - phi_c (phi_c free), {kind}", 1.5, [f[1] for f in fits], np.nan, why)


def compaction_rows(table, results):
    for nodes, surface in GRAIN_KINDS:
        rough = "; rough grains touch at outer nodes while phi counts hulls" if not surface else ""
        jamming_rows(table, results, "jamming", nodes, surface, 5e-4, 1.2e-2, f"few grains{rough}")
        jamming_rows(table, results, "compaction", nodes, surface, 2e-3, 1.2e-2, f"pressure of the ramp itself{rough}")
        names = [
            n for n in results.runs(scene="compaction", nodes=nodes, surface=surface) if at_pressure(results, n, 1e-2)
        ]
        soft = [n for n in names if results.plan[n]["alpha"] == "-0.8"]
        if not soft and (nodes, surface) != GRAIN_KINDS[0]:
            continue
        for pressure, published in ((1e-2, 0.68), (0.5, 0.99)):
            values = [v for v in (at_pressure(results, n, pressure) for n in soft) if v]
            table.number(
                f"phi at P~ = {pressure:g}, nu = 0.4, {kind_text(nodes, surface)}",
                published,
                values,
                0.001,
                "resolution: contacts are soft over d/2, and R is 3.9 d instead of 10 d"
                if nodes == "300"
                else f"{results.plan[names[0]]['grains']} grains, and the ramp's rate",
            )


def early_rows(table, results):
    for alpha, published, mu in (("-0.8", 0.87, 0.17), ("12", 0.85, 0.10)):
        for nodes, surface in GRAIN_KINDS:
            slowest = [
                n
                for n in results.runs(scene="shear", alpha=alpha, nodes=nodes, remap="positions", surface=surface)
                if results.rows("early", n)
            ]
            if not slowest and (nodes, surface) != GRAIN_KINDS[0]:
                continue
            slowest = sorted(slowest, key=lambda n: (float(results.plan[n]["rate"]), -int(results.plan[n]["grains"])))
            slowest = [
                n
                for n in slowest
                if all(results.plan[n][key] == results.plan[slowest[0]][key] for key in ("rate", "grains"))
            ]
            rows = [results.rows("early", n)[0] for n in slowest]
            rate, grains = (results.plan[slowest[0]][key] if slowest else "-" for key in ("rate", "grains"))
            why = "resolution (see above) and rate" if nodes == "300" else f"{grains} grains, and the rate"
            number = f"{float(rows[0]['inertial_number']):.2g}" if rows else "-"
            nu = f"nu = {POISSON[alpha]:g}, {kind_text(nodes, surface)}"
            table.number(
                f"phi before shear, P~ = 0.1, {nu}",
                published,
                [float(r["phi_start"]) for r in rows if r["phi_start"]],
                0.0015,
                why,
            )
            table.number(
                f"phi, early shear, {nu}",
                published,
                [float(r["phi"]) for r in rows if r["phi"]],
                float(rows[0]["phi_error"] or "nan") if rows else np.nan,
                why,
            )
            table.number(
                f"mu, 1 < strain < 5, {nu}",
                mu,
                [float(r["mu"]) for r in rows],
                float(rows[0]["mu_error"]) if rows else np.nan,
                f"rate {rate} (I = {number}) instead of 1.6e-5: mu grows with I",
            )


def size_rows(table, results):
    """mu and phi of packings of several sizes, at the rates that they were sheared at."""
    for alpha, nu in POISSON.items():
        for rate in sorted(
            {row["rate"] for row in results.plan.values() if row["scene"] == "shear" and row["grains"] == "256"},
            key=float,
        ):
            found = []
            for grains in ("64", "256", "1024"):
                names = results.runs(scene="shear", alpha=alpha, nodes=300, grains=grains, rate=rate, remap="positions")
                rows = [results.rows("early", n)[0] for n in names if results.rows("early", n)]
                if rows:
                    mu = mean_of_runs([float(row["mu"]) for row in rows], float(rows[0]["mu_error"]))
                    phi = np.mean([float(row["phi"]) for row in rows])
                    found.append(f"{grains} grains: mu {value_text(*mu)}, phi {phi:.3f}")
            if len(found) > 1:
                table.text(
                    f"size of the packing, nu = {nu:g}, 300 nodes, rate {rate}", "-", "; ".join(found), "1 < strain < 5"
                )


def onset(results, name):
    """First strain from which the mean ordered share of five frames is above one half; None when that never comes."""
    strain, disordered = results.columns("structure", name, "strain", "disordered")
    if len(strain) < 5:
        return None
    mean = np.convolve(1 - disordered, np.ones(5) / 5, "valid")
    return float(strain[4:][mean > 0.5][0]) if (mean > 0.5).any() else None


def late_order(results, name):
    strain, disordered = results.columns("structure", name, "strain", "disordered")
    return float(np.mean(1 - disordered[strain > 0.8 * strain.max()]))


def judgement(results, name):
    """Whether a run crystallised by nuclei, where clusters were measured; else nothing."""
    columns = ("strain", "solid_share", "largest_finite_cluster")
    rows = [row for row in results.rows("structure", name) if row.get("solid_share")]
    if len(rows) < 5:
        return ""
    found = crystallisation({column: np.array([float(row[column]) for row in rows]) for column in columns})
    return f", largest nucleus {found.nucleus}, {'crystallised' if found.crystallised else 'not crystallised'}"


def order_rows(table, results):
    published = {"-0.8": "3 of 3 by strain 102.4", "0": "3 of 3", "2": "3 of 3", "5": "1 of 3", "12": "0 of 3"}
    long = [row for row in results.plan.values() if row["scene"] == "shear" and float(row["strain"]) > 10]
    kinds = sorted(
        {(row["surface"], row["nodes"], row["rate"], row["grains"]) for row in long},
        key=lambda kind: (kind[0], int(kind[1]), -float(kind[2]), -int(kind[3])),
    )
    for alpha, nu in POISSON.items():
        for surface, nodes, rate, grains in kinds:
            planned = results.runs(scene="shear", alpha=alpha, nodes=nodes, grains=grains, rate=rate, surface=surface)
            if not planned:
                continue
            names = [n for n in planned if results.reached(n) > 10]
            ordered = [n for n in names if late_order(results, n) > 0.5]
            detail = "; ".join(
                f"to strain {results.reached(n):.0f}: "
                + (
                    f"order from {onset(results, n):.0f}, share at the end {late_order(results, n):.2f}"
                    if onset(results, n)
                    else f"none, share at the end {late_order(results, n):.2f}"
                )
                + judgement(results, n)
                for n in names
            )
            table.text(
                f"runs that order, nu = {nu:g}, {packing_text(grains, nodes, surface)}, rate {rate}",
                published[alpha],
                f"{len(ordered)} of {len(names)} ({detail})" if names else "not afforded",
                f"{int(grains) ** (1 / 3):.0f} grains per edge (published: 10); rate {float(rate) / 1.6e-5:.0f} times the published one",
            )


def shape_rows(table, results):
    def early_mean(alpha, column):
        name = results.longest(alpha)
        if not name:
            return np.nan
        strain, v = results.columns("structure", name, "strain", column)
        return float(np.mean(v[(strain > 1) & (strain < 5)]))

    pairs = [
        ("spread of hull volumes, deviation over mean", "larger at nu = -0.5", "volume_deviation_d3", "volume_mean_d3"),
        ("asphericity - 1", "larger at nu = 0.4", "asphericity_mean", None),
        ("spread of asphericity", "larger at nu = 0.4", "asphericity_deviation", None),
    ]
    for what, published, column, over in pairs:
        a, b = (
            early_mean(alpha, column) / (early_mean(alpha, over) if over else 1.0)
            - (1.0 if column == "asphericity_mean" else 0.0)
            for alpha in ("-0.8", "12")
        )
        table.text(
            what + ", 1 < strain < 5",
            published,
            f"{a:.4f} at nu = 0.4, {b:.4f} at nu = -0.5",
            "300 nodes; the undeformed grain has asphericity 1.035",
        )
    for alpha in ("-0.8", "2", "12"):
        name = results.longest(alpha)
        if name:
            strain, values = results.columns("structure", name, "strain", "asphericity_mean")
            first = values[(strain > 1) & (strain < 10)]
            last = values[strain > 0.8 * strain.max()]
            table.text(
                f"asphericity, 1 < strain < 10 and last fifth, nu = {POISSON[alpha]:g}",
                "drops" if alpha != "12" else "no change",
                f"{first.mean():.4f} -> {last.mean():.4f}",
                "the drop comes with order",
            )
    for nodes, surface in GRAIN_KINDS:
        for alpha, nu in POISSON.items():
            name = results.longest(alpha, nodes, surface)
            if name and results.rows("distributions", name, window="early", quantity="facets"):
                centre, count = results.columns(
                    "distributions", name, "centre", "count", quantity="facets", window="early"
                )
                table.text(
                    f"facets of a grain (peak), 2 < strain < 4.5, nu = {nu:g}, {kind_text(nodes, surface)}",
                    "10 to 11",
                    f"{centre[np.argmax(count)]:.0f} (mean {np.average(centre, weights=count):.1f})",
                    "robust rule" + ("" if surface else " on cut grains: rough hulls have facets of their own"),
                )


def light_rows(table, results):
    for alpha, nu in POISSON.items():
        for surface in ("", "wall"):
            names = [n for n in results.runs(scene="light", alpha=alpha, surface=surface) if results.rows("early", n)]
            rows = [results.rows("early", n)[0] for n in names]
            if not rows:
                continue
            number, reached = float(rows[0]["inertial_number"]), rows[0]["to_strain"]
            why = f"I = {number:.2g}, to strain {reached}; {'grains relaxed in a smooth wall' if surface else 'rough grains of 300 nodes have friction'}"
            what = f"P~ = 1e-4, nu = {nu:g}, {kind_text(300, surface)}"
            table.number(
                f"nearly rigid grains, {what}: mu", 0.1, [float(r["mu"]) for r in rows], float(rows[0]["mu_error"]), why
            )
            table.number(
                "the same: phi",
                0.64,
                [float(r["phi"]) for r in rows if r["phi"]],
                float(rows[0]["phi_error"] or "nan"),
                why,
            )
            table.text(
                "the same: crystal", "none", f"share {late_order(results, names[0]):.2f} at the end", "far shorter"
            )


def slow_limit(number, mu, error):
    """mu_0 of mu = mu_0 + c I^b, its error and b: least squares weighted by the errors, the error from 400 disturbed copies."""
    powers = np.linspace(0.1, 1.0, 181)

    def fit(values):
        best = (np.inf, np.nan, np.nan)
        for power in powers:
            matrix = np.column_stack([np.ones_like(number), number**power]) / error[:, None]
            solution = np.linalg.lstsq(matrix, values / error, rcond=None)[0]
            best = min(best, (np.sum((matrix @ solution - values / error) ** 2), solution[0], power))
        return best[1:]

    generator = np.random.default_rng(1)
    disturbed = [fit(mu + error * generator.standard_normal(len(mu)))[0] for _ in range(400)]
    limit, power = fit(mu)
    return limit, np.std(disturbed), power


def rigid_rows(table, results):
    names = sorted(
        (n for n in results.runs(scene="spheres") if results.rows("early", n)),
        key=lambda n: float(results.plan[n]["rate"]),
    )
    long = [n for n in names if float(results.plan[n]["strain"]) > 5.0]
    names = [n for n in names if n not in long]
    starts = [float(results.rows("early", name)[0]["phi_start"]) for name in names[:1]]
    table.number(
        "rigid spheres: phi compressed to P~ = 1e-5, at rest", 0.64, starts, np.nan, "one packing of 216 spheres"
    )
    for name in names:
        row = results.rows("early", name)[0]
        number = float(row["inertial_number"])
        why = f"I = {number:.2g}; {results.plan[name]['grains']} spheres to strain {row['to_strain']}"
        table.number(
            f"rigid spheres, P~ = 1e-5: mu at I = {number:.2g}",
            0.1,
            [float(row["mu"])],
            float(row["mu_error"]),
            why + "; Peyneau and Roux: the limit I -> 0",
        )
        table.number(f"the same: phi at I = {number:.2g}", 0.64, [float(row["phi_reference"])], np.nan, why)
        table.text(
            "the same: crystal",
            "none (strain 1000)",
            f"share {late_order(results, name):.2f} at the end",
            "far shorter" + (f"; to strain {results.reached(long[0]):.0f} below" if long else ""),
        )
        for peer in results.peer(results.plan[name]["rate"]):
            table.text(
                f"the same: mu and phi at I = {number:.2g} in YADE",
                "-",
                f"{float(peer['mu']):.3f} +- {float(peer['mu_error']):.3f}, phi {float(peer['phi']):.3f} (at rest {float(peer['phi_start']):.3f})",
                "an independent program, same law, number, pressure and rate; velocities follow the cell",
            )
    rows = [results.rows("early", name)[0] for name in names]
    if len(rows) > 3:
        number, mu, error = (
            np.array([float(row[key]) for row in rows]) for key in ("inertial_number", "mu", "mu_error")
        )
        limit, limit_error, power = slow_limit(number, mu, error)
        table.number(
            "rigid spheres: mu for I -> 0, mu_0 + c I^b",
            0.1,
            [limit],
            limit_error,
            f"{len(rows)} rates, b = {power:.2f}",
        )
    for name in long:
        strain, mu, phi = results.columns("series", name, "strain", "mu", "phi_reference")
        frames, disordered = results.columns("structure", name, "strain", "disordered")
        mean, error = blocked_mean(mu[strain > 1.0])
        number = float(results.rows("early", name)[0]["inertial_number"])
        table.text(
            f"rigid spheres sheared at I = {number:.2g} to strain {results.reached(name):.0f}: crystal",
            "none (strain 1000)",
            f"largest share in any of {len(frames)} frames {1 - disordered.min():.3f}; mu {mean:.4f} +- {error:.4f}, phi {phi[strain > 1.0].mean():.3f}",
            f"{results.plan[name]['grains']} spheres",
        )


def total_rows(results):
    rows = [row for name in results.plan for row in results.rows("summary", name)]
    node_steps = sum(float(r["steps"]) * float(r["nodes"]) for r in rows)
    hours = sum(float(r["seconds"]) for r in rows) / 3600
    finished = sum(r["finished"] == "1" for r in rows)
    return (
        f"{len(rows)} of {len(results.plan)} planned runs begun, {finished} finished; {node_steps:.3g} node-steps in "
        f"{hours:.1f} hours of run time, all runs together."
    )


def main(results_folder, plan, page):
    results, table = Results(results_folder, plan), Table()
    for add in (compaction_rows, early_rows, size_rows, order_rows, shape_rows, light_rows, rigid_rows):
        add(table, results)
    block = "\n".join([BEGIN, "", total_rows(results), "", *table.lines, "", END])
    page = pathlib.Path(page)
    text = page.read_text() if page.exists() else f"{BEGIN}{END}\n"
    if BEGIN not in text or END not in text:
        raise SystemExit(f"{page}: the markers of the table are missing")
    page.write_text(text[: text.index(BEGIN)] + block + text[text.index(END) + len(END) :])


if __name__ == "__main__":
    main(*sys.argv[1:4])
