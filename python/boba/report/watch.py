# SPDX-License-Identifier: GPL-3.0-or-later
"""`boba watch`: the report of a run in progress, served to this machine's browsers alone and drawn again as it goes."""
from __future__ import annotations

import argparse
import hashlib
import http.server
import pathlib
import signal
import socket
import sys
import threading
from collections.abc import Sequence
from typing import Any

from .gather import PackingCache, expand, report_data
from .page import json_text, page_of

LOOPBACK = "127.0.0.1"


def parse(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="boba watch",
        description="Shows a run in a browser while it goes on. The page is served on the loopback address alone, reads "
        "the run's folder and changes nothing. Ctrl-C ends it; the run goes on.",
    )
    parser.add_argument("folders", nargs="+", metavar="RUN", help="output folder of a run, or a folder of runs")
    parser.add_argument("--port", type=int, default=0, help="port of the loopback address (default: a free one)")
    chosen = parser.parse_args(arguments)
    if not 0 <= chosen.port <= 65535:
        parser.error(f"--port {chosen.port}: must be from 0 to 65535")
    return chosen


class Source:
    """The data of a page, gathered again when a file of a run has changed. Used by several threads."""

    def __init__(self, folders: list[pathlib.Path]) -> None:
        self._folders = folders
        self._lock = threading.Lock()
        self._cache = PackingCache()
        self._stamp: Any = None
        self._data: dict[str, Any] = {}

    def _stamp_now(self) -> Any:
        stamps = []
        for folder in expand(self._folders):
            for path in sorted([*folder.glob("*"), *folder.glob("measures/*.csv")]):
                try:
                    state = path.stat()
                except OSError:
                    continue  # removed meanwhile
                stamps.append((str(path), state.st_mtime_ns, state.st_size))
        return stamps

    def data(self) -> dict[str, Any]:
        """Data of gather.report_data. \\throws OSError, ValueError with a sentence, as that does."""
        with self._lock:
            stamp = self._stamp_now()
            if stamp != self._stamp:
                self._data = report_data(self._folders, cache=self._cache)
                self._stamp = stamp
            return self._data

    def part(self, name: str) -> str:
        """JSON of "packings", or of all else ("rest")."""
        data = self.data()
        return json_text(data["packings"] if name == "packings" else data | {"packings": []})


class Handler(http.server.BaseHTTPRequestHandler):
    """Three addresses, nothing else: the page, its data, its packings. Names no file, so no path leads anywhere."""

    server: Server
    protocol_version = "HTTP/1.1"
    server_version, sys_version = "boba", ""

    def do_HEAD(self) -> None:  # noqa: N802
        self.do_GET()

    def do_GET(self) -> None:  # noqa: N802
        """Answers, unless another host's name stands in the request: such a page has been led here."""
        port = self.server.server_address[1]
        if self.headers.get("Host") not in (f"{LOOPBACK}:{port}", f"localhost:{port}"):
            self._answer(403, "text/plain", "boba watch answers to this machine's own name alone\n")
            return
        if self.headers.get("Sec-Fetch-Site") in ("cross-site", "same-site"):
            self._answer(403, "text/plain", "boba watch answers to its own page alone\n")
            return
        try:
            if self.path == "/":
                self._answer(200, "text/html; charset=utf-8", page_of(self.server.source.data(), live=True))
            elif self.path in ("/rest", "/packings"):
                self._answer(200, "application/json", self.server.source.part(self.path[1:]))
            else:
                self._answer(404, "text/plain", "there is no such page\n")
        except (OSError, ValueError) as error:
            self._answer(500, "text/plain", f"{error}\n")

    def _answer(self, code: int, kind: str, text: str) -> None:
        body = text.encode("utf-8")
        mark = f'"{hashlib.sha256(body).hexdigest()[:32]}"'
        unchanged = code == 200 and self.headers.get("If-None-Match") == mark
        try:
            self.send_response(304 if unchanged else code)
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", "0" if unchanged else str(len(body)))
            self.send_header("ETag", mark)
            self.send_header("Cache-Control", "no-cache")
            self.send_header("X-Content-Type-Options", "nosniff")
            self.send_header("X-Frame-Options", "DENY")
            self.send_header("Cross-Origin-Resource-Policy", "same-origin")
            self.end_headers()
            if not unchanged and self.command != "HEAD":
                self.wfile.write(body)
        except (BrokenPipeError, ConnectionResetError):
            pass  # the browser has turned away

    def log_message(self, *_: Any) -> None:
        """Requests are not written down."""


class Server(http.server.ThreadingHTTPServer):
    """Serves one Source on the loopback address."""

    daemon_threads = True
    allow_reuse_address = True

    def __init__(self, source: Source, port: int) -> None:
        self.source = source
        super().__init__((LOOPBACK, port), Handler)

    @property
    def address(self) -> str:
        """What a browser opens."""
        return f"http://{LOOPBACK}:{self.server_address[1]}/"

    def handle_error(self, *_: Any) -> None:
        """A connection that breaks is no news."""
        if not isinstance(sys.exc_info()[1], (ConnectionError, socket.timeout)):
            super().handle_error(*_)


def main(arguments: Sequence[str] | None = None) -> int:
    chosen = parse(arguments)
    source = Source([pathlib.Path(folder) for folder in chosen.folders])
    try:
        source.data()
    except (OSError, ValueError) as error:
        print(f"boba watch: {error}", file=sys.stderr)
        return 2
    try:
        server = Server(source, chosen.port)
    except OSError as error:
        print(f"boba watch: --port {chosen.port}: {error.strerror}", file=sys.stderr)
        return 1
    ends = {signal.SIGINT, signal.SIGTERM}
    signal.pthread_sigmask(signal.SIG_BLOCK, ends)  # from the line below on, either ends the command in one way
    threading.Thread(target=server.serve_forever, daemon=True).start()
    print(f"{server.address} shows {', '.join(chosen.folders)}; Ctrl-C ends it", flush=True)
    signal.sigwait(ends)
    print()
    server.shutdown()
    server.server_close()
    return 0
