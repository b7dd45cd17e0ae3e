# SPDX-License-Identifier: GPL-3.0-or-later
"""The course of a run: where its curves begin, and what they are drawn against."""
import numpy as np

from . import look


def path_of(strain):
    """Strain added up along the way, whatever its direction."""
    return np.concatenate([[0.0], np.cumsum(np.abs(np.diff(strain)))])


def turns_back(strain):
    """True when the shear runs both ways."""
    steps = np.diff(strain)
    return bool((steps > 0).any() and (steps < 0).any())


def abscissa(run, table=None):
    """Rows, their places on the axis, and its label: strain since the shear began, or time when nothing shears.

    A shear that turns back is drawn against the strain added up along its way, so that no curve folds over itself.
    """
    whole = run.table
    table = whole if table is None else table
    if np.ptp(whole["strain"]) == 0:
        return slice(None), table["time_tau"], look.quantity("time_tau", "time")
    first = int(np.flatnonzero(np.diff(whole["strain"]) != 0)[0])
    rows = table["step"] >= whole["step"][first]
    if not rows.any():
        rows[-1] = True
    if not turns_back(whole["strain"]):
        return rows, table["strain"][rows], look.quantity("strain", "strain")
    x = np.interp(table["step"], whole["step"], path_of(whole["strain"]))
    return rows, x[rows], r"strain along the way $\int|\mathrm{d}\gamma|$"


def compression_rows(run):
    """Rows of table.csv in which the packing grows denser under a pressure above rounding, before it is sheared."""
    table = run.table
    # Columns up to the first shear; later stages compress a packing that has flowed.
    moving = np.flatnonzero(np.diff(table["strain"]) != 0)
    rows = np.arange(moving[0] if len(moving) else len(table["step"]))
    pressure = table["P_k/d"][rows]
    rows = rows[np.isfinite(pressure)]
    if len(rows) == 0:
        return rows
    rows = rows[table["P_k/d"][rows] > 1e-5 * table["P_k/d"][rows].max()]
    densest = np.maximum.accumulate(table["phi_reference"][rows])
    return rows[np.diff(densest, prepend=0.0) > 0]
