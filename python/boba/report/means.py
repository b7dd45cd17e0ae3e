# SPDX-License-Identifier: GPL-3.0-or-later
"""Means with errors of every stage, and what tells the runs of a sweep apart."""
from __future__ import annotations

from typing import Any

import numpy as np

from ..blocking import blocked_mean
from ..run import Run
from ..table import Table
from .curves import run_table
from .words import settings_of

#: (table, column, heading)
QUANTITIES = (
    ("table.csv", "mu", "mu"),
    ("table.csv", "P_k/d", "P (k/d)"),
    ("table.csv", "P_normalised", "P~"),
    ("table.csv", "phi_reference", "phi, undeformed volumes"),
    ("packing_fraction", "phi", "phi, nodes and hulls"),
    ("table.csv", "inertial_number", "I"),
    ("coordination", "contacts_per_grain", "contacts per grain"),
    ("coordination", "fabric_anisotropy", "fabric anisotropy"),
    ("shape", "volume_mean_d3", "grain volume (d^3)"),
    ("shape", "asphericity_mean", "asphericity"),
    ("shape", "facets_mean", "facets per grain"),
    ("order", "solid_share", "share with seven solid bonds"),
    ("table.csv", "end_force_kd", "force on the ends (k d)"),
)


def _second_half(table: Table, first: float, last: float) -> Table:
    """Rows of the second half of the time from `first` to `last`, tau."""
    return table.where((table["time_tau"] >= 0.5 * (first + last)) & (table["time_tau"] <= last))


def mean_of(run: Run, name: str, column: str, stage: int, span: tuple[float, float]) -> dict[str, Any] | None:
    """Mean, standard error (null for a single row) and rows of a column in the second half of a stage, or None."""
    table = run_table(run, name)
    if table is None or column not in table:
        return None
    rows = _second_half(table.where(run.stage_of_rows(table) == stage), *span)
    values = rows[column][np.isfinite(rows[column])]
    if len(values) == 0:
        return None
    if len(values) == 1:
        return {"mean": float(values[0]), "error": None, "rows": 1}
    mean, error = blocked_mean(values)
    return {"mean": mean, "error": error, "rows": len(values)}


def means_of(label: str, run: Run) -> list[dict[str, Any]]:
    """For each stage that has rows: its label and means of the second half of its time."""
    table = run_table(run, "table.csv")
    if table is None or "stage" not in table:
        return []
    try:
        labels = {stage.index: stage.label for stage in run.stages}
    except (OSError, ValueError):
        labels = {}
    rows = []
    for stage in np.unique(table["stage"][np.isfinite(table["stage"])]).astype(int):
        times = table["time_tau"][table["stage"] == stage]
        span = (float(times[0]), float(times[-1]))
        cells = [mean_of(run, name, column, int(stage), span) for name, column, _ in QUANTITIES]
        if any(cells):
            rows.append({"run": label, "stage": labels.get(int(stage), f"stage.{stage}"), "cells": cells})
    return rows


def means_table(runs: list[tuple[str, Run]]) -> dict[str, Any]:
    """Headings and rows of the table of means; headings that no row fills are left out."""
    rows = [row for label, run in runs for row in means_of(label, run)]
    filled = [k for k in range(len(QUANTITIES)) if any(row["cells"][k] for row in rows)]
    for row in rows:
        row["cells"] = [row["cells"][k] for k in filled]
    return {"headings": [QUANTITIES[k][2] for k in filled], "rows": rows}


def sweep_of(runs: list[tuple[str, Run]], means: dict[str, Any]) -> dict[str, Any] | None:
    """Settings in which runs differ, with the means of each run's last stage; None for fewer than two runs."""
    if len(runs) < 2:
        return None
    settings = []
    for _, run in runs:
        try:
            settings.append(settings_of(run.scene))
        except (OSError, ValueError):
            settings.append({})
    names = sorted({name for own in settings for name in own})
    differing = [name for name in names if len({repr(own.get(name)) for own in settings}) > 1]
    rows = []
    for (label, _), own in zip(runs, settings):
        last = [row for row in means["rows"] if row["run"] == label][-1:]
        values = [own.get(name) for name in differing]
        rows.append(
            {
                "run": label,
                "stage": last[0]["stage"] if last else "",
                "settings": [v if isinstance(v, (int, float, str)) or v is None else repr(v) for v in values],
                "cells": last[0]["cells"] if last else [None] * len(means["headings"]),
            }
        )
    return {"settings": differing, "headings": means["headings"], "rows": rows}
