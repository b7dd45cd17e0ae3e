# SPDX-License-Identifier: GPL-3.0-or-later
"""What `boba report` gathers: outlines against formulas, means against numbers, bad input against sentences."""
import base64
import json
import os
import subprocess
import zlib

import boba
import h5py
import made_run
import numpy as np
import pytest
from boba.report import curves, hulls, log, packing, page, studies
from boba.report.gather import report_data
from boba.report.means import means_of
from boba.report.words import material_of


def report(program, folder, *arguments, environment=None):
    return subprocess.run(
        [program, "report", *map(str, arguments)], cwd=folder, capture_output=True, text=True, check=False,
        env={**os.environ, **(environment or {})},
    )  # fmt: skip


def data_of(path):
    text = path.read_text()
    begin = text.index("<script id=data type=application/json>") + 38
    return json.loads(text[begin : text.index("</script>", begin)])


def test_an_outline_is_the_hull_grown_by_half_a_node():
    rng = np.random.default_rng(4)
    cube = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]) * 3.0
    nodes = np.concatenate([cube, rng.uniform(-3, 3, (200, 3))])
    outline = hulls.outline_of(nodes, 40)
    assert outline.volume == pytest.approx(216) and outline.area == pytest.approx(216)
    assert outline.asphericity == pytest.approx((6 / np.pi) ** 0.5)  # A^(3/2) / (6 sqrt(pi) V) of a cube
    assert np.abs(outline.vertices).max() == pytest.approx(3.5, abs=0.11)  # faces move out by d/2
    a, b, c = (outline.vertices[outline.triangles[:, k]] for k in range(3))
    assert (np.einsum("ij,ij->i", np.cross(b - a, c - a), a) > 0).all()  # outward


def test_large_hulls_are_simplified_and_keep_their_numbers():
    rng = np.random.default_rng(5)
    directions = rng.normal(size=(3000, 3))
    nodes = 10 * directions / np.linalg.norm(directions, axis=1, keepdims=True)
    outline = hulls.outline_of(nodes, 100)
    assert len(outline.vertices) <= 100 and len(outline.triangles) == 2 * len(outline.vertices) - 4
    assert outline.volume == pytest.approx(4 / 3 * np.pi * 1000, rel=0.01)
    assert outline.asphericity == pytest.approx(1, abs=0.005)
    radii = np.linalg.norm(outline.vertices, axis=1)
    assert radii.min() > 10.3 and radii.max() < 10.7


def test_single_nodes_and_flat_grains_become_balls():
    one = hulls.outline_of(np.array([[1.0, 2.0, 3.0]]), 40)
    assert np.allclose(np.linalg.norm(one.vertices - [1, 2, 3], axis=1), 0.5)
    assert one.volume == pytest.approx(np.pi / 6) and one.asphericity == pytest.approx(1)
    flat = hulls.outline_of(np.array([[0.0, 0, 0], [2, 0, 0], [0, 2, 0], [2, 2, 0], [1, 1, 0]]), 40)
    assert np.isnan(flat.volume) and len(flat.triangles) > 20


def test_positions_come_back_within_a_quantum(folder):
    run = boba.open(folder)
    shown = packing.packing_of(run, packing.molecules_of(run), 1e7)
    assert shown["grains"] == made_run.MOLECULES.tolist() and len(shown["frames"]) == 3
    frame = shown["frames"][1]
    read = lambda key, kind: np.frombuffer(zlib.decompress(base64.b64decode(frame[key])), dtype=kind)  # noqa: E731
    places = read("vertices", "<i2").reshape(-1, 3) * shown["quantum"] + shown["centre"]
    outlines = [
        hulls.outline_of(nodes + shift, packing.MOST_VERTICES)
        for nodes, shift in zip(run.frames[1].grains, run.frames[1].shift_into_cell(run.frames[1].grain_centres))
    ]
    wanted = np.concatenate([outline.vertices for outline in outlines])
    assert np.abs(places - wanted).max() <= 0.51 * shown["quantum"]
    assert read("vertex_counts", "<u2").tolist() == [len(outline.vertices) for outline in outlines]


@pytest.mark.parametrize("grains, frames", [(1, 500), (64, 21), (64, 400), (1024, 40), (20000, 3)])
def test_frames_stay_quick_to_draw_and_the_file_small(grains, frames):
    budget = packing.budget_for(grains, frames, 11e6)
    triangles = grains * (2 * budget.vertices - 4)
    assert triangles <= packing.MOST_TRIANGLES or budget.vertices == packing.FEWEST_VERTICES
    assert budget.frames >= 2 and budget.frames * grains * budget.vertices * 13 <= max(11e6, 3 * grains * 14 * 13)
    assert packing.chosen_frames(frames, budget.frames)[-1] == frames - 1


