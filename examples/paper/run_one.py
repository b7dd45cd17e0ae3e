# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs one line of a plan, or continues it from its last checkpoint: run_one.py PLAN NAME OUT BOBA."""
import csv
import pathlib
import subprocess
import sys


def settings(row):
    """What a line of the plan changes in its scene."""
    values = {"seed": row["seed"], "species.0.count": row["grains"]}
    if row["scene"] != "spheres":
        values |= {"template.0.nodes": row["nodes"], "species.0.alpha": row["alpha"]}
    if row.get("arrangement"):
        values["stage.insert.arrangement"] = f'"{row["arrangement"]}"'
    if row["surface"]:
        values["template.0.surface"] = f'"{row["surface"]}"'
    if row["rate"]:
        values |= {"stage.shear.rate": row["rate"], "stage.shear.strain": row["strain"]}
    if row["every"]:
        values["measure.0.every_strain"] = row["every"]
    if row["scene"] in ("shear", "crystal"):
        values |= {"stage.shear.remap": f'"{row["remap"]}"', "measure.1.every_strain": row["every"]}
    return values


def main(plan, name, out, boba):
    row = next(row for row in csv.DictReader(open(plan)) if row["name"] == name)
    folder = pathlib.Path(out) / name
    folder.parent.mkdir(parents=True, exist_ok=True)
    if any((folder / "checkpoints").glob("*.boba")):
        command = [boba, "resume", str(folder)]
    else:
        scene = pathlib.Path(__file__).parent / f"{row['scene']}.toml"
        command = [boba, "run", str(scene), "--output", str(folder), "--force"]
        for key, value in settings(row).items():
            command += ["--set", f"{key}={value}"]
    with open(f"{folder}.log", "a") as log:
        return subprocess.call(command, stdout=log, stderr=subprocess.STDOUT)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:5]))
