# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables that runs write: columns by name, with their units."""
from __future__ import annotations

import os
import pathlib
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import pandas

# Endings of column names, longest first, and the units that they mean (docs/formats.md, docs/formats-measure.md).
_UNITS = {
    "_steps/s": "steps/s",
    "_k/d": "k/d",
    "_1/d": "1/d",
    "_kd2": "k d^2",
    "_tau": "tau",
    "_kd": "k d",
    "_d2": "d^2",
    "_d3": "d^3",
    "_d": "d",
}
_WHOLE = ("step", "stage", "grain", "other", "facet", "species", "image_a", "image_b", "image_c", "pairs", "facets")


def unit_of(column: str) -> str:
    """Unit that a column's name ends with, in words: "k/d" of "P_k/d"; "1" for a pure number."""
    return next((unit for ending, unit in _UNITS.items() if column.endswith(ending)), "1")


class Table(dict[str, np.ndarray]):
    """Columns of a table: name -> array of shape (rows,); an empty field of the file is nan.

    The order of the columns is the file's. `path` is the file (None for a table made here).
    """

    def __init__(self, columns: dict[str, np.ndarray], path: pathlib.Path | None = None) -> None:
        super().__init__(columns)
        self.path = path

    @property
    def n_rows(self) -> int:
        """Number of rows."""
        return len(next(iter(self.values()))) if self else 0

    @property
    def units(self) -> dict[str, str]:
        """Unit of every column; "1" for a pure number."""
        return {name: unit_of(name) for name in self}

    def where(self, chosen: np.ndarray) -> Table:
        """The rows that `chosen` names: a mask of shape (rows,), or row numbers."""
        return Table({name: values[chosen] for name, values in self.items()}, self.path)

    def to_numpy(self) -> np.ndarray:
        """A structured array of shape (rows,): one field per column, whole numbers as int64."""
        whole = {name for name in self if name in _WHOLE and np.isfinite(self[name]).all()}
        kinds: list[tuple[str, type]] = [(name, np.int64 if name in whole else np.float64) for name in self]
        array = np.empty(self.n_rows, dtype=kinds)
        for name, values in self.items():
            array[name] = values
        return array

    def to_pandas(self) -> pandas.DataFrame:
        """A DataFrame with the same columns; `attrs["units"]` holds their units.

        \\throws ImportError where pandas is not installed.
        """
        try:
            import pandas
        except ImportError as error:
            raise ImportError("to_pandas needs pandas (Debian: python3-pandas); to_numpy does not") from error
        frame = pandas.DataFrame(self.to_numpy())
        frame.attrs["units"] = self.units
        return frame

    def __repr__(self) -> str:
        columns = ", ".join(name if unit == "1" else f"{name} [{unit}]" for name, unit in self.units.items())
        return f"<boba.Table {self.path or ''}: {self.n_rows} rows; {columns}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return Table, (dict(self), self.path)


def read_table(path: str | os.PathLike[str]) -> Table:
    """Reads a CSV table, also one that is still being written: a row counts once it is whole.

    \\throws FileNotFoundError; ValueError with the file's name where a field is not a number.
    """
    path = pathlib.Path(path)
    with path.open() as file:
        header = file.readline()
        names = header.rstrip("\n").split(",") if header.endswith("\n") else []
        rows = [line.rstrip("\n").split(",") for line in file if line.endswith("\n")]
    rows = [row for row in rows if len(row) == len(names)]
    try:
        values = np.array([[float(field) if field else np.nan for field in row] for row in rows], dtype=float)
    except ValueError as error:
        raise ValueError(f"{path}: not a table of numbers: {error}") from None
    values = values.reshape(len(rows), len(names))
    return Table({name: values[:, k] for k, name in enumerate(names)}, path)
