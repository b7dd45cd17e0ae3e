# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables, stages, averages, frames: everything is compared with the numbers of made_run."""
import pickle
import re
import sys
import tomllib
import warnings

import boba
import made_run
import numpy as np
import pytest


def test_a_table_names_its_units(folder):
    table = boba.open(folder).table
    assert table.units == {
        "step": "1",
        "time_tau": "tau",
        "stage": "1",
        "strain": "1",
        "mu": "1",
        "P_k/d": "k/d",
        "P_normalised": "1",
        "kinetic_energy_kd2": "k d^2",
    }
    assert table.n_rows == 213
    assert "213 rows" in repr(table) and "P_k/d [k/d]" in repr(table)
    again = pickle.loads(pickle.dumps(table))
    assert list(again) == list(table) and again.path == table.path


def test_a_table_as_a_structured_array(folder):
    array = boba.open(folder).table.to_numpy()
    assert array.shape == (213,)
    assert array["step"].dtype == np.int64 and array["strain"].dtype == np.float64
    assert array[150]["step"] == 149 and array[150]["mu"] == -0.3
    assert np.isnan(array["P_normalised"]).all()


def test_a_table_as_a_data_frame(folder):
    pandas = pytest.importorskip("pandas")
    frame = boba.open(folder).table.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and frame.attrs["units"]["P_k/d"] == "k/d"
    assert frame[frame.stage == 2].mu.unique().tolist() == [-0.3]


def test_without_pandas_a_sentence(folder, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError, match="python3-pandas"):
        boba.open(folder).table.to_pandas()


def test_averages_do_not_mix_directions(folder):
    run = boba.open(folder)
    with pytest.raises(ValueError, match="both ways between 0 and 0.45, in the stages 1, 2"):
        run.average("mu", 0, 0.45)
    assert run.average("mu", 0, 0.45, stage="forth") == pytest.approx((0.2, 0.0), abs=1e-12)
    assert run.average("mu", 0, 0.45, stage=2)[0] == pytest.approx(-0.3, abs=1e-12)
    assert run.average("mu", 0, 0.6, stage="hold")[0] == pytest.approx(0.05, abs=1e-12)
    with pytest.raises(KeyError, match="more than one stage is of this type"):
        run.average("mu", 0, 0.6, stage="shear")
    with pytest.raises(KeyError, match="no such stage; there are stage.0 insert"):
        run.average("mu", 0, 0.6, stage=9)


def test_rows_at_rest_are_left_out_with_a_warning(folder):
    table = (folder / "table.csv").read_text().splitlines()
    kept = [line for line in table if not re.match(r"\d+,[^,]*,2,", line)]  # forth, then rest at strain 0.5
    (folder / "table.csv").write_text("\n".join(kept) + "\n")
    with pytest.warns(UserWarning, match="rows of the stages 3, which do not shear"):
        assert boba.open(folder).average("mu", 0.4, 0.6)[0] == pytest.approx(0.2, abs=1e-12)


def test_measures_know_their_stage(folder):
    run = boba.open(folder)
    coordination = run.measure("coordination")
    # Steps 100 and 200, where one stage ends and the next begins, belong to the one that ends.
    assert run.stage_of_rows(coordination).tolist() == [1, 1, 1, 2, 2, 3]
    assert run.of_stage(coordination, "back")["contacts_per_grain"].tolist() == [7.0, 8.0]
    assert run.average("contacts_per_grain", -0.1, 1.1, "coordination", stage="forth")[0] == pytest.approx(11 / 3)


def test_contacts_of_a_step(folder):
    run = boba.open(folder)
    assert run.contacts(50)["grain"].tolist() == [4, 11]
    assert run.contacts(100).n_rows == 0  # measured, and nothing touched
    with pytest.raises(KeyError, match="step 51 was not measured; steps: 0 to 205, 6 in all"):
        run.contacts(51)


def test_the_scene_with_what_was_set(folder):
    run = boba.open(folder)
    assert run.scene.title == "made by a test"
    assert run.scene.overrides == ["stage.3.time=7"]
    assert run.scene.values["stage"][3]["time"] == 7
    assert [stage.label for stage in run.stages][1:3] == ['stage.1 shear "forth"', 'stage.2 shear "back"']


