# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene in plain words: grains, material, stages."""
from __future__ import annotations

import pathlib
import tomllib
from typing import Any

import numpy as np

from ..scene import SceneText


def poisson_table() -> list[dict[str, float]]:
    """Rows alpha, young, poisson of the installed table or the source tree's; [] where there is none."""
    here = pathlib.Path(__file__).resolve()
    for parent in here.parents:
        for place in ("poisson_table.toml", "share/boba/poisson_table.toml", "calibration/table.toml"):
            if (parent / place).is_file():
                try:
                    return tomllib.loads((parent / place).read_text())["entry"]
                except (tomllib.TOMLDecodeError, KeyError, OSError):
                    return []
    return []


def material_of(alpha: float | None, poisson: float | None, k: float = 1.0) -> str:
    """Elastic constants in words: what the table says for alpha (k d) or nu, linear between its rows."""
    table = poisson_table()
    given = (
        f"alpha = {alpha:g} k d" if alpha is not None else f"nu = {poisson:g}" if poisson is not None else "alpha = 0"
    )
    if not table:
        return given
    alphas, young, nus = (np.array([row[key] for row in table], dtype=float) for key in ("alpha", "young", "poisson"))
    if poisson is not None and alpha is None:
        if not nus.min() <= poisson <= nus.max():
            return given
        alpha = float(np.interp(-poisson, -nus, alphas)) * k
        given += f" (alpha about {alpha:.3g} k d)"
    scaled = (alpha or 0.0) / k
    if not alphas.min() <= scaled <= alphas.max():
        return given
    nu, modulus = np.interp(scaled, alphas, nus), k * np.interp(scaled, alphas, young)
    kind = "auxetic" if nu < -0.05 else "nearly incompressible" if nu > 0.45 else "compressible"
    shown = f"Poisson's ratio about {nu:.2f} ({kind}), " if poisson is None else f"{kind}, "
    return f"{given}: {shown}Young's modulus about {modulus:.3g} k/d"


def _number(value: Any) -> float | None:
    return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else None


def _tables(values: Any) -> list[dict[str, Any]]:
    return [entry for entry in values if isinstance(entry, dict)] if isinstance(values, list) else []


def grains_in_words(scene: SceneText) -> list[str]:
    """A sentence for each species, or for the files that a run started from."""
    values = scene.values
    material = values.get("material", {}) if isinstance(values.get("material"), dict) else {}
    k = _number(material.get("k")) or 1.0
    templates = {t.get("name", ""): t for t in _tables(values.get("template"))}
    sentences = []
    for species in _tables(values.get("species")):
        template = templates.get(species.get("template"), next(iter(templates.values()), {}))
        size = f"{template['nodes']} nodes" if "nodes" in template else f"radius {template.get('radius', 10)} d"
        name = f"{species['name']}: " if "name" in species else ""
        of_what = f"{species.get('count', '?')} {template.get('shape', 'sphere')}s of {size}"
        if template.get("nodes") == 1:
            sentences.append(f"{name}{species.get('count', '?')} rigid spheres of diameter d")
            continue
        elastic = material_of(_number(species.get("alpha")), _number(species.get("poisson")), k)
        sentences.append(f"{name}{of_what}; {elastic}")
    start = values.get("start")
    if isinstance(start, dict) and start:
        files = [str(start[key]) for key in ("lammps_reference", "lammps_state", "trajectory") if key in start]
        sentences.append(f"started from {', '.join(files)}")
    for key, what in (
        ("gamma", "damping gamma"),
        ("k3", "cubic contact stiffness k3"),
        ("hertz_modulus", "Hertz modulus"),
    ):
        if key in material:
            sentences.append(f"{what} = {material[key]}")
    return sentences


_STAGES = {
    "insert": "place the grains without overlap",
    "specimen": "place one grain in an open cell",
    "compress": "compress on all sides up to a pressure and hold it",
    "hold": "hold",
    "shear": "simple shear in x with gradient y",
    "press": "squeeze along z between two ends",
}


def stages_in_words(scene: SceneText) -> list[dict[str, str]]:
    """For each stage its label and what it does, with the values that the scene gives."""
    told = []
    entries = scene.values.get("stage", [])
    for stage in scene.stages:
        entry = entries[stage.index]
        given = ", ".join(f"{key} = {value}" for key, value in entry.items() if key not in ("type", "name"))
        told.append({"label": stage.label, "what": _STAGES.get(stage.kind, stage.kind), "given": given})
    return told


def settings_of(scene: SceneText) -> dict[str, Any]:
    """Every value of a scene under a dotted name, for telling runs of a sweep apart."""
    flat: dict[str, Any] = {}

    def walk(name: str, value: Any) -> None:
        if isinstance(value, dict):
            for key, item in value.items():
                walk(f"{name}.{key}" if name else key, item)
        elif isinstance(value, list) and value and all(isinstance(item, dict) for item in value):
            for k, item in enumerate(value):
                walk(f"{name}.{item.get('name') or k}", item)
        else:
            flat[name] = value

    walk("", scene.values)
    return {name: value for name, value in flat.items() if name not in ("title", "output.directory")}
