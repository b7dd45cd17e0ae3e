# SPDX-License-Identifier: GPL-3.0-or-later
"""`boba plot`: panels of whatever was measured, and pictures of a frame."""
import argparse
import pathlib
import sys

from . import look, panels
from .run import open_run

SHEET_FORMATS = (".png", ".pdf", ".svg")


def parse(arguments):
    parser = argparse.ArgumentParser(prog="boba plot", description="Panels and pictures of one or several runs.")
    parser.add_argument("runs", nargs="+", help="output folders of runs; several are drawn together")
    parser.add_argument(
        "--output",
        help="folder of the pictures, or a PNG, PDF or SVG for the sheet of all panels alone "
        "(default: plots in the first run's folder, and the sheet as plot.png beside it)",
    )
    parser.add_argument(
        "--window",
        nargs=2,
        type=float,
        default=(1.0, 5.0),
        metavar=("FIRST", "LAST"),
        help="strain window of averages (default: 1 5)",
    )
    parser.add_argument("--labels", nargs="+", help="one for each run (default: names of the folders)")
    parser.add_argument("--format", choices=("png", "pdf", "svg"), default="png", help="of the figures (default: png)")
    parser.add_argument("--dpi", type=int, default=150, help="pixels per inch of PNG figures (default: 150)")
    parser.add_argument("--pictures", action="store_true", help="also draw the grains, a cross-section and hulls (VTK)")
    parser.add_argument("--frame", type=int, default=-1, help="frame of the pictures (default: the last)")
    parser.add_argument("--hulls", type=int, nargs="+", default=[0, 1, 2, 3], help="grains whose hulls are drawn")
    return parser.parse_args(arguments)


def draw_panels(runs, window, folder, sheet_path, dpi):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    chosen = panels.available(runs, window)
    if not chosen:
        return []
    columns = 2 if len(chosen) in (2, 4) else min(3, len(chosen))
    rows = -(-len(chosen) // columns)
    with plt.rc_context(look.style()):
        size = (4.6 * columns, 3.2 * rows)
        sheet, grid = plt.subplots(rows, columns, figsize=size, squeeze=False, layout="constrained")
        written = []
        for axes in grid.flat[len(chosen) :]:
            axes.axis("off")
        for (name, draw), axes in zip(chosen, grid.flat):
            draw(axes)
            if folder is None:
                continue
            single, own = plt.subplots(figsize=(4.6, 3.2), layout="constrained")
            draw(own)
            written.append(folder / f"{name}{sheet_path.suffix}")
            single.savefig(written[-1], dpi=dpi)
            plt.close(single)
        written.append(sheet_path)
        sheet.savefig(written[-1], dpi=dpi)
        plt.close(sheet)
    return written


def draw_pictures(runs, frame_number, hulls, folder):
    from . import pictures

    written = []
    for label, run in runs:
        frame = run.frames[frame_number]
        hulls = [h for h in hulls if h < len(frame.first_node) - 1]
        for name, draw in (("grains", pictures.grains_picture), ("cross_section", pictures.cross_section_picture)):
            written.append(folder / (f"{name}.png" if len(runs) == 1 else f"{name}_{label}.png"))
            draw(frame, written[-1])
        written.append(folder / ("hulls.png" if len(runs) == 1 else f"hulls_{label}.png"))
        pictures.hulls_picture(frame, written[-1], hulls)
    return written


def main(arguments=None):
    chosen = parse(arguments)
    if not 20 <= chosen.dpi <= 2400:
        print(f"boba plot: --dpi {chosen.dpi}: must be from 20 to 2400", file=sys.stderr)
        return 2
    labels = chosen.labels or [pathlib.Path(run).resolve().name for run in chosen.runs]
    if len(labels) != len(chosen.runs):
        print(f"boba plot: {len(labels)} labels for {len(chosen.runs)} runs", file=sys.stderr)
        return 2
    try:
        runs = [(label, open_run(folder)) for label, folder in zip(labels, chosen.runs)]
    except FileNotFoundError as error:
        print(f"boba plot: {error}", file=sys.stderr)
        return 2
    try:
        if chosen.pictures:
            check_frames(runs, chosen.frame)
        return draw(chosen, runs)
    except (OSError, ValueError, KeyError, IndexError) as error:
        text = error.args[0] if isinstance(error, KeyError) and error.args else error
        print(f"boba plot: {text}", file=sys.stderr)
        return 2


def check_frames(runs, number):
    """Pictures need a frame of every run: told before anything is drawn."""
    for _, run in runs:
        if not run.frames.path.exists():
            raise FileNotFoundError(
                f"{run.folder} holds no trajectory.h5, which --pictures draws from: a run stores "
                "frames when its scene has [output.trajectory]"
            )
        n = len(run.frames)
        if not -n <= number < n:
            raise IndexError(f"--frame {number}: {run.frames.path} holds {n} frames")


def draw(chosen, runs):
    output = pathlib.Path(chosen.output) if chosen.output else None
    if output and output.suffix in SHEET_FORMATS and not output.is_dir():
        folder, sheet = None, output
    elif output and output.suffix and not output.is_dir():
        raise ValueError(
            f"--output {output}: {output.suffix} is no format of a sheet; there are "
            f"{', '.join(SHEET_FORMATS)}, and folders"
        )
    else:
        folder = output or runs[0][1].folder / "plots"
        sheet = (folder if output else runs[0][1].folder) / f"plot.{chosen.format}"
        folder.mkdir(parents=True, exist_ok=True)
    written = draw_panels(runs, tuple(chosen.window), folder, sheet, chosen.dpi)
    if chosen.pictures:
        written += draw_pictures(runs, chosen.frame, chosen.hulls, folder or sheet.parent)
    if not written:
        print(
            "boba plot: nothing to draw: no table.csv that varies and no measures (see boba measure)", file=sys.stderr
        )
        return 1
    for path in written:
        print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
