"""Cuts the power of the service's disk at random under load: an ext4 on a loop device is shut down
without writing anything more (EXT4_IOC_SHUTDOWN, the ioctl of xfstests), and mounted again. Nothing
that was told to a client may be lost: a job's 202 answer, an event, a checkpoint that an event
names, a completed state with its outcome and series.

usage: power_cut.py SLUICE [--cuts N] [--seed N]

Needs root and loop devices; says so and exits with 77, "skipped", where there are none. It runs in a
mount namespace of its own: another program that copies the machine's would keep the disk mounted,
and so shut down, beyond its unmounting.
"""

import argparse
import collections
import contextlib
import errno
import fcntl
import http.client
import json
import os
import pathlib
import random
import shutil
import sqlite3
import struct
import subprocess
import sys
import tempfile
import threading
import time

from storm import HANG, HOST, KINDS, Service, digests_of, kill_workers, undisturbed

EXT4_IOC_SHUTDOWN = 0x8004587D  # _IOR('X', 125, __u32)
NO_LOG_FLUSH = 2  # what the journal has in memory is lost too
IMAGE_BYTES = 256 << 20
JOBS_IN_FLIGHT = 4
SKIPPED = 77


class Disk:
    """An ext4 of its own whose power can be cut."""

    def __init__(self, folder):
        self.image = folder / "disk"
        self.mount_point = folder / "mounted"
        self.mount_point.mkdir()
        with open(self.image, "wb") as image:
            image.truncate(IMAGE_BYTES)
        self.call("mkfs.ext4", "-q", self.image)
        self.is_mounted = False

    @staticmethod
    def call(*command):
        subprocess.run([str(part) for part in command], check=True, capture_output=True, text=True,
                       env=Disk.environment())

    def mount(self):
        self.call("mount", "-o", "loop", self.image, self.mount_point)
        self.is_mounted = True

    def unmount(self):
        """Once nothing uses it any more; killed processes take a moment, and so does the kernel."""
        self.until(lambda: self.try_call("umount", self.mount_point), "stays in use")
        self.is_mounted = False
        self.until(self.is_released, "stays on its loop device")

    def until(self, condition, complaint):
        for _ in range(600):
            if condition():
                return
            time.sleep(0.05)
        raise RuntimeError(f"{self.mount_point} {complaint}")

    def try_call(self, *command):
        """False when something uses the file system."""
        try:
            self.call(*command)
        except subprocess.CalledProcessError as error:
            if "busy" not in error.stderr:
                raise
            return False
        return True

    def is_released(self):
        """Mounted again before that, it would be the same file system, still shut down."""
        found = subprocess.run(["losetup", "-j", str(self.image)], capture_output=True, text=True,
                               env=self.environment(), check=True)
        return not found.stdout

    @staticmethod
    def environment():
        return {**os.environ, "PATH": os.environ["PATH"] + ":/sbin:/usr/sbin"}

    def cut(self):
        folder = os.open(self.mount_point, os.O_RDONLY | os.O_DIRECTORY)
        try:
            fcntl.ioctl(folder, EXT4_IOC_SHUTDOWN, struct.pack("I", NO_LOG_FLUSH))
        finally:
            os.close(folder)

    def check(self):
        """Replays the journal by mounting, then has the file system checked."""
        self.mount()
        self.unmount()
        self.call("e2fsck", "-f", "-n", self.image)


def why_not(folder):
    """Why this machine cannot run the test; None when it can."""
    if os.geteuid() != 0:
        return "needs root"
    try:
        disk = Disk(folder)
        disk.mount()
    except (OSError, subprocess.CalledProcessError) as error:
        return f"no ext4 on a loop device: {getattr(error, 'stderr', '') or error}"
    reason = None
    try:
        disk.cut()
        (disk.mount_point / "file").write_text("")
        reason = "the file system takes writes after it was shut down"
    except OSError as error:
        if error.errno not in (errno.EIO, 117, 108):
            reason = f"no shutdown of file systems: {error}"
    disk.unmount()
    return reason


