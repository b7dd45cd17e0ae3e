# SPDX-License-Identifier: GPL-3.0-or-later
"""Reduces run folders to the small tables in results/: collect.py RUNS.csv OUT RESULTS.

Every run of RUNS.csv that has a folder OUT/NAME goes in, as far as it has come; the tables of a run that has no folder
are kept as they are, so that runs of several machines can be gathered one after another.
"""
import csv
import pathlib
import re
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
import boba
from boba.run import read_table

COMPACTION_PRESSURES = np.geomspace(1e-5, 0.5, 60)
SCATTERING_PRESSURES = (1e-2, 3e-2, 0.1, 0.2, 0.5)
SCATTERING_STRAINS = (0.0, 3.2, 51.2, 102.4)


def start_of_shear(table):
    """First row of the shear: the strain has just begun to grow."""
    return int(np.flatnonzero(np.diff(table["strain"]) != 0)[0]) if np.ptp(table["strain"]) > 0 else len(table["step"])


def at_steps(table, steps):
    """Rows of the run's table at the steps of a measure: the nearest ones."""
    return np.clip(np.searchsorted(table["step"], steps), 0, len(table["step"]) - 1)


def not_ordered(order):
    """Share of grains that are no crystal by bond order; those among their own copies are none."""
    return order["disordered_share"] + order.get("unknown_share", 0.0)


def log_numbers(run):
    """Seconds and node-steps from run.log, all sessions of the run together."""
    text = (run.folder / "run.log").read_text()
    nodes = int(re.search(r"(\d+) nodes", text).group(1))
    times = re.findall(r"^\d+-\d+-\d+ (\d+):(\d+):(\d+) info (.*)", text, re.M)
    seconds, begun = 0.0, None
    for h, m, s, message in times:
        now = 3600 * int(h) + 60 * int(m) + int(s)
        begun = now if message.startswith("boba ") or begun is None else begun
        seconds += (now - begun) % 86400
        begun = now
    return nodes, seconds


def is_done(run):
    return "done at step" in (run.folder / "run.log").read_text()


def summary(run, spec):
    table = run.table
    nodes, seconds = log_numbers(run)
    return [
        {
            "steps": int(table["step"][-1]),
            "nodes": nodes,
            "strain": round(float(table["strain"][-1]), 3),
            "finished": int(is_done(run)),
            "seconds": int(seconds),
        }
    ]


def compaction(run, spec):
    """phi and the volume ratio on a fixed grid of P~, each from the frame nearest in log P~."""
    if spec["scene"] != "compaction":
        return []
    table, measured, order = run.table, run.measure("packing_fraction"), run.measure("order")
    end = start_of_shear(table)
    pressure = table["P_normalised"][at_steps(table, measured["step"])]
    rows, used = [], set()
    for wanted in COMPACTION_PRESSURES:
        k = int(np.argmin(np.abs(np.log(np.maximum(pressure, 1e-12) / wanted))))
        if k not in used and abs(np.log(max(pressure[k], 1e-12) / wanted)) < 0.3 and k <= end:
            used.add(k)
            rows.append(
                {
                    "P": f"{pressure[k]:.4g}",
                    "phi": f"{measured['phi'][k]:.5f}",
                    "phi_error": f"{measured['phi_error'][k]:.5f}",
                    "phi_nodes": f"{measured['phi_nodes'][k]:.5f}",
                    "phi_reference": f"{measured['phi_undeformed_hulls'][k]:.5f}",
                    "ordered": f"{1 - not_ordered(order)[k]:.3f}",
                }
            )
    return rows


def jamming(run, spec):
    """P~ and phi at rest, the last frame of every stage that has come to its end."""
    if spec["scene"] != "jamming":
        return []
    table, measured = run.table, run.measure("packing_fraction")
    ended = np.unique(table["stage"])[: None if is_done(run) else -1]
    rows = []
    for stage in ended:
        last = np.flatnonzero(table["stage"] == stage)[-1]
        k = np.flatnonzero(measured["step"] <= table["step"][last])[-1]
        rows.append(
            {
                "P": f"{table['P_normalised'][last]:.4g}",
                "phi": f"{measured['phi'][k]:.5f}",
                "phi_error": f"{measured['phi_error'][k]:.5f}",
            }
        )
    return rows


