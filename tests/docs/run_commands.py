# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the commands of Markdown pages as a reader would, in an empty folder, and fails when one of them fails.

    ```toml scene.toml     a fenced block whose first line names a file (after the language) is written to it
    ```sh run              is run by bash in the folder, all of it; the first command that fails ends it
    ```sh exit=75          must end with that exit code
    any other block        is for reading

Pages are taken one after the other in the same folder. Usage: run_commands.py --bin FOLDER [--keep FOLDER] PAGE ...
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

FENCE = re.compile(r"^```(\w+)[ ]+(\S+)$")


def blocks(page):
    """(line, language, what, text) of every block whose opening line has a second word."""
    inside, first, lines = None, 0, []
    for number, line in enumerate(page.read_text().splitlines(), 1):
        if inside is None:
            if found := FENCE.match(line):
                inside, first, lines = found.groups(), number, []
            elif line.startswith("```"):
                inside = ("", "")
        elif line.startswith("```"):
            if inside[0]:
                yield first, *inside, "\n".join(lines) + "\n"
            inside = None
        else:
            lines.append(line)


def run(page, folder, environment):
    """Number of blocks that were run; raises RuntimeError at the first that fails."""
    done = 0
    for line, language, what, text in blocks(page):
        if language != "sh":
            path = folder / what
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
            continue
        if what != "run" and not what.startswith("exit="):
            raise RuntimeError(f"{page}:{line}: a block of sh is marked run or exit=CODE, not {what}")
        wanted = int(what[5:]) if what.startswith("exit=") else 0
        begin = time.monotonic()
        result = subprocess.run(
            ["bash", "-euo", "pipefail", "-c", text],
            cwd=folder, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=900,
        )  # fmt: skip
        print(f"{page.name}:{line}: exit {result.returncode} after {time.monotonic() - begin:.1f} s", flush=True)
        if result.returncode != wanted:
            raise RuntimeError(f"{page}:{line}: exit {result.returncode}, not {wanted}, of\n{text}\n{result.stdout}")
        done += 1
    return done


def main():
    parser = argparse.ArgumentParser(description="Runs the commands of Markdown pages.")
    parser.add_argument("pages", nargs="+", type=pathlib.Path)
    parser.add_argument("--bin", required=True, type=pathlib.Path, help="folder of the programs")
    parser.add_argument("--keep", type=pathlib.Path, help="an empty folder to run in, instead of a temporary one")
    chosen = parser.parse_args()
    source = pathlib.Path(__file__).resolve().parents[2]
    environment = dict(
        os.environ, PATH=f"{chosen.bin.resolve()}:/usr/bin:{os.environ['PATH']}", BOBA_SOURCE=str(source)
    )
    environment.pop("DISPLAY", None)
    with tempfile.TemporaryDirectory(prefix="boba-docs-") as temporary:
        folder = chosen.keep or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        try:
            for page in chosen.pages:
                if run(page, folder, environment) == 0:
                    raise RuntimeError(f"{page}: has no block that is run")
        except (RuntimeError, subprocess.TimeoutExpired) as error:
            print(error, file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
