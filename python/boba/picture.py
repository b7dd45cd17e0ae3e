# SPDX-License-Identifier: GPL-3.0-or-later
"""`boba picture`: the grains of one frame, coloured by anything that was measured."""
import argparse
import pathlib
import sys

import numpy as np

from . import look
from .pictures import cell_edges, cross_section_nodes, fit, grain_colours, hull_of
from .render import Picture, view_axes
from .run import open_run

FORMATS = (".png", ".pdf", ".svg")
# Tables that hold a value for each grain, in the order in which a column is looked for.
GRAIN_TABLES = ("grains", "grain_order", "grain_motion", "grain_stress")
# Columns whose values are names.
CLASSES = {
    "class": ("disordered", "fcc", "hcp", "bcc", "unknown"),
    "template": ("unknown", "fcc", "hcp", "bcc", "sc", "icosahedral"),
}
WORDS = {"P": "pressure", "volume": "volume", "asphericity": "asphericity"}


def parse(arguments):
    parser = argparse.ArgumentParser(prog="boba picture", description="The grains of one frame of a run.")
    parser.add_argument("run", help="output folder of a run that stored frames ([output.trajectory])")
    parser.add_argument("--output", help="PNG, PDF or SVG (default: picture.png in the run's folder)")
    parser.add_argument(
        "--colour",
        default="grain",
        metavar="BY",
        help="grain, species, pressure, volume, asphericity, class, template or any other column with a value "
        "for each grain in the tables of boba measure (default: grain)",
    )
    parser.add_argument("--range", nargs=2, type=float, metavar=("LOW", "HIGH"), help="of the colours (default: all)")
    parser.add_argument("--frame", type=int, default=-1, help="number of the frame (default: the last)")
    parser.add_argument("--strain", type=float, help="instead: the frame whose strain is nearest")
    parser.add_argument("--hulls", action="store_true", help="convex hulls instead of nodes")
    parser.add_argument("--grains", type=int, nargs="+", metavar="G", help="these grains alone, from 0")
    parser.add_argument(
        "--section", metavar="AXIS[=PLACE]", help="a slice normal to x, y or z at a fraction of the cell, as z=0.5"
    )
    parser.add_argument("--thickness", type=float, default=2.0, help="of the slice, d (default: 2)")
    parser.add_argument(
        "--view", type=float, nargs=3, default=(0.5, 0.35, 1.0), metavar=("X", "Y", "Z"), help="direction of the eye"
    )
    parser.add_argument("--no-cell", action="store_true", help="leave the edges of the cell out")
    parser.add_argument("--no-scale", action="store_true", help="leave the scale bar out")
    parser.add_argument("--width", type=int, default=1200, help="of the picture, pixels (default: 1200)")
    parser.add_argument("--dpi", type=int, default=200, help="pixels per inch (default: 200)")
    chosen = parser.parse_args(arguments)
    if not 100 <= chosen.width <= 20000:
        parser.error(f"--width {chosen.width}: must be from 100 to 20000")
    if not 20 <= chosen.dpi <= 2400:
        parser.error(f"--dpi {chosen.dpi}: must be from 20 to 2400")
    return chosen


def chosen_frame(run, chosen):
    if not run.frames.path.exists():
        raise FileNotFoundError(
            f"{run.folder} holds no trajectory.h5: a run stores frames when its scene has [output.trajectory]"
        )
    if chosen.strain is not None:
        return run.frames.at_strain(chosen.strain)
    n = len(run.frames)
    if not -n <= chosen.frame < n:
        raise IndexError(f"--frame {chosen.frame}: {run.frames.path} holds {n} frames")
    return run.frames[chosen.frame]


def column_of(run, frame, name):
    """A value for each grain and its column's name, from the first table of measures that has it."""
    for table in GRAIN_TABLES:
        if table not in run.measures:
            continue
        for column in run.measure(table):
            if name in (column, look.name_of(column)):
                return np.asarray(run.rows(table, frame.step)[column]), column
    raise KeyError(
        f"--colour {name}: no table of measures of {run.folder} has such a value for each grain; "
        "boba measure makes them"
    )


