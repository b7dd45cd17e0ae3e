# SPDX-License-Identifier: GPL-3.0-or-later
"""The scripts of examples/python, run as a reader runs them; their numbers against those of the tables they leave."""
import os
import pathlib
import re
import subprocess
import sys

import boba
import pytest

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples" / "python"


def run_script(name, folder):
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "BOBA_CACHE_DIR": str(folder / "cache")}
    done = subprocess.run(
        [sys.executable, EXAMPLES / name, folder / "out"],
        cwd=folder, env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def mean_of_rows(run, column):
    rows = run.table.where((run.table["strain"] > 0.2) & (run.table["strain"] < 0.4))
    return rows[column].mean()


def test_first_packing(tmp_path):
    told = run_script("first_packing.py", tmp_path)
    run = boba.open(tmp_path / "out")
    mu = float(re.search(r"mu = (\S+) \+-", told).group(1))
    assert mu == pytest.approx(mean_of_rows(run, "mu"), abs=6e-4)
    assert 0.05 < mu < 0.6
    pressures = [float(word) for word in re.findall(r"P (\S+) k/d", told)]
    assert pressures[-1] == pytest.approx(run.table["P_k/d"][-1], abs=6e-5)
    assert "<script id=data" in (tmp_path / "out" / "report.html").read_text()


def test_stress_ratio(tmp_path):
    told = run_script("stress_ratio.py", tmp_path)
    rows = re.findall(r"^ *(\de-\d+) +(\S+) +(\S+) \+- (\S+)$", told, re.MULTILINE)
    assert [float(row[0]) for row in rows] == [1e-3, 2e-3, 4e-3]
    for rate, inertial, mu, error in rows:
        run = boba.open(tmp_path / "out" / f"rate_{float(rate):g}")
        assert float(inertial) == pytest.approx(mean_of_rows(run, "inertial_number"), abs=6e-6)
        assert float(mu) == pytest.approx(mean_of_rows(run, "mu"), abs=6e-5)
        assert 0 < float(error) < 0.1
    # I is the rate times a length and the root of mass over pressure, all three held: it is proportional to the rate.
    inertial = [float(row[1]) for row in rows]
    assert inertial[1] / inertial[0] == pytest.approx(2, rel=0.02) and inertial[2] / inertial[0] == pytest.approx(
        4, rel=0.03
    )