def scattering(run, spec):
    """I, P_F and S of chosen frames: pressures of a compaction, strains of a shear."""
    if spec["scene"] == "spheres" or spec["seed"] != "1" or "scattering" not in run.measures:
        return []
    table, measured = run.table, run.measure("scattering")
    steps = np.unique(measured["step"])
    at = at_steps(table, steps)
    rows = []
    if spec["scene"] == "compaction":
        values, wanted, kind = np.log(np.maximum(table["P_normalised"][at], 1e-12)), SCATTERING_PRESSURES, "P"
        chosen = [(w, int(np.argmin(np.abs(values - np.log(w))))) for w in wanted]
        chosen = [(w, k) for w, k in chosen if abs(values[k] - np.log(w)) < 0.3]
    else:
        sheared = np.flatnonzero(steps >= table["step"][start_of_shear(table)])
        strains, kind = table["strain"][at], "strain"
        chosen = [(w, int(sheared[np.argmin(np.abs(strains[sheared] - w))])) for w in SCATTERING_STRAINS]
        chosen = [(w, k) for w, k in chosen if abs(strains[k] - w) < 0.2]
    for label, k in chosen:
        frame = run.rows("scattering", steps[k])
        rows += [
            {"kind": kind, "value": label, "q": f"{q:.4f}", "form_factor": f"{p:.5g}", "structure": f"{s:.5g}"}
            for q, p, s in zip(frame["q_1/d"], frame["form_factor"], frame["structure"])
        ]
    return rows


def series(run, spec):
    """mu, P~ and phi_reference averaged over bins of strain: 0.1 up to strain 5, 0.8 above."""
    if spec["scene"] == "compaction":
        return []
    table = run.table
    begin = start_of_shear(table)
    strain = table["strain"][begin:]
    edges = np.concatenate([np.arange(0, 5.0, 0.1), np.arange(5.0, 1100, 0.8)])
    which = np.digitize(strain, edges)
    rows = []
    for b in np.unique(which):
        inside = begin + np.flatnonzero(which == b)
        mean = {name: table[name][inside].mean() for name in ("strain", "mu", "P_normalised", "phi_reference")}
        rows.append(
            {
                "strain": f"{mean['strain']:.3f}",
                "mu": f"{mean['mu']:.4f}",
                "mu_deviation": f"{table['mu'][inside].std():.4f}",
                "P": f"{mean['P_normalised']:.5g}",
                "phi_reference": f"{mean['phi_reference']:.4f}",
            }
        )
    return rows


def early(run, spec):
    """Means over 1 < strain < 5 (or as far as the run has come) with errors by blocking."""
    table = run.table
    last = min(5.0, float(table["strain"][-1]))
    if spec["scene"] == "compaction" or last < 2.0:
        return []
    mu, mu_error = run.average("mu", 1.0, last)
    inside = (table["strain"] > 1.0) & (table["strain"] < last)
    row = {
        "to_strain": f"{last:.2f}",
        "mu": f"{mu:.4f}",
        "mu_error": f"{mu_error:.4f}",
        "mu_deviation": f"{table['mu'][inside].std():.4f}",
        "inertial_number": f"{table['inertial_number'][inside].mean():.4g}",
        "P": f"{table['P_normalised'][inside].mean():.5g}",
        "phi_reference": f"{table['phi_reference'][inside].mean():.4f}",
        "phi": "",
        "phi_error": "",
        "phi_start": "",
    }
    if spec["scene"] == "spheres":  # phi_reference is their packing fraction
        row["phi_start"] = f"{table['phi_reference'][start_of_shear(table)]:.4f}"
    if "packing_fraction" in run.measures:
        measured = run.measure("packing_fraction")
        chosen = (measured["strain"] > 1.0) & (measured["strain"] < last + 0.01)
        begun = measured["step"] >= table["step"][start_of_shear(table)]
        if chosen.sum() > 1:
            row["phi"] = f"{measured['phi'][chosen].mean():.4f}"
            row["phi_error"] = f"{measured['phi'][chosen].std(ddof=1) / np.sqrt(chosen.sum()):.4f}"
            row["phi_start"] = f"{measured['phi'][begun][0]:.4f}"
    return [row]


