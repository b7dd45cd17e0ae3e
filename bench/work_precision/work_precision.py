#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Error against run time of the engine, the measures and the calibration, one setting at a time.

Every run is made once and kept under DIR/runs; calling again goes on where it stopped. Needs numpy and matplotlib."""
import argparse
import os
import pathlib
import platform
import subprocess
import sys

import axes
from runner import Runner


def arguments():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "program", metavar="BOBA", type=pathlib.Path, help="the program boba; boba-calibrate lies beside it"
    )
    parser.add_argument("--output", required=True, type=pathlib.Path, help="folder for runs, results.csv and pictures")
    parser.add_argument(
        "--quick", action="store_true", help="few and short runs: shows that it works, not what is true"
    )
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time, each on one thread")
    parser.add_argument("--only-analyse", action="store_true", help="start nothing; use the runs that are there")
    return parser.parse_args()


def programs(boba):
    """Paths of the two programs; raises FileNotFoundError where one is missing."""
    found = {"boba": boba.resolve(), "boba-calibrate": boba.resolve().parent / "boba-calibrate"}
    for path in found.values():
        if not path.exists():
            raise FileNotFoundError(f"{path}: there is no such program")
    return found


def describe_machine(boba, folder):
    """Writes machine.txt: processor, cores and the program's version."""
    model = next(
        (
            line.split(":")[1].strip()
            for line in open("/proc/cpuinfo", encoding="utf-8")
            if line.startswith("model name")
        ),
        "?",
    )
    info = subprocess.run([boba, "info"], capture_output=True, text=True, check=True).stdout.splitlines()[:2]
    text = [model, f"{os.cpu_count()} cores, {platform.platform()}", *info]
    (folder / "machine.txt").write_text("\n".join(text) + "\n")


def main():
    """Runs what is missing, then evaluates what is there."""
    options = arguments()
    options.output.mkdir(parents=True, exist_ok=True)
    try:
        found = programs(options.program)
    except FileNotFoundError as error:
        print(error, file=sys.stderr)
        return 2
    (options.output / "packing.toml").write_text(axes.PACKING)
    (options.output / "press.toml").write_text(axes.PRESS)
    describe_machine(found["boba"], options.output)
    runner, plan = Runner(options.output, found, options.jobs), axes.Plan(options.quick)
    if not options.only_analyse:
        runner.all(axes.all_runs(plan))
    import analysis
    import plots

    rows = analysis.evaluate(runner, plan)
    analysis.write(rows, options.output / "results.csv")
    plots.draw(rows, options.output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
