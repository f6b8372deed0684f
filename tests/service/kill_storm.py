"""Kills workers and the service at random under a load of small jobs: no job may be lost, none
completed twice, and every result must equal the undisturbed run's.

usage: kill_storm.py SLUICE [--kills N] [--jobs N] [--seed N]

Jobs are submitted while the storm goes on, each with an Idempotency-Key and again until the service
has answered: what was acknowledged must be there, and once only.
"""

import argparse
import collections
import json
import os
import pathlib
import random
import shutil
import signal
import socket
import sqlite3
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request

HANG = 1800  # s: only so that a hang ends as a failure
KINDS = 4  # different scenes
SHARE_OF_THE_SERVICE = 0.2  # of all kills
HOST = "127.0.0.1"


def scene(kind):
    """A dam break of about 110 particles; one to three seconds of work, by kind."""
    return {
        "name": f"storm-{kind}",
        "tank": {"width": 1.61, "height": 0.6},
        "fluid": [{"shape": "rectangle", "corner": [0, 0], "size": [0.6, 0.3]}],
        "gravity": [0, -9.81],
        "resolution": {"spacing": 0.04},
        "numerics": {
            "integrator": "kick_drift_kick",
            "courant": 0.5,
            "density_diffusion": {"delta": 0.1},
            "artificial_viscosity": {"alpha": 0.02},
        },
        "sensors": [
            {"name": "P1", "kind": "pressure", "position": [1.61, 0.02], "interval": 0.01}],
        "end_time": 10.0 + 5.0 * kind,
    }


def digests_of(outcome_path):
    return json.loads(outcome_path.read_text())["digests"]


class Service:
    """`sluice serve` on a port that stays the same through its deaths."""

    def __init__(self, program, data):
        with socket.socket() as probe:
            probe.bind((HOST, 0))
            self.port = probe.getsockname()[1]
        self.command = [program, "serve", "--data", str(data), "--port", str(self.port),
                        "--crash-limit", "1000000"]
        self.log = open(data.parent / "serve.log", "ab")
        self.process = None

    def start(self):
        self.process = subprocess.Popen(self.command, stdout=self.log, stderr=self.log,
                                        stdin=subprocess.DEVNULL)

    def kill(self):
        self.process.kill()
        self.process.wait()

    def stop(self):
        """A clean stop: returns its exit status."""
        self.process.terminate()
        return self.process.wait(HANG)

    def request(self, method, path, body=None, headers=None):
        """The JSON answer; None when nobody answered."""
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(f"http://{HOST}:{self.port}{path}", data, headers or {},
                                         method=method)
        if data:
            request.add_header("Content-Type", "application/json")
        try:
            with urllib.request.urlopen(request, timeout=30) as answer:
                return json.load(answer)
        except urllib.error.HTTPError as error:
            if error.code == 503:
                return None
            raise RuntimeError(f"{method} {path}: {error.code} {error.read().decode()}") from error
        except (OSError, json.JSONDecodeError):
            return None


