# SPDX-License-Identifier: GPL-3.0-or-later
"""The packing of a run in 3-D as compact numbers: outlines of all grains, frame by frame, and what colours them."""
from __future__ import annotations

import base64
import dataclasses
import zlib
from typing import Any

import numpy as np

from ..frames import Frame
from ..run import Run
from .curves import plain
from .hulls import NODE_RADIUS, Outline, outline_of

# Triangles that a frame may have: what software rendering turns at more than 20 frames a second at 800 x 600.
MOST_TRIANGLES = 60_000
#: A triangle belongs to a facet when their normals are as near as the rule of the measure has it (docs/formats-measure.md).
FACET_COSINE = 0.99
MOST_VERTICES, FEWEST_VERTICES = 160, 14


@dataclasses.dataclass(frozen=True)
class Budget:
    """What a packing may take of the page."""

    vertices: int  # of a grain
    frames: int


def budget_for(n_grains: int, n_frames: int, bytes_allowed: float) -> Budget:
    """Vertices of a grain and frames, so that frames stay quick to draw and the file small.

    A hull of v vertices has 2 v - 4 triangles. A vertex takes 6 bytes and its two triangles 6 or 12; packed and in
    base64 about as much.
    """
    vertices = int(np.clip((MOST_TRIANGLES / max(n_grains, 1) + 4) / 2, FEWEST_VERTICES, MOST_VERTICES))
    per_frame = n_grains * vertices * 13.0
    return Budget(vertices, int(np.clip(bytes_allowed / per_frame, 2, 200).astype(int)) if n_frames > 2 else n_frames)


def chosen_frames(n: int, most: int) -> list[int]:
    """Numbers of at most `most` frames, the first and last among them, evenly spread."""
    return sorted({int(k) for k in np.linspace(0, n - 1, min(n, max(most, 1))).round()})


def packed(array: np.ndarray, kind: str) -> str:
    """Numbers as little-endian bytes of a numpy kind, deflated, in base64."""
    return base64.b64encode(zlib.compress(np.ascontiguousarray(array, dtype=kind).tobytes(), 6)).decode("ascii")


def _by_grain(run: Run, table: str, column: str, step: int, molecules: np.ndarray) -> np.ndarray | None:
    """A column of a table of grains at a step, in the order of the frame's grains; None where it was not measured."""
    try:
        rows = run.rows(table, step)
        values = dict(zip(rows["grain"].astype(int).tolist(), rows[column].tolist()))
    except (OSError, KeyError):
        return None
    return np.array([values.get(int(m), np.nan) for m in molecules])


def _facets_of(run: Run, step: int, molecules: np.ndarray, outlines: list[Outline]) -> list[np.ndarray] | None:
    """For each grain and triangle 1 where it lies in a facet that was measured."""
    try:
        rows = run.rows("facets", step)
    except (OSError, KeyError):
        return None
    normals = np.stack([rows[f"normal_{axis}"] for axis in "xyz"], axis=1)
    grains = rows["grain"].astype(int)
    marks = []
    for molecule, outline in zip(molecules, outlines):
        own = normals[grains == molecule]
        cosine = (outline.normals @ own.T).max(axis=1, initial=-1) if len(own) else np.full(len(outline.normals), -1.0)
        near = cosine > FACET_COSINE
        marks.append(near.astype(np.uint8))
    return marks


def grain_values(run: Run, frame: Frame, outlines: list[Outline], molecules: np.ndarray) -> dict[str, np.ndarray]:
    """What can colour the grains at a frame, by name; shape (grains,) each.

    Pressure is -tr / 3 of the grain's part of the stress over its hull's volume, k/d.
    """
    volume = np.array([outline.volume for outline in outlines])
    with np.errstate(invalid="ignore", divide="ignore"):
        pressure = -frame.grain_stress[:, :3].sum(axis=1) / 3 / volume
    values = {
        "volume": volume,
        "asphericity": np.array([outline.asphericity for outline in outlines]),
        "pressure": pressure,
    }
    for name, table, column in (
        ("order", "grain_order", "template"),
        ("bonds", "grain_order", "solid_bonds"),
        ("facet_count", "grains", "facets"),
        ("d2min", "grain_motion", "d2min_d2"),
    ):
        measured = _by_grain(run, table, column, frame.step, molecules)
        if measured is not None:
            values[name] = measured
    return values


ORDER_CLASSES = ["unknown", "fcc", "hcp", "bcc", "sc", "icosahedral"]


def _quantities(values: list[dict[str, np.ndarray]], species: list[str], has_facets: bool) -> list[dict[str, Any]]:
    names: list[dict[str, Any]] = [{"key": "grain", "label": "grain", "kind": "index"}]
    if len(species) > 1:
        names.append({"key": "species", "label": "species", "kind": "class", "classes": species})
    numbers = {
        "pressure": "pressure (k/d)",
        "volume": "volume (d^3)",
        "asphericity": "asphericity",
        "facet_count": "number of facets",
        "bonds": "solid-like bonds",
        "d2min": "D2min (d^2)",
    }
    for key, label in numbers.items():
        if any(key in frame and np.isfinite(frame[key]).any() for frame in values):
            names.append({"key": key, "label": label, "kind": "number"})
    if any("order" in frame for frame in values):
        names.append({"key": "order", "label": "class of order", "kind": "class", "classes": ORDER_CLASSES})
    if has_facets:
        names.append({"key": "facets", "label": "facets", "kind": "triangle", "classes": ["curved", "facet"]})
    return names


