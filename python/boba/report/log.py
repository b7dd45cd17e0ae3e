# SPDX-License-Identifier: GPL-3.0-or-later
"""What run.log says: how the run ended, what was held, what was warned of, and who computed it."""
from __future__ import annotations

import dataclasses
import datetime
import fcntl
import os
import pathlib
import re
import struct

_LINE = re.compile(r"^(\d{4}-\d\d-\d\d \d\d:\d\d:\d\d) (\w+) (.*)$")


@dataclasses.dataclass(frozen=True)
class LogLine:
    """One line of run.log."""

    when: datetime.datetime | None
    level: str
    text: str


@dataclasses.dataclass(frozen=True)
class Ending:
    """How a run stands: `state` is one of done, running, stopped, failed, cut off, unknown; `text` says it in words."""

    state: str
    text: str


def read_log(path: pathlib.Path) -> list[LogLine]:
    """The lines of a log; [] where there is none."""
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except FileNotFoundError:
        return []
    lines = []
    for line in text.splitlines():
        found = _LINE.match(line)
        if found:
            when = datetime.datetime.strptime(found.group(1), "%Y-%m-%d %H:%M:%S")
            lines.append(LogLine(when, found.group(2), found.group(3)))
        elif line:
            lines.append(LogLine(None, "", line))
    return lines


def is_locked(path: pathlib.Path) -> bool:
    """A process holds the POSIX lock of a run's run.lock."""
    try:
        descriptor = os.open(path, os.O_RDONLY)
    except OSError:
        return False
    try:
        # struct flock of Linux on 64 bits: l_type, l_whence, l_start, l_len, l_pid.
        layout = "hhqqi4x"
        question = struct.pack(layout, fcntl.F_WRLCK, os.SEEK_SET, 0, 0, 0)
        answer = struct.unpack(layout, fcntl.fcntl(descriptor, fcntl.F_GETLK, question))
        return answer[0] != fcntl.F_UNLCK
    except OSError:
        return False
    finally:
        os.close(descriptor)


def ending_of(lines: list[LogLine], locked: bool) -> Ending:
    """How a run stands after these lines of its log."""
    if locked:
        return Ending("running", "In progress")
    for line in reversed(lines):
        if line.text.startswith("done at step"):
            return Ending("done", f"Done: {line.text}")
        if line.text.startswith("stopped by"):
            return Ending("stopped", f"Stopped: {line.text}")
        if line.level in ("error", "critical"):
            return Ending("failed", f"Failed: {line.text}")
    if lines:
        return Ending("cut off", "Cut off: the log has no last line; boba resume continues from the last checkpoint")
    return Ending("unknown", "There is no run.log: how the run ended is not known")


def checks_of(lines: list[LogLine]) -> list[dict[str, str]]:
    """What went well and what did not: dictionaries of `level` (good, warn, bad, info) and `text`."""
    checks = []
    for line in lines:
        text = line.text
        if line.level in ("error", "critical"):
            checks.append({"level": "bad", "text": text})
        elif "warning:" in text or line.level in ("warning", "warn") or "gap accepted" in text:
            checks.append({"level": "warn", "text": text})
        elif re.search(r"\bskipped\b|left out|are missing", text):
            checks.append({"level": "info", "text": text})
        elif ": pressure held:" in text:
            checks.append({"level": "good", "text": text})
    return checks


def facts_of(lines: list[LogLine]) -> dict[str, str]:
    """Program, machine and times, in words."""
    facts = {}
    programs = [line.text for line in lines if re.match(r"boba \S+ \(", line.text)]
    if programs:
        program, _, instructions = programs[-1].partition(", instruction set ")
        facts["Program"] = program
        facts["Instruction set"] = instructions
    for line in lines:
        size = re.search(r": (\d+ grains?, \d+ nodes?), (.*?), (double|mixed) precision, [^;]*; (.*)$", line.text)
        if size:
            facts["Size"] = size.group(1)
            facts["Computed on"] = size.group(2)
            facts["Precision"] = size.group(3)
    times = [line.when for line in lines if line.when]
    if times:
        facts["Started"] = times[0].isoformat(" ")
        facts["Last line of the log"] = times[-1].isoformat(" ")
    speeds = [line.text for line in lines if re.match(r"stage\.\d+ .* steps in ", line.text)]
    for text in speeds:
        name, _, rest = text.partition(":")
        found = re.search(r"(\d+ steps in .*)$", rest)
        if found:
            facts[f"Time of {name}"] = found.group(1)
    return facts
