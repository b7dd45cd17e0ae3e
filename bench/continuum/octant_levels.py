#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bonded cylinder in three dimensions (R = 1, h = 3, nu = 0.25), refined evenly, on one rank and more.

Times are those of rank 0, by the clock and of the processor; on a shared machine only the latter tell something.
The last lines are the ratios of the clock's times on one rank and on more, the shortest of the repeats.
Usage: octant_levels.py PROGRAM [--levels 2,3,4,5] [--degree 1] [--ranks 1,2] [--multigrid gamg,boomer] [--repeat 1]
Level 5 of degree 1 has 922 179 unknowns and takes 3 GB."""
import argparse
import json
import os
import pathlib
import subprocess
import tempfile

parser = argparse.ArgumentParser()
parser.add_argument("program")
parser.add_argument("--levels", default="2,3,4,5")
parser.add_argument("--degree", default="1")
parser.add_argument("--ranks", default="1,2")
parser.add_argument("--multigrid", default="gamg,boomer")
parser.add_argument("--repeat", type=int, default=1)
choice = parser.parse_args()
environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def solved(level, ranks, multigrid):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(
            [
                "mpirun",
                "-np",
                ranks,
                choice.program,
                "cylinder",
                "--radius",
                "1",
                "--height",
                "3",
                "--young",
                "1",
                "--poisson",
                "0.25",
                "--strain",
                "0.01",
                "--dimension",
                "3",
                "--degree",
                choice.degree,
                "--refinements",
                level,
                "--multigrid",
                multigrid,
                "--no-fields",
                "--output",
                folder,
            ],
            check=True,
            env=environment,
            stdout=subprocess.DEVNULL,
        )
        return json.loads((pathlib.Path(folder) / "summary.json").read_text())["loads"][0]


phases = ("assemble", "precondition", "solve")
print(
    "| multigrid | unknowns | ranks | iterations | assembly s | set-up s | solution s | processor s of these |"
    " force |"
)
print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | --- | ---: |")
ratios = []
for name in choice.multigrid.split(","):
    for level in choice.levels.split(","):
        alone = None
        for ranks in choice.ranks.split(","):
            runs = [solved(level, ranks, name) for _ in range(choice.repeat)]
            best = min(runs, key=lambda load: load["seconds"])
            alone = alone or best["seconds"]
            clock = " | ".join(f"{best[phase + '_seconds']:.2f}" for phase in phases)
            processor = ", ".join(f"{best[phase + '_cpu_seconds']:.2f}" for phase in phases)
            print(
                f"| {name} | {best['n_unknowns']} | {ranks} | {best['cg_iterations']} | {clock} | {processor} | "
                f"{best['force']:.9g} |",
                flush=True,
            )
            if ranks != "1":
                ratios.append(
                    f"{name}, {best['n_unknowns']} unknowns: {ranks} ranks are "
                    f"{alone / best['seconds']:.2f} times as fast as 1"
                )
print()
print("\n".join(ratios))