class Witness(threading.Thread):
    """Reads a job's events as any client does and remembers them, across deaths of the service."""

    def __init__(self, service, job):
        super().__init__(daemon=True)
        self.service = service
        self.job = job
        self.seen = {}  # number -> (name, detail)
        self.over = False

    def run(self):
        while not self.over:
            try:
                self.listen()
            except (OSError, ValueError, http.client.HTTPException):
                pass
            time.sleep(0.05)

    def listen(self):
        connection = http.client.HTTPConnection(HOST, self.service.port, timeout=20)
        try:
            connection.request("GET", f"/v1/jobs/{self.job}/events",
                               headers={"Last-Event-ID": str(max(self.seen, default=0))})
            answer = connection.getresponse()
            if answer.status == 204:
                self.over = True
            while answer.status == 200 and not self.over:
                line = answer.readline()
                if not line:
                    return
                if line.startswith(b"data: ") and b'"number"' in line:
                    event = json.loads(line[6:])
                    self.seen[event["number"]] = (event["name"], event["detail"])
                    self.over = event["name"] == "completed"
        finally:
            connection.close()


class Storm:
    def __init__(self, arguments, folder):
        self.program = arguments.sluice
        self.cuts_wanted = arguments.cuts
        self.random = random.Random(arguments.seed)
        self.disk = Disk(folder)
        self.data = self.disk.mount_point / "data"
        self.service = Service(self.program, self.data, folder / "serve.log",
                               "--disk-reserve", "1MB")
        self.witnesses = []  # of all jobs that were acknowledged, in order of submission
        self.told = collections.Counter()
        self.end = time.monotonic() + HANG

    def load_until(self, end):
        """Submits jobs so that some are always on their way, and asks for checkpoints."""
        while time.monotonic() < end:
            if sum(not witness.over for witness in self.witnesses) < JOBS_IN_FLIGHT:
                job = self.service.submit(len(self.witnesses))
                if job:
                    self.witnesses.append(Witness(self.service, job))
                    self.witnesses[-1].start()
            elif self.random.random() < 0.2:
                witness = self.random.choice(self.witnesses[-JOBS_IN_FLIGHT:])
                self.service.request("POST", f"/v1/jobs/{witness.job}/checkpoint")
            time.sleep(self.random.uniform(0, 0.1))

    def cut(self):
        """Loads the service, cuts the power in the midst of it, and ends what still runs."""
        self.disk.mount()
        self.service.start()
        seconds = self.random.uniform(0.8, 3.0)
        # The load outlives the disk: what is answered after the cut is a promise too.
        loader = threading.Thread(target=self.load_until, args=(time.monotonic() + seconds + 0.1,))
        loader.start()
        time.sleep(seconds)
        self.disk.cut()
        time.sleep(self.random.choice([0, 0.1]))
        self.service.kill()
        kill_workers(self.data)
        loader.join()
        self.disk.unmount()

    def rows(self, sql, values=()):
        with contextlib.closing(sqlite3.connect(self.data / "jobs.sqlite")) as base:
            return base.execute(sql, values).fetchall()

    def problems(self):
        """What was told and is not there; on a copy, so that the service finds what the cut left."""
        self.disk.check()
        self.disk.mount()
        copy = self.data.with_name("copy")
        shutil.copytree(self.data, copy)
        self.data, kept = copy, self.data
        try:
            states = dict(self.rows("SELECT id, state FROM jobs"))
            events = {number: rest for number, *rest in
                      self.rows("SELECT number, job, name FROM events")}
            for witness in self.witnesses:
                yield from self.problems_of(witness, states, events)
        except sqlite3.Error as error:
            yield f"jobs.sqlite is not what was committed: {error}"
        finally:
            self.data = kept
            shutil.rmtree(copy)
            self.disk.unmount()

    def problems_of(self, witness, states, events):
        job = witness.job
        if job not in states or not (self.data / "jobs" / job / "scene.json").is_file():
            yield f"job {job} was acknowledged and is lost"
            return
        for number, (name, detail) in list(witness.seen.items()):
            if events.get(number) != [job, name]:
                yield f"event {number}, {name} of {job}, is {events.get(number)}"
            if name == "completed":
                yield from self.problems_of_end(job, states[job])
        checkpoints = [detail["step"] for name, detail in witness.seen.values()
                       if name == "checkpoint"]
        if checkpoints and not self.has_checkpoint(job, max(checkpoints)):
            yield f"the checkpoint of {job} at step {max(checkpoints)} is lost"

    def problems_of_end(self, job, state):
        if state != "completed":
            yield f"job {job} was completed and is {state}"
        folder = self.data / "jobs" / job
        for name in ("outcome.json", "series.h5"):
            if not (folder / name).is_file():
                yield f"{name} of {job}, which was completed, is lost"
        if (folder / "series.h5").is_file() and not self.is_whole(folder / "series.h5"):
            yield f"series.h5 of {job} is damaged"

    def has_checkpoint(self, job, step):
        """A whole one of that step or a later one."""
        files = sorted((self.data / "jobs" / job).glob("checkpoint-*.h5"), reverse=True)
        return any(int(path.stem.split("-")[1]) >= step and self.is_whole(path) for path in files)

    def is_whole(self, path):
        return subprocess.run([self.program, "inspect", str(path)], capture_output=True).returncode == 0

    def rage(self):
        for cut in range(self.cuts_wanted):
            self.cut()
            for problem in self.problems():
                yield f"cut {cut + 1}: {problem}"

    def calm(self, digests):
        """Lets all jobs end and compares them with the undisturbed runs."""
        self.disk.mount()
        self.service.start()
        jobs = [witness.job for witness in self.witnesses]
        while self.service.unfinished(jobs) != 0:
            if time.monotonic() > self.end:
                raise RuntimeError(f"{self.service.unfinished(jobs)} jobs have not ended in time")
            time.sleep(0.2)
        for witness in self.witnesses:
            witness.join(HANG)
        status = self.service.stop()
        if status != 0:
            yield f"the service ended with status {status}"
        for number, witness in enumerate(self.witnesses):
            outcome = self.data / "jobs" / witness.job / "outcome.json"
            if digests_of(outcome) != digests[number % KINDS]:
                yield f"job {witness.job}: other digests than the undisturbed run's"
            self.told.update(name for name, _ in witness.seen.values())

    def close(self):
        for witness in self.witnesses:
            witness.over = True
        self.service.kill()
        self.service.log.close()
        kill_workers(self.data)
        if self.disk.is_mounted:
            self.disk.unmount()


