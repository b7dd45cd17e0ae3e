#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Strong scaling from alternating runs: 1 rank, 2 ranks, and as many ranks' shares apart, as programs of their own.

Usage: bench/scaling/strong.py [--runs 8] [--steps 80] [--mixed] [BENCH_SCALING]
The host's speed changes by half within minutes, so what counts is the ratio of the best of each and the median of
neighbours. "apart" is what the cores give two programs that know nothing of each other (32 x 5137 each): the rest is
what the ranks cost. Needs two free cores.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess


def last_line(output: bytes) -> float:
    return json.loads(output.decode().strip().splitlines()[-1])["ms_a_step"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?", default="build/release/bin/bench_scaling")
    parser.add_argument("--runs", type=int, default=8)
    parser.add_argument("--steps", type=int, default=80)
    parser.add_argument("--mixed", action="store_true")
    arguments = parser.parse_args()
    environment = dict(os.environ, OMP_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    program = str(pathlib.Path(arguments.program).resolve())
    tail = ["--steps", str(arguments.steps)] + (["--mixed"] if arguments.mixed else [])

    def start(command: list[str]) -> subprocess.Popen:
        return subprocess.Popen(command + tail, stdout=subprocess.PIPE, env=environment)

    whole, half = [program, "--times", "2", "2", "1"], [program, "--times", "2", "1", "1"]
    times: dict[str, list[float]] = {"1 rank": [], "2 ranks": [], "apart": []}
    for _ in range(arguments.runs):
        times["1 rank"].append(last_line(start(["taskset", "-c", "0", *whole]).communicate()[0]))
        times["2 ranks"].append(last_line(start(["mpirun", "--bind-to", "core", "-np", "2", *whole]).communicate()[0]))
        both = [start(["taskset", "-c", str(core), *half]) for core in (0, 1)]
        times["apart"].append(max(last_line(process.communicate()[0]) for process in both))
    for name, values in times.items():
        print(f"{name:8s} best {min(values):6.2f} ms a step, median {statistics.median(values):6.2f}")
    for name in ("2 ranks", "apart"):
        ratios = [one / two for one, two in zip(times["1 rank"], times[name])]
        print(
            f"{name:8s} {min(times['1 rank']) / min(times[name]):.2f} times as fast (best against best), "
            f"{statistics.median(ratios):.2f} (median of neighbours, {min(ratios):.2f} to {max(ratios):.2f})"
        )


if __name__ == "__main__":
    main()
