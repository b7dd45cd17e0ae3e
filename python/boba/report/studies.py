# SPDX-License-Identifier: GPL-3.0-or-later
"""Outputs of `boba compare`, `boba calibrate` and `boba continuum`: panels, facts and a table each."""
from __future__ import annotations

import json
import pathlib
from typing import Any

import numpy as np

from ..table import read_table
from .curves import own_panel, plain

#: File and schema of each kind of output (docs/formats-calibration.md, docs/formats-continuum.md).
STUDIES = (
    ("comparison", "comparison.json", "boba-comparison"),
    ("calibration", "table.json", "boba-calibration-table"),
    ("continuum", "summary.json", "boba-continuum-summary"),
)


def kind_of(folder: pathlib.Path) -> str | None:
    """Which of STUDIES a folder holds, or None. \\throws ValueError where the file is none of Boba's or no JSON."""
    for kind, name, schema in STUDIES:
        path = folder / name
        if path.is_file():
            content = _content(path)
            if content.get("schema") == schema:
                return kind
            raise ValueError(f"{path}: schema {content.get('schema')!r}: must be {schema}")
    return "tables" if any((folder / name).is_file() for name in ("curve.csv", "specimen.csv")) else None


def _content(path: pathlib.Path) -> dict[str, Any]:
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (json.JSONDecodeError, UnicodeDecodeError) as error:
        raise ValueError(f"{path}: no JSON: {error}") from None
    if not isinstance(content, dict):
        raise ValueError(f"{path}: must hold an object")
    return content


def _facts(label: str, folder: pathlib.Path, content: dict[str, Any]) -> dict[str, Any]:
    scalars = {k: v for k, v in content.items() if isinstance(v, (str, int, float)) and not isinstance(v, bool)}
    parameters = content.get("parameters", {})
    if isinstance(parameters, dict):
        scalars |= {k: v for k, v in parameters.items() if isinstance(v, (str, int, float))}
    return {
        "name": label,
        "folder": str(folder),
        "title": "",
        "status": {"state": "done", "text": "Result file"},
        "facts": [[key.replace("_", " "), str(value)] for key, value in scalars.items()],
        "checks": [],
        "grains": [],
        "stages": [],
        "overrides": [],
        "scene": "",
        "log": "",
    }


def _number(value: Any) -> float:
    return float(value) if isinstance(value, (int, float)) else float("nan")


def _comparison(k: int, content: dict[str, Any]) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    rows = [row for row in content.get("rows", []) if isinstance(row, dict)]
    panels = []
    groups: dict[tuple[str, str], dict[float, list[dict[str, Any]]]] = {}
    for row in rows:
        key = (str(row.get("setup", "")), str(row.get("quantity", "")))
        groups.setdefault(key, {}).setdefault(_number(row.get("alpha")), []).append(row)
    for (setup, quantity), by_alpha in groups.items():
        for alpha, own in by_alpha.items():
            own = sorted(own, key=lambda row: _number(row.get("load")))
            loads = plain([_number(row.get("load")) for row in own])
            particles = {
                "run": k,
                "label": "particles",
                "style": "solid",
                "xs": loads,
                "ys": plain([_number(row.get("particles")) for row in own]),
                "errors": plain([_number(row.get("particles_error")) for row in own]),
                "points": True,
            }
            series = [particles]
            models = sorted({m for row in own if isinstance(row.get("continuum"), dict) for m in row["continuum"]})
            for model, style in zip(models, ("dash", "dots", "dashdot") * len(models)):
                values = [_number((row.get("continuum") or {}).get(model)) for row in own]
                series.append(
                    {"run": k, "label": model, "style": style, "xs": loads, "ys": plain(values), "shade": True}
                )
            hertz = [_number(row.get("hertz")) for row in own]
            if np.isfinite(hertz).any():
                series.append(
                    {"run": k, "label": "Hertz", "style": "dots", "xs": loads, "ys": plain(hertz), "shade": True}
                )
            title = f"{quantity.replace('_', ' ')}, {setup}, alpha = {alpha:g}"
            panels.append(
                own_panel(
                    f"compare_{k}_{setup}_{quantity}_{alpha:g}", setup or "Comparison", title, "load", quantity, series
                )
            )
    best = content.get("best_model")
    headings = ["load", "particles", "error", f"continuum ({best})", "difference (%)"]
    table_rows = []
    for row in rows:
        model = (row.get("continuum") or {}).get(best) if isinstance(row.get("continuum"), dict) else None
        particles = _number(row.get("particles"))
        difference = 100 * (particles / model - 1) if isinstance(model, (int, float)) and model else None
        cells = [row.get("load"), row.get("particles"), row.get("particles_error"), model, difference]
        what = f"{row.get('setup')}, {row.get('quantity')}, alpha = {_number(row.get('alpha')):g}"
        table_rows.append({"run": "", "stage": what, "cells": [_cell(value) for value in cells]})
    return panels, {"headings": headings, "rows": table_rows}


