# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs programs and keeps what they cost: a run that has finished is not repeated."""
import concurrent.futures
import dataclasses
import datetime
import json
import os
import pathlib
import shutil
import subprocess
import time


@dataclasses.dataclass(frozen=True)
class Run:
    """One call of a program: `{out}` in its arguments is the run's folder, `{NAME}` that of another run."""

    name: str
    arguments: tuple
    after: tuple = ()


class Runner:
    """Keeps runs under FOLDER/runs/NAME, each with record.json: arguments, exit code, processor and wall seconds."""

    def __init__(self, folder, programs, jobs):
        self.folder = pathlib.Path(folder).resolve()
        self.programs = programs
        self.jobs = jobs
        self.environment = {
            **os.environ,
            "BOBA_CACHE_DIR": str(self.folder / "cache"),
            "OMP_NUM_THREADS": "1",
            "OPENBLAS_NUM_THREADS": "1",
        }
        (self.folder / "cache").mkdir(parents=True, exist_ok=True)

    def place(self, name):
        """Folder of a run."""
        return self.folder / "runs" / name

    def record(self, name):
        """What is known of a finished run, or None."""
        path = self.place(name) / "record.json"
        return json.loads(path.read_text()) if path.exists() else None

    def all(self, runs):
        """Runs what has not finished yet, in order; a run waits for those it needs, which come before it."""
        started = {}
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            for run in runs:
                if not self.finished(run):
                    started[run.name] = pool.submit(
                        self.wait_and_run, run, [started[name] for name in run.after if name in started]
                    )
            for future in started.values():
                future.result()

    def wait_and_run(self, run, others):
        """One run after others; says what it cost."""
        concurrent.futures.wait(others)
        record = self.run(run)
        print(
            f"{run.name}: exit code {record['exit_code']}, {record['cpu_seconds']:.2f} s of processor, "
            f"{record['wall_seconds']:.1f} s",
            flush=True,
        )

    def finished(self, run):
        """Whether this run is there with these arguments."""
        record = self.record(run.name)
        return record is not None and record["arguments"] == list(run.arguments)

    def run(self, run):
        """Starts the program in an empty folder, waits for it, and writes the record last."""
        place = self.place(run.name)
        shutil.rmtree(place, ignore_errors=True)
        place.mkdir(parents=True)
        load, began, clock = (
            os.getloadavg()[0],
            datetime.datetime.now().astimezone().isoformat(timespec="seconds"),
            time.monotonic(),
        )
        with open(place / "stdout.txt", "w", encoding="utf-8") as text:
            process = subprocess.Popen(
                self.command(run), cwd=self.folder, env=self.environment, stdout=text, stderr=text
            )
            _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        record = {
            "name": run.name,
            "arguments": list(run.arguments),
            "exit_code": process.returncode,
            "cpu_seconds": usage.ru_utime + usage.ru_stime,
            "wall_seconds": time.monotonic() - clock,
            "began": began,
            "load": load,
        }
        (place / "record.json").write_text(json.dumps(record, indent=1) + "\n")
        return record

    def command(self, run):
        """The command line with programs and folders filled in."""
        places = {"out": self.place(run.name) / "result", "here": self.folder} | {
            name: self.place(name) / "result" for name in run.after
        }
        words = list(run.arguments)
        for name, place in places.items():
            words = [word.replace("{" + name + "}", str(place)) for word in words]
        return [str(self.programs[words[0]]), *words[1:]]
