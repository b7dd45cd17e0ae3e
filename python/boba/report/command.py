# SPDX-License-Identifier: GPL-3.0-or-later
"""`boba report`: runs as one HTML file."""
from __future__ import annotations

import argparse
import os
import pathlib
import sys
from collections.abc import Sequence

from .gather import report_data
from .page import page_of


def parse(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="boba report",
        description="Writes one HTML file that shows runs: curves, means, distributions and the packing in 3-D. It needs "
        "no network and no program but a browser.",
    )
    parser.add_argument(
        "folders",
        nargs="+",
        metavar="RUN",
        help="output folder of a run, a folder of runs, or an output of boba compare, calibrate or continuum",
    )
    parser.add_argument("--output", default="report.html", help="file to write (default: report.html)")
    parser.add_argument("--no-packing", action="store_true", help="leave the packing out: a smaller file, sooner there")
    parser.add_argument(
        "--force", action="store_true", help="replace a file of that name that boba report did not write"
    )
    return parser.parse_args(arguments)


_MARK = "<script id=data type=application/json>"


def check_output(path: pathlib.Path, force: bool) -> None:
    """\\throws ValueError where the file cannot be the report, or is not one of ours."""
    if path.is_dir():
        raise ValueError(f"--output {path}: is a folder; a file is wanted, such as {path / 'report.html'}")
    if path.suffix.lower() not in (".html", ".htm"):
        raise ValueError(f"--output {path}: must end with .html")
    if not path.parent.is_dir():
        raise ValueError(f"--output {path}: there is no folder {path.parent}")
    if path.exists() and not force and _MARK not in path.read_text(encoding="utf-8", errors="replace"):
        raise ValueError(f"--output {path}: exists and is no report; --force replaces it")


def write(path: pathlib.Path, text: str) -> None:
    """Writes the file in one go: a reader sees the old one or the new one."""
    beside = path.with_name(path.name + ".part")
    try:
        beside.write_text(text, encoding="utf-8")
        os.replace(beside, path)
    except OSError:
        beside.unlink(missing_ok=True)
        raise


def main(arguments: Sequence[str] | None = None) -> int:
    chosen = parse(arguments)
    output = pathlib.Path(chosen.output)
    try:
        check_output(output, chosen.force)
        data = report_data([pathlib.Path(folder) for folder in chosen.folders], not chosen.no_packing)
    except (OSError, ValueError) as error:
        print(f"boba report: {error}", file=sys.stderr)
        return 2
    text = page_of(data)
    try:
        write(output, text)
    except OSError as error:
        print(f"boba report: {output}: cannot be written: {error.strerror}", file=sys.stderr)
        return 1
    shown = len(data["runs"])
    print(f"{output}: {shown} run{'s' if shown > 1 else ''}, {len(text) / 1e6:.1f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