#: Columns of the table of order that runs have which were measured before there were templates and clusters have not.
NEW_ORDER = (
    "unknown_share",
    "template_fcc_share",
    "template_hcp_share",
    "template_bcc_share",
    "template_unknown_share",
    "template_rmsd_mean",
    "solid_share",
    "largest_cluster",
    "largest_percolates_x",
    "largest_percolates_y",
    "largest_percolates_z",
    "largest_finite_cluster",
    "bragg_peak",
)


def structure(run, spec):
    """Order, shapes and phi of every measured frame of the shear."""
    if spec["scene"] == "compaction" or "order" not in run.measures:
        return []
    order = run.measure("order")
    first = run.table["step"][start_of_shear(run.table)] if np.ptp(run.table["strain"]) > 0 else np.inf
    shape = run.measure("shape") if "shape" in run.measures else None
    phi = run.measure("packing_fraction") if "packing_fraction" in run.measures else None
    rows = []
    for k in np.flatnonzero(order["step"] >= first):
        step = order["step"][k]
        row = {"strain": f"{order['strain'][k]:.2f}"}
        row |= {name: f"{order[name + '_share'][k]:.3f}" for name in ("fcc", "hcp", "bcc")}
        row["disordered"] = f"{not_ordered(order)[k]:.3f}"
        row |= {name: f"{order[name][k]:.4f}" for name in ("q6_mean", "averaged_q6_mean")}
        row |= {name: f"{order[name][k]:.4g}" for name in NEW_ORDER if name in order}
        names = (
            "volume_mean_d3",
            "volume_deviation_d3",
            "asphericity_mean",
            "asphericity_deviation",
            "facets_mean",
            "twelve_facets_share",
            "faceted_share",
            "facets_transitive_mean",
            "faceted_share_transitive",
        )
        here = np.flatnonzero(shape["step"] == step) if shape else []
        row |= {name: f"{shape[name][here[0]]:.5g}" if len(here) else "" for name in names}
        here = np.flatnonzero(phi["step"] == step) if phi else []
        row["phi"] = f"{phi['phi'][here[0]]:.4f}" if len(here) else ""
        rows.append(row)
    return rows


def windows(reached):
    """Early and late windows of strain for distributions."""
    late = [("late", 0.8 * reached, reached + 0.01)] if reached > 10 else []
    return [("early", 2.0, 4.5)] + late


def distributions(run, spec):
    """Histograms over grains and frames: volume over the undeformed one, asphericity, facets (both rules)."""
    if spec["scene"] != "shear" or "grains" not in run.measures:
        return []
    grains, shape = run.measure("grains"), run.measure("shape")
    volume = shape["undeformed_volume_d3"][0]
    bins = {
        "volume": (grains["volume_d3"] / volume, np.arange(0.4, 1.6001, 0.02)),
        "asphericity": (grains["asphericity"], np.arange(1.0, 1.6001, 0.01)),
        "facets": (grains["facets"], np.arange(-0.5, 80.6)),
        "facets_transitive": (grains["facets_transitive"], np.arange(-0.5, 80.6)),
    }
    rows = []
    for window, low, high in windows(float(run.table["strain"][-1])):
        inside = (grains["strain"] > low) & (grains["strain"] < high)
        for name, (values, edges) in bins.items():
            counts = np.histogram(values[inside], edges)[0]
            rows += [
                {"window": window, "quantity": name, "centre": f"{0.5 * (a + b):.3f}", "count": int(n)}
                for a, b, n in zip(edges[:-1], edges[1:], counts)
                if n
            ]
    return rows


def traces(run, spec):
    """One grain's volume and asphericity against strain."""
    if spec["scene"] != "shear" or spec["seed"] != "1" or "grains" not in run.measures:
        return []
    grains = run.measure("grains")
    chosen = (grains["grain"] == grains["grain"].min()) & (grains["strain"] > 0)
    return [
        {"strain": f"{s:.2f}", "volume_d3": f"{v:.2f}", "asphericity": f"{a:.4f}"}
        for s, v, a in zip(grains["strain"][chosen], grains["volume_d3"][chosen], grains["asphericity"][chosen])
    ]


