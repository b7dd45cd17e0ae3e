# SPDX-License-Identifier: GPL-3.0-or-later
"""Two processes in one folder, what --force may remove, and a run whose files were changed before it is resumed."""

import os
import shutil
import signal
import socket
import subprocess
import unittest

from boba_program import LONG, ProgramTest, main, table_without_speed

MORE = [
    "--set",
    "output.dump.every_time=30",
    "--set",
    "output.vtk.every_time=60",
    "--set",
    'measure=[{what = "shape, order", every_strain = 0.05}]',
]


class OneHolder(ProgramTest):
    def test_second_process_is_refused_and_told_who_is_there(self):
        run = self.start("run", "scene.toml", "--output", "o", *LONG)
        self.wait_for("o/checkpoints/checkpoint-000001.boba")
        self.wait_for_rows("o/table.csv", 3)
        for words in (["resume", "o"], ["run", "scene.toml", "--output", "o", "--force"]):
            self.assert_refused(self.boba(*words), f"process {run.pid} on {socket.gethostname()}, since 2")
        self.assertIsNone(run.poll())
        run.send_signal(signal.SIGTERM)
        self.assertEqual(run.wait(60), 75)
        self.assertNotIn(b"\0", (self.folder / "o/table.csv").read_bytes())
        self.assertFalse((self.folder / "o/run.lock").exists())

    def test_readers_are_welcome_while_it_runs(self):
        self.start("run", "scene.toml", "--output", "o", *LONG)
        self.wait_for_rows("o/table.csv", 60)
        result = self.boba("measure", "o", "--what", "order")
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_one_of_two_resumes_wins(self):
        self.boba("run", "scene.toml", "--output", "o", *LONG, "--wall-time", "0.5")
        both = [self.start("resume", "o", "--wall-time", "3") for _ in range(2)]
        self.assertEqual(sorted(process.wait(60) for process in both), [2, 75])
        steps = [int(line.split(",")[0]) for line in (self.folder / "o/table.csv").read_text().splitlines()[1:]]
        self.assertEqual(steps, sorted(set(steps)))

    def test_a_killed_holder_holds_nothing(self):
        run = self.start("run", "scene.toml", "--output", "o", *LONG)
        self.wait_for_rows("o/table.csv", 3)
        run.kill()
        run.wait()
        self.assertTrue((self.folder / "o/run.lock").exists())
        self.assertEqual(self.boba("resume", "o", "--wall-time", "0.2").returncode, 75)


class Force(ProgramTest):
    def test_without_a_run_nothing_is_replaced(self):
        names = ["measures/notes.txt", "vtk/my.vtp", "checkpoints/README", "trajectory.h5", "keep.txt", "scene.toml"]
        for name in names:
            (self.folder / "a" / name).parent.mkdir(parents=True, exist_ok=True)
            (self.folder / "a" / name).write_text("mine")
        self.assert_refused(self.boba("run", "scene.toml", "--output", "a", "--force"), "holds no run")
        for name in names:
            self.assertEqual((self.folder / "a" / name).read_text(), "mine", name)

    def test_only_what_the_run_wrote_goes(self):
        self.assertEqual(self.boba("run", "scene.toml", "--output", "a", *MORE).returncode, 0)
        kept = [
            "measures/notes.txt",
            "measures/contacts.csv",
            "vtk/my.vtp",
            "vtk/packing_x.vtp",
            "checkpoints/README",
            "keep.txt",
        ]
        for name in kept:
            (self.folder / "a" / name).write_text("mine")
        stale = self.folder / "a/vtk/packing_99999999.vtp"
        stale.write_text("of a run")
        result = self.boba("run", "scene.toml", "--output", "a", "--force", "--set", "seed=8")
        self.assertEqual(result.returncode, 0, result.stderr)
        for name in kept:
            self.assertEqual((self.folder / "a" / name).read_text(), "mine", name)
        for gone in ("vtk/packing.pvd", "measures/shape.csv", "dump.lammpstrj", "vtk/packing_99999999.vtp"):
            self.assertFalse((self.folder / "a" / gone).exists(), gone)

    def test_the_list_of_files_leads_nowhere_else(self):
        self.assertEqual(self.boba("run", "scene.toml", "--output", "a").returncode, 0)
        (self.folder / "mine.txt").write_text("mine")
        (self.folder / "a/mine.txt").write_text("mine")
        with open(self.folder / "a/files.txt", "a") as names:
            names.write("../mine.txt\nmine.txt\n")
        self.assertEqual(self.boba("run", "scene.toml", "--output", "a", "--force").returncode, 0)
        self.assertTrue((self.folder / "mine.txt").exists())
        self.assertTrue((self.folder / "a/mine.txt").exists())

    def test_what_the_scene_reads_stays(self):
        self.assertEqual(self.boba("run", "scene.toml", "--output", "b").returncode, 0)
        before = (self.folder / "b/trajectory.h5").read_bytes()
        (self.folder / "b/next.toml").write_text(
            '[start]\ntrajectory = "trajectory.h5"\n[[stage]]\ntype = "hold"\ntime = 1.0\n'
        )
        self.assert_refused(self.boba("run", "b/next.toml", "--output", "b", "--force"), "b/trajectory.h5", "reads it")
        os.symlink("b/trajectory.h5", self.folder / "link.h5")
        (self.folder / "next.toml").write_text(
            '[start]\ntrajectory = "link.h5"\n[[stage]]\ntype = "hold"\ntime = 1.0\n'
        )
        self.assert_refused(self.boba("run", "next.toml", "--output", "b", "--force"), "b/trajectory.h5")
        self.assertEqual((self.folder / "b/trajectory.h5").read_bytes(), before)

    def test_a_foreign_file_where_the_run_writes_is_told(self):
        without = ["--set", "output={table={every_time=20.0}}"]
        self.assertEqual(self.boba("run", "scene.toml", "--output", "a", *without).returncode, 0)
        (self.folder / "a/trajectory.h5").write_text("mine")
        self.assert_refused(self.boba("run", "scene.toml", "--output", "a", "--force"), "a/trajectory.h5")
        self.assertEqual((self.folder / "a/trajectory.h5").read_text(), "mine")

    def test_a_run_is_replaced_by_its_own_scene(self):
        self.assertEqual(self.boba("run", "scene.toml", "--output", "a").returncode, 0)
        text = (self.folder / "a/scene.toml").read_text()
        result = self.boba("run", "a/scene.toml", "--output", "a", "--force")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue((self.folder / "a/scene.toml").read_text().startswith(text))