@pytest.mark.parametrize(
    "assignment, place, value",
    [
        ("title=two words", lambda tree: tree["title"], "two words"),
        ("stage.forth.rate=1e-4", lambda tree: tree["stage"][1]["rate"], 1e-4),
        ("stage.hold.time=3", lambda tree: tree["stage"][3]["time"], 3),
        ("output={table={every_time=20.0}}", lambda tree: tree["output"]["table"]["every_time"], 20.0),
        ("output.trajectory.every_strain=0.5", lambda tree: tree["output"]["trajectory"]["every_strain"], 0.5),
    ],
)
def test_assignments(assignment, place, value):
    tree = tomllib.loads(made_run.SCENE)
    boba.scene.apply_override(tree, assignment)
    assert place(tree) == value


def test_frames(folder):
    frames = boba.open(folder).frames
    assert len(frames) == 3 and frames.steps.tolist() == made_run.STEPS
    for k, frame in enumerate(frames):
        np.testing.assert_allclose(frame.positions, made_run.unwrapped(k), atol=1e-12)
        np.testing.assert_array_equal(frame.velocities, made_run.velocities(k))
        placed = frame.whole_grains()
        for g in range(2):
            nodes = slice(10 * g, 10 * g + 10)
            shift = np.linalg.solve(made_run.BOX, (placed[nodes] - made_run.unwrapped(k)[nodes]).T).T
            np.testing.assert_allclose(shift, np.broadcast_to(np.round(shift[0]), (10, 3)), atol=1e-9)
            inside = np.linalg.solve(made_run.BOX, placed[nodes].mean(0) - made_run.ORIGIN)
            assert ((inside >= 0) & (inside < 1)).all()
    assert frames.at_strain(0.52).step == 7
    assert "2 grains, 20 nodes" in repr(frames[0])
    with pytest.raises(IndexError, match="frame 3 of 3"):
        frames[3]


def test_what_is_inside(folder, tmp_path):
    assert "insert, forth, back, hold" in repr(boba.open(folder))
    assert "3 frames" in repr(boba.open(folder)) and "measures contacts, coordination" in repr(boba.open(folder))
    (tmp_path / "empty").mkdir()
    assert "no files of a run" in repr(boba.open(tmp_path / "empty"))
    assert repr(boba.open(tmp_path / "empty").frames) == "<boba.Frames: none stored>"
    with pytest.raises(FileNotFoundError, match="there is no such folder"):
        boba.open(tmp_path / "nothing")
    with pytest.raises(FileNotFoundError, match="output.trajectory"):
        boba.open(tmp_path / "empty").frames[0]


def test_a_universe_of_whole_grains(folder):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pytest.importorskip("MDAnalysis")
        universe = boba.open(folder).universe()
        assert (len(universe.atoms), len(universe.residues), len(universe.segments)) == (20, 2, 2)
        assert universe.residues.resids.tolist() == made_run.MOLECULES.tolist()
        assert universe.atoms.ids.tolist() == made_run.IDS.tolist()
        assert sorted(tuple(sorted(bond)) for bond in universe.bonds.indices.tolist()) == [(0, 3), (10, 19)]
        assert [ts.time for ts in universe.trajectory] == made_run.TIMES
        assert [ts.data["step"] for ts in universe.trajectory] == made_run.STEPS
        assert universe.trajectory.dt == pytest.approx(0.45)
        for k in (2, 0, 1):
            ts = universe.trajectory[k]
            lengths = np.linalg.norm(made_run.BOX, axis=0)
            np.testing.assert_allclose(ts.dimensions[:3], lengths, rtol=1e-6)
            cosine = made_run.BOX[:, 1] @ made_run.BOX[:, 2] / lengths[1] / lengths[2]
            assert np.cos(np.radians(ts.dimensions[3])) == pytest.approx(cosine, abs=1e-6)
            np.testing.assert_array_equal(ts.velocities, made_run.velocities(k).astype(np.float32))
            # A grain keeps its shape: distances between its nodes are those of the unwrapped positions.
            x, wanted = universe.residues[1].atoms.positions, made_run.unwrapped(k)[10:]
            np.testing.assert_allclose(x[1:] - x[0], wanted[1:] - wanted[0], atol=1e-5)
        wrapped = boba.open(folder).universe("wrapped").trajectory[1]
        inside = np.linalg.solve(made_run.BOX, (wrapped.positions - made_run.ORIGIN).T)
        assert (inside > -1e-5).all() and (inside < 1 + 1e-5).all()
        unwrapped = boba.open(folder).universe("unwrapped").trajectory[1]
        np.testing.assert_allclose(unwrapped.positions, made_run.unwrapped(1), rtol=1e-6)
        (folder / "trajectory.h5").unlink()
        with pytest.raises(FileNotFoundError, match="output.trajectory"):
            boba.open(folder).universe()
        with pytest.raises(ValueError, match="must be one of whole, wrapped, unwrapped"):
            boba.open(folder).universe("torn")
