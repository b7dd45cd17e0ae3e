# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that a report tells, as plain data for its page."""
from __future__ import annotations

import datetime
import pathlib
from typing import Any

from .._version import __version__
from ..run import Run, open_run
from . import curves, studies
from .log import checks_of, ending_of, facts_of, is_locked, read_log
from .means import means_table, sweep_of
from .words import grains_in_words, stages_in_words

#: Runs whose packings a report shows; of more, these many first ones.
MOST_PACKINGS = 6
#: Bytes of the page that all packings together may take.
MOST_BYTES = 11_000_000
#: Bytes of a run's log that the page repeats, from its end.
MOST_LOG = 60_000
_FILES_OF_A_RUN = ("table.csv", "scene.toml", "run.log", "trajectory.h5")


class NotARun(ValueError):
    """A folder that holds nothing to report."""


def is_run(folder: pathlib.Path) -> bool:
    """The folder has a file that a run writes."""
    return any((folder / name).is_file() for name in _FILES_OF_A_RUN) and not (folder / "table.json").is_file()


def expand(folders: list[pathlib.Path]) -> list[pathlib.Path]:
    """The folders to report: a folder of runs stands for those in it.

    \\throws FileNotFoundError, NotADirectoryError, NotARun with one sentence.
    """
    found = []
    for folder in folders:
        if not folder.exists():
            raise FileNotFoundError(f"{folder}: there is no such folder")
        if not folder.is_dir():
            raise NotADirectoryError(f"{folder}: is a file; the output folder of a run is wanted")
        if studies.kind_of(folder) or is_run(folder):
            found.append(folder)
            continue
        below = sorted(path for path in folder.iterdir() if path.is_dir() and (is_run(path) or studies.kind_of(path)))
        if not below:
            raise NotARun(
                f"{folder}: holds no run: none of {', '.join(_FILES_OF_A_RUN)} is there, nor in a folder below it"
            )
        found += below
    return found


def labels_for(folders: list[pathlib.Path]) -> list[str]:
    """Names that tell the folders apart: their last parts, as many as are needed."""
    whole = [folder.resolve() for folder in folders]
    for n in range(1, 6):
        labels = ["/".join(path.parts[-n:]) for path in whole]
        if len(set(labels)) == len(set(whole)):
            break
    return [label if labels.count(label) == 1 else f"{label} ({k + 1})" for k, label in enumerate(labels)]


def _text_of(path: pathlib.Path, most: int) -> str:
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""
    return text if len(text) <= most else "[...]\n" + text[-most:]


def run_facts(label: str, run: Run) -> dict[str, Any]:
    """What was run, how it ended, what went well and what did not."""
    lines = read_log(run.folder / "run.log")
    ending = ending_of(lines, is_locked(run.folder / "run.lock"))
    checks = checks_of(lines)
    told: dict[str, Any] = {"title": "", "grains": [], "stages": [], "overrides": []}
    try:
        scene = run.scene
        told = {"title": scene.title, "grains": grains_in_words(scene), "stages": stages_in_words(scene)}
        told["overrides"] = scene.overrides
    except FileNotFoundError:
        checks.append({"level": "info", "text": "scene.toml is missing: what was run is not known"})
    except ValueError as error:
        checks.append({"level": "warn", "text": str(error)})
    checks += _readability(run)
    facts = facts_of(lines)
    return told | {
        "name": label,
        "folder": str(run.folder),
        "status": {"state": ending.state, "text": ending.text},
        "facts": [[key, value] for key, value in facts.items()],
        "checks": checks,
        "scene": _text_of(run.folder / "scene.toml", MOST_LOG),
        "log": _text_of(run.folder / "run.log", MOST_LOG),
    }


def _readability(run: Run) -> list[dict[str, str]]:
    """Tables that are missing or cannot be read."""
    checks = []
    for name in ["table.csv", *run.measures]:
        try:
            table = run.table if name == "table.csv" else run.measure(name)
            if table.n_rows == 0:
                checks.append({"level": "info", "text": f"{name}: has no rows"})
        except FileNotFoundError:
            checks.append({"level": "info", "text": "table.csv is missing: no curves of the run itself"})
        except (OSError, ValueError, UnicodeDecodeError) as error:
            checks.append({"level": "warn", "text": str(error)})
    if not run.measures:
        checks.append({"level": "info", "text": "nothing was measured: boba measure RUN gives shapes, order, contacts"})
    return checks


PackingCache = dict[Any, Any]  # what packing_of keeps between two calls


