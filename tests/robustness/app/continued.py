# SPDX-License-Identifier: GPL-3.0-or-later
"""A run that continues another takes over what was stored; what a packing cannot have is refused before writing."""

import csv
import pathlib
import unittest

from boba_program import ProgramTest, main


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


class Continued(ProgramTest):
    NEXT = """[start]
trajectory = "prep/trajectory.h5"
[output.trajectory]
velocities = true
every_strain = 0.01
[[stage]]
type = "shear"
rate = 5e-3
strain = 0.05
pressure = 0.05
"""

    def prepare(self, *words):
        result = self.boba("run", "scene.toml", "--output", "prep", "--set", "stage.2.strain=0.1", *words)
        self.assertEqual(result.returncode, 0, result.stderr)
        (self.folder / "next.toml").write_text(self.NEXT)

    def go_on(self, *words):
        result = self.boba("run", "next.toml", "--output", "next", *words)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def test_the_material_is_the_trajectorys(self):
        self.prepare("--set", "material.k=0.5", "--set", "material.gamma=0.7")
        told = self.go_on().stdout
        self.assertIn("k = 0.5, gamma = 0.7", told)
        before, after = rows(self.folder / "prep/table.csv")[-1], rows(self.folder / "next/table.csv")[0]
        self.assertLess(abs(float(after["P_k/d"]) / float(before["P_k/d"]) - 1.0), 0.1)  # twice as much with k = 1
        self.assertIn("# --set material.k=0.5", (self.folder / "next/scene.toml").read_text())
        # A measure, a resumed run and the next run know it too.
        self.assertEqual(self.boba("measure", "next", "--what", "stress").returncode, 0)
        last = rows(self.folder / "next/measures/stress.csv")[-1]
        self.assertLess(abs(float(last["P_k/d"]) / float(last["P_run_k/d"]) - 1.0), 0.05)
        (self.folder / "third.toml").write_text(self.NEXT.replace("prep/", "next/"))
        self.assertIn("k = 0.5, gamma = 0.7", self.boba("check", "third.toml").stdout)

    def test_the_scene_may_say_otherwise(self):
        self.prepare("--set", "material.k=0.5")
        told = self.go_on("--set", "material.k=1").stdout
        self.assertIn("k = 1 (of the scene) instead of 0.5", told)
        self.assertNotIn("material.k=0.5", (self.folder / "next/scene.toml").read_text())

    def test_the_strain_goes_on(self):
        self.prepare()
        self.assertIn("strain 0.1 of the frame", self.go_on().stdout)
        strains = [float(row["strain"]) for row in rows(self.folder / "next/table.csv")]
        self.assertAlmostEqual(strains[0], 0.1, delta=1e-9)
        self.assertAlmostEqual(strains[-1], 0.15, delta=1e-9)
        told = self.boba("run", "next.toml", "--output", "zero", "--set", "start.strain=0").stdout
        self.assertIn("start.strain = 0, instead of 0.1 of the frame", told)
        self.assertEqual(float(rows(self.folder / "zero/table.csv")[0]["strain"]), 0.0)

    def test_a_resumed_run_knows_it_too(self):
        self.prepare("--set", "material.k=0.5")
        words = ["--set", "stage.0.strain=3", "--quiet"]
        self.assertEqual(self.boba("run", "next.toml", "--output", "whole", *words).returncode, 0)
        stopped = self.boba("run", "next.toml", "--output", "parts", *words, "--wall-time", "0.3")
        self.assertEqual(stopped.returncode, 75, stopped.stderr)
        self.assertEqual(self.boba("resume", "parts", "--quiet").returncode, 0)
        self.assertEqual(
            (self.folder / "whole/table.csv").read_text().splitlines()[-1].split(",")[:10],
            (self.folder / "parts/table.csv").read_text().splitlines()[-1].split(",")[:10],
        )

    def test_one_nu_for_a_mixture_is_told(self):
        self.prepare("--set", 'species=[{template="grain",count=4,alpha=2.0},{template="grain",count=4,alpha=-0.5}]')
        self.assertIn("alpha = -0.5, 2 k d of the trajectory", self.go_on().stdout)
        told = self.boba("check", "next.toml", "--set", "start.poisson=0.25").stdout
        self.assertIn(
            "warning: start.poisson = 0.25 applies to all 8 grains of 2 species, instead of alpha = -0.5, 2", told
        )

    def test_an_open_cell_cannot_be_compressed(self):
        (self.folder / "specimen.toml").write_text(
            """[output.trajectory]
velocities = true
[[template]]
name = "grain"
nodes = 60
[[species]]
count = 1
alpha = 2.0
[[stage]]
type = "specimen"
[[stage]]
type = "hold"
time = 5.0
"""
        )
        result = self.boba("run", "specimen.toml", "--output", "prep")
        self.assertEqual(result.returncode, 0, result.stderr)
        stages = {
            "compress": "pressure = 0.05",
            "shear": "rate = 1e-3\nstrain = 0.1",
            "hold": "time = 5.0\npressure = 0.05",
        }
        for kind, keys in stages.items():
            (self.folder / "next.toml").write_text(
                f'[start]\ntrajectory = "prep/trajectory.h5"\n[[stage]]\ntype = "{kind}"\n{keys}\n'
            )
            for words in (["check", "next.toml"], ["run", "next.toml", "--output", "next"]):
                self.assert_refused(self.boba(*words), "stage.0", kind.split()[0], "periodic")
        self.assertFalse((self.folder / "next").exists())


