# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves of runs as plain data: which tables there are, which panels they fill, and in which order they are shown."""
from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from ..course import path_of
from ..run import Run
from ..table import Table, unit_of

#: More rows than this are thinned for the page: of each bin its first, smallest and largest rows stay.
MOST_ROWS = 4000


@dataclasses.dataclass(frozen=True)
class Line:
    """A column of a table of every run; `deviation` is the column of a band around it, `error` of its error bars."""

    table: str
    column: str
    label: str = ""
    style: str = "solid"
    deviation: str = ""
    error: str = ""


@dataclasses.dataclass(frozen=True)
class Panel:
    """A panel against time or strain."""

    name: str
    group: str
    title: str
    y: str
    lines: tuple[Line, ...]
    log: bool = False
    note: str = ""


CLOCK_PANELS = (
    Panel("mu", "Loading", "Stress ratio", "mu", (Line("table.csv", "mu"),)),
    Panel(
        "phi",
        "Loading",
        "Packing fraction",
        "phi",
        (
            Line("packing_fraction", "phi", "nodes and hulls", error="phi_error"),
            Line("table.csv", "phi_reference", "undeformed volumes", "dash"),
        ),
    ),
    Panel("pressure", "Loading", "Pressure", "P (k/d)", (Line("table.csv", "P_k/d"),)),
    Panel("normalised", "Loading", "Normalised pressure", "P~", (Line("table.csv", "P_normalised"),)),
    Panel("inertial", "Loading", "Inertial number", "I", (Line("table.csv", "inertial_number"),), log=True),
    Panel(
        "energies",
        "Loading",
        "Energies",
        "energy (k d^2)",
        (
            Line("table.csv", "elastic_energy_kd2", "elastic"),
            Line("table.csv", "kinetic_energy_kd2", "kinetic", "dash"),
        ),
        log=True,
    ),
    Panel("force", "Loading", "Force on the ends", "force (k d)", (Line("table.csv", "end_force_kd"),)),
    Panel("gap", "Loading", "Distance of the ends", "gap (d)", (Line("table.csv", "end_gap_d"),)),
    Panel(
        "overlap", "Loading", "Largest overlap of two nodes", "overlap (d)", (Line("table.csv", "largest_overlap_d"),)
    ),
    Panel("speed", "Loading", "Speed", "steps per second", (Line("table.csv", "speed_steps/s"),)),
    Panel(
        "normal_stress",
        "Loading",
        "Normal stress differences",
        "N (k/d)",
        (Line("stress", "N1_k/d", "N1"), Line("stress", "N2_k/d", "N2", "dash")),
    ),
    Panel(
        "coordination",
        "Contacts",
        "Contacts per grain",
        "contacts",
        (
            Line("coordination", "contacts_per_grain", "all grains"),
            Line("coordination", "contacts_without_rattlers", "without rattlers", "dash"),
        ),
    ),
    Panel(
        "anisotropy", "Contacts", "Anisotropy of the fabric", "anisotropy", (Line("coordination", "fabric_anisotropy"),)
    ),
    Panel("area", "Contacts", "Mean contact area", "area (d^2)", (Line("coordination", "area_mean_d2"),)),
    Panel("contact_force", "Contacts", "Mean contact force", "force (k d)", (Line("coordination", "force_mean_kd"),)),
    Panel(
        "volume",
        "Shape",
        "Volume of a grain",
        "volume (d^3)",
        (
            Line("shape", "volume_mean_d3", "mean, band: deviation", deviation="volume_deviation_d3"),
            Line("shape", "undeformed_volume_d3", "undeformed", "dots"),
        ),
    ),
    Panel(
        "asphericity",
        "Shape",
        "Asphericity",
        "asphericity",
        (
            Line("shape", "asphericity_mean", "mean, band: deviation", deviation="asphericity_deviation"),
            Line("shape", "undeformed_asphericity", "undeformed", "dots"),
        ),
    ),
    Panel("facets", "Shape", "Facets per grain", "facets", (Line("shape", "facets_mean"),)),
    Panel(
        "faceted",
        "Shape",
        "Faceted share of the surface",
        "share",
        (Line("shape", "faceted_share"), Line("shape", "undeformed_faceted_share", "undeformed", "dots")),
    ),
    Panel(
        "order",
        "Order",
        "Crystals (template matching)",
        "share of grains",
        (
            Line("order", "template_fcc_share", "fcc"),
            Line("order", "template_hcp_share", "hcp", "dash"),
            Line("order", "template_bcc_share", "bcc", "dots"),
            Line("order", "solid_share", "seven solid bonds", "dashdot"),
        ),
    ),
    Panel(
        "clusters",
        "Order",
        "Largest cluster of ordered grains",
        "grains",
        (Line("order", "largest_cluster", "any"), Line("order", "largest_finite_cluster", "not percolating", "dash")),
    ),
    Panel("bragg", "Order", "Largest Bragg peak", "share of N^2", (Line("order", "bragg_peak"),)),
    Panel(
        "non_affine",
        "Motion",
        "Non-affine motion since the first frame",
        "mean square displacement (d^2)",
        (Line("motion", "non_affine_square_d2"),),
    ),
    Panel("changed", "Motion", "Grains whose neighbours changed", "share", (Line("motion", "changed_share"),)),
)