class Storm:
    def __init__(self, arguments, folder):
        self.program = arguments.sluice
        self.kills_wanted = arguments.kills
        self.jobs_wanted = arguments.jobs
        self.random = random.Random(arguments.seed)
        self.folder = folder
        self.data = folder / "data"
        self.data.mkdir()
        self.service = Service(self.program, self.data)
        self.kind_of = {}  # id -> kind of scene, of all jobs that were acknowledged
        self.killed = collections.Counter()
        self.end = time.monotonic() + HANG

    def undisturbed(self):
        """The digests of each kind of scene, run alone."""
        digests = []
        for kind in range(KINDS):
            path = self.folder / f"{kind}.json"
            path.write_text(json.dumps(scene(kind)))
            subprocess.run([self.program, "run", str(path), "--folder", str(self.folder / str(kind)),
                            "--threads", "1", "--progress", "none"],
                           check=True, capture_output=True, timeout=HANG)
            digests.append(digests_of(self.folder / str(kind) / "outcome.json"))
        return digests

    def submit_one(self):
        """Tries once; the same key until it is acknowledged."""
        number = len(self.kind_of)
        kind = number % KINDS
        answer = self.service.request("POST", "/v1/jobs", scene(kind),
                                      {"Idempotency-Key": f"storm-{number}"})
        if answer:
            self.kind_of[answer["id"]] = kind

    def workers(self):
        """Process ids of all workers of this data folder."""
        wanted = str(self.data / "jobs").encode()
        found = []
        for entry in pathlib.Path("/proc").iterdir():
            if not entry.name.isdigit():
                continue
            try:
                arguments = (entry / "cmdline").read_bytes().split(b"\0")
            except OSError:
                continue
            if len(arguments) > 2 and arguments[1] == b"run" and arguments[2].startswith(wanted):
                found.append(int(entry.name))
        return found

    def kill_something(self):
        if self.random.random() < SHARE_OF_THE_SERVICE:
            self.service.kill()
            self.killed["service"] += 1
            time.sleep(self.random.choice([0, 0, self.random.uniform(0, 0.5)]))
            self.service.start()
            return
        workers = self.workers()
        if not workers:
            return
        try:
            os.kill(self.random.choice(workers), signal.SIGKILL)
            self.killed["worker"] += 1
        except ProcessLookupError:
            pass

    def unfinished(self):
        """How many acknowledged jobs have not ended; None when nobody answers."""
        count = 0
        for state in ("queued", "running", "paused"):
            answer = self.service.request("GET", f"/v1/jobs?state={state}&limit=1000")
            if answer is None:
                return None
            count += len(answer["jobs"])
        return count

    def pause(self):
        """Seconds to the next kill: mostly long enough that it meets runs on their way, now and
        then so short that it meets processes that have only begun."""
        return self.random.uniform(0.2, 1.5) if self.random.random() < 0.75 else 0.02

    def rage(self):
        self.service.start()
        while self.killed.total() < self.kills_wanted:
            if time.monotonic() > self.end:
                raise RuntimeError(f"only {dict(self.killed)} of {self.kills_wanted} kills in time")
            if len(self.kind_of) < self.jobs_wanted or self.unfinished() == 0:
                self.submit_one()
                self.submit_one()
            time.sleep(self.pause())
            self.kill_something()
        while len(self.kind_of) < self.jobs_wanted:
            self.submit_one()

    def calm(self):
        while self.unfinished() != 0:
            if time.monotonic() > self.end:
                raise RuntimeError(f"{self.unfinished()} jobs have not ended in time")
            time.sleep(0.2)
        return self.service.stop()

    def rows(self, sql):
        with sqlite3.connect(f"file:{self.data / 'jobs.sqlite'}?mode=ro", uri=True) as base:
            return base.execute(sql).fetchall()

    def problems(self, undisturbed):
        states = dict(self.rows("SELECT id, state FROM jobs"))
        ends = dict(self.rows(
            "SELECT job, count(*) FROM events WHERE name = 'completed' GROUP BY job"))
        if set(states) != set(self.kind_of):
            yield (f"{len(self.kind_of)} jobs were acknowledged, {len(states)} are there: "
                   f"{set(states) ^ set(self.kind_of)}")
        for job, kind in self.kind_of.items():
            state = states.get(job, "lost")
            if state != "completed":
                reason = self.rows(f"SELECT reason FROM jobs WHERE id = '{job}'")
                yield f"job {job} is {state}: {reason}"
                continue
            if ends.get(job) != 1:
                yield f"job {job} was completed {ends.get(job)} times"
            outcome = self.data / "jobs" / job / "outcome.json"
            if digests_of(outcome) != undisturbed[kind]:
                yield f"job {job}: other digests than the undisturbed run's"
        left = self.workers()
        if left:
            yield f"workers outlived the service: {left}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sluice")
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--jobs", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    folder = pathlib.Path(tempfile.mkdtemp(prefix="sluice-storm-"))
    storm = Storm(arguments, folder)
    try:
        undisturbed = storm.undisturbed()
        begun = time.monotonic()
        storm.rage()
        status = storm.calm()
        problems = list(storm.problems(undisturbed))
        if status != 0:
            problems.append(f"the service ended with status {status}")
    finally:
        if storm.service.process and storm.service.process.poll() is None:
            storm.service.kill()
        storm.service.log.close()
    for problem in problems:
        print(problem)
    (attempts,), = storm.rows("SELECT sum(attempts) FROM jobs")
    (resumed,), = storm.rows("SELECT count(*) FROM events WHERE name = 'resumed'")
    print(f"{storm.killed['worker']} kills of workers, {storm.killed['service']} of the service, "
          f"{len(storm.kind_of)} jobs, {attempts} attempts, {resumed} of them from a checkpoint, "
          f"{time.monotonic() - begun:.0f} s: {len(problems)} problems")
    if problems:
        print((folder / "serve.log").read_text(errors="replace")[-4000:])
        return 1
    shutil.rmtree(folder, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