class Hulls(ProgramTest):
    def test_measures_that_the_grains_cannot_have(self):
        text = (self.folder / "scene.toml").read_text()
        single = ["--set", "template.0.nodes=1"]
        for what in ("shape", "packing-fraction", "all", "order"):
            voronoi = 'neighbours = "voronoi"\n' if what == "order" else ""
            (self.folder / "hulls.toml").write_text(
                f'{text}\n[[measure]]\nwhat = "{what}"\n{voronoi}every_strain = 0.1\n'
            )
            for words in (["check", "--quick"], ["check"], ["run", "--output", "o"]):
                result = self.boba(words[0], "hulls.toml", *words[1:], *single)
                self.assert_refused(result, "measure.0.what", "hulls.toml:")
            self.assertFalse((self.folder / "o").exists())
        # The same when the grains come from a trajectory.
        self.assertEqual(self.boba("run", "scene.toml", "--output", "s", *single).returncode, 0)
        (self.folder / "next.toml").write_text(
            '[start]\ntrajectory = "s/trajectory.h5"\n[[measure]]\nwhat = "shape"\n[[stage]]\ntype = "hold"\ntime = 1.0\n'
        )
        for words in (["check", "next.toml"], ["run", "next.toml", "--output", "o"]):
            self.assert_refused(self.boba(*words), "measure.0.what")
        self.assertFalse((self.folder / "o").exists())


class Readme(ProgramTest):
    def test_its_scene_runs_and_is_measured(self):
        text = (pathlib.Path(__file__).resolve().parents[3] / "README.md").read_text()
        lines = text[text.index("\n    seed = 1\n") :].splitlines()[1:]
        end = next(i for i, line in enumerate(lines) if line.startswith("    boba "))
        (self.folder / "readme.toml").write_text("\n".join(line[4:] for line in lines[:end]))
        words = ["template.0.nodes=60", "species.0.count=8", "stage.shear.strain=0.1", "stage.shear.rate=1e-2"]
        words += ["stage.compress.rate=5e-3", "stage.compress.kinetic_tolerance=1e-2"]
        sets = [word for setting in words for word in ("--set", setting)]
        result = self.boba("run", "readme.toml", "--output", "o", "--threads", "1", *sets)
        self.assertEqual(result.returncode, 0, result.stderr)
        measured = self.boba("measure", "o", "--what", "shape,order")
        self.assertEqual(measured.returncode, 0, measured.stderr)


class Ranges(ProgramTest):
    def test_insert_finds_a_fraction_of_its_own(self):
        (self.folder / "insert.toml").write_text(
            """[[template]]
name = "grain"
nodes = 250
[[species]]
template = "grain"
count = 10
poisson = -0.25
[[stage]]
type = "insert"
[[stage]]
type = "hold"
time = 1.0
"""
        )
        result = self.boba("run", "insert.toml", "--output", "o")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("packing_fraction = 0.38", result.stdout)
        self.assert_refused(self.boba("run", "insert.toml", "--output", "p", "--set", "stage.0.packing_fraction=0.5"))

    def test_ranges_of_the_documents_are_those_of_the_program(self):
        reference = self.boba("info", "--scene-reference").stdout
        for text in ("20 and more, or 1", "radius of 1.58"):
            self.assertIn(text, reference)
        for value, code in (("0.44", 0), ("-0.8", 0), ("0.441", 2), ("-0.81", 2)):
            result = self.boba("check", "scene.toml", "--quick", "--set", f"species=[{{count=2, poisson={value}}}]")
            self.assertEqual(result.returncode, code, value + result.stderr)
        self.assert_refused(
            self.boba("check", "scene.toml", "--quick", "--set", 'template=[{name="grain", radius=0.6}]'),
            "template.0.radius = 0.6",
        )


if __name__ == "__main__":
    main()