def plain(values: Any) -> list[float | None]:
    """Numbers as JSON has them: what is not finite is null."""
    return [float(v) if np.isfinite(v) else None for v in np.asarray(values, dtype=float)]


def accumulated_strain(strain: np.ndarray) -> np.ndarray:
    """Strain run through, forth and back counted alike, from 0; nan before anything shears. Shape (rows,)."""
    path = path_of(strain)
    moving = np.flatnonzero(path > 0)
    if len(moving) == 0:
        return np.full(len(strain), np.nan)
    path[: max(moving[0] - 1, 0)] = np.nan
    return path


def thinned(table: Table, most: int = MOST_ROWS) -> np.ndarray:
    """Numbers of the rows that stand for a long table: all where there are few enough."""
    n = table.n_rows
    if n <= most:
        return np.arange(n)
    watched = [table[name] for name in ("mu", "P_k/d", "phi_reference", "kinetic_energy_kd2") if name in table][:4]
    kept = [0, n - 1]
    edges = np.linspace(0, n, most // (1 + 2 * max(len(watched), 1)) + 1).astype(int)
    for a, b in zip(edges[:-1], edges[1:]):
        kept.append(a)
        for values in watched:
            part = values[a:b]
            if np.isfinite(part).any():
                kept += [a + int(np.nanargmin(part)), a + int(np.nanargmax(part))]
    return np.unique(kept)


def run_table(run: Run, name: str) -> Table | None:
    """table.csv or a table of measures, or None where it is missing, empty, or has no time."""
    try:
        table = run.table if name == "table.csv" else run.measure(name)
    except (OSError, KeyError):
        return None
    return table if table.n_rows and "time_tau" in table and "strain" in table else None


def _is_shown(values: np.ndarray) -> bool:
    finite = values[np.isfinite(values)]
    return len(finite) > 1 and bool(np.any(finite != finite[0]) or finite[0] != 0)


def clock_data(runs: list[tuple[str, Run]]) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Tables (rows of the runs that panels draw) and the panels against time or strain that name their columns."""
    tables: dict[tuple[int, str], dict[str, Any]] = {}
    order: list[tuple[int, str]] = []
    panels = []

    def place_of(k: int, run: Run, line: Line) -> int | None:
        table = run_table(run, line.table)
        if table is None or line.column not in table or not _is_shown(table[line.column]):
            return None
        key = (k, line.table)
        rows = thinned(table)
        if key not in tables:
            order.append(key)
            tables[key] = {
                "run": k,
                "name": line.table,
                "rows": table.n_rows,
                "time": plain(table["time_tau"][rows]),
                "strain": plain(accumulated_strain(table["strain"])[rows]),
                "step": plain(table["step"][rows]),
                "columns": {},
            }
        for column in (line.column, line.deviation, line.error):
            if column and column in table:
                tables[key]["columns"].setdefault(column, plain(table[column][rows]))
        return order.index(key)

    for panel in CLOCK_PANELS:
        series = []
        for k, (label, run) in enumerate(runs):
            for line in panel.lines:
                place = place_of(k, run, line)
                if place is not None:
                    entry = {"run": k, "label": line.label, "style": line.style, "table": place, "column": line.column}
                    entry |= {key: getattr(line, key) for key in ("deviation", "error") if getattr(line, key)}
                    series.append(entry)
        if any(entry["style"] != "dots" for entry in series):
            panels.append(
                {
                    "id": panel.name,
                    "group": panel.group,
                    "title": panel.title,
                    "x": "clock",
                    "y": panel.y,
                    "log": panel.log,
                    "note": panel.note,
                    "series": series,
                }
            )
    return [tables[key] for key in order], panels


def own_panel(
    name: str, group: str, title: str, x: str, y: str, series: list[dict[str, Any]], **more: Any
) -> dict[str, Any]:
    """A panel with its own abscissa: each series has `run`, `label`, `style`, `xs`, `ys` and may have `errors`."""
    return {
        "id": name,
        "group": group,
        "title": title,
        "x": x,
        "y": y,
        "log": False,
        "note": "",
        "series": series,
    } | more


def _first_and_last(run: Run, name: str) -> list[int]:
    steps = run.steps(name)
    return [int(steps[0]), int(steps[-1])] if len(steps) > 1 else [int(steps[0])] if len(steps) else []


def _when(run: Run, name: str, step: int) -> str:
    rows = run.rows(name, step)
    if np.ptp(run.measure(name)["strain"]) > 0:
        return f"strain {rows['strain'][0]:.3g}"
    return f"time {rows['time_tau'][0]:.4g}"


def spectrum_panels(runs: list[tuple[str, Run]]) -> list[dict[str, Any]]:
    """S(q), P_F(q) and g(r) of the first and the last frame that was measured."""
    wanted = (
        ("structure", "scattering", "q_1/d", "structure", "Structure factor S(q)", "q (1/d)", "S", False),
        ("form", "scattering", "q_1/d", "form_factor", "Form factor P_F(q)", "q (1/d)", "P_F", True),
        ("pair", "pair_distribution", "r_d", "g", "Pair distribution g(r)", "r (d)", "g", False),
    )
    panels = []
    for name, table, x, y, title, x_label, y_label, log in wanted:
        series = []
        for k, (_, run) in enumerate(runs):
            measured = run_table(run, table)
            if measured is None or x not in measured or y not in measured:
                continue
            for step, style in zip(
                _first_and_last(run, table), ("dots", "solid") if len(run.steps(table)) > 1 else ("solid",)
            ):
                rows = run.rows(table, step)
                series.append(
                    {
                        "run": k,
                        "label": _when(run, table, step),
                        "style": style,
                        "xs": plain(rows[x]),
                        "ys": plain(rows[y]),
                    }
                )
        if series:
            panels.append(own_panel(name, "Order", title, x_label, y_label, series, log=log))
    return panels


def histogram(values: np.ndarray, edges: np.ndarray) -> dict[str, Any]:
    """Counts between edges as a stepped line: `xs` the edges, `ys` the counts and a last 0."""
    counts, _ = np.histogram(values, bins=edges)
    return {"xs": plain(edges), "ys": plain([*counts, 0])}


def distribution_panels(runs: list[tuple[str, Run]]) -> list[dict[str, Any]]:
    """Distributions over the grains at the first and last frame whose shapes were measured."""
    wanted = (
        ("volume_d3", "Volume of the grains"),
        ("asphericity", "Asphericity of the grains"),
        ("facets", "Facets of the grains"),
        ("faceted_share", "Faceted share of the grains' surface"),
    )
    panels = []
    for column, title in wanted:
        chosen = []
        for k, (_, run) in enumerate(runs):
            table = run_table(run, "grains")
            if table is not None and column in table:
                chosen += [(k, run, step) for step in _first_and_last(run, "grains")]
        values = [run.rows("grains", step)[column] for _, run, step in chosen]
        values = [v[np.isfinite(v)] for v in values]
        if not any(len(v) > 1 for v in values):
            continue
        everything = np.concatenate(values)
        if column == "facets":
            edges = np.arange(np.floor(everything.min()) - 0.5, everything.max() + 1.5)
        else:
            edges = np.histogram_bin_edges(everything, bins=25)
        series = []
        for (k, run, step), own in zip(chosen, values):
            first = len(run.steps("grains")) > 1 and step == run.steps("grains")[0]
            entry = {"run": k, "label": _when(run, "grains", step), "style": "dots" if first else "solid"}
            series.append(entry | histogram(own, edges))
        unit = unit_of(column)
        x_label = column.removesuffix("_d3").replace("_", " ") + ("" if unit == "1" else f" ({unit})")
        panels.append(
            own_panel(f"distribution_{column}", "Distributions", title, x_label, "grains", series, stepped=True)
        )
    return panels


def loading_panels(runs: list[tuple[str, Run]]) -> list[dict[str, Any]]:
    """Curves of one column against another: compaction, and force against the distance of the ends."""
    wanted = (
        ("compaction", "P_k/d", "phi_reference", "Compaction", "P (k/d)", "phi of undeformed volumes", "compress"),
        ("press", "end_gap_d", "end_force_kd", "Force against distance of the ends", "gap (d)", "force (k d)", "press"),
    )
    panels = []
    for name, x, y, title, x_label, y_label, kind in wanted:
        series = []
        for k, (_, run) in enumerate(runs):
            table = run_table(run, "table.csv")
            if table is None or x not in table or y not in table or "stage" not in table:
                continue
            try:
                stages = [stage for stage in run.stages if stage.kind == kind]
            except (OSError, ValueError):
                continue
            for stage in stages:
                rows = table.where(table["stage"] == stage.index)
                rows = rows.where(np.isfinite(rows[x]) & np.isfinite(rows[y]))
                if name == "compaction":
                    rows = rows.where(rows[x] > 1e-8)
                if rows.n_rows > 2:
                    rows = rows.where(np.argsort(rows[x], kind="stable"))
                    label = stage.label if len(stages) > 1 else ""
                    series.append(
                        {"run": k, "label": label, "style": "solid", "xs": plain(rows[x]), "ys": plain(rows[y])}
                    )
        if series:
            panels.append(own_panel(name, "Loading", title, x_label, y_label, series, log_x=name == "compaction"))
    return panels