def test_means_are_those_of_the_second_half(folder):
    forth, back, rest = means_of("run", boba.open(folder))
    assert [row["stage"] for row in (forth, back)] == ['stage.1 shear "forth"', 'stage.2 shear "back"']
    assert [row["cells"][0]["mean"] for row in (forth, back, rest)] == pytest.approx([0.2, -0.3, 0.05])
    assert forth["cells"][0]["rows"] == 51  # times 500 to 1000 tau of 0 to 1000
    assert forth["cells"][6]["mean"] == pytest.approx(5.5)  # contacts at steps 50 and 100


def test_strain_run_through_rises_forth_and_back():
    strain = np.array([0, 0, 0, 0.5, 1.0, 0.5, 0.0, 0.0])
    np.testing.assert_array_equal(curves.accumulated_strain(strain)[2:], [0, 0.5, 1, 1.5, 2, 2])
    assert np.isnan(curves.accumulated_strain(strain)[:2]).all()
    assert np.isnan(curves.accumulated_strain(np.zeros(3))).all()


def test_long_tables_are_thinned_to_rows_of_their_own_with_the_extremes():
    rng = np.random.default_rng(3)
    table = boba.Table({"step": np.arange(50_000.0), "mu": rng.normal(size=50_000), "P_k/d": rng.normal(size=50_000)})
    rows = curves.thinned(table)
    assert len(rows) <= 1.1 * curves.MOST_ROWS and (np.diff(rows) > 0).all()
    for column in ("mu", "P_k/d"):
        assert {int(table[column].argmin()), int(table[column].argmax()), 0, 49_999} <= set(rows.tolist())


def test_constants_of_a_material_in_words():
    # Published (examples and docs): alpha = 0 has nu = 1/4, and nu falls with alpha.
    assert "Poisson's ratio about 0.25" in material_of(0.0, None)
    assert "auxetic" in material_of(8.0, None)
    assert "alpha about" in material_of(None, 0.1)
    assert material_of(1e9, None) == "alpha = 1e+09 k d"


@pytest.mark.parametrize(
    "last, state",
    [
        ("info done at step 10; results in out", "done"),
        ("info stopped by SIGINT at step 4; checkpoint c; continue with: boba resume out", "stopped"),
        ("error the disk is full", "failed"),
        ("info stage.1 compress: P 0.1 k/d", "cut off"),
    ],
)
def test_how_a_run_ended(tmp_path, last, state):
    (tmp_path / "run.log").write_text(
        f"2026-12-01 04:30:49 info boba 0.1.0 (abc), instruction set avx2\n2026-12-01 04:31:00 {last}\n"
    )
    lines = log.read_log(tmp_path / "run.log")
    assert log.ending_of(lines, False).state == state
    assert log.ending_of(lines, True).state == "running"
    assert log.facts_of(lines)["Instruction set"] == "avx2"


def test_data_cannot_end_their_element():
    text = page.json_text({"a": "</script><!--<script>&", "b": ["\u2028", None, 1e-300]})
    assert not set("<>&\u2028") & set(text)
    assert json.loads(text) == {"a": "</script><!--<script>&", "b": ["\u2028", None, 1e-300]}


def test_the_command_writes_one_file(program, folder):
    done = report(program, folder.parent, "run", "--output", "report.html")
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("report.html: 1 run, ")
    data = data_of(folder.parent / "report.html")
    table = boba.open(folder).table
    assert data["tables"][0]["columns"]["mu"] == table["mu"].tolist()
    assert report(program, folder.parent, "run").returncode == 0  # our own file is replaced


def test_bad_input_gets_a_sentence(program, tmp_path, folder):
    (tmp_path / "empty").mkdir()
    (tmp_path / "mine.html").write_text("my own page")
    for arguments, words in (
        (["nothing"], "nothing: there is no such folder"),
        (["mine.html"], "mine.html: is a file"),
        (["empty"], "empty: holds no run"),
        ([folder, "--output", "mine.html"], "mine.html: exists and is no report; --force replaces it"),
        ([folder, "--output", "missing/report.html"], "there is no folder missing"),
        ([folder, "--output", "report.txt"], "report.txt: must end with .html"),
        ([folder, "--output", "empty"], "empty: is a folder"),
    ):
        done = report(program, tmp_path, *arguments)
        assert done.returncode == 2 and words in done.stderr and done.stderr.count("\n") == 1, done.stderr
    assert (tmp_path / "mine.html").read_text() == "my own page"
    assert not list(tmp_path.glob("*.part"))
    assert report(program, tmp_path).returncode == 2