def pressures(run, frame):
    """-tr(grain_stress) / 3 over the grain's hull volume where it was measured, else over n / 1.226 d^3."""
    volume = np.diff(frame.first_node) / 1.226
    if "grains" in run.measures and frame.step in run.steps("grains"):
        volume = run.rows("grains", frame.step)["volume_d3"]
    return -frame.grain_stress[:, :3].sum(axis=1) / 3.0 / volume


class Colouring:
    """A colour for each grain (0 to 255), and what the legend needs: names with colours, or a range with a label."""

    def __init__(self, run, frame, chosen):
        n = len(frame.first_node) - 1
        self.entries, self.limits, self.label = [], None, ""
        if chosen.colour == "grain":
            self.of_grain = grain_colours(n)
        elif chosen.colour == "species":
            self._by_name(frame.species, run.species_names(int(frame.species.max()) + 1))
        elif chosen.colour == "pressure":
            self._by_value(pressures(run, frame), "P_k/d", chosen.range)
        else:
            values, column = column_of(run, frame, chosen.colour)
            if column in CLASSES:
                self._by_name(values.astype(int), CLASSES[column])
            else:
                self._by_value(values, column, chosen.range)

    def _by_name(self, numbers, names):
        import matplotlib.colors

        palette = [255 * np.array(matplotlib.colors.to_rgb(c)) for c in look.colours(len(names))]
        self.of_grain = np.array([palette[k] for k in numbers])
        self.entries = [(names[k], palette[k] / 255) for k in sorted(set(int(k) for k in numbers))]

    def _by_value(self, values, column, limits):
        import matplotlib

        known = values[np.isfinite(values)]
        if len(known) == 0:
            raise ValueError(f"--colour: {column} is not known for any grain of this frame")
        low, high = limits or (known.min(), known.max())
        if not high > low:
            low, high = low - 0.5 * abs(low or 1.0), low + 0.5 * abs(low or 1.0)
        share = np.clip((values - low) / (high - low), 0.0, 1.0)
        self.of_grain = 255 * matplotlib.colormaps["viridis"](np.nan_to_num(share))[:, :3]
        self.of_grain[~np.isfinite(values)] = 190
        self.limits = (low, high)
        name = look.name_of(column)
        self.label = look.quantity(column, WORDS.get(name, ""))


def section_of(text):
    """(axis number, fraction) of AXIS[=PLACE]."""
    axis, _, place = text.partition("=")
    try:
        at = float(place) if place else 0.5
    except ValueError:
        at = -1.0
    if axis not in ("x", "y", "z") or not 0.0 <= at <= 1.0:
        raise ValueError(f"--section {text}: write x, y or z and a fraction of the cell from 0 to 1, as z=0.5")
    return "xyz".index(axis), at


def draw(run, frame, chosen):
    """The raster (rows, columns, 3), and the picture that made it."""
    colouring = Colouring(run, frame, chosen)
    n = len(frame.first_node) - 1
    wanted = np.arange(n) if chosen.grains is None else np.array(chosen.grains)
    if len(wanted) and (wanted.min() < 0 or wanted.max() >= n):
        raise IndexError(f"--grains: there are grains 0 to {n - 1}")
    if chosen.section:
        axis, place = section_of(chosen.section)
        points, grain = cross_section_nodes(frame, chosen.thickness, axis, place)
        inside = np.isin(grain, wanted)
        points, grain = points[inside], grain[inside]
        if len(points) == 0:
            raise ValueError(f"--section {chosen.section}: there is no node in this slice")
        direction = np.eye(3)[axis]
        axes = view_axes(direction, (0.0, 0.0, 1.0) if axis < 2 else (0.0, 1.0, 0.0))
        hulls = []
    else:
        axes = view_axes(chosen.view, (0.0, 1.0, 0.0) if abs(chosen.view[0]) + abs(chosen.view[2]) > 0 else (0, 0, 1))
        grains = frame.placed_grains
        hulls = [(g, hull_of(grains[g])) for g in wanted] if chosen.hulls else []
        points = np.concatenate([grains[g] for g in wanted])
        grain = np.repeat(wanted, [len(grains[g]) for g in wanted])
    edges = [] if chosen.no_cell or not np.isfinite(frame.box).all() else cell_edges(frame)
    if chosen.section and edges:
        axis, place = section_of(chosen.section)
        edges = [edge for edge in cell_edges(frame, axis, place)]
    corners = np.array(edges).reshape(-1, 3) if edges else points[:1]
    centre, span = fit(axes, np.concatenate([points, corners]), 1.5)
    picture = Picture(axes, centre, span, chosen.width)
    for g, (vertices, triangles, _) in hulls:
        picture.triangles(vertices, triangles, np.tile(colouring.of_grain[g], (len(triangles), 1)), edge=0.75)
    if not hulls:
        picture.spheres(points, colouring.of_grain[grain])
    for a, b in edges:
        picture.segment(a, b, width=max(1.0, chosen.width / 600))
    return picture, colouring


