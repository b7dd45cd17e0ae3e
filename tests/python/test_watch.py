# SPDX-License-Identifier: GPL-3.0-or-later
"""`boba watch`: a page that follows the run, answers to this machine alone, and ends with the terminal."""
import http.client
import os
import signal
import subprocess
import urllib.parse

import pytest

from browser import Browser


@pytest.fixture
def watched(program, folder):
    """(process, port) of `boba watch` on the folder."""
    process = subprocess.Popen(
        [program, "watch", str(folder)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )  # fmt: skip
    line = process.stdout.readline()
    assert line.startswith("http://127.0.0.1:"), line + process.stderr.read()
    yield process, urllib.parse.urlsplit(line.split()[0]).port
    process.kill()
    process.wait()


def answer(port, path="/", method="GET", **headers):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    connection.putrequest(method, path, skip_host=True)
    for name, value in ({"Host": f"127.0.0.1:{port}"} | headers).items():
        connection.putheader(name.replace("_", "-"), value)
    connection.endheaders()
    response = connection.getresponse()
    body = response.read().decode()
    return response.status, body, response.headers


def test_only_its_own_pages_for_its_own_host(watched, folder):
    _, port = watched
    status, body, headers = answer(port)
    assert status == 200 and "made by a test" in body and headers["X-Frame-Options"] == "DENY"
    assert answer(port, Host=f"localhost:{port}")[0] == 200
    for host in ("example.org", f"example.org:{port}", "127.0.0.1", f"127.0.0.1:{port + 1}", ""):
        assert answer(port, Host=host)[0] == 403, host
    assert answer(port, Sec_Fetch_Site="cross-site")[0] == 403
    for path in ("/../table.csv", "/table.csv", "//etc/passwd", "/%2e%2e/scene.toml", "/rest?x", "/rest/..", "/data"):
        status, body, _ = answer(port, path)
        assert status == 404 and "mu" not in body, path
    for method in ("POST", "PUT", "DELETE"):
        assert answer(port, "/rest", method)[0] == 501
    mark = answer(port, "/rest")[2]["ETag"]
    assert answer(port, "/rest", If_None_Match=mark)[:2] == (304, "")
    before = {path: path.stat().st_mtime_ns for path in folder.rglob("*")}
    answer(port, "/packings")
    assert {path: path.stat().st_mtime_ns for path in folder.rglob("*")} == before  # it reads alone


def test_it_listens_on_the_loopback_address_alone(watched):
    process, port = watched
    listening = set()
    for line in open("/proc/net/tcp").readlines()[1:]:
        fields = line.split()
        if fields[3] == "0A" and fields[1].endswith(f":{port:04X}"):
            listening.add(fields[1].split(":")[0])
    assert listening == {"0100007F"}


@pytest.mark.parametrize("end", [signal.SIGINT, signal.SIGTERM])
def test_it_ends_with_the_terminal(watched, end):
    process, _ = watched  # the fixture returns at the first line, so the signal comes as early as a user's can
    process.send_signal(end)
    assert process.wait(30) == 0
    assert process.stderr.read() == ""


def test_bad_input(program, tmp_path):
    for arguments, words in (
        (["nothing"], "there is no such folder"),
        ([".", "--port", "99999"], "must be from 0 to 65535"),
    ):
        done = subprocess.run([program, "watch", *arguments], cwd=tmp_path, capture_output=True, text=True, check=False)
        assert done.returncode == 2 and words in done.stderr, done.stderr


def test_the_page_follows_the_run(watched, folder, tmp_path):
    _, port = watched
    browser = Browser(tmp_path)
    try:
        browser.open(f"http://127.0.0.1:{port}/")
        browser.wait("return Number(document.body.dataset.refreshed) >= 1")
        assert "No process writes here now" in browser.element("#live").text
        rows = len(made_run_rows(folder))
        with (folder / "table.csv").open("a") as file:
            file.write("211,2110.0,3,0.5,0.07,0.1,,1.0\n")
        browser.wait("return Report.data.tables[0].rows === arguments[0]".replace("arguments[0]", str(rows + 1)))
        browser.wait("return Report.panelsDrawn.get('mu').plot.data[1].includes(0.07)")
        with (folder / "run.log").open("a") as file:
            file.write("2026-12-01 05:00:00 info done at step 211; results in run\n")
        browser.wait("return document.querySelector('.chip.done') !== null")
        assert browser.console() == []
        os.kill(watched[0].pid, signal.SIGINT)
        watched[0].wait(30)
        browser.wait("return document.getElementById('live').textContent.includes('boba watch has stopped')")
    finally:
        browser.quit()


def made_run_rows(folder):
    return (folder / "table.csv").read_text().splitlines()[1:]


def test_a_run_in_progress_is_told_by_its_lock(folder):
    from boba.report import log

    assert not log.is_locked(folder / "run.lock")
    holder = subprocess.Popen(
        ["/usr/bin/python3", "-c", "import fcntl, sys; f = open(sys.argv[1], 'w'); fcntl.lockf(f, fcntl.LOCK_EX);"
         "print('held', flush=True); sys.stdin.read()", str(folder / "run.lock")],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
    )  # fmt: skip
    assert holder.stdout.readline() == "held\n"
    assert log.is_locked(folder / "run.lock")
    holder.communicate("")
    assert not log.is_locked(folder / "run.lock")
