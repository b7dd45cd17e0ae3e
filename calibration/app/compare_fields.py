# SPDX-License-Identifier: GPL-3.0-or-later
"""Fields of particles and continuum on the meridian. Usage: compare_fields.py DIR (as `compare --fields` leaves it)

Both sides are smoothed alike: the continuum is sampled at the nodes' undeformed places, and node values of both are averaged over
the meridian with a Gaussian of LENGTH. Stress of a node: its virial over the volume of a node of the bulk.
Writes fields.json (error norms) and fields_ALPHA.png."""
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

LENGTH = 1.0  # d, standard deviation of the Gaussian
DENSITY = 1.226  # nodes per d^3
NAMES = ("u_r", "u_z", "stress_rr", "stress_zz", "stress_hoop", "stress_rz")


def particles(file):
    """Meridian places (r, |z|) of the nodes and the six values, the lower half mirrored."""
    data = np.genfromtxt(file, delimiter=",", names=True)
    x, y, z = (data[name] - data[name].mean() for name in "xyz")
    r = np.hypot(x, y)
    c, s, side = x / r, y / r, np.sign(z)
    ux, uy = data["ux"] - data["ux"].mean(), data["uy"] - data["uy"].mean()
    stress = {name: data["w" + name] * DENSITY for name in ("xx", "yy", "zz", "yz", "xz", "xy")}
    values = np.array(
        [
            c * ux + s * uy,
            side * (data["uz"] - data["uz"].mean()),
            c * c * stress["xx"] + s * s * stress["yy"] + 2 * c * s * stress["xy"],
            stress["zz"],
            s * s * stress["xx"] + c * c * stress["yy"] - 2 * c * s * stress["xy"],
            side * (c * stress["xz"] + s * stress["yz"]),
        ]
    )
    return np.column_stack([r, np.abs(z)]), values


def continuum(file, places):
    """The continuum's values at the places; NaN outside the body."""
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(file))
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(np.column_stack([places, np.zeros(len(places))]), deep=True))
    cloud = vtk.vtkPolyData()
    cloud.SetPoints(points)
    probe = vtk.vtkProbeFilter()
    probe.SetInputData(cloud)
    probe.SetSourceConnection(reader.GetOutputPort())
    probe.Update()
    found = probe.GetOutput().GetPointData()
    inside = vtk_to_numpy(found.GetArray("vtkValidPointMask")).astype(bool)
    displacement = vtk_to_numpy(found.GetArray("displacement"))
    values = np.array(
        [displacement[:, 0], displacement[:, 1]] + [vtk_to_numpy(found.GetArray(n)) for n in NAMES[2:]], dtype=float
    )
    values[:, ~inside] = np.nan
    return values


def smoothed(places, values, grid):
    """Gaussian averages of node values at grid points; NaN where fewer than three nodes' weight is near."""
    out = np.full((len(values), len(grid)), np.nan)
    for g, point in enumerate(grid):
        weight = np.exp(-((places - point) ** 2).sum(axis=1) / (2 * LENGTH**2))
        total = weight.sum()
        if total > 3.0:
            out[:, g] = values @ weight / total
    return out


def picture(file, grid, ours, theirs):
    figure, axes = plt.subplots(2, 3, figsize=(11, 7), constrained_layout=True)
    for axis, name, left, right in zip(axes.flat, NAMES, ours, theirs):
        limit = np.nanpercentile(np.abs(right), 98)
        for side, field in ((-1, left), (1, right)):
            shown = axis.scatter(
                side * grid[:, 0], grid[:, 1], c=field, s=10, cmap="RdBu_r", vmin=-limit, vmax=limit, marker="s"
            )
        axis.set_title(f"{name}: particles | continuum", fontsize=9)
        axis.set_aspect("equal")
        axis.set_xlabel("r / d", fontsize=8)
        axis.set_ylabel("z / d", fontsize=8)
        figure.colorbar(shown, ax=axis, shrink=0.7)
    figure.savefig(file, dpi=70)


def main(folder):
    folder = pathlib.Path(folder)
    document = json.loads((folder / "comparison.json").read_text())
    sphere = document["problem"] == "sphere"
    norms = []
    for nodes in sorted(folder.glob("continuum/nodes_*.csv")):
        alpha = nodes.stem.removeprefix("nodes_")
        model = folder / "continuum" / (f"sphere_finite_layer_{alpha}" if sphere else f"cylinder_bonded_finite_{alpha}")
        files = sorted(model.glob("fields_*.vtu"))
        if not files:
            continue
        places, ours = particles(nodes)
        theirs = continuum(files[-1], places)
        inside = np.isfinite(theirs[0])
        places, ours, theirs = places[inside], ours[:, inside], theirs[:, inside]
        grid = np.array(
            [(r, z) for r in np.arange(0.25, places[:, 0].max(), 0.5) for z in np.arange(0.25, places[:, 1].max(), 0.5)]
        )
        grid = grid[[np.min(((places - point) ** 2).sum(axis=1)) < 0.5 for point in grid]]
        left, right = smoothed(places, ours, grid), smoothed(places, theirs, grid)
        weight = grid[:, 0]  # volume around the axis
        entry = {"alpha": float(alpha), "smoothing_length": LENGTH, "grid_points": len(grid)}
        for name, a, b in zip(NAMES, left, right):
            good = np.isfinite(a) & np.isfinite(b)
            scale = np.sqrt(np.average(b[good] ** 2, weights=weight[good]))
            entry[name] = {
                "rms_difference": float(np.sqrt(np.average((a[good] - b[good]) ** 2, weights=weight[good]))),
                "rms_continuum": float(scale),
            }
        norms.append(entry)
        picture(folder / f"fields_{alpha}.png", grid, left, right)
        print(
            f"fields, alpha = {alpha}: rms difference over rms of the continuum: "
            + ", ".join(f"{name} {entry[name]['rms_difference'] / entry[name]['rms_continuum']:.3f}" for name in NAMES)
        )
    (folder / "fields.json").write_text(
        json.dumps({"schema": "boba-comparison-fields", "version": 1, "alphas": norms}, indent=1)
    )


if __name__ == "__main__":
    main(sys.argv[1])