class Gaps(ProgramTest):
    """A run stopped after some checkpoints; each change to its files is told, and nothing goes on without a word."""

    def stopped_run(self, name):
        run = self.start("run", "scene.toml", "--output", name, *MORE, "--set", "stage.2.strain=1")
        self.wait_for_rows(f"{name}/measures/shape.csv", 4)
        self.wait_for(f"{name}/vtk/packing.pvd")
        run.send_signal(signal.SIGTERM)
        self.assertEqual(run.wait(60), 75)

    def changed(self, change):
        shutil.rmtree(self.folder / "o", ignore_errors=True)
        shutil.copytree(self.folder / "stopped", self.folder / "o")
        change(self.folder / "o")
        return self.boba("resume", "o", "--quiet", "--wall-time", "30")

    def test_changes(self):
        self.stopped_run("stopped")

        def cut(name, n):
            return lambda o: os.truncate(o / name, n)

        def remove(name):
            return lambda o: shutil.rmtree(o / name) if (o / name).is_dir() else os.remove(o / name)

        def edit(name, old, new):
            def change(o):
                text = (o / name).read_text()
                self.assertIn(old, text)
                (o / name).write_text(text.replace(old, new, 1))

            return change

        row = (self.folder / "stopped/table.csv").read_text().splitlines()[5]
        a_vtp = sorted((self.folder / "stopped/vtk").glob("*.vtp"))[0].name
        changes = {
            "table.csv": [
                remove("table.csv"),
                cut("table.csv", 500),
                edit("table.csv", row, "x"),
                edit("table.csv", row, row.replace("0", "1", 1)),
            ],
            "dump.lammpstrj": [remove("dump.lammpstrj"), cut("dump.lammpstrj", 3000)],
            "trajectory.h5": [remove("trajectory.h5"), cut("trajectory.h5", 4000)],
            "vtk": [remove("vtk"), remove(f"vtk/{a_vtp}"), cut(f"vtk/{a_vtp}", 100), remove("vtk/packing.pvd")],
            "measures": [remove("measures"), remove("measures/shape.csv"), cut("measures/order.csv", 60)],
            "scene.toml": [edit("scene.toml", "rate = 5e-3", "rate = 1e-2"), remove("scene.toml")],
        }
        for name, ways in changes.items():
            for i, way in enumerate(ways):
                with self.subTest(name=name, way=i):
                    self.assert_refused(self.changed(way), name, "--accept-gaps")

        self.assertEqual(self.changed(lambda o: None).returncode, 0)
        whole = table_without_speed(self.folder / "o/table.csv")

        self.assert_refused(self.changed(remove("trajectory.h5")))
        result = self.boba("resume", "o", "--accept-gaps")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("trajectory.h5 is missing", result.stdout)
        self.assertEqual(table_without_speed(self.folder / "o/table.csv"), whole)
        self.assertTrue((self.folder / "o/trajectory.h5").exists())

        self.assert_refused(self.changed(edit("table.csv", row, "x")))
        self.assertEqual(self.boba("resume", "o", "--accept-gaps").returncode, 0)
        rows = table_without_speed(self.folder / "o/table.csv")
        self.assertEqual([r for r in rows if r != "x"], [r for i, r in enumerate(whole) if i != 5])


class StageTables(ProgramTest):
    """A stage's own table is written when the stage ends; a run that continues misses it when it is gone."""

    SCENE = """[[template]]
name = "grain"
nodes = 30
[[species]]
count = 8
alpha = 1.0
[[stage]]
type = "insert"
packing_fraction = 0.2
[[stage]]
type = "quasistatic"
strain = 0.01
steps = 2
force_tolerance = 1e-3
[[stage]]
type = "hold"
time = 1e6
"""

    def test_a_lost_table_is_told(self):
        (self.folder / "steps.toml").write_text(self.SCENE)
        run = self.start("run", "steps.toml", "--output", "o")
        self.wait_for("o/stages/stage-1.csv")
        run.send_signal(signal.SIGTERM)
        self.assertEqual(run.wait(60), 75)
        table = self.folder / "o/stages/stage-1.csv"
        text = table.read_text()
        self.assertEqual([line.split(",")[1] for line in text.splitlines()], ["strain", "0", "0.005", "0.01"])
        table.unlink()
        self.assert_refused(self.boba("resume", "o"), "stages/stage-1.csv is missing", "--accept-gaps")
        table.write_text(text.replace("0.005", "0.004"))
        self.assert_refused(self.boba("resume", "o"), "stages/stage-1.csv was edited")
        table.write_text(text)
        self.assertEqual(self.boba("resume", "o", "--quiet", "--wall-time", "0.1").returncode, 75)
        self.assertEqual(
            self.boba("run", "steps.toml", "--output", "o", "--force", "--wall-time", "0.1").returncode, 75
        )


if __name__ == "__main__":
    main()