def _packing(
    k: int, run: Run, facts: dict[str, Any], bytes_allowed: float, cache: PackingCache
) -> dict[str, Any] | None:
    """The packing of run k, or None with a check that says why."""
    if not run.frames.path.exists():
        text = "no frames are stored: a packing is shown where the scene has [output.trajectory]"
        facts["checks"].append({"level": "info", "text": text})
        return None
    try:
        from .packing import molecules_of, packing_of

        packing = packing_of(run, molecules_of(run), bytes_allowed, cache.setdefault(k, {}))
    except ImportError as error:
        facts["checks"].append({"level": "warn", "text": f"the packing is left out: {error} (Debian: python3-scipy)"})
        return None
    except (OSError, ValueError, KeyError, IndexError) as error:
        facts["checks"].append({"level": "warn", "text": f"the packing is left out: {error}"})
        return None
    if packing is None:
        facts["checks"].append({"level": "info", "text": "trajectory.h5 holds no whole frame yet"})
        return None
    shown, stored = len(packing["frames"]), packing["stored_frames"]
    if shown < stored:
        facts["checks"].append(
            {"level": "info", "text": f"{shown} of {stored} frames are shown, to keep the file small"}
        )
    return packing | {"run": k}


def _usable(run: Run) -> Run:
    """The run, whose tables that cannot be read count as missing (run_facts tells of them)."""
    return _Forgiving(run.folder, run.measures_folder)


class _Forgiving(Run):
    """A run whose unreadable tables are missing."""

    def _read(self, path: pathlib.Path):  # type: ignore[no-untyped-def]
        try:
            return super()._read(path)
        except (ValueError, UnicodeDecodeError) as error:
            raise FileNotFoundError(str(error)) from None


def report_data(
    folders: list[pathlib.Path], with_packings: bool = True, cache: PackingCache | None = None
) -> dict[str, Any]:
    """The data of a report of runs, or of outputs of compare, calibrate and continuum.

    cache: kept by the caller who gathers the same runs again, so that frames are read once.
    \\throws FileNotFoundError, NotADirectoryError, ValueError with one sentence for folders that hold neither.
    """
    folders = expand(folders)
    labels = labels_for(folders)
    data: dict[str, Any] = {
        "version": __version__,
        "made": datetime.datetime.now().astimezone().isoformat(" ", "seconds"),
        "runs": [],
        "tables": [],
        "panels": [],
        "means": {"headings": [], "rows": []},
        "sweep": None,
        "packings": [],
    }
    kinds = [studies.kind_of(folder) for folder in folders]
    if any(kinds):
        if not all(kinds):
            which = folders[kinds.index(None)]
            raise NotARun(f"{which}: a run, beside an output of compare or calibrate: make a report for each")
        return data | _studies(folders, labels, kinds)
    runs = [(label, open_run(folder)) for label, folder in zip(labels, folders)]
    data["runs"] = [run_facts(label, run) for label, run in runs]
    usable = [(label, _usable(run)) for label, run in runs]
    data["tables"], panels = curves.clock_data(usable)
    loading = curves.loading_panels(usable)
    data["panels"] = panels + loading + curves.spectrum_panels(usable) + curves.distribution_panels(usable)
    data["means"] = means_table(usable)
    data["sweep"] = sweep_of(usable, data["means"])
    if with_packings:
        chosen = usable[:MOST_PACKINGS]
        stored = sum(run.frames.path.exists() for _, run in chosen)
        for k, (_, run) in enumerate(chosen):
            packing = _packing(k, run, data["runs"][k], MOST_BYTES / max(stored, 1), {} if cache is None else cache)
            if packing:
                data["packings"].append(packing)
        for facts in data["runs"][MOST_PACKINGS:]:
            text = f"the packing is left out: a report shows those of its first {MOST_PACKINGS} runs"
            facts["checks"].append({"level": "info", "text": text})
    return data


def _studies(folders: list[pathlib.Path], labels: list[str], kinds: list[str | None]) -> dict[str, Any]:
    found = [
        studies.study_of(k, label, folder, kind or "")
        for k, (folder, label, kind) in enumerate(zip(folders, labels, kinds))
    ]
    means = max((study["means"] for study in found), key=lambda table: len(table["rows"]))
    return {
        "runs": [study["facts"] for study in found],
        "panels": [panel for study in found for panel in study["panels"]],
        "means": means if len(found) == 1 else {"headings": [], "rows": []},
    }
