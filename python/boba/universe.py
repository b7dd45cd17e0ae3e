# SPDX-License-Identifier: GPL-3.0-or-later
"""Trajectories of Boba in MDAnalysis: grains as residues, bonds, whole grains, steps and times as the run had them.

`Run.universe()` makes a Universe. Its frames carry `ts.data["step"]`, `["strain"]`, `["grain_stress"]` (grains x 6, k d)
and `["origin"]` (the cell's corner, d) beside the time (tau). Positions are float32, as MDAnalysis keeps them.
"""
from __future__ import annotations

import os
import pathlib
from typing import Any

import numpy as np

from .frames import Frame, Frames

try:
    import MDAnalysis
    from MDAnalysis.coordinates.base import ReaderBase
    from MDAnalysis.lib.mdamath import triclinic_box
except ImportError as error:
    raise ImportError("a universe needs MDAnalysis (Debian: python3-mdanalysis)") from error

PLACEMENTS = ("whole", "wrapped", "unwrapped")


class TrajectoryReader(ReaderBase):
    """Reads trajectory.h5 for MDAnalysis; `grains` is one of PLACEMENTS."""

    format = ["BOBA"]
    units = {"time": None, "length": None}

    def __init__(self, filename: str | os.PathLike[str], grains: str = "whole", **options: Any) -> None:
        self._grains = grains
        self._frames = Frames(pathlib.Path(filename))
        self._steps, self._times = self._frames.steps, self._frames.times
        self.n_frames = len(self._steps)
        first = self._frames[0]
        self.n_atoms = len(first.positions)
        if self.n_frames > 1:
            # The mean interval; each frame's own time is exact.
            options.setdefault("dt", float(self._times[-1] - self._times[0]) / (self.n_frames - 1))
        super().__init__(os.fspath(filename), **options)
        self.ts = self._Timestep(
            self.n_atoms, positions=True, velocities=first.velocities is not None, **self._ts_kwargs
        )
        self._fill(0)

    @property
    def times(self) -> np.ndarray:
        """Times of the frames, tau, shape (frames,)."""
        return self._times

    def _placed(self, frame: Frame) -> np.ndarray:
        if self._grains == "whole":
            return frame.whole_grains()
        if self._grains == "unwrapped":
            return frame.positions
        return frame.positions + frame.shift_into_cell(frame.positions)

    def _fill(self, index: int) -> Any:
        frame, ts = self._frames[index], self.ts
        ts.frame = index
        ts.time = frame.time
        ts.positions = self._placed(frame)
        if frame.velocities is not None:
            ts.velocities = frame.velocities
        ts.dimensions = triclinic_box(*frame.box.T)
        ts.data.update(step=frame.step, strain=frame.strain, grain_stress=frame.grain_stress, origin=frame.origin)
        return ts

    def _read_frame(self, frame: int) -> Any:
        return self._fill(frame)

    def _read_next_timestep(self) -> Any:
        if self.ts.frame + 1 >= self.n_frames:
            raise EOFError
        return self._fill(self.ts.frame + 1)

    def _reopen(self) -> None:
        self.ts.frame = -1

    def close(self) -> None:
        """Nothing stays open between frames."""


def make_universe(path: pathlib.Path, grains: str = "whole") -> MDAnalysis.Universe:
    """The Universe of a trajectory; see Run.universe."""
    if grains not in PLACEMENTS:
        raise ValueError(f"universe: grains = {grains!r}: must be one of {', '.join(PLACEMENTS)}")
    if len(Frames(path)) == 0:
        raise ValueError(f"{path}: holds no frame yet")

    def look(file: Any) -> tuple[np.ndarray, ...]:
        parameters, everything = file["parameters/grains"], file["particles/all"]
        names = ("first_node", "molecule", "species")
        return (*(parameters[n][:] for n in names), everything["id"][:], everything["mass"][:], bonds_of(file))

    def bonds_of(file: Any) -> np.ndarray:
        return file["connectivity/bonds"][:] if "connectivity/bonds" in file else np.empty((0, 2), dtype=int)

    first_node, molecule, species, ids, masses, bonds = Frames(path)._read(look)
    segments, segment_of_grain = np.unique(species, return_inverse=True)
    universe = MDAnalysis.Universe.empty(
        len(ids),
        n_residues=len(molecule),
        n_segments=len(segments),
        atom_resindex=np.repeat(np.arange(len(molecule)), np.diff(first_node)),
        residue_segindex=segment_of_grain,
    )
    universe.add_TopologyAttr("ids", ids)
    universe.add_TopologyAttr("masses", masses)
    universe.add_TopologyAttr("types", species[universe.atoms.resindices].astype(str))
    universe.add_TopologyAttr("resids", molecule)
    universe.add_TopologyAttr("resnames", np.array([f"species{s}" for s in species], dtype=object))
    universe.add_TopologyAttr("segids", np.array([f"species{s}" for s in segments], dtype=object))
    order = np.argsort(ids)
    places = order[np.searchsorted(ids, bonds, sorter=order)]
    universe.add_TopologyAttr("bonds", [tuple(pair) for pair in places.tolist()])
    universe.load_new(os.fspath(path), format=TrajectoryReader, grains=grains)
    return universe
