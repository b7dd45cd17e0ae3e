# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs driven from Python: the same bits as `boba run`, states that hold together, stops, errors, Ctrl-C."""
import os
import signal
import subprocess
import sys
import time
import tomllib

import boba
import numpy as np
import pytest
from boba.toml_text import scene_text

SCENE = {
    "title": 'driven "by" Python',
    "seed": 3,
    "run": {"threads": 2},
    "output": {"directory": "out", "table": {"every_time": 5.0}, "trajectory": {"every_time": 50.0}},
    "template": [{"name": "grain", "nodes": 60}],
    "species": [{"template": "grain", "count": 8, "alpha": 2.0}],
    "stage": [
        {"type": "insert", "packing_fraction": 0.25},
        {"type": "compress", "pressure": 0.1, "rate": 2e-3, "kinetic_tolerance": 1e-4},
        {"type": "shear", "rate": 2e-3, "strain": 0.2, "pressure": 0.1},
        {"type": "hold", "time": 10.0},
    ],
}


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder with scene.toml and `plain`, what `boba run` makes of it."""
    folder = tmp_path_factory.mktemp("driven")
    os.environ["BOBA_CACHE_DIR"] = str(folder / "cache")
    (folder / "scene.toml").write_text(scene_text(SCENE))
    subprocess.run(
        [os.environ["BOBA_PROGRAM"], "run", "scene.toml", "--output", "plain", "--quiet"], cwd=folder, check=True
    )
    return folder


def without_speed(folder):
    """table.csv as text, without the column that tells how fast the machine was."""
    return [line.rpartition(",")[0] for line in (folder / "table.csv").read_text().splitlines()]


def assert_same_run(folder, other):
    assert without_speed(folder) == without_speed(other)
    frames, others = boba.open(folder).frames, boba.open(other).frames
    assert len(frames) == len(others) > 3
    for a, b in zip(frames, others):
        np.testing.assert_array_equal(a.positions, b.positions)
        np.testing.assert_array_equal(a.grain_stress, b.grain_stress)


def test_a_scene_of_python_values_is_toml():
    assert tomllib.loads(scene_text(SCENE)) == SCENE
    odd = {"title": 'a"b\\c\n\x7f\u00e9', "x": [1, 2.5, True, np.float64(3), np.int64(4)], "run": {"t": {"u": 1e-12}}}
    assert tomllib.loads(scene_text(odd)) == odd
    for value in (float("nan"), None, object()):
        with pytest.raises(TypeError, match="a scene holds"):
            scene_text({"x": value})


def test_the_same_bits_whoever_watches(place):
    simulation = boba.Simulation(place / "scene.toml", output=place / "watched")
    seen = []
    run = simulation.run(every=37, observers=[lambda state: seen.append((state.step, state.positions.sum()))])
    assert simulation.outcome == "done"
    assert_same_run(run.folder, place / "plain")
    steps = [step for step, _ in seen]
    ends = {int(run.of_stage(run.table, k)["step"][-1]) for k in (1, 2, 3)}
    assert steps == sorted(set(range(0, max(ends) + 1, 37)) | ends)


def test_from_values_with_settings(place, monkeypatch):
    monkeypatch.chdir(place)
    simulation = boba.Simulation(SCENE, set={"output.directory": "made", "stage.shear.strain": 0.2})
    assert "not begun" in repr(simulation)
    assert_same_run(simulation.run().folder, place / "plain")


def test_states_hold_together(place):
    simulation = boba.Simulation(place / "scene.toml", output=place / "looked", threads=1)
    table = boba.open(place / "plain").table
    row_of = {int(step): k for k, step in enumerate(table["step"])}
    looked = 0
    for state in simulation.steps(every=100):
        assert state.pressure == pytest.approx(-state.stress[:3].sum() / 3, rel=1e-12, abs=1e-15)
        if state.step in row_of:
            assert state.pressure == table["P_k/d"][row_of[state.step]]
            assert state.kinetic_energy == table["kinetic_energy_kd2"][row_of[state.step]]
        x, v, f = state.positions, state.velocities, state.forces
        assert x.shape == v.shape == f.shape == (480, 3)
        assert 0.5 * (v**2).sum() == pytest.approx(state.kinetic_energy, rel=1e-9, abs=1e-15)
        assert np.abs(f.sum(axis=0)).max() < 1e-10  # action and reaction
        nodes = state.first_node
        assert nodes.tolist() == list(range(0, 481, 60))
        np.testing.assert_allclose(
            state.grain_centres, [x[a:b].mean(axis=0) for a, b in zip(nodes, nodes[1:])], rtol=1e-12
        )
        assert state.grain_numbers.tolist() == list(range(1, 9)) and set(state.species) == {0}
        if state.step % 100 == 0 and state.pressure > 1e-3 and not 0 < state.strain:
            # While nothing shears the cell moves by less than 1e-3 in a step, and with it the volume.
            mean = state.grain_stress.sum(axis=0) / state.volume
            np.testing.assert_allclose(mean, state.stress, rtol=2e-3, atol=1e-4)
            looked += 1
    assert looked > 3
    with pytest.raises(RuntimeError, match="take arrays before the next state"):
        state.positions


def test_stop_and_resume_are_the_same_run(place):
    simulation = boba.Simulation(place / "scene.toml", output=place / "stopped")
    for state in simulation.steps(every=250):
        if state.step >= 500:
            break  # leaving the loop stops the run
    assert simulation.outcome == "stopped"
    assert list((place / "stopped/checkpoints").glob("*.boba"))
    with pytest.raises(RuntimeError, match="a simulation runs once"):
        simulation.run()
    resumed = boba.Simulation.resume(place / "stopped")
    assert_same_run(resumed.run(every=333).folder, place / "plain")


def test_an_error_in_python_stops_the_run_with_a_checkpoint(place):
    simulation = boba.Simulation(place / "scene.toml", output=place / "broken")

    def observer(state):
        if state.step >= 300:
            raise ZeroDivisionError("mine")

    with pytest.raises(ZeroDivisionError, match="mine"):
        simulation.run(every=100, observers=[observer])
    assert simulation.outcome == "stopped"
    assert boba.Simulation.resume(place / "broken").run().table["step"][-1] > 300


def test_errors_are_the_programs_sentences(place, program):
    for setting in ({"stage.shear.rate": 7.0}, {"stage.shear.speed": 1}, {"species.0.count": 0}):
        ((key, value),) = setting.items()
        told = subprocess.run(
            [program, "run", "scene.toml", "--output", "wrong", "--set", f"{key}={value}"],
            cwd=place, capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert told.returncode == 2
        before = os.getcwd()
        os.chdir(place)
        try:
            with pytest.raises(boba.InputError) as error:
                boba.Simulation("scene.toml", set=setting, output="wrong").run()
        finally:
            os.chdir(before)
        assert f"boba: {error.value}" == told.stderr.strip().splitlines()[-1]
    assert not (place / "wrong").exists()
    with pytest.raises(boba.InputError, match="output"):
        boba.Simulation(place / "scene.toml", output=place / "plain").run()  # there is a run in it
    with pytest.raises(ValueError, match="every = 0: must be at least 1"):
        next(boba.Simulation(place / "scene.toml", output=place / "wrong").steps(every=0))
    with pytest.raises(FileNotFoundError, match="there is no such program"):
        boba.Simulation(place / "scene.toml", program="/nowhere/boba")


def test_a_run_that_fails(place):
    simulation = boba.Simulation(place / "scene.toml", set={"stage.compress.max_time": 20.0}, output=place / "failed")
    with pytest.raises(boba.RunError, match="settle"):
        simulation.run()
    assert simulation.outcome == "failed"


CTRL_C = """
import boba, sys
sim = boba.Simulation("scene.toml", set={"stage.hold.time": 1e6}, output="interrupted")
try:
    for state in sim.steps(every=int(sys.argv[1]) or None):
        print(state.step, flush=True)
except KeyboardInterrupt:
    print("interrupted", sim.outcome, flush=True)
"""


@pytest.mark.parametrize("every", [0, 200])
def test_ctrl_c_stops_at_a_checkpoint(place, every):
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    process = subprocess.Popen(
        [sys.executable, "-c", CTRL_C, str(every)], cwd=place, stdout=subprocess.PIPE, text=True, env=environment
    )
    assert process.stdout.readline() == "0\n"
    time.sleep(1)
    process.send_signal(signal.SIGINT)
    assert process.communicate(timeout=60)[0].splitlines()[-1] == "interrupted stopped"
    assert list((place / "interrupted/checkpoints").glob("*.boba"))
    subprocess.run(["rm", "-r", place / "interrupted"], check=True)


def test_pipes_that_are_none(place, program):
    for pipes in ("7", "x,y", "1,2", "300,301"):
        done = subprocess.run(
            [program, "run", "scene.toml", "--output", "none", "--caller", pipes],
            cwd=place, capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode == 2 and "--caller" in done.stderr, done.stderr
    assert not (place / "none").exists()