def _bounds(frame: Frame) -> np.ndarray:
    corners = np.array([[i, j, k] for k in (0, 1) for j in (0, 1) for i in (0, 1)]) @ frame.box.T + frame.origin
    points = np.concatenate([corners, frame.grain_centres + frame.shift_into_cell(frame.grain_centres)])
    return np.array([points.min(axis=0), points.max(axis=0)])


def _frame_data(
    frame: Frame, outlines: list[Outline], facets: list[np.ndarray] | None, scale: tuple[np.ndarray, float]
):
    origin, step = scale
    vertices = np.concatenate([outline.vertices for outline in outlines])
    places = np.clip(np.round((vertices - origin) / step), -32767, 32767)
    triangles = np.concatenate([outline.triangles for outline in outlines])
    data = {
        "step": frame.step,
        "time": frame.time,
        "strain": frame.strain,
        "box": plain(frame.box.T.ravel()),
        "origin": plain(frame.origin),
        "vertices": packed(places, "<i2"),
        "vertex_counts": packed(np.array([len(outline.vertices) for outline in outlines]), "<u2"),
        "triangles": packed(triangles, "<u2"),
        "triangle_counts": packed(np.array([len(outline.triangles) for outline in outlines]), "<u2"),
    }
    if facets is not None:
        data["facets"] = packed(np.concatenate(facets), "u1")
    return data


def node_radius(run: Run) -> float:
    """Half of the diameter at which nodes touch, d."""
    try:
        diameter = run.scene.values["material"]["contact_diameter"]
    except (OSError, ValueError, KeyError, TypeError):
        return NODE_RADIUS
    return 0.5 * diameter if isinstance(diameter, (int, float)) and diameter > 0 else NODE_RADIUS


def _outlined(run: Run, number: int, vertices: int, cache: dict[Any, Any]) -> tuple[Frame, list[Outline]]:
    """A frame without its nodes, and the outlines of its grains."""
    key = (number, vertices)
    if key not in cache:
        frame, radius = run.frames[number], node_radius(run)
        outlines = [outline_of(nodes, vertices, radius) for nodes in frame.placed_grains]
        frame.positions, frame.velocities = np.empty((0, 3)), None
        cache[key] = (frame, outlines)
    return cache[key]


def packing_of(
    run: Run, molecules: np.ndarray, bytes_allowed: float, cache: dict[Any, Any] | None = None
) -> dict[str, Any] | None:
    """Everything that the 3-D view of a run needs, or None for a run without frames.

    molecules: numbers of the grains in other files, shape (grains,). cache: outlines of frames that were seen before,
    kept by the caller. Positions are whole numbers of `quantum` from
    `centre`; counts, vertices and triangles of the grains lie one after the other, triangles count from the first
    vertex of their grain.
    """
    frames = run.frames
    n = len(frames)
    if n == 0:
        return None
    last = frames[n - 1]
    budget = budget_for(last.n_grains, n, bytes_allowed)
    numbers = chosen_frames(n, budget.frames)
    shown, outlines_of, values, bounds = [], [], [], []
    for number in numbers:
        frame, outlines = _outlined(run, number, budget.vertices, {} if cache is None else cache)
        shown.append(frame)
        outlines_of.append(outlines)
        values.append(grain_values(run, frame, outlines, molecules))
        bounds.append(_bounds(frame))
    lowest, highest = np.min([b[0] for b in bounds], axis=0), np.max([b[1] for b in bounds], axis=0)
    reach = max(
        float(np.abs(outline.vertices - 0.5 * (lowest + highest)).max())
        for outlines in outlines_of
        for outline in outlines
    )
    scale = (0.5 * (lowest + highest), reach / 32767)
    facets = [_facets_of(run, frame.step, molecules, outlines) for frame, outlines in zip(shown, outlines_of)]
    has_facets = any(marks is not None for marks in facets)
    data = []
    for frame, outlines, marks, own in zip(shown, outlines_of, facets, values):
        entry = _frame_data(frame, outlines, marks, scale)
        entry["values"] = {key: plain(column) for key, column in own.items()}
        data.append(entry)
    species = run.species_names(int(last.species.max(initial=-1)) + 1)
    return {
        "grains": [int(m) for m in molecules],
        "species": [int(s) for s in last.species],
        "quantities": _quantities(values, species, has_facets),
        "centre": plain(scale[0]),
        "quantum": scale[1],
        "nodes": int(last.first_node[-1]),
        "frames": data,
        "stored_frames": n,
        "simplified": bool(max(len(o.vertices) for outlines in outlines_of for o in outlines) >= 0.7 * budget.vertices),
    }


def molecules_of(run: Run) -> np.ndarray:
    """Numbers of the grains in other files, shape (grains,)."""
    return run.frames._read(lambda file: file["parameters/grains/molecule"][:])
