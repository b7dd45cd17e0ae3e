#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a table of the runs of a sweep: means over the second half of the shear. Usage: summarise.py OUTPUT DONE..."""
import csv
import os
import re
import sys


def row_of(done):
    folder = os.path.dirname(done)
    alpha, seed, rate = re.search(r"alpha(.+)_seed(.+)_rate(.+)$", os.path.basename(folder)).groups()
    with open(os.path.join(folder, "table.csv")) as file:
        rows = [
            {key: float(value) if value else float("nan") for key, value in row.items()} for row in csv.DictReader(file)
        ]
    last = rows[-1]["stage"]
    shear = [row for row in rows if row["stage"] == last]
    begin, end = shear[0]["strain"], shear[-1]["strain"]
    late = [row for row in shear if abs(row["strain"] - begin) >= 0.5 * abs(end - begin)]

    def mean(key):
        return sum(row[key] for row in late) / len(late)

    return {
        "alpha_kd": alpha,
        "seed": seed,
        "rate_1/tau": rate,
        "strain": end,
        "mu": mean("mu"),
        "P_normalised": mean("P_normalised"),
        "phi_reference": mean("phi_reference"),
        "inertial_number": mean("inertial_number"),
        "rows": len(late),
    }


def main():
    rows = [row_of(done) for done in sys.argv[2:]]
    with open(sys.argv[1], "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)


main()
