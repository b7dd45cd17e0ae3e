#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""boba run with [[measure]], boba measure on what it stored, boba plot: they must tell the same."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

PROGRAM = sys.argv.pop(1)
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "python"))
import boba  # noqa: E402

SCENE = """
seed = 3
[run]
threads = 2
[output.trajectory]
every_strain = 0.05
velocities = true
[[measure]]
what = "stress, shape, order, contacts"
every_strain = 0.05
[[measure]]
what = "packing-fraction, motion"
every_strain = 0.1
points = 20000
[[template]]
name = "grain"
nodes = 60
[[species]]
count = 12
alpha = 2.0
[[stage]]
type = "insert"
packing_fraction = 0.25
[[stage]]
type = "compress"
pressure = 0.2
rate = 2e-3
pressure_tolerance = 0.05
kinetic_tolerance = 0.05
[[stage]]
type = "shear"
rate = 2e-3
strain = 0.3
pressure = 0.2
remap = "velocities"
[[stage]]
type = "hold"
time = 50
"""
RATE, DT = 2e-3, 0.1


def boba_program(folder, *arguments):
    return subprocess.run(
        [PROGRAM, *map(str, arguments)],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "BOBA_CACHE_DIR": str(folder / "cache")},
    )


class Program(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        (cls.folder / "scene.toml").write_text(SCENE)
        cls.done = boba_program(cls.folder, "run", "scene.toml", "--output", "run")
        assert cls.done.returncode == 0, cls.done.stderr + cls.done.stdout

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_stored_frames_give_what_the_run_measured(self):
        stored = boba_program(self.folder, "measure", "run", "--output", "again", "--points", "20000")
        self.assertEqual(stored.returncode, 0, stored.stderr)
        self.assertNotIn("note:", stored.stdout)
        live, later = boba.open(self.folder / "run"), boba.open(self.folder / "run", self.folder / "again")
        for name in ("shape", "grains", "order", "grain_order", "coordination", "contacts"):
            a, b = live.measure(name), later.measure(name)
            self.assertEqual(list(a), list(b))
            np.testing.assert_array_equal(a["step"], b["step"], name)
            for column in a:
                np.testing.assert_allclose(a[column], b[column], rtol=1e-6, atol=1e-9, err_msg=f"{name} {column}")
        self.assertGreater(len(live.measure("stress")["step"]), 6)
        self.assertGreater(len(live.measure("packing_fraction")["step"]), 3)

    def test_forces_evaluated_again_give_the_stress_of_the_run(self):
        run = boba.open(self.folder / "run")
        done = boba_program(self.folder, "measure", "run", "--output", "evaluated", "--what", "stress")
        self.assertEqual(done.returncode, 0, done.stderr)
        again, table = boba.open(self.folder / "run", self.folder / "evaluated").measure("stress"), run.table
        stage = {step: k for k, step in enumerate(table["step"])}  # the last row of a step: where a stage began
        self.assertTrue((again["with_damping"] == 1).all())
        moduli = 2.0  # k/d, more than the bulk and shear moduli of this packing (a grain's E is 4)
        compared = 0
        for k, step in enumerate(again["step"]):
            row = stage[step]
            p, mu = table["P_k/d"][row], table["mu"][row]
            if step == 0:
                continue  # nothing touches
            # A resting cell: the same numbers. A moving one has moved by one step since its forces were evaluated.
            still = row == len(table["step"]) - 1
            stress_change = 1e-9 if still else moduli * RATE * DT
            self.assertAlmostEqual(again["P_k/d"][k], p, delta=stress_change)
            self.assertAlmostEqual(again["mu"][k], mu, delta=stress_change / p)
            compared += 1
        self.assertGreater(compared, 6)
        np.testing.assert_allclose(again["P_run_k/d"], run.measure("stress")["P_k/d"], rtol=1e-12, atol=1e-14)
        grains, stored = (
            boba.open(self.folder / "run", self.folder / "evaluated").rows("grain_stress", again["step"][-1]),
            None,
        )
        stored = run.rows("grain_stress", again["step"][-1])
        for column in stored:
            np.testing.assert_allclose(grains[column], stored[column], atol=1e-8, err_msg=column)

    def test_without_velocities_the_damping_is_said_to_be_missing(self):
        (self.folder / "still.toml").write_text(SCENE.replace("velocities = true", ""))
        self.assertEqual(boba_program(self.folder, "run", "still.toml", "--output", "still").returncode, 0)
        done = boba_program(self.folder, "measure", "still", "--output", "still_anew", "--what", "stress")
        self.assertIn("damping and kinetic parts are missing", done.stdout)
        stress = boba.open(self.folder / "still", self.folder / "still_anew").measure("stress")
        self.assertTrue((stress["with_damping"] == 0).all())
        self.assertTrue(np.isnan(stress["kinetic_xx_k/d"]).all())
        # At the end, after a rest, there is little to miss; while it sheared there was more.
        missing = abs(stress["P_k/d"] - stress["P_run_k/d"])
        self.assertLess(missing[-1], 1e-4)
        self.assertGreater(missing[-2], missing[-1])

    def test_stress_is_that_of_the_table(self):
        run = boba.open(self.folder / "run")
        stress, table = run.measure("stress"), run.table
        for step, pressure, mu in zip(stress["step"], stress["P_k/d"], stress["mu"]):
            row = np.flatnonzero(table["step"] == step)
            for k in row:
                # The cell moves by one step of the barostat between the stress and the frame: |dV/V| <= 3 rate_cap dt.
                self.assertAlmostEqual(table["P_k/d"][k], pressure, delta=3e-4 * abs(pressure) + 1e-12)
                np.testing.assert_allclose(
                    table["mu"][k], mu, rtol=0, atol=1e-12
                )  # both empty at rest without pressure
        self.assertTrue(np.isfinite(stress["kinetic_xx_k/d"]).all())
        self.assertTrue((stress["kinetic_xx_k/d"] <= 0).all())

    def test_sensible_numbers(self):
        run = boba.open(self.folder / "run")
        shape = run.measure("shape")
        self.assertLess(shape["volume_mean_d3"][-1], shape["undeformed_volume_d3"][-1])
        self.assertAlmostEqual(shape["volume_mean_d3"][0], shape["undeformed_volume_d3"][0], delta=1e-6)
        phi = run.measure("packing_fraction")["phi"]
        self.assertGreater(phi[-1], phi[0] + 0.2)
        self.assertEqual(run.measure("coordination")["contacts_per_grain"][0], 0)  # placed apart
        self.assertGreater(run.measure("coordination")["contacts_per_grain"][-1], 4)
        contacts = run.contacts(int(run.measure("contacts")["step"][-1]))
        self.assertTrue((contacts["area_d2"] > 0.7).all())

    def test_mistakes_are_named_and_write_nothing(self):
        for text, word in (
            (SCENE.replace("stress, shape", "stress, colour"), "colour"),
            (SCENE.replace("packing-fraction, motion", "shape"), "another"),
            (SCENE.replace("points = 20000", "points = 20000\nrelaxed = true"), "relaxed"),
            (SCENE.replace("fraction = 0.25", 'fraction = 0.25\narrangement = "fcc"'), "4 and 32"),
        ):
            (self.folder / "wrong.toml").write_text(text)
            refused = boba_program(self.folder, "run", "wrong.toml", "--output", "wrong")
            self.assertEqual(refused.returncode, 2)
            self.assertIn(word, refused.stderr)
            self.assertFalse((self.folder / "wrong").exists())
        again = boba_program(self.folder, "measure", "run")
        self.assertEqual(again.returncode, 2)  # the run's own tables are there
        self.assertIn("stress.csv", again.stderr)
        self.assertEqual(boba_program(self.folder, "measure", "nothing").returncode, 2)
        self.assertEqual(boba_program(self.folder, "measure", "run", "--what", "colour").returncode, 2)

    def test_a_run_that_was_stopped_goes_on_with_its_tables(self):
        (self.folder / "stop.toml").write_text(SCENE.replace("[run]", "[run]\nwall_time = 0.05"))
        codes = [boba_program(self.folder, "run", "stop.toml", "--output", "stopped").returncode]
        while codes[-1] == 75 and len(codes) < 200:
            seconds = 0.05 if len(codes) < 6 else 100  # some stops on any machine, and then to the end
            codes.append(boba_program(self.folder, "resume", "stopped", "--wall-time", seconds).returncode)
        self.assertEqual(codes[-1], 0, codes)
        self.assertGreater(len(codes), 1, "the run was never stopped: give it less wall time")
        for name in (
            "stress.csv",
            "grains.csv",
            "packing_fraction.csv",
            "contacts.csv",
            "motion.csv",
            "grain_motion.csv",
        ):
            self.assertEqual(
                (self.folder / "stopped/measures" / name).read_text(),
                (self.folder / "run/measures" / name).read_text(),
                name,
            )

    def test_order_of_rested_copies_leaves_the_run_as_it_was(self):
        dump = SCENE.replace("[output.trajectory]", "[output.dump]\nevery_strain = 0.1\n[output.trajectory]")
        plain = dump.replace(", order, contacts", ", contacts")
        rested = plain.replace(
            "[[template]]",
            '[[measure]]\nwhat = "order"\nrelaxed = true\nrest_time = 20\n' "every_strain = 0.05\n[[template]]",
        )
        for name, scene in (("plain", plain), ("rested", rested)):
            (self.folder / f"{name}.toml").write_text(scene)
            done = boba_program(self.folder, "run", f"{name}.toml", "--output", name)
            self.assertEqual(done.returncode, 0, done.stderr)
        tables = [boba.open(self.folder / name).table for name in ("plain", "rested")]
        for column in tables[0]:
            if column != "speed_steps/s":
                np.testing.assert_array_equal(tables[0][column], tables[1][column], column)
        for file in ("dump.lammpstrj", "measures/stress.csv", "measures/motion.csv"):
            self.assertEqual(
                (self.folder / "plain" / file).read_bytes(), (self.folder / "rested" / file).read_bytes(), file
            )
        live = boba.open(self.folder / "rested").measure("order")
        flowing = boba.open(self.folder / "run").measure("order")
        self.assertEqual(set(live["rest_tau"]), {20.0})
        self.assertEqual(set(flowing["rest_tau"]), {0.0})
        self.assertGreater(abs(live["q6_mean"] - flowing["q6_mean"]).max(), 1e-4)
        stored = boba_program(
            self.folder,
            "measure",
            "rested",
            "--output",
            "rested_again",
            "--what",
            "order",
            "--relaxed",
            "--rest-time",
            "20",
        )
        self.assertEqual(stored.returncode, 0, stored.stderr)
        again = boba.open(self.folder / "rested", self.folder / "rested_again").measure("order")
        np.testing.assert_allclose(again["q6_mean"], live["q6_mean"], atol=1e-6)

    def test_a_crystal_is_one_at_the_start(self):
        for arrangement, count in (("fcc", 32), ("hcp", 48), ("bcc", 54)):
            scene = SCENE.replace("count = 12", f"count = {count}").replace(
                "fraction = 0.25", f'fraction = 0.25\narrangement = "{arrangement}"'
            )
            scene = scene[: scene.index('[[stage]]\ntype = "compress"')] + '[[stage]]\ntype = "hold"\ntime = 1\n'
            (self.folder / f"{arrangement}.toml").write_text(scene)
            done = boba_program(self.folder, "run", f"{arrangement}.toml", "--output", arrangement)
            self.assertEqual(done.returncode, 0, done.stderr)
            order = boba.open(self.folder / arrangement).measure("order")
            self.assertEqual(order[f"template_{arrangement}_share"][0], 1.0)
            self.assertAlmostEqual(order["bragg_peak"][0], 1.0, delta=1e-6)
            self.assertEqual(order["largest_cluster"][0], count)
            self.assertEqual(order["largest_percolates_y"][0], 1.0)
            self.assertEqual(order["largest_finite_cluster"][0], 0.0)

    def test_plot_of_a_run(self):
        plotted = boba_program(self.folder, "plot", "run", "--pictures", "--window", "0.05", "0.3")
        self.assertEqual(plotted.returncode, 0, plotted.stderr)
        for name in (
            "plot.png",
            "plots/facet_counts.png",
            "plots/grains.png",
            "plots/hulls.png",
            "plots/stress_ratio.png",
        ):
            self.assertGreater((self.folder / "run" / name).stat().st_size, 5000, name)


if __name__ == "__main__":
    unittest.main()
