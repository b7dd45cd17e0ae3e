# SPDX-License-Identifier: GPL-3.0-or-later
"""One run: its folder, tables and frames."""
import pathlib
import time as clock

import numpy as np


def read_table(path):
    """A CSV table as a dictionary of columns; an empty field is nan. Reads a table that is still being written."""
    with pathlib.Path(path).open() as file:
        header = file.readline()
        names = header.rstrip("\n").split(",") if header.endswith("\n") else []
        rows = [line.rstrip("\n").split(",") for line in file if line.endswith("\n")]
    rows = [row for row in rows if len(row) == len(names)]
    try:
        values = np.array([[float(field) if field else np.nan for field in row] for row in rows], dtype=float)
    except ValueError as error:
        raise ValueError(f"{path}: not a table of numbers: {error}") from None
    values = values.reshape(len(rows), len(names))
    return {name: values[:, k] for k, name in enumerate(names)}


def blocked_mean(values):
    """Mean of a correlated series and the standard error of that mean, by blocking.

    Block size: the smallest B with B^3 > 2 n (error_B / error_1)^4 (Lee et al., Phys. Rev. E 83, 066706, 2011);
    without such a B the largest error met, which is then a lower bound.
    """
    values = np.asarray(values, dtype=float)
    values = values[np.isfinite(values)]
    n = len(values)
    if n < 2:
        raise ValueError(f"blocking: {n} values; at least 2 are needed")
    mean = values.mean()
    blocks, size, best = values, 1, 0.0
    first = error = blocks.std() / np.sqrt(n - 1)
    while True:
        best = max(best, error)
        if len(blocks) // 2 < 8:
            return mean, best
        even = len(blocks) // 2 * 2
        blocks = 0.5 * (blocks[0:even:2] + blocks[1:even:2])
        size *= 2
        error = blocks.std() / np.sqrt(len(blocks) - 1)
        inflation = error / first if first > 0 else 1.0
        if size**3 > 2 * n * inflation**4:
            return mean, error


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


def _is_complete(file, index):
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
    """One frame: `box` (columns a, b, c), `origin`, `step`, `time`, `strain`, unwrapped `positions`, per-grain data."""

    def __init__(self, file, index):
        particles = file["particles/all"]
        observables = file["observables"]
        self.step = int(particles["position/step"][index])
        self.time = float(particles["position/time"][index])
        self.strain = float(observables["strain/value"][index])
        # H5MD: rows of `edges` are the cell vectors.
        self.box = particles["box/edges/value"][index].T
        self.origin = particles["box/boba_origin/value"][index]
        wrapped = particles["position/value"][index]
        self.positions = wrapped + particles["image/value"][index] @ self.box.T
        self.grain_centres = observables["grain_centre/value"][index]
        self.grain_stress = observables["grain_stress/value"][index]
        self.first_node = file["parameters/grains/first_node"][:]
        self.species = file["parameters/grains/species"][:]

    @property
    def grains(self):
        """List of arrays (n, 3): the unwrapped nodes of each grain, d."""
        return [self.positions[a:b] for a, b in zip(self.first_node[:-1], self.first_node[1:])]

    @property
    def volume(self):
        return float(np.linalg.det(self.box))

    def shift_into_cell(self, x):
        """The lattice vector that takes the point x into the cell, d."""
        return -self.box @ np.floor(np.linalg.solve(self.box, np.asarray(x) - self.origin))


class Frames:
    """Frames of a trajectory, by number (negative from the end); read when asked for."""

    def __init__(self, path):
        self.path = path

    def _file(self):
        import h5py

        return h5py.File(self.path, "r")

    def _read(self, look):
        """Looks into the file. A run that goes on may be in the middle of a write: then it is opened again."""
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
    def _count(file):
        n = min(len(file[name]) for name in _GROWING)
        while n > 0 and not _is_complete(file, n - 1):
            n -= 1
        return n

    def __len__(self):
        return self._read(self._count)

    def __getitem__(self, index):
        def look(file):
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

    def at_strain(self, strain):
        """The frame whose strain is nearest."""
        strains = self._read(lambda file: file["observables/strain/value"][: self._count(file)])
        if len(strains) == 0:
            raise IndexError(f"{self.path}: holds no frame yet")
        return self[int(np.argmin(np.abs(strains - strain)))]


class Run:
    """A run's output folder."""

    def __init__(self, folder, measures=None):
        self.folder = pathlib.Path(folder)
        if not self.folder.is_dir():
            raise FileNotFoundError(f"{self.folder}: there is no such folder")
        self.measures_folder = pathlib.Path(measures) if measures else self.folder / "measures"
        self._tables = {}

    @property
    def table(self):
        """Columns of table.csv."""
        return self._read(self.folder / "table.csv")

    @property
    def measures(self):
        """Names of the tables of measures that there are."""
        return sorted(path.stem for path in self.measures_folder.glob("*.csv"))

    def measure(self, name):
        """Columns of measures/NAME.csv."""
        path = self.measures_folder / f"{name}.csv"
        if not path.exists():
            raise KeyError(f"{path}: there is no such table; there are: {', '.join(self.measures) or 'none'}")
        return self._read(path)

    def rows(self, name, step):
        """The rows of one frame of a table of measures; KeyError when that frame was not measured."""
        table = self.measure(name)
        chosen = table["step"] == step
        if not chosen.any():
            # A frame without contacts, facets or rows of motion has no rows; its summary has one.
            summary = {"contacts": "coordination", "facets": "shape"}.get(name, name)
            steps = self.steps(summary if summary in self.measures else name)
            if step not in steps:
                known = f"{steps[0]} to {steps[-1]}, {len(steps)} in all" if len(steps) else "none"
                raise KeyError(f"{self.measures_folder / name}.csv: step {step} was not measured; steps: {known}")
        return {column: values[chosen] for column, values in table.items()}

    def steps(self, name):
        """Steps of the frames in a table of measures, ascending."""
        return np.unique(self.measure(name)["step"]).astype(int)

    def contacts(self, step):
        """Contact network of one frame: grain, other, image, force, area, normal, branch."""
        return self.rows("contacts", step)

    def grain_traces(self, column, name="grains"):
        """(strains, values[frame, grain]) of a per-grain column."""
        table = self.measure(name)
        steps = np.unique(table["step"])
        frames = [table["step"] == step for step in steps]
        return (np.array([table["strain"][f][0] for f in frames]), np.array([table[column][f] for f in frames]))

    def average(self, column, first, last, name=None):
        """Mean and standard error (blocking) of a column over first < strain < last, from table.csv or a measure."""
        table = self.measure(name) if name else self.table
        inside = (table["strain"] > first) & (table["strain"] < last)
        return blocked_mean(table[column][inside])

    @property
    def frames(self):
        return Frames(self.folder / "trajectory.h5")

    def _read(self, path):
        stamp = path.stat().st_mtime_ns
        if self._tables.get(path, (None,))[0] != stamp:
            self._tables[path] = (stamp, read_table(path))
        return self._tables[path][1]


def open_run(folder, measures=None):
    """Opens a run's output folder; `measures` names another folder of measures than FOLDER/measures."""
    return Run(folder, measures)
