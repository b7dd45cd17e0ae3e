#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fails when the engine has become slower: node-steps a second against what is on record, both in units of a reference
loop (512-bit multiply-adds and a triad in the second cache) that is timed between them in the same run, since clocks
differ from hour to hour.

Usage: guard.py BENCH_ENGINE --compare docs/performance.json          exit code 3 on a loss above 15 %
       guard.py BENCH_ENGINE --write docs/performance.json            put this machine's figures on record
"""
import argparse
import datetime
import json
import math
import pathlib
import platform
import subprocess
import sys

ENGINE = "dense_shear/fastest/grains:(16/nodes:5137/alpha:2|64/nodes:300/alpha:2)/threads:1"
REFERENCE = ("vector_multiply_adds", "triad/1024")
ALLOWED_LOSS = 0.15


def timed(program, repetitions):
    """Best rate of every benchmark over the repetitions, which are run in random order."""
    done = subprocess.run(
        [
            program,
            f"--benchmark_filter={ENGINE}|" + "|".join(f"{name}$" for name in REFERENCE),
            f"--benchmark_repetitions={repetitions}",
            "--benchmark_enable_random_interleaving=true",
            "--benchmark_min_time=0.5",
            "--benchmark_format=json",
        ],
        check=True,
        stdout=subprocess.PIPE,
        text=True,
    )
    best = {}
    for run in json.loads(done.stdout)["benchmarks"]:
        if run["run_type"] == "iteration":
            rate = run.get("node_steps") or run.get("instructions") or run["bytes_per_second"]
            name = run["run_name"].split("/min_time")[0]
            best[name] = max(rate, best.get(name, 0.0))
    return best


def relative(best):
    """Node-steps per unit of the reference: the geometric mean of its loops."""
    loops = [rate for name, rate in best.items() if name in REFERENCE]
    reference = math.prod(loops) ** (1.0 / len(loops))
    return {name: rate / reference for name, rate in best.items() if name not in REFERENCE}


def processor():
    lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
    return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), platform.machine())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--repetitions", type=int, default=5)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--compare", type=pathlib.Path, metavar="FILE")
    what.add_argument("--write", type=pathlib.Path, metavar="FILE")
    choice = parser.parse_args()
    record = json.loads(choice.compare.read_text()) if choice.compare else None
    best = timed(choice.program, choice.repetitions)
    ratios = relative(best)
    if choice.write:
        choice.write.write_text(
            json.dumps(
                {
                    "date": datetime.date.today().isoformat(),
                    "processor": processor(),
                    "node_steps_per_second": best,
                    "relative_to_reference": ratios,
                },
                indent=1,
            )
            + "\n"
        )
        return 0
    worst = 0.0
    for name, before in record["relative_to_reference"].items():
        loss = 1.0 - ratios[name] / before
        worst = max(worst, loss)
        print(f"{name}: {best[name] / 1e6:.1f} M node-steps/s, {-100 * loss:+.1f} % against the record")
    if worst > ALLOWED_LOSS:
        print(
            f"a loss of {100 * worst:.0f} %, more than {100 * ALLOWED_LOSS:.0f} % "
            f"(on record: {record['processor']}, {record['date']})",
            file=sys.stderr,
        )
        return 3
    return 0


if __name__ == "__main__":
    sys.exit(main())