def _cell(value: Any) -> dict[str, Any] | None:
    number = _number(value) if value is not None else float("nan")
    return {"mean": number, "error": None, "rows": 1} if np.isfinite(number) else None


def _csv_panels(k: int, folder: pathlib.Path) -> list[dict[str, Any]]:
    """Curves of the tables that boba-calibrate writes: moduli against alpha, and a network under strain."""
    wanted = (
        ("table.csv", "alpha", (("young", "Young's modulus (k/d)"), ("poisson", "Poisson's ratio")), "alpha (k d)"),
        ("table.csv", "alpha", (("bulk", "bulk modulus (k/d)"), ("shear", "shear modulus (k/d)")), "alpha (k d)"),
        ("table.csv", "alpha", (("anisotropy", "anisotropy of a finite box"),), "alpha (k d)"),
        (
            "curve.csv",
            "strain",
            (("stress_k_per_d", "nominal stress (k/d)"), ("poisson", "-d ln(lateral) / d ln(axial)")),
            "strain",
        ),
        (
            "specimen.csv",
            "radius_d",
            (("young", "Young's modulus (k/d)"), ("poisson", "Poisson's ratio")),
            "radius (d)",
        ),
    )
    panels = []
    for name, x, columns, x_label in wanted:
        if not (folder / name).is_file():
            continue
        try:
            table = read_table(folder / name)
        except ValueError:
            continue  # specimen.csv has columns of words
        if x not in table:
            continue
        table = table.where(np.argsort(table[x], kind="stable"))
        for column, y_label in columns:
            if column not in table or not np.isfinite(table[column]).any():
                continue
            series = [
                {"run": k, "label": "computed", "style": "solid", "xs": plain(table[x]), "ys": plain(table[column])}
            ]
            if f"{column}_error" in table:
                series[0]["errors"] = plain(table[f"{column}_error"])
            published = f"published_{column}"
            if published in table and np.isfinite(table[published]).any():
                points = {"xs": plain(table[x]), "ys": plain(table[published]), "points": True}
                series.append({"run": k, "label": "published", "style": "none", "shade": True} | points)
            title = y_label.partition(" (")[0]
            panels.append(
                own_panel(f"{name}_{k}_{column}", name, title[:1].upper() + title[1:], x_label, y_label, series)
            )
    return panels


def _continuum(k: int, content: dict[str, Any]) -> list[dict[str, Any]]:
    loads = [load for load in content.get("loads", []) if isinstance(load, dict)]
    x = "approach" if loads and "approach" in loads[0] else "strain"
    panels = []
    for name in (
        "force",
        "contact_radius",
        "peak_pressure",
        "equatorial_bulge",
        "apparent_modulus",
        "midheight_poisson",
    ):
        values = [_number(load.get(name)) for load in loads]
        if not np.isfinite(values).any():
            continue
        xs = plain([_number(load.get(x)) for load in loads])
        series = [
            {"run": k, "label": "finite elements", "style": "solid", "xs": xs, "ys": plain(values), "points": True}
        ]
        hertz = [_number(load.get(f"hertz_{name}")) for load in loads]
        if np.isfinite(hertz).any():
            series.append({"run": k, "label": "Hertz", "style": "dash", "xs": xs, "ys": plain(hertz), "shade": True})
        title = name.replace("_", " ")
        panels.append(own_panel(f"continuum_{k}_{name}", "Loads", title[:1].upper() + title[1:], x, title, series))
    return panels


def study_of(k: int, label: str, folder: pathlib.Path, kind: str) -> dict[str, Any]:
    """Facts, panels and table of one output; k is its place in the report."""
    names = {own: name for own, name, _ in STUDIES}
    content = _content(folder / names[kind]) if kind in names else {}
    table: dict[str, Any] = {"headings": [], "rows": []}
    if kind == "comparison":
        panels, table = _comparison(k, content)
    elif kind == "continuum":
        panels = _continuum(k, content)
    else:
        panels = _csv_panels(k, folder)
    return {"facts": _facts(label, folder, content), "panels": panels, "means": table}