def rest(run, spec):
    """A crystal or a disordered packing at rest under the pressure, before shear: each grain's share of everything.

    `energy` is the table's elastic energy (pairwise part: the many-body term of alpha has none), `work` that of the cell
    on the packing, -integral of P dV over the compression, which holds what was dissipated too.
    """
    if spec["scene"] != "crystal":
        return []
    table, order = run.table, run.measure("order")
    last = start_of_shear(table)
    if last >= len(table["step"]) - 1 and not is_done(run):
        return []
    k = min(last, len(table["step"]) - 1)
    n = int(spec["grains"])
    volume = table["Lx_d"] * table["Ly_d"] * table["Lz_d"] / n
    pressure = table["P_k/d"]
    work = -float(np.sum(0.5 * (pressure[1 : k + 1] + pressure[:k]) * np.diff(volume[: k + 1])))
    o = int(np.argmin(np.abs(order["step"] - table["step"][k])))
    row = {
        "arrangement": spec["arrangement"],
        "P": f"{table['P_normalised'][k]:.5g}",
        "pressure": f"{pressure[k]:.6g}",
        "volume": f"{volume[k]:.5f}",
        "phi_reference": f"{table['phi_reference'][k]:.5f}",
        "energy": f"{table['elastic_energy_kd2'][k] / n:.6g}",
        "work": f"{work:.6g}",
        "enthalpy": f"{work + pressure[k] * volume[k]:.6g}",
        "kinetic": f"{table['kinetic_energy_kd2'][k] / n:.3g}",
    }
    return [row | {name: f"{order[name][o]:.4g}" for name in NEW_ORDER + ("template_shear_mean",)}]


TABLES = {
    "summary": summary,
    "compaction": compaction,
    "jamming": jamming,
    "scattering": scattering,
    "series": series,
    "early": early,
    "structure": structure,
    "distributions": distributions,
    "traces": traces,
    "rest": rest,
}


def peer(out, results):
    """Means of YADE's runs of the rigid spheres, OUT/yade_r*.csv (yade_spheres.py): results/yade.csv."""
    rows = []
    for path in sorted(pathlib.Path(out).glob("yade_r*.csv")):
        table = read_table(path)
        inside = (table["strain"] > 1.0) & (table["strain"] < 5.0)
        mu, error = boba.blocked_mean(table["mu"][inside])
        pressure = table["P_k/d"][inside].mean()
        rate = float(path.stem.removeprefix("yade_r"))
        rows.append(
            {
                "rate": f"{rate:g}",
                "inertial_number": f"{rate * np.sqrt(6.0 / np.pi / pressure):.4g}",
                "to_strain": f"{table['strain'][-1]:.2f}",
                "P": f"{pressure:.4g}",
                "mu": f"{mu:.4f}",
                "mu_error": f"{error:.4f}",
                "phi": f"{table['phi'][inside].mean():.4f}",
                "phi_start": f"{table['phi_at_rest'][0]:.4f}",
            }
        )
    if rows:
        write(results / "yade.csv", rows)


def write(path, rows):
    names = list(dict.fromkeys(name for row in rows for name in row)) or ["name"]  # newer rows may have more columns
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, names, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def main(plan, out, results):
    specs = list(csv.DictReader(open(plan)))
    results = pathlib.Path(results)
    results.mkdir(parents=True, exist_ok=True)
    for name, make in TABLES.items():
        path = results / f"{name}.csv"
        kept = list(csv.DictReader(path.open())) if path.exists() else []
        rows = []
        for spec in specs:
            folder = pathlib.Path(out) / spec["name"]
            old = [row for row in kept if row["name"] == spec["name"]]
            try:
                new = make(boba.open(folder), spec) if (folder / "table.csv").exists() else None
            except (IndexError, KeyError):  # only just begun
                new = []
            rows += old if new is None else [{"name": spec["name"]} | row for row in new]
        # The plan of crystals has few of the tables, and it alone has `rest`.
        if not rows and (name == "rest" or all(spec["scene"] == "crystal" for spec in specs)):
            continue
        write(path, rows)
        print(f"{path}: {len(rows)} rows")
    peer(out, results)


if __name__ == "__main__":
    main(*sys.argv[1:4])