def checks(folder):
    return " | ".join(check["text"] for check in report_data([folder])["runs"][0]["checks"])


def test_runs_that_lack_something_still_have_a_page(folder):
    size = (folder / "trajectory.h5").stat().st_size
    whole = (folder / "trajectory.h5").read_bytes()
    (folder / "trajectory.h5").write_bytes(whole[: size // 2])
    assert "the packing is left out" in checks(folder)
    (folder / "trajectory.h5").write_bytes(whole)
    with h5py.File(folder / "trajectory.h5", "r+") as file:
        file["particles/all/position/value"][2, 5, 1] = np.nan
    assert len(report_data([folder])["packings"][0]["frames"]) == 2
    (folder / "trajectory.h5").unlink()
    assert "no frames are stored" in checks(folder)
    (folder / "measures/contacts.csv").write_text("step,time_tau,strain\n1,x,y\n")
    (folder / "measures/coordination.csv").write_text("")
    assert "not a table of numbers" in checks(folder) and "coordination: has no rows" in checks(folder)
    (folder / "scene.toml").write_bytes(b"\xff\xfe title = [")
    assert "no TOML" in checks(folder)
    (folder / "scene.toml").unlink()
    assert "scene.toml is missing" in checks(folder)
    (folder / "table.csv").write_text("step,time_tau,strain\n0,1")
    assert report_data([folder])["panels"] == []
    (folder / "table.csv").unlink()
    (folder / "run.log").write_text("2026-12-01 04:30:49 info boba 0.1.0 (abc), instruction set avx2\n")
    assert "table.csv is missing" in checks(folder)


def comparison(folder):
    folder.mkdir()
    rows = [
        {"alpha": 2.0, "poisson": 0.0, "setup": "walls", "load": load, "quantity": "force", "particles": 10 * load,
         "particles_error": 0.5, "samples": [], "continuum": {"linear": 9 * load, "finite": None}, "hertz": 8 * load}
        for load in (0.2, 0.1)
    ]  # fmt: skip
    content = {"schema": "boba-comparison", "version": 1, "problem": "sphere", "best_model": "linear", "rows": rows}
    (folder / "comparison.json").write_text(json.dumps(content))
    return folder


def test_an_output_of_compare(tmp_path):
    data = report_data([comparison(tmp_path / "compare")])
    panel = data["panels"][0]
    assert [series["label"] for series in panel["series"]] == ["particles", "finite", "linear", "Hertz"]
    assert panel["series"][0]["xs"] == [0.1, 0.2] and panel["series"][0]["ys"] == [1.0, 2.0]
    assert panel["series"][2]["ys"] == pytest.approx([0.9, 1.8])
    assert data["means"]["rows"][0]["cells"][4]["mean"] == pytest.approx(100 / 9)  # 10 against 9, in per cent


def test_an_output_of_calibrate(tmp_path):
    folder = tmp_path / "calibrate"
    folder.mkdir()
    (folder / "table.json").write_text(json.dumps({"schema": "boba-calibration-table", "version": 1}))
    names = ["alpha", "young", "young_error", "poisson", "published_young"]
    made_run.write_table(
        folder / "table.csv", dict(zip(names, [[2.0, 0.0], [4.0, 1.8], [0.1, 0.2], [0.0, 0.25], [None, 1.9]]))
    )
    data = report_data([folder])
    young = next(panel for panel in data["panels"] if "Young" in panel["title"])
    assert young["series"][0]["xs"] == [0.0, 2.0] and young["series"][0]["errors"] == [0.2, 0.1]
    assert young["series"][1]["ys"] == [1.9, None]


def test_other_outputs_that_are_none(tmp_path, folder):
    other = tmp_path / "other"
    other.mkdir()
    (other / "summary.json").write_text(json.dumps({"schema": "something else"}))
    with pytest.raises(ValueError, match="must be boba-continuum-summary"):
        studies.kind_of(other)
    (other / "summary.json").write_text("{")
    with pytest.raises(ValueError, match="no JSON"):
        studies.kind_of(other)
    with pytest.raises(ValueError, match="make a report for each"):
        report_data([folder, comparison(tmp_path / "compare")])
