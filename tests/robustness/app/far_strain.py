# SPDX-License-Identifier: GPL-3.0-or-later
"""Shear to a strain of 1e5 (BOBA_STRAIN) in both precisions: nodes are never wrapped, so they end far from the cell.

The pressure of the run's last step is that of forces evaluated again from the stored frame, with nothing but the file:
to 1e-9 in double precision, to 1e-5 in mixed.
"""

import csv
import os
import unittest

from boba_program import ProgramTest, main

STRAIN = float(os.environ.get("BOBA_STRAIN", "1e5"))

SCENE = """[run]
threads = 1
dt = 0.18
[output.table]
every_strain = 1000
every_time = 1e9
[output.trajectory]
velocities = true
[[template]]
name = "grain"
nodes = 20
[[species]]
count = 2
alpha = 2.0
[[stage]]
type = "insert"
packing_fraction = 0.1
[[stage]]
type = "compress"
pressure = 0.05
rate = 2e-3
kinetic_tolerance = 1e-2
[[stage]]
type = "shear"
rate = 0.1
"""


def last_row(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))[-1]


class FarStrain(ProgramTest):
    def test_pressure_of_the_last_frame(self):
        (self.folder / "far.toml").write_text(f"{SCENE}strain = {STRAIN:.1f}\n")
        for precision, tolerance in (("double", 1e-9), ("mixed", 1e-5)):
            with self.subTest(precision=precision):
                words = ["--output", precision, "--quiet", "--set", f'run.precision="{precision}"']
                self.assertEqual(self.boba("run", "far.toml", *words, timeout=3400).returncode, 0)
                measured = self.boba("measure", precision, "--what", "stress", "--frame", "-1")
                self.assertEqual(measured.returncode, 0, measured.stderr)
                row = last_row(self.folder / precision / "measures/stress.csv")
                run = last_row(self.folder / precision / "table.csv")
                self.assertAlmostEqual(float(run["strain"]), STRAIN, delta=1e-6 * STRAIN)
                difference = abs(float(row["P_k/d"]) / float(run["P_k/d"]) - 1.0)
                print(f"{precision}: P = {run['P_k/d']}, evaluated again {row['P_k/d']}, difference {difference:.2g}")
                self.assertLess(difference, tolerance)


if __name__ == "__main__":
    main()
