# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene that a run kept: scene.toml with what --set changed."""
from __future__ import annotations

import dataclasses
import pathlib
import tomllib
from typing import Any

_SET = "# --set "


@dataclasses.dataclass(frozen=True)
class Stage:
    """One stage of a scene.

    index: from 0, as in the scene and in the column `stage` of table.csv; kind: its type; name: its own, or "".
    """

    index: int
    kind: str
    name: str

    @property
    def label(self) -> str:
        """What the log calls it."""
        return f"stage.{self.index} {self.kind}" + (f' "{self.name}"' if self.name else "")


def _value_of(text: str) -> Any:
    """The value of an assignment: TOML, else a text."""
    try:
        return tomllib.loads(f"value = {text}\n")["value"]
    except tomllib.TOMLDecodeError:
        return text


def _entry(items: list[Any], part: str) -> Any:
    """The entry of a list that a part of a path names: a number, a type or a name."""
    if part.isdigit():
        return items[int(part)]
    return next(item for item in items if part in (item.get("type"), item.get("name")))


def apply_override(tree: dict[str, Any], assignment: str) -> None:
    """Replaces a value as --set does: "section.key=value", "stage.0.key=value".

    \\throws ValueError, LookupError where the assignment names no place of the tree.
    """
    place, equals, text = assignment.partition("=")
    if not equals:
        raise ValueError(f"{assignment}: not an assignment")
    *path, key = place.strip().split(".")
    node: Any = tree
    for part in path:
        node = _entry(node, part) if isinstance(node, list) else node.setdefault(part, {})
    if isinstance(node, list):
        node[int(key)] = _value_of(text)
    else:
        node[key] = _value_of(text)


@dataclasses.dataclass(frozen=True)
class SceneText:
    """A scene as a run kept it: its text, its tree of values, and what --set changed in it."""

    text: str
    values: dict[str, Any]
    overrides: list[str]

    @property
    def title(self) -> str:
        """The scene's title, or ""."""
        title = self.values.get("title", "")
        return title if isinstance(title, str) else ""

    @property
    def stages(self) -> list[Stage]:
        """The stages, in their order."""
        listed = self.values.get("stage", [])
        entries = [entry for entry in listed if isinstance(entry, dict)] if isinstance(listed, list) else []
        return [Stage(k, str(entry.get("type", "")), str(entry.get("name", ""))) for k, entry in enumerate(entries)]


def read_scene(path: pathlib.Path) -> SceneText:
    """Reads the scene.toml of a run's folder. \\throws FileNotFoundError; ValueError where it is no TOML."""
    text = path.read_text(encoding="utf-8", errors="replace")
    try:
        values = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"{path}: no TOML: {error}") from None
    overrides = []
    for line in reversed(text.splitlines()):
        if not line.startswith(_SET):
            break
        overrides.insert(0, line.removeprefix(_SET))
    for assignment in overrides:
        try:
            apply_override(values, assignment)
        except (LookupError, ValueError, StopIteration, AttributeError, TypeError):
            continue  # kept in `overrides`, where a reader sees it
    return SceneText(text, values, overrides)
