# SPDX-License-Identifier: GPL-3.0-or-later
"""The program boba, which computes for this module: where it is, and what its exit codes mean."""
from __future__ import annotations

import os
import pathlib
import shutil

DONE, WRONG_INPUT, STOPPED = 0, 2, 75


class RunError(RuntimeError):
    """A run that failed: a blow-up, a full disk, a pressure that did not settle. Its last checkpoints stay."""


class InputError(ValueError):
    """Wrong input, in the program's own sentence: what, where, the value, what is allowed."""


def find_program(program: str | os.PathLike[str] | None = None) -> pathlib.Path:
    """The program boba: the one that is named, BOBA_PROGRAM's, the one beside this module, or the first on PATH.

    \\throws FileNotFoundError where there is none.
    """
    beside = pathlib.Path(__file__).resolve().parents[4] / "bin" / "boba"  # of PREFIX/share/boba/python/boba
    for candidate in (program, os.environ.get("BOBA_PROGRAM"), beside, shutil.which("boba")):
        if candidate and os.access(candidate, os.X_OK) and pathlib.Path(candidate).is_file():
            return pathlib.Path(candidate)
        if candidate == program and program is not None:
            break
    raise FileNotFoundError(
        f"{program or 'boba'}: there is no such program; it is looked for in BOBA_PROGRAM, beside the module and on PATH"
    )


def error_of(code: int, stderr: str) -> Exception:
    """The exception for an exit code, with the sentence that the program told."""
    lines = [line for line in stderr.splitlines() if line.startswith("boba: ") and not line.startswith("boba: warning")]
    sentence = lines[-1].removeprefix("boba: ") if lines else stderr.strip() or f"the program ended with {code}"
    return InputError(sentence) if code == WRONG_INPUT else RunError(sentence)
