# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of a trajectory (H5MD), also of a run that still goes on."""
from __future__ import annotations

import pathlib
import time as clock
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike

if TYPE_CHECKING:
    import h5py

# Fill values: what a reader sees of a frame that is not written yet (docs/formats.md).
_GROWING = (
    "particles/all/position/step",
    "particles/all/position/time",
    "particles/all/box/edges/value",
    "particles/all/box/boba_origin/value",
    "particles/all/position/value",
    "particles/all/image/value",
    "observables/strain/value",
    "observables/grain_centre/value",
    "observables/grain_stress/value",
)
_IMAGE_NOT_WRITTEN = np.iinfo(np.int32).min
_Result = TypeVar("_Result")


def _is_complete(file: h5py.File, index: int) -> bool:
    """Every dataset has the frame, and no value of it is a fill value: what is flushed first is not known."""
    for name in _GROWING:
        values = file[name]
        if len(values) <= index:
            return False
        frame = np.asarray(values[index])
        if frame.dtype.kind == "f":
            written = np.isfinite(frame).all()
        else:
            written = (frame >= 0).all() if name.endswith("step") else (frame != _IMAGE_NOT_WRITTEN).all()
        if not written:
            return False
    return True


class Frame:
    """One frame; lengths in d, times in tau.

    step, time, strain: when it was written.
    box: shape (3, 3), the cell vectors a, b, c as columns; origin: shape (3,), the cell's corner.
    positions: shape (nodes, 3), unwrapped; velocities: the same in d/tau, or None where none were stored.
    grain_centres: shape (grains, 3); grain_stress: shape (grains, 6), k d, xx yy zz xy xz yz, tension positive: the
    grain's part of the stress times the cell's volume.
    first_node: shape (grains + 1,): nodes first_node[g] to first_node[g + 1] - 1 are grain g's; species: shape (grains,).
    """

    def __init__(self, file: h5py.File, index: int) -> None:
        particles = file["particles/all"]
        observables = file["observables"]
        self.step = int(particles["position/step"][index])
        self.time = float(particles["position/time"][index])
        self.strain = float(observables["strain/value"][index])
        # H5MD: rows of `edges` are the cell vectors.
        self.box: np.ndarray = particles["box/edges/value"][index].T
        self.origin: np.ndarray = particles["box/boba_origin/value"][index]
        wrapped = particles["position/value"][index]
        self.positions: np.ndarray = wrapped + particles["image/value"][index] @ self.box.T
        stored = "velocity" in particles and len(particles["velocity/value"]) > index
        self.velocities: np.ndarray | None = particles["velocity/value"][index] if stored else None
        self.grain_centres: np.ndarray = observables["grain_centre/value"][index]
        self.grain_stress: np.ndarray = observables["grain_stress/value"][index]
        self.first_node: np.ndarray = file["parameters/grains/first_node"][:]
        self.species: np.ndarray = file["parameters/grains/species"][:]

    @property
    def n_grains(self) -> int:
        """Number of grains."""
        return len(self.first_node) - 1

    @property
    def grains(self) -> list[np.ndarray]:
        """The unwrapped nodes of each grain, arrays of shape (n, 3), d."""
        return self._by_grain(self.positions)

    @property
    def placed_grains(self) -> list[np.ndarray]:
        """The nodes of each grain, whole, with its centre in the cell, arrays of shape (n, 3), d."""
        return self._by_grain(self.whole_grains())

    @property
    def grain_of_node(self) -> np.ndarray:
        """Number of the grain that each node belongs to, shape (nodes,)."""
        return np.repeat(np.arange(self.n_grains), np.diff(self.first_node))

    @property
    def volume(self) -> float:
        """Volume of the cell, d^3."""
        return float(np.linalg.det(self.box))

    def shift_into_cell(self, x: ArrayLike) -> np.ndarray:
        """The lattice vector that takes the point x into the cell, d; shape (3,), or (n, 3) for n points."""
        points = np.asarray(x, dtype=float)
        fractional = np.linalg.solve(self.box, (points - self.origin).T).T
        return -np.floor(fractional) @ self.box.T

    def whole_grains(self) -> np.ndarray:
        """Positions of all nodes, shape (nodes, 3), d: each grain whole, moved so that its centre is in the cell."""
        return self.positions + self.shift_into_cell(self.grain_centres)[self.grain_of_node]

    def _by_grain(self, nodes: np.ndarray) -> list[np.ndarray]:
        return [nodes[a:b] for a, b in zip(self.first_node[:-1], self.first_node[1:])]

    def __repr__(self) -> str:
        return (
            f"<boba.Frame at step {self.step}, time {self.time:g} tau, strain {self.strain:g}: "
            f"{self.n_grains} grains, {len(self.positions)} nodes>"
        )


class Frames:
    """Frames of a trajectory, by number (negative from the end); each is read when it is taken."""

    def __init__(self, path: pathlib.Path) -> None:
        self.path = path

    def _file(self) -> h5py.File:
        import h5py

        return h5py.File(self.path, "r")

    def _read(self, look: Callable[[Any], _Result]) -> _Result:
        """Looks into the file. A run that goes on may be in the middle of a write: then it is opened again."""
        if not self.path.exists():
            raise FileNotFoundError(f"{self.path}: there is no such file; a run stores frames for [output.trajectory]")
        for attempt in range(50):
            try:
                with self._file() as file:
                    return look(file)
            except FileNotFoundError:
                raise
            except (OSError, RuntimeError, KeyError) as error:
                failure = error
                clock.sleep(0.02)
        raise OSError(f"{self.path}: cannot be read: {failure}") from failure

    @staticmethod
    def _count(file: h5py.File) -> int:
        n = min(len(file[name]) for name in _GROWING)
        while n > 0 and not _is_complete(file, n - 1):
            n -= 1
        return n

    def __len__(self) -> int:
        return self._read(self._count)

    def __getitem__(self, index: int) -> Frame:
        def look(file: h5py.File) -> Frame | int | None:
            n = self._count(file)
            if not -n <= index < n:
                return n
            frame = Frame(file, index % n)
            return frame if _is_complete(file, index % n) else None

        frame = self._read(look)
        if frame is None:
            raise ValueError(f"{self.path}: frame {index} was never finished")
        if not isinstance(frame, Frame):
            raise IndexError(f"{self.path}: frame {index} of {frame}")
        return frame

    def __iter__(self) -> Iterator[Frame]:
        return (self[k] for k in range(len(self)))

    @property
    def steps(self) -> np.ndarray:
        """Steps of the frames, shape (frames,)."""
        return self._read(lambda file: file[_GROWING[0]][: self._count(file)])

    @property
    def times(self) -> np.ndarray:
        """Times of the frames, tau, shape (frames,)."""
        return self._read(lambda file: file[_GROWING[1]][: self._count(file)])

    @property
    def strains(self) -> np.ndarray:
        """Shear strains of the frames, shape (frames,)."""
        return self._read(lambda file: file["observables/strain/value"][: self._count(file)])

    def at_strain(self, strain: float) -> Frame:
        """The frame whose strain is nearest. \\throws IndexError where there is no frame yet."""
        strains = self.strains
        if len(strains) == 0:
            raise IndexError(f"{self.path}: holds no frame yet")
        return self[int(np.argmin(np.abs(strains - strain)))]

    def __repr__(self) -> str:
        return f"<boba.Frames {self.path}: {len(self)} frames>" if self.path.exists() else "<boba.Frames: none stored>"
