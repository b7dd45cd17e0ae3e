# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory: how much a run takes, what `boba check` says of it, and how a run ends that may not have it."""

import os
import re
import resource
import subprocess
import unittest

from boba_program import PROGRAM, ProgramTest, main

MEGABYTE = 1 << 20


class Memory(ProgramTest):
    def peak(self, *words):
        """Largest resident size of one run of the program, bytes."""
        process = subprocess.Popen(
            [PROGRAM, *words], cwd=self.folder, env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
        )
        error = process.stderr.read()
        process.stderr.close()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertIn(process.returncode, (0, 75), error)
        return 1024.0 * usage.ru_maxrss

    def test_check_knows_what_small_grains_take(self):
        quiet = ["--set", "output={checkpoint={every_seconds=1e6}}", "--threads", "1"]
        run = ["run", "scene.toml", *quiet, "--quiet", "--force", "--output", "o", "--wall-time", "1"]
        base = self.peak(*run[:-4], "--output", "first", "--set", "species.0.count=1", "--wall-time", "0.1")
        for nodes, count in ((1, 20000), (20, 4000)):
            with self.subTest(nodes=nodes):
                size = ["--set", f"template.0.nodes={nodes}", "--set", f"species.0.count={count}"]
                size += ["--set", "stage.0.packing_fraction=0.2"]
                told = self.boba("check", "scene.toml", "--quick", *size).stdout
                at_most = float(re.search(r"([0-9.]+) MB at most", told)[1]) * 1e6
                taken = self.peak(*[word if word != "o" else f"o{nodes}" for word in run if word != "--force"], *size)
                print(f"{count} grains of {nodes}: {(taken - base) / count:.0f} bytes each, told {at_most / count:.0f}")
                self.assertLess(taken - base, at_most)
                self.assertGreater(taken - base, at_most / 4)

    def test_memory_that_runs_out_is_one_sentence(self):
        size = [
            "--set",
            "template.0.nodes=20",
            "--set",
            "species.0.count=4000",
            "--set",
            "stage.0.packing_fraction=0.2",
        ]
        self.boba("check", "scene.toml", "--threads", "1", "--set", "template.0.nodes=20")  # builds the template
        n_refused = 0
        for megabytes in (90, 120, 150, 180, 210):

            def limit(of=megabytes):
                resource.setrlimit(resource.RLIMIT_AS, (of * MEGABYTE, of * MEGABYTE))

            words = ["run", "scene.toml", "--output", f"m{megabytes}", "--quiet", "--threads", "2", *size]
            result = self.boba(*words, "--wall-time", "1", preexec_fn=limit)
            with self.subTest(megabytes=megabytes):
                self.assertIn(result.returncode, (0, 1, 75, 127), result.stderr)  # 127: no room for the libraries
                if result.returncode == 1:
                    self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
                    n_refused += "out of memory" in result.stderr
        self.assertGreater(n_refused, 0)


if __name__ == "__main__":
    main()
