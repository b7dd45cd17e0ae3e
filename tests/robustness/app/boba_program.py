# SPDX-License-Identifier: GPL-3.0-or-later
"""What the Python tests of the program share: a folder for each test, a small scene, and ways to start `boba` in it."""

import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = os.environ.get("BOBA_PROGRAM", "boba")

SCENE = """title = "eight small grains"
seed = 7

[run]
threads = 1

[output.table]
every_strain = 0.01
every_time = 20.0

[output.trajectory]
every_strain = 0.05
velocities = true

[output.checkpoint]
every_time = 40.0

[[template]]
name = "grain"
nodes = 60

[[species]]
template = "grain"
count = 8
alpha = 2.0

[[stage]]
type = "insert"
packing_fraction = 0.3

[[stage]]
type = "compress"
pressure = 0.05
rate = 2e-3

[[stage]]
type = "shear"
rate = 5e-3
strain = 0.2
pressure = 0.05
"""

LONG = ["--set", "stage.2.strain=200"]


class ProgramTest(unittest.TestCase):
    """Each test stands in a folder of its own with scene.toml in it."""

    def setUp(self):
        self._folder = tempfile.TemporaryDirectory(prefix="boba-test-")
        self.addCleanup(self._folder.cleanup)
        self.folder = pathlib.Path(self._folder.name)
        (self.folder / "scene.toml").write_text(SCENE)
        self.environment = dict(os.environ, OMP_WAIT_POLICY="passive")
        self.environment.setdefault("BOBA_CACHE_DIR", os.path.join(tempfile.gettempdir(), "boba-test-cache"))

    def boba(self, *words, **how):
        """Runs to the end; returns the completed process, with text."""
        how.setdefault("stdout", subprocess.PIPE)
        how.setdefault("stderr", subprocess.PIPE)
        how.setdefault("env", self.environment)
        how.setdefault("timeout", 120)
        return subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, text=True, **how)

    def start(self, *words, **how):
        """Starts and does not wait; it is ended with the test."""
        how.setdefault("stdout", subprocess.DEVNULL)
        how.setdefault("stderr", subprocess.PIPE)
        process = subprocess.Popen([PROGRAM, *map(str, words)], cwd=self.folder, text=True, env=self.environment, **how)

        def end():
            if process.poll() is None:
                process.kill()
            process.communicate()

        self.addCleanup(end)
        return process

    def wait_for(self, name, seconds=60):
        """Waits until a file of the folder holds something."""
        path = self.folder / name
        for _ in range(int(seconds / 0.02)):
            if path.exists() and path.stat().st_size > 0:
                return
            time.sleep(0.02)
        self.fail(f"{name} did not come")

    def wait_for_rows(self, name, n, seconds=60):
        path = self.folder / name
        for _ in range(int(seconds / 0.02)):
            if path.exists() and path.read_bytes().count(b"\n") > n:
                return
            time.sleep(0.02)
        self.fail(f"{name} has not got {n} rows")

    def assert_refused(self, result, *parts, code=2):
        self.assertEqual(result.returncode, code, result.stderr)
        for part in parts:
            self.assertIn(part, result.stderr)


def table_without_speed(path):
    """Rows of table.csv without the last column, the only one that depends on the clock."""
    return [line.rsplit(",", 1)[0] for line in pathlib.Path(path).read_text().splitlines()]


def main():
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[1:]])
