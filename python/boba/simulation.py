# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs that Python drives: it starts the program boba, looks at the steps that it wants, and says how to continue.

The program computes in a process of its own, with as many threads as it is given, while Python is free. What it writes
is what `boba run` of the same scene writes, bit for bit.
"""
from __future__ import annotations

import dataclasses
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

import numpy as np

from .program import DONE, STOPPED, error_of, find_program
from .run import Run, open_run
from .toml_text import scene_text, value_text


@dataclasses.dataclass
class State:
    """A packing at one step, while the run waits there; lengths in d, times in tau.

    step, time, strain, stage (from 0, as in the scene), stage_done (share of it, as far as it is known).
    pressure, mu (nan where the pressure cannot be told from rounding), stress: shape (6,), xx yy zz xy xz yz, k/d,
    tension positive. kinetic_energy, elastic_energy: k d^2. largest_overlap: d.
    box: shape (3, 3), cell vectors a, b, c as columns; origin: shape (3,), the cell's corner.
    """

    step: int
    time: float
    strain: float
    stage: int
    stage_done: float
    pressure: float
    mu: float
    kinetic_energy: float
    elastic_energy: float
    largest_overlap: float
    stress: np.ndarray
    box: np.ndarray
    origin: np.ndarray
    _simulation: Simulation = dataclasses.field(repr=False)

    def _array(self, name: str, columns: int = 1) -> np.ndarray:
        values = self._simulation._array(self, name)
        return values.reshape(-1, columns) if columns > 1 else values

    @property
    def positions(self) -> np.ndarray:
        """Unwrapped positions of all nodes, shape (nodes, 3), d. A copy, as all arrays are."""
        return self._array("position", 3)

    @property
    def velocities(self) -> np.ndarray:
        """Full-step velocities of all nodes, shape (nodes, 3), d/tau."""
        return self._array("velocity", 3)

    @property
    def forces(self) -> np.ndarray:
        """Forces on all nodes, shape (nodes, 3), k d."""
        return self._array("force", 3)

    @property
    def grain_centres(self) -> np.ndarray:
        """Mean of each grain's nodes, unwrapped, shape (grains, 3), d."""
        return self._array("grain_centre", 3)

    @property
    def grain_stress(self) -> np.ndarray:
        """Each grain's part of the stress times the cell's volume, shape (grains, 6), k d^2, tension positive."""
        return self._array("grain_stress", 6)

    @property
    def first_node(self) -> np.ndarray:
        """Shape (grains + 1,): nodes first_node[g] to first_node[g + 1] - 1 are grain g's."""
        return self._array("first_node").astype(np.int64)

    @property
    def species(self) -> np.ndarray:
        """Species of each grain, shape (grains,), from 0 as in the scene."""
        return self._array("species").astype(np.int64)

    @property
    def grain_numbers(self) -> np.ndarray:
        """Number of each grain in files, shape (grains,)."""
        return self._array("molecule").astype(np.int64)

    @property
    def volume(self) -> float:
        """Volume of the cell, d^3."""
        return float(np.linalg.det(self.box))


def _state_of(line: str, simulation: Simulation) -> State:
    words = line.split()[1:]
    numbers = [float(word) for word in words]
    return State(
        int(words[0]),
        *numbers[1:3],
        int(words[3]),
        *numbers[4:10],
        stress=np.array(numbers[10:16]),
        box=np.array(numbers[16:25]).reshape(3, 3),
        origin=np.array(numbers[25:28]),
        _simulation=simulation,
    )


Observer = Callable[[State], Any]


