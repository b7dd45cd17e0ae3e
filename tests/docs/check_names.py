# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of files in the Markdown pages are real: every path of the source tree that a page names exists, every link
that leads into the tree has a target, and no line of prose is longer than 120 columns.

Usage: check_names.py SOURCE_TREE [PAGE ...]; without pages all that lie at the top, in docs/ and in examples/.
"""
import pathlib
import re
import sys

# Folders of the tree; a word that begins with one of them and a slash names a file there.
FOLDERS = (
    "bpm", "continuum", "calibration", "python", "tests", "bench", "examples", "docs", "scripts", "cmake", "base",
)  # fmt: skip
# Words with a slash that are no files: an atom style of LAMMPS.
OTHER_WORDS = ("bpm/sphere",)
NAME = re.compile(r"(?<![\w./~-])((?:" + "|".join(FOLDERS) + r")/[\w./*{},-]+)")
LINK = re.compile(r"\]\(([^)\s]+)\)")


def expand(name):
    """`a/{b,c}.h` as a/b.h and a/c.h."""
    found = re.search(r"\{([^{}]*)\}", name)
    if not found:
        return [name]
    return [x for part in found[1].split(",") for x in expand(name[: found.start()] + part + name[found.end() :])]


def is_there(tree, name):
    """True when a file, a folder, a header without its ending, or a pattern of them exists."""
    if any(c in name for c in "*"):
        return any(tree.glob(name.rstrip("/")))
    return any((tree / (name.rstrip("/.") + ending)).exists() for ending in ("", ".h", ".cpp", ".py", ".md"))


def prose(text):
    """Lines outside fenced blocks, with their numbers."""
    fenced = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        elif not fenced:
            yield number, line


def faults(tree, page):
    text = page.read_text()
    here = page.relative_to(tree)
    for number, line in enumerate(text.splitlines(), 1):
        for name in NAME.findall(line):
            for one in expand(name.rstrip(".,")):
                if one not in OTHER_WORDS and not is_there(tree, one) and not is_there(page.parent, one):
                    yield f"{here}:{number}: {one}: there is no such file"
        for target in LINK.findall(line):
            target = target.split("#")[0]
            if target and "://" not in target and not target.startswith("mailto:"):
                if not (page.parent / target).exists():
                    yield f"{here}:{number}: the link {target} leads nowhere"
    for number, line in prose(text):
        if len(line) > 120 and not line.lstrip().startswith(("|", "![", "[")):
            yield f"{here}:{number}: {len(line)} columns, at most 120"


def main():
    tree = pathlib.Path(sys.argv[1]).resolve()
    pages = [pathlib.Path(page).resolve() for page in sys.argv[2:]] or [
        page for pattern in ("*.md", "docs/**/*.md", "examples/**/*.md") for page in sorted(tree.glob(pattern))
    ]
    if not pages:
        print(f"check_names: {tree} holds no pages", file=sys.stderr)
        return 2
    found = [fault for page in pages for fault in faults(tree, page)]
    for fault in found:
        print(fault, file=sys.stderr)
    print(f"check_names: {len(pages)} pages, {len(found)} faults")
    return 3 if found else 0


if __name__ == "__main__":
    sys.exit(main())
