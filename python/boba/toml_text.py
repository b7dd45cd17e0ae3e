# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes built in Python, as TOML."""
from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

import numpy as np


def value_text(value: Any) -> str:
    """A value as TOML writes it on one line. \\throws TypeError for what a scene cannot hold."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        if not math.isfinite(value):
            raise TypeError(f"{value}: a scene holds finite numbers")
        text = repr(float(value))
        return text if any(mark in text for mark in ".e") else text + ".0"
    if isinstance(value, str):
        # JSON's strings are TOML's, but for DEL and characters beyond 16 bits, which stay as they are.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(value_text(item) for item in value) + "]"
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{value_text(str(k))} = {value_text(v)}" for k, v in value.items()) + "}"
    raise TypeError(f"{value!r}: a scene holds texts, numbers, true, false, lists and tables of them")


def scene_text(scene: Mapping[str, Any]) -> str:
    """A scene as TOML: lists of tables become [[template]], [[species]], [[stage]] ..., other tables [output] ..."""
    plain, tables = [], []
    for key, value in scene.items():
        if isinstance(value, Mapping):
            tables += [f"[{key}]", *(f"{name} = {value_text(item)}" for name, item in value.items())]
        elif isinstance(value, (list, tuple)) and value and all(isinstance(item, Mapping) for item in value):
            for entry in value:
                tables += [f"[[{key}]]", *(f"{name} = {value_text(item)}" for name, item in entry.items())]
        else:
            plain.append(f"{key} = {value_text(value)}")
    return "\n".join([*plain, *tables]) + "\n"
