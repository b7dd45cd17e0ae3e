# SPDX-License-Identifier: GPL-3.0-or-later
import os
import pathlib
import sys

import pytest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [os.environ.get("BOBA_PYTHON_FOLDER", str(ROOT / "python")), str(pathlib.Path(__file__).parent)]

import made_run  # noqa: E402


@pytest.fixture
def folder(tmp_path):
    """The output folder of made_run."""
    return made_run.make_run(tmp_path / "run")


@pytest.fixture
def program():
    """The program boba. Tests that need it are told where it is by BOBA_PROGRAM."""
    return os.environ["BOBA_PROGRAM"]
