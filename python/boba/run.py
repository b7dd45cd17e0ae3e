# SPDX-License-Identifier: GPL-3.0-or-later
"""One run: its folder, tables, frames and scene."""
from __future__ import annotations

import os
import pathlib
import warnings
from typing import TYPE_CHECKING

import numpy as np

from .blocking import blocked_mean
from .frames import Frame, Frames
from .scene import SceneText, Stage, read_scene
from .table import Table, read_table

if TYPE_CHECKING:
    import MDAnalysis

__all__ = ["Frame", "Frames", "Run", "blocked_mean", "open_run", "read_table"]

#: The table that has a row for every frame of a table whose frames may have none.
_SUMMARY = {"contacts": "coordination", "facets": "shape"}


class Run:
    """A run's output folder. Nothing is read before it is used, and a table again once its file has changed."""

    def __init__(self, folder: str | os.PathLike[str], measures: str | os.PathLike[str] | None = None) -> None:
        self.folder = pathlib.Path(folder)
        if not self.folder.is_dir():
            raise FileNotFoundError(f"{self.folder}: there is no such folder")
        self.measures_folder = pathlib.Path(measures) if measures else self.folder / "measures"
        self._tables: dict[pathlib.Path, tuple[int, Table]] = {}

    @property
    def table(self) -> Table:
        """Columns of table.csv (docs/formats.md)."""
        return self._read(self.folder / "table.csv")

    @property
    def measures(self) -> list[str]:
        """Names of the tables of measures that there are."""
        return sorted(path.stem for path in self.measures_folder.glob("*.csv"))

    def measure(self, name: str) -> Table:
        """Columns of measures/NAME.csv (docs/formats-measure.md). \\throws KeyError where there is no such table."""
        path = self.measures_folder / f"{name}.csv"
        if not path.exists():
            raise KeyError(f"{path}: there is no such table; there are: {', '.join(self.measures) or 'none'}")
        return self._read(path)

    @property
    def stage_tables(self) -> dict[int, Table]:
        """The tables that stages wrote when they ended (stages/stage-N.csv), by the stage's number."""
        paths = (self.folder / "stages").glob("stage-*.csv")
        return {int(path.stem.removeprefix("stage-")): self._read(path) for path in sorted(paths)}

    def rows(self, name: str, step: int) -> Table:
        """The rows of one frame of a table of measures. \\throws KeyError where that frame was not measured."""
        table = self.measure(name)
        chosen = table["step"] == step
        if not chosen.any():
            # A frame without contacts, facets or rows of motion has no rows; its summary has one.
            summary = _SUMMARY.get(name, name)
            steps = self.steps(summary if summary in self.measures else name)
            if step not in steps:
                known = f"{steps[0]} to {steps[-1]}, {len(steps)} in all" if len(steps) else "none"
                raise KeyError(f"{self.measures_folder / name}.csv: step {step} was not measured; steps: {known}")
        return table.where(chosen)

    def steps(self, name: str) -> np.ndarray:
        """Steps of the frames in a table of measures, ascending, shape (frames,)."""
        return np.unique(self.measure(name)["step"]).astype(int)

    def contacts(self, step: int) -> Table:
        """Contact network of one frame: grain, other, image, force, area, normal, branch.

        \\throws KeyError where the contacts of that step were not measured.
        """
        return self.rows("contacts", step)

    def grain_traces(self, column: str, name: str = "grains") -> tuple[np.ndarray, np.ndarray]:
        """Strains, shape (frames,), and values, shape (frames, grains), of a column that has a row for each grain."""
        table = self.measure(name)
        steps = np.unique(table["step"])
        frames = [table["step"] == step for step in steps]
        return (np.array([table["strain"][f][0] for f in frames]), np.array([table[column][f] for f in frames]))

    @property
    def scene(self) -> SceneText:
        """The scene that was run, with what --set changed. \\throws FileNotFoundError; ValueError."""
        return read_scene(self.folder / "scene.toml")

    def species_names(self, n: int) -> list[str]:
        """Names of species 0 to n - 1: those of the scene where it has any, else "species 0" and so on."""
        try:
            listed = [entry for entry in self.scene.values.get("species", []) if isinstance(entry, dict)]
        except (OSError, ValueError):
            listed = []
        return [str(listed[s]["name"]) if s < len(listed) and "name" in listed[s] else f"species {s}" for s in range(n)]

    @property
    def stages(self) -> list[Stage]:
        """The stages of the scene, in their order."""
        return self.scene.stages

    def find_stage(self, stage: int | str) -> Stage:
        """The stage of that number (from 0), name, or type where only one stage has it. \\throws KeyError."""
        stages = self.stages
        found = [s for s in stages if (s.index == stage if isinstance(stage, int) else s.name == stage)]
        if not found and isinstance(stage, str):
            found = [s for s in stages if s.kind == stage]
        if len(found) != 1:
            why = "more than one stage is of this type" if found else "there is no such stage"
            raise KeyError(f"{self.folder}: stage {stage!r}: {why}; there are {', '.join(s.label for s in stages)}")
        return found[0]

    def stage_of_rows(self, table: Table) -> np.ndarray:
        """Number of the stage that each row of a table belongs to, shape (rows,); -1 where table.csv does not tell.

        A step at which one stage ends and the next begins belongs to the one that ends.
        """
        if "stage" in table:
            return table["stage"].astype(int)
        steps, stages = self.table["step"], self.table["stage"].astype(int)
        result = np.full(table.n_rows, -1)
        for stage in reversed(np.unique(stages)):
            own = steps[stages == stage]
            result[(table["step"] >= own.min()) & (table["step"] <= own.max())] = stage
        return result

    def of_stage(self, table: Table, stage: int | str) -> Table:
        """The rows of a table that belong to one stage: its number, name or type."""
        return table.where(self.stage_of_rows(table) == self.find_stage(stage).index)

    def average(
        self, column: str, first: float, last: float, name: str | None = None, stage: int | str | None = None
    ) -> tuple[float, float]:
        """Mean and standard error (blocking) of a column over first < strain < last.

        name: a table of measures; without it table.csv. stage: only rows of that stage (number, name or type).
        Rows of a stage that does not shear are part of the mean only where `stage` names it, with a warning otherwise.
        \\throws ValueError where the strain runs both ways through the window and no stage is named: the mean of both
        directions says nothing.
        """
        table = self.measure(name) if name else self.table
        if stage is not None:
            table = self.of_stage(table, stage)
        table = table.where((table["strain"] > first) & (table["strain"] < last))
        if stage is None:
            table = self._of_one_direction(table, first, last)
        return blocked_mean(table[column])

    def _of_one_direction(self, table: Table, first: float, last: float) -> Table:
        whole = self.table
        if "stage" not in whole:
            return table
        of_row, numbers = self.stage_of_rows(table), whole["stage"].astype(int)
        paths = {k: whole["strain"][numbers == k] for k in np.unique(of_row) if k >= 0}
        turns = {k: np.sign(path[-1] - path[0]) if len(path) else 0.0 for k, path in paths.items()}
        moving = {k: turn for k, turn in turns.items() if turn != 0}
        if len(set(moving.values())) > 1:
            raise ValueError(
                f"{self.folder}: the strain runs both ways between {first:g} and {last:g}, in the stages "
                f"{', '.join(map(str, moving))}: name one of them by stage="
            )
        at_rest = [k for k in turns if k not in moving]
        if moving and at_rest:
            warnings.warn(
                f"{self.folder}: rows of the stages {', '.join(map(str, at_rest))}, which do not shear, are left out "
                "of the average; stage= names one",
                stacklevel=3,
            )
            return table.where(~np.isin(of_row, at_rest))
        return table

    @property
    def frames(self) -> Frames:
        """The stored frames."""
        return Frames(self.folder / "trajectory.h5")

    def universe(self, grains: str = "whole") -> MDAnalysis.Universe:
        """An MDAnalysis Universe of the stored frames (see boba.universe).

        Grains are residues (resid is the grain's number in other files), species are segments, bonds are bonds.
        Lengths are d, times tau. grains: "whole" (centre in the cell), "wrapped" (nodes in the cell) or "unwrapped".
        \\throws ImportError where MDAnalysis is not installed; FileNotFoundError without frames; ValueError.
        """
        from .universe import make_universe

        return make_universe(self.frames.path, grains)

    def _read(self, path: pathlib.Path) -> Table:
        stamp = path.stat().st_mtime_ns
        if self._tables.get(path, (None,))[0] != stamp:
            self._tables[path] = (stamp, read_table(path))
        return self._tables[path][1]

    def __repr__(self) -> str:
        parts = []
        try:
            parts.append(f"stages {', '.join(stage.name or stage.kind for stage in self.stages)}")
        except (OSError, ValueError):
            pass
        try:
            table = self.table
            if table.n_rows:
                parts.append(f"table of {table.n_rows} rows to step {table['step'][-1]:.0f}")
                if "strain" in table:
                    parts[-1] += f", strain {table['strain'][-1]:g}"
        except (OSError, ValueError):
            pass
        try:
            parts.append(f"{len(self.frames)} frames")
        except (OSError, ImportError):
            pass
        if self.measures:
            parts.append(f"measures {', '.join(self.measures)}")
        return f"<boba.Run {self.folder}: {'; '.join(parts) or 'no files of a run'}>"


def open_run(folder: str | os.PathLike[str], measures: str | os.PathLike[str] | None = None) -> Run:
    """Opens a run's output folder; `measures` names another folder of measures than FOLDER/measures.

    \\throws FileNotFoundError where there is no such folder.
    """
    return Run(folder, measures)
