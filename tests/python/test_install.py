# SPDX-License-Identifier: GPL-3.0-or-later
"""pip install ./python into an environment of its own, then reading with the source tree out of sight."""
import pathlib
import re
import shutil
import subprocess
import sys

import made_run

ROOT = pathlib.Path(__file__).resolve().parents[2]


def test_pip_install(tmp_path):
    folder = made_run.make_run(tmp_path / "run")
    # A copy: pip builds in the tree, and the tree of a test stays as it was.
    shutil.copytree(ROOT / "python", tmp_path / "python", ignore=shutil.ignore_patterns("build", "*.egg-info"))
    environment = tmp_path / "environment"
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", "--system-site-packages", environment], check=True)
    done = subprocess.run(
        [sys.executable, "-m", "pip", "--python", environment / "bin/python", "install", tmp_path / "python"]
        + ["--no-index", "--no-build-isolation", "--no-deps", "--disable-pip-version-check"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    shutil.rmtree(tmp_path / "python")
    program = (
        "import boba, sys\n"
        "run = boba.open(sys.argv[1])\n"
        "print(boba.__version__, boba.__file__)\n"
        "print(run.average('mu', 0, 0.5, stage='forth')[0], len(run.frames))\n"
    )
    read = subprocess.run(
        [environment / "bin/python", "-c", program, folder], capture_output=True, text=True, check=True, cwd=tmp_path
    )
    version, place, mean, frames = read.stdout.split()
    assert place.startswith(str(environment))
    assert (round(float(mean), 12), int(frames)) == (0.2, 3)
    assert list((environment / "lib").glob("python3*/site-packages/boba/py.typed"))
    # One version: the module's, pip's and the program's, which CMake reads from the same line.
    metadata = next((environment / "lib").glob("python3*/site-packages/boba-*.dist-info/METADATA")).read_text()
    assert f"\nVersion: {version}\n" in metadata
    line = (ROOT / "python/boba/_version.py").read_text()
    assert re.search(r'^__version__ = "(.*)"$', line, re.MULTILINE).group(1) == version
    assert "_version.py" in (ROOT / "CMakeLists.txt").read_text()


def test_the_program_has_the_version_of_the_module(program):
    import boba

    shown = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
    assert shown.startswith(f"boba {boba.__version__} "), shown
