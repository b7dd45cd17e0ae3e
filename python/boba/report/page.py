# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of a report: one HTML file with its style, its programs and its data inside, that fetches nothing."""
from __future__ import annotations

import base64
import hashlib
import html
import json
import pathlib
from typing import Any

HERE = pathlib.Path(__file__).resolve().parent
STYLES = ("vendor/uPlot.min.css", "page/style.css")
PROGRAMS = (
    "vendor/uPlot.iife.min.js",
    "vendor/three.min.js",
    "page/base.js",
    "page/colours.js",
    "page/curves.js",
    "page/overview.js",
    "page/geometry.js",
    "page/packing.js",
    "page/start.js",
)


def json_text(data: Any) -> str:
    """JSON that a script element may hold: nothing in it can end the element or begin a comment."""
    text = json.dumps(data, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _program(name: str) -> str:
    text = (HERE / name).read_text(encoding="utf-8")
    if "</script" in text.lower():
        raise AssertionError(f"{name}: holds the end of a script element")
    return text


def _policy(programs: list[str], live: bool) -> str:
    """What the page may do: its own programs, by their hashes, its own style, pictures that it made itself."""
    hashes = " ".join(
        f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'" for text in programs
    )
    connect = " connect-src 'self';" if live else ""
    return (
        f"default-src 'none'; script-src {hashes}; style-src 'unsafe-inline'; img-src data: blob:;{connect} "
        "base-uri 'none'; form-action 'none'"
    )


def page_title(data: dict[str, Any]) -> str:
    """Title of the page: a single run's own, else the names of the runs."""
    runs = data["runs"]
    if len(runs) == 1:
        return runs[0]["title"] or runs[0]["name"]
    return f"{len(runs)} runs: {', '.join(run['name'] for run in runs[:4])}{' ...' if len(runs) > 4 else ''}"


def page_of(data: dict[str, Any], live: bool = False) -> str:
    """The whole page for data of gather.report_data; `live` for `boba watch`, whose page fetches its data again."""
    programs = [_program(name) for name in PROGRAMS]
    styles = [(HERE / name).read_text(encoding="utf-8") for name in STYLES]
    body = (HERE / "page/page.html").read_text(encoding="utf-8")
    parts = [
        "<!doctype html>\n<html lang=en>\n<head>\n<meta charset=utf-8>\n",
        f'<meta http-equiv=Content-Security-Policy content="{html.escape(_policy(programs, live))}">\n',
        "<meta name=viewport content='width=device-width, initial-scale=1'>\n<meta name=color-scheme content='light dark'>\n",
        "<link rel=icon href='data:,'>\n",
        f"<title>{html.escape(page_title(data))} - Boba</title>\n",
        *(f"<style>\n{style}\n</style>\n" for style in styles),
        f"</head>\n<body{' data-live=yes' if live else ''}>\n",
        body,
        f"<script id=data type=application/json>{json_text(data)}</script>\n",
        *(f"<script>{program}</script>\n" for program in programs),
        "</body>\n</html>\n",
    ]
    return "".join(parts)
