# SPDX-License-Identifier: GPL-3.0-or-later
"""`boba measure`: nothing is overwritten, nothing is written in vain, and a run's material is the run's."""

import csv
import json
import unittest

from boba_program import ProgramTest, main


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


class Measures(ProgramTest):
    def setUp(self):
        super().setUp()
        self.short = ["--set", "stage.2.strain=0.05", "--quiet"]

    def run_scene(self, *words):
        result = self.boba("run", *words, *self.short)
        self.assertEqual(result.returncode, 0, result.stderr)

    def averages(self):
        return json.loads((self.folder / "o/measures/averages.json").read_text())

    def test_comments_of_a_copied_scene_are_no_settings(self):
        self.run_scene(
            "scene.toml",
            "--output",
            "a",
            "--set",
            "material.k=10",
            "--set",
            "stage.1.pressure=0.5",
            "--set",
            "stage.2.pressure=0.5",
            "--set",
            "run.dt=0.03",
        )
        self.run_scene("a/scene.toml", "--output", "b")  # k = 1 again
        self.run_scene("scene.toml", "--output", "c")
        for run in "bc":
            self.assertEqual(self.boba("measure", run, "--what", "stress").returncode, 0)
        ours, right = rows(self.folder / "b/measures/stress.csv")[-1], rows(self.folder / "c/measures/stress.csv")[-1]
        self.assertEqual(ours, right)
        self.assertEqual(self.boba("measure", "a", "--what", "stress").returncode, 0)
        last = rows(self.folder / "a/measures/stress.csv")[-1]
        self.assertLess(abs(float(last["P_k/d"]) / float(last["P_run_k/d"]) - 1.0), 0.05)  # k = 10 applies there

    def test_averages_of_earlier_measures_stay(self):
        self.run_scene("scene.toml", "--output", "o")
        self.assertEqual(self.boba("measure", "o", "--what", "shape").returncode, 0)
        first = self.averages()
        self.assertEqual(self.boba("measure", "o", "--what", "order", "--window", "-1", "1").returncode, 0)
        both = self.averages()
        self.assertEqual({name: both[name] for name in first}, first)
        self.assertIn("ordered_share", both)
        self.assertEqual(both["ordered_share"]["strain_window"], [-1.0, 1.0])
        self.assertNotIn("strain_window", both["volume_mean_d3"])

    def test_foreign_files_are_left_alone(self):
        self.run_scene("scene.toml", "--output", "o")
        (self.folder / "o/measures").mkdir()
        for name, content in (
            ("averages.json", '{"mine": 1}'),
            ("averages.json", "[1, 2"),
            ("contacts.csv", "a,b\n1,2\n"),
        ):
            path = self.folder / "o/measures" / name
            path.write_text(content)
            self.assert_refused(self.boba("measure", "o", "--what", "contacts", "--force"), name, "left alone")
            self.assertEqual(path.read_text(), content)
            self.assertEqual([p.name for p in path.parent.iterdir()], [name])
            path.unlink()

    def test_what_is_refused_writes_nothing(self):
        self.run_scene("scene.toml", "--output", "o")
        for words in (
            ["--q-max", "-1"],
            ["--q-max", "nan"],
            ["--q-max", "1e9"],
            ["--shell-width", "-1"],
            ["--points", "0"],
            ["--target-error", "2"],
            ["--min-cosine", "3"],
            ["--min-area-share", "-1"],
            ["--window", "7", "8"],
            ["--window", "1", "0"],
            ["--frame", "99999"],
            ["--every", "0"],
        ):
            with self.subTest(words=words):
                self.assert_refused(self.boba("measure", "o", "--what", "packing-fraction,scattering,shape", *words))
                self.assertFalse((self.folder / "o/measures").exists())
        self.assertIn("strains are from", self.boba("measure", "o", "--window", "7", "8").stderr)
        self.assertEqual(self.boba("measure", "o", "--what", "scattering,shape").returncode, 0)
        self.assert_refused(self.boba("measure", "o", "--what", "shape"), "--force")
        self.assertEqual(self.boba("measure", "o", "--what", "shape", "--force").returncode, 0)

    def test_measures_that_the_grains_cannot_have(self):
        single = ["--set", "template.0.nodes=1"]
        self.run_scene("scene.toml", "--output", "s", *single)
        self.assert_refused(self.boba("measure", "s", "--what", "shape"), "1 node")
        self.assertFalse((self.folder / "s/measures").exists())
        self.assertEqual(self.boba("measure", "s", "--what", "order,contacts,stress").returncode, 0)

    def test_a_run_without_a_trajectory(self):
        self.run_scene("scene.toml", "--output", "o", "--set", "output={table={every_time=20.0}}")
        self.assert_refused(self.boba("measure", "o"), "[output.trajectory]")
        self.assert_refused(self.boba("measure", "nowhere"), "nowhere")


class Sampling(ProgramTest):
    def test_shear_forward_and_back_is_sampled_by_path(self):
        (self.folder / "turn.toml").write_text(
            (self.folder / "scene.toml").read_text().replace("strain = 0.2", "strain = 0.1")
            + '\n[[stage]]\ntype = "shear"\nrate = -5e-3\nstrain = 0.1\npressure = 0.05\n'
        )
        self.assertEqual(
            self.boba("run", "turn.toml", "--output", "o", "--set", "output.table.every_time=1e9").returncode, 0
        )
        table = rows(self.folder / "o/table.csv")
        back = [float(row["strain"]) for row in table if row["stage"] in ("3", "3.0")]
        self.assertEqual(len(back), 10)
        for i, strain in enumerate(back):
            self.assertAlmostEqual(strain, 0.1 - 0.01 * (i + 1), delta=2 * 5e-3 * 0.1)


if __name__ == "__main__":
    main()