class Simulation:
    """One run of a scene.

        sim = boba.Simulation("scene.toml", set={"stage.shear.rate": 1e-4}, output="out/slow")
        for state in sim.steps(every=100):
            print(state.strain, state.mu)
        run = sim.read()                      # as boba.open(sim.output)

    scene: a file, or a mapping with the values of one (lists of mappings for template, species and stage; files that it
    names by their whole paths).
    set: what --set changes. output: the run's folder; default the scene's. threads: default the scene's, or all cores.
    force: replace the run that is in the folder. program: default find_program().
    Nothing runs before steps() or run(). Its errors are InputError and RunError with the program's sentence.
    """

    def __init__(
        self,
        scene: str | os.PathLike[str] | Mapping[str, Any],
        *,
        set: Mapping[str, Any] | None = None,
        output: str | os.PathLike[str] | None = None,
        threads: int | None = None,
        force: bool = False,
        program: str | os.PathLike[str] | None = None,
    ) -> None:
        self._program = find_program(program)
        self._made: pathlib.Path | None = None
        if isinstance(scene, Mapping):
            self._made = pathlib.Path(tempfile.mkdtemp(prefix="boba-scene-"))
            (self._made / "scene.toml").write_text(scene_text(scene), encoding="utf-8")
            scene = self._made / "scene.toml"
        self._scene = pathlib.Path(scene)
        self._arguments = ["run", os.fspath(self._scene)]
        for place, value in (set or {}).items():
            # A text that is no number, list or table stands for itself.
            text = value if isinstance(value, str) and "\n" not in value else value_text(value)
            self._arguments += ["--set", f"{place}={text}"]
        self._options: list[str] = ["--force"] if force else []
        if output is not None:
            self._options += ["--output", os.fspath(output)]
        if threads is not None:
            self._options += ["--threads", str(threads)]
        self._begin(pathlib.Path(output) if output is not None else None)

    def _begin(self, output: pathlib.Path | None) -> None:
        self._output = output
        self._process: subprocess.Popen[str] | None = None
        self._state: State | None = None
        self._requests = self._answers = None
        self._told: Any = None
        self.outcome: str | None = None

    @classmethod
    def resume(
        cls,
        folder: str | os.PathLike[str],
        *,
        threads: int | None = None,
        program: str | os.PathLike[str] | None = None,
    ) -> Simulation:
        """A run that was stopped or killed, continued from its last checkpoint as `boba resume` does."""
        self = cls.__new__(cls)
        self._program = find_program(program)
        self._made = None
        self._arguments = ["resume", os.fspath(folder)]
        self._options = ["--threads", str(threads)] if threads is not None else []
        self._begin(pathlib.Path(folder))
        return self

    @property
    def output(self) -> pathlib.Path:
        """The run's folder."""
        if self._output is None:
            from .scene import read_scene

            directory = read_scene(self._scene).values.get("output", {}).get("directory")
            settings = [word for word in self._arguments if word.startswith("output.directory=")]
            if settings:
                directory = settings[-1].partition("=")[2].strip('"')
            if not directory:
                raise ValueError(f"{self._scene}: names no output.directory; give output=")
            self._output = pathlib.Path(directory)
        return self._output

    def read(self) -> Run:
        """The run's folder opened for reading, also while it runs."""
        return open_run(self.output)

    def steps(self, every: int | None = None, observers: Iterable[Observer] = ()) -> Iterator[State]:
        """Runs, and gives the state at the first step, each `every` steps, and at the end of every stage.

        The run waits while Python looks; arrays of a state can be taken until the next one. Leaving the loop early
        stops the run with a checkpoint. observers: functions that are called with each state first.
        After Ctrl-C the run stops with a checkpoint, and KeyboardInterrupt goes on.
        \\throws InputError, RunError; ValueError for every < 1; RuntimeError when it has run already.
        """
        if every is not None and every < 1:
            raise ValueError(f"steps: every = {every}: must be at least 1")
        if self.outcome is not None or self._process is not None:
            raise RuntimeError("a simulation runs once: make another one, or Simulation.resume(output)")
        self._start()
        try:
            while (line := self._line()).startswith("state "):
                self._state = _state_of(line, self)
                for observer in observers:
                    observer(self._state)
                yield self._state
                step = self._state.step
                self._state = None
                self._ask(f"go {-1 if every is None else (step // every + 1) * every}")
            self._end()
        except GeneratorExit:
            self.stop()
            raise
        except KeyboardInterrupt:
            self.stop()
            raise
        finally:
            if self._process is not None:
                self.stop()

    def run(self, every: int | None = None, observers: Iterable[Observer] = ()) -> Run:
        """Runs to the end and opens what was written. Observers see the states that steps() would give."""
        for _ in self.steps(every, observers):
            pass
        return self.read()

    def stop(self) -> None:
        """Stops with a checkpoint, from which Simulation.resume continues bit for bit. Does nothing when it has ended."""
        process = self._process
        if process is None:
            return
        # Closed pipes are a wish to stop at a step that is looked at; the signal is one at any other.
        process.send_signal(signal.SIGTERM)
        self._close_pipes()
        self._end(raising=False)

    def _start(self) -> None:
        try:
            self._output = self.output.absolute()  # wherever Python goes meanwhile
        except (OSError, ValueError):
            pass  # a scene that cannot be read: the program tells why
        their_requests, requests = os.pipe()
        answers, their_answers = os.pipe()
        self._told = tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace")
        command = [os.fspath(self._program), *self._arguments, *self._options, "--quiet"]
        command += ["--caller", f"{their_requests},{their_answers}"]
        try:
            # A session of its own: Ctrl-C reaches Python alone, which stops the run in an orderly way.
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=self._told,
                pass_fds=(their_requests, their_answers),
                start_new_session=True,
                text=True,
            )
        except OSError:
            os.close(requests)
            os.close(answers)
            raise
        finally:
            os.close(their_requests)
            os.close(their_answers)
        self._requests, self._answers = os.fdopen(requests, "wb", buffering=0), os.fdopen(answers, "rb")

    def _line(self) -> str:
        return self._answers.readline().decode("ascii")

    def _ask(self, request: str) -> None:
        try:
            self._requests.write(request.encode("ascii") + b"\n")
        except BrokenPipeError:
            pass  # it has ended; its exit code tells why

    def _array(self, state: State, name: str) -> np.ndarray:
        if state is not self._state:
            raise RuntimeError(f"{name}: the run has left step {state.step}; take arrays before the next state")
        self._ask(f"array {name}")
        kind, _, rest = self._line().rstrip("\n").partition(" ")
        if kind != "array":
            raise RuntimeError(rest if kind == "error" else f"{name}: the program has ended")
        count = int(rest)
        values = np.frombuffer(self._answers.read(8 * count), dtype="<f8")
        if len(values) != count:
            raise RuntimeError(f"{name}: the program ended while it sent {count} numbers")
        return values

    def _close_pipes(self) -> None:
        for pipe in (self._requests, self._answers):
            if pipe is not None:
                pipe.close()

    def _end(self, raising: bool = True) -> None:
        process, self._process, self._state = self._process, None, None
        assert process is not None
        code = process.wait()
        self._close_pipes()
        self._told.seek(0)
        told = self._told.read()
        self._told.close()
        if self._made is not None:
            shutil.rmtree(self._made, ignore_errors=True)
        self.outcome = {DONE: "done", STOPPED: "stopped"}.get(code, "failed")
        if self.outcome == "failed" and raising:
            raise error_of(code, told)

    def __repr__(self) -> str:
        where = self._output if self._output is not None else self._scene
        now = "running" if self._process is not None else self.outcome or "not begun"
        return f"<boba.Simulation {where}: {now}{f' at step {self._state.step}' if self._state else ''}>"