def nice_length(span):
    """1, 2 or 5 times a power of ten, about a fifth of the width."""
    power = 10.0 ** np.floor(np.log10(span / 5.0))
    return max(f * power for f in (1.0, 2.0, 5.0) if f * power <= span / 5.0)


def save(path, picture, colouring, chosen):
    """The raster at its own resolution, with a scale bar below and the legend or colour bar beside it."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    pixels = picture.pixels() / 255.0
    rows, columns = pixels.shape[:2]
    beside = 0.28 if colouring.entries or colouring.limits else 0.0
    below = 0.0 if chosen.no_scale else 0.045
    width, height = columns / chosen.dpi * (1 + beside), rows / chosen.dpi + columns / chosen.dpi * below
    with plt.rc_context(look.style() | {"font.size": max(5.0, 9.0 * columns / chosen.dpi / 6.0)}):
        figure = plt.figure(figsize=(width, height), dpi=chosen.dpi)
        bottom = 1 - rows / chosen.dpi / height
        axes = figure.add_axes((0, bottom, 1 / (1 + beside), 1 - bottom))
        axes.imshow(pixels, interpolation="nearest", aspect="auto")
        axes.axis("off")
        if not chosen.no_scale:
            length = nice_length(columns / picture.scale * picture.oversampling)
            share = length * picture.scale / picture.oversampling / columns / (1 + beside)
            bar = figure.add_axes((0, 0, 1 / (1 + beside), bottom))
            bar.axis("off")
            bar.set_xlim(0, 1 / (1 + beside))
            bar.set_ylim(0, 1)
            bar.plot([0.02, 0.02 + share], [0.5, 0.5], "k", lw=2, solid_capstyle="butt")
            bar.text(0.03 + share, 0.5, f"${length:g}\\,d$", va="center")
        if colouring.limits:
            place = figure.add_axes((1.02 / (1 + beside), bottom + 0.15 * (1 - bottom), 0.025, 0.7 * (1 - bottom)))
            scale = matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(*colouring.limits), "viridis")
            figure.colorbar(scale, cax=place, label=colouring.label)
        elif colouring.entries:
            patches = [matplotlib.patches.Patch(color=colour, label=name) for name, colour in colouring.entries]
            figure.legend(handles=patches, loc="center left", bbox_to_anchor=(1.01 / (1 + beside), 0.5))
        figure.savefig(path, dpi=chosen.dpi)
        plt.close(figure)


def main(arguments=None):
    chosen = parse(arguments)
    try:
        run = open_run(chosen.run)
        path = pathlib.Path(chosen.output) if chosen.output else run.folder / "picture.png"
        if path.suffix not in FORMATS:
            raise ValueError(f"--output {path}: a picture ends with {', '.join(FORMATS)}")
        picture, colouring = draw(run, chosen_frame(run, chosen), chosen)
        path.parent.mkdir(parents=True, exist_ok=True)
        save(path, picture, colouring, chosen)
    except (OSError, ValueError, KeyError, IndexError) as error:
        text = error.args[0] if isinstance(error, KeyError) and error.args else error
        print(f"boba picture: {text}", file=sys.stderr)
        return 2
    print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
