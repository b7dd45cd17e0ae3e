# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 1 from trajectories: pictures.py RUNS.csv OUT FIGURE.png.

Rows nu = 0.4, 0 (0.25 while there is no run at 0), -0.5; columns: a squeezed cylinder, the packing at strain 3.2 and the last of the largest
packing beyond strain 20, a cross-section at 3.2, a grain's hull.
"""
import csv
import pathlib
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from PIL import Image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
import boba
from boba import pictures
from figures import POISSON


def last_run(plan, out, alpha):
    """Of the runs of grains of 300 nodes beyond strain 20 the one with the most grains, of several the one sheared farthest."""
    rows = [
        row
        for row in csv.DictReader(open(plan))
        if row["scene"] == "shear"
        and row["alpha"] == alpha
        and row["nodes"] == "300"
        and not row["surface"]
        and (pathlib.Path(out) / row["name"] / "trajectory.h5").exists()
    ]
    reached = {row["name"]: float(boba.open(f"{out}/{row['name']}").table["strain"][-1]) for row in rows}
    best = max(
        rows, key=lambda row: (reached[row["name"]] > 20, int(row["grains"]), reached[row["name"]]), default=None
    )
    return best and boba.open(f"{out}/{best['name']}")


def early_run(plan, out, alpha):
    """A run at strain 3.2: of the published resolution where there is one, and smooth as the published grains are."""
    rows = [row for row in csv.DictReader(open(plan)) if row["scene"] == "shear" and row["alpha"] == alpha]
    for row in sorted(rows, key=lambda row: (-int(row["nodes"]), -int(row["grains"]), not row["surface"])):
        folder = pathlib.Path(out) / row["name"]
        if (folder / "trajectory.h5").exists() and boba.open(folder).table["strain"][-1] >= 3.2:
            return boba.open(folder)
    return last_run(plan, out, alpha)


def main(plan, out, path):
    figure, axes = plt.subplots(3, 5, figsize=(12, 7.5))
    with tempfile.TemporaryDirectory() as folder:
        picture = f"{folder}/picture.png"
        middle = "2" if last_run(plan, out, "2") else "0"
        for row, alpha in zip(axes, ("-0.8", middle, "12")):
            cylinder, run, early = (
                boba.open(f"{out}/cylinder_a{alpha}"),
                last_run(plan, out, alpha),
                early_run(plan, out, alpha),
            )
            at_early, last = early.frames.at_strain(3.2), run.frames[-1]
            draw = [
                (lambda: pictures.grains_picture(cylinder.frames[-1], picture, (1.0, 0.0, 0.25), 260), "squeezed"),
                (lambda: pictures.grains_picture(at_early, picture, width=420), f"strain {at_early.strain:.1f}"),
                (lambda: pictures.grains_picture(last, picture, width=420), f"strain {last.strain:.1f}"),
                (lambda: pictures.cross_section_picture(at_early, picture, width=420), "cross-section"),
                (lambda: pictures.hulls_picture(at_early, picture, (0,), 320), "hull"),
            ]
            for axis, (make, title) in zip(row, draw):
                make()
                pixels = plt.imread(picture)
                axis.imshow(pixels.swapaxes(0, 1)[::-1] if title == "squeezed" else pixels)
                axis.set_title(title, fontsize=8)
                axis.set_xticks([])
                axis.set_yticks([])
                axis.set_frame_on(False)
            row[0].set_ylabel(rf"$\nu$ = {POISSON[alpha]:g}")
    figure.tight_layout()
    figure.savefig(path, dpi=80)
    Image.open(path).convert("RGB").quantize(128).save(path, optimize=True)  # small enough for the repository


if __name__ == "__main__":
    main(*sys.argv[1:4])