def run(arguments, folder):
    storm = Storm(arguments, folder)
    begun = time.monotonic()
    try:
        digests = undisturbed(arguments.sluice, folder)
        problems = list(storm.rage())
        problems += storm.calm(digests)
    finally:
        storm.close()
    for problem in problems:
        print(problem)
    print(f"{arguments.cuts} cuts, {len(storm.witnesses)} jobs, told to clients: "
          f"{storm.told.total()} events, {storm.told['checkpoint']} of them checkpoints, "
          f"{storm.told['resumed']} resumed, {storm.told['completed']} completed, "
          f"{time.monotonic() - begun:.0f} s: {len(problems)} problems")
    if problems:
        print((folder / "serve.log").read_text(errors="replace")[-4000:])
    return 1 if problems else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sluice")
    parser.add_argument("--cuts", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--in-namespace", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if os.geteuid() == 0 and not arguments.in_namespace:
        os.execvp("unshare", ["unshare", "--mount", sys.executable, *sys.argv, "--in-namespace"])
    folder = pathlib.Path(tempfile.mkdtemp(prefix="sluice-cut-"))
    (folder / "probe").mkdir()
    reason = why_not(folder / "probe")
    if reason:
        print(f"skipped: {reason}")
        shutil.rmtree(folder, ignore_errors=True)
        return SKIPPED
    status = run(arguments, folder)
    if status == 0:
        shutil.rmtree(folder, ignore_errors=True)
    return status


if __name__ == "__main__":
    sys.exit(main())
