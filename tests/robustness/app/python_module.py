# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python module and `boba plot` on runs that go on, that are empty, or that lack what is asked for."""

import pathlib
import signal
import sys
import unittest

import numpy as np

from boba_program import LONG, ProgramTest, main

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "python"))
import boba  # noqa: E402


class Frames(ProgramTest):
    def test_frames_of_a_run_that_goes_on_are_whole(self):
        run = self.start("run", "scene.toml", "--output", "o", *LONG, "--set", "output.trajectory.every_strain=0.001")
        self.wait_for("o/trajectory.h5")
        self.wait_for_rows("o/table.csv", 5)
        frames = boba.open_run(self.folder / "o").frames
        n_read, last = 0, -1
        while n_read < 400 and run.poll() is None:
            frame = frames[-1]
            self.assertTrue(np.isfinite(frame.positions).all(), f"step {frame.step}")
            self.assertLess(np.abs(frame.positions).max(), 1e6)
            self.assertGreaterEqual(frame.step, last)
            last = frame.step
            n_read += 1
        self.assertIsNone(run.poll())
        run.send_signal(signal.SIGTERM)
        run.wait(60)

    def test_a_frame_with_fill_values_does_not_count(self):
        import h5py

        self.assertEqual(self.boba("run", "scene.toml", "--output", "o").returncode, 0)
        frames = boba.open_run(self.folder / "o").frames
        n = len(frames)
        with h5py.File(self.folder / "o/trajectory.h5", "r+") as file:
            file["particles/all/position/value"][n - 1, 5, 1] = np.nan
        self.assertEqual(len(frames), n - 1)
        self.assertTrue(np.isfinite(frames[-1].positions).all())
        with self.assertRaises(IndexError):
            frames[n - 1]

    def test_a_step_that_was_not_measured(self):
        self.assertEqual(self.boba("run", "scene.toml", "--output", "o").returncode, 0)
        self.assertEqual(self.boba("measure", "o", "--what", "contacts,order").returncode, 0)
        run = boba.open_run(self.folder / "o")
        self.assertGreater(len(run.contacts(run.steps("coordination")[-1])["grain"]), 0)
        self.assertEqual(len(run.contacts(run.steps("coordination")[0])["grain"]), 0)  # placed without contacts
        for name in ("contacts", "order"):
            with self.assertRaisesRegex(KeyError, "12345"):
                run.rows(name, 12345)


class Plot(ProgramTest):
    def test_what_is_missing_is_told(self):
        without = ["--set", "output={table={every_time=20.0}}"]
        self.assertEqual(self.boba("run", "scene.toml", "--output", "o", *without).returncode, 0)
        result = self.boba("plot", "o", "--pictures")
        self.assert_refused(result, "trajectory.h5")
        self.assertNotIn("Traceback", result.stderr)
        self.assertFalse((self.folder / "o/plots").exists())
        result = self.boba("plot", "o", "--output", "sheet.pdf")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue((self.folder / "sheet.pdf").read_bytes().startswith(b"%PDF"))
        self.assert_refused(self.boba("plot", "o", "--output", "sheet.doc"), ".doc")
        self.assertFalse((self.folder / "sheet.doc").exists())

    def test_empty_tables(self):
        (self.folder / "o/measures").mkdir(parents=True)
        for content in ("", "step,time_tau,strain,mu\n", "step,time_tau,strain,mu\n1,", "step,time_tau\nx,y\n"):
            (self.folder / "o/table.csv").write_text(content)
            (self.folder / "o/measures/order.csv").write_text(content)
            result = self.boba("plot", "o")
            self.assertIn(result.returncode, (1, 2), result.stderr)
            self.assertNotIn("Traceback", result.stderr)


if __name__ == "__main__":
    main()
