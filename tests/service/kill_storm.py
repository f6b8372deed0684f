"""Kills workers and the service at random under a load of small jobs: no job may be lost, none
completed twice, and every result must equal the undisturbed run's.

usage: kill_storm.py SLUICE [--kills N] [--jobs N] [--seed N]

Jobs are submitted while the storm goes on, each with an Idempotency-Key and again until the service
has answered: what was acknowledged must be there, and once only. Workers are
asked for a checkpoint first, mostly, and killed after it, so that runs go on from one, or during it.
"""

import argparse
import collections
import contextlib
import json
import os
import pathlib
import random
import shutil
import signal
import sqlite3
import sys
import tempfile
import time

from storm import HANG, KINDS, Service, digests_of, undisturbed, workers

SHARE_OF_THE_SERVICE = 0.2  # of all kills
JOBS_IN_FLIGHT = 6  # enough that there is always a worker to kill
LEAST_RESUMED = 0.2  # attempts per kill; below it the storm shows too little


class Storm:
    def __init__(self, arguments, folder):
        self.kills_wanted = arguments.kills
        self.jobs_wanted = arguments.jobs
        self.random = random.Random(arguments.seed)
        self.data = folder / "data"
        self.data.mkdir()
        self.service = Service(arguments.sluice, self.data, folder / "serve.log")
        self.kind_of = {}  # id -> kind of scene, of all jobs that were acknowledged
        self.killed = collections.Counter()
        self.end = time.monotonic() + HANG

    def submit_one(self):
        """Tries once; the same key until it is acknowledged."""
        number = len(self.kind_of)
        job = self.service.submit(number)
        if job:
            self.kind_of[job] = number % KINDS

    def kill_service(self):
        self.service.kill()
        self.killed["service"] += 1
        time.sleep(self.random.choice([0, 0, self.random.uniform(0, 0.5)]))
        self.service.start()

    def kill_worker(self):
        running = workers(self.data)
        if not running:
            return
        pid = self.random.choice(sorted(running))
        if self.random.random() < 0.75:
            self.service.request("POST", f"/v1/jobs/{running[pid]}/checkpoint")
            if self.random.random() < 0.67:
                self.wait_for_checkpoint(pid, self.data / "jobs" / running[pid])
        try:
            os.kill(pid, signal.SIGKILL)
            self.killed["worker"] += 1
        except ProcessLookupError:
            pass

    def wait_for_checkpoint(self, pid, folder):
        """Until the job has one, or its worker is gone: however slow the machine is."""
        while not list(folder.glob("checkpoint-*.h5")) and pid in workers(self.data):
            time.sleep(0.01)

    def pause(self):
        """Seconds to the next kill: mostly long enough that it meets runs on their way, now and
        then so short that it meets processes that have only begun."""
        return self.random.uniform(0.2, 1.5) if self.random.random() < 0.75 else 0.02

    def submit_some(self):
        unfinished = self.service.unfinished(self.kind_of)
        few = unfinished is not None and unfinished < JOBS_IN_FLIGHT
        if len(self.kind_of) < self.jobs_wanted or few:
            self.submit_one()
            self.submit_one()

    def rage(self):
        self.service.start()
        while self.killed.total() < self.kills_wanted:
            if time.monotonic() > self.end:
                raise RuntimeError(f"only {dict(self.killed)} of {self.kills_wanted} kills in time")
            self.submit_some()
            time.sleep(self.pause())
            if self.random.random() < SHARE_OF_THE_SERVICE:
                self.kill_service()
            else:
                self.kill_worker()
        while len(self.kind_of) < self.jobs_wanted:
            self.submit_one()

    def calm(self):
        while self.service.unfinished(self.kind_of) != 0:
            if time.monotonic() > self.end:
                raise RuntimeError(f"{self.service.unfinished(self.kind_of)} jobs have not ended in time")
            time.sleep(0.2)
        return self.service.stop()

    def rows(self, sql, values=()):
        path = f"file:{self.data / 'jobs.sqlite'}?mode=ro"
        with contextlib.closing(sqlite3.connect(path, uri=True)) as base:
            return base.execute(sql, values).fetchall()

    def problems_of(self, job, digests, state):
        history = self.rows("SELECT name, detail FROM events WHERE job = ? ORDER BY number", (job,))
        names = [name for name, _ in history]
        if state != "completed":
            yield f"job {job} is {state}: {names}"
            return
        if names.count("completed") != 1 or names[-1] != "completed":
            yield f"job {job} was completed {names.count('completed')} times: {names}"
        steps = [json.loads(detail)["step"] for name, detail in history if name == "resumed"]
        if steps != sorted(steps):
            yield f"job {job} fell back behind a checkpoint that it had: {steps}"
        if digests_of(self.data / "jobs" / job / "outcome.json") != digests:
            yield f"job {job}: other digests than the undisturbed run's"

    def problems(self, digests):
        states = dict(self.rows("SELECT id, state FROM jobs"))
        for job in set(states) - set(self.kind_of):
            if states[job] != "paused":
                yield f"job {job} was not acknowledged and is {states[job]}"
        for job, kind in self.kind_of.items():
            yield from self.problems_of(job, digests[kind], states.get(job, "lost"))
        left = workers(self.data)
        if left:
            yield f"workers outlived the service: {left}"
        _, resumed = self.attempts()
        if resumed < LEAST_RESUMED * self.killed.total():
            yield f"only {resumed} attempts went on from a checkpoint after {self.killed.total()} kills"

    def attempts(self):
        """How many there were, and how many of them went on from a checkpoint."""
        (attempts,), = self.rows("SELECT sum(attempts) FROM jobs")
        (resumed,), = self.rows("SELECT count(*) FROM events WHERE name = 'resumed'")
        return attempts, resumed

    def summary(self):
        attempts, resumed = self.attempts()
        (often,), = self.rows("SELECT max(n) FROM "
                              "(SELECT count(*) AS n FROM events WHERE name = 'resumed' GROUP BY job)")
        return (f"{self.killed['worker']} kills of workers, {self.killed['service']} of the service, "
                f"{len(self.kind_of)} jobs, {attempts} attempts, {resumed} of them from a checkpoint "
                f"(up to {often} in one job)")


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
        digests = undisturbed(arguments.sluice, folder)
        begun = time.monotonic()
        storm.rage()
        status = storm.calm()
        problems = list(storm.problems(digests))
        if status != 0:
            problems.append(f"the service ended with status {status}")
    finally:
        storm.service.kill()
        storm.service.log.close()
    for problem in problems:
        print(problem)
    print(f"{storm.summary()}, {time.monotonic() - begun:.0f} s: {len(problems)} problems")
    if problems:
        print((folder / "serve.log").read_text(errors="replace")[-4000:])
        return 1
    shutil.rmtree(folder, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
