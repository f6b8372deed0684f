"""Backup and restore of a data folder whose service and jobs run: the restored jobs end exactly as
the ones that were left alone.

Usage: backup_restore.py SLUICE ROOT [-v] [TEST...]
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM = ""
ROOT = ""
SKIPPED = 77
OPTIONS = ("--cores", "1", "--disk-reserve", "0")


def script(name, *arguments):
    result = subprocess.run([os.path.join(ROOT, "deploy", name), *arguments], text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=120,
                            check=False)
    return result.returncode, result.stdout


class Backup(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.data, self.copy, self.restored = (
            os.path.join(folder.name, name) for name in ("data", "a copy's", "restored"))

    def outcome(self, data, job):
        with open(os.path.join(data, "jobs", job, "outcome.json"), encoding="utf-8") as stream:
            return json.load(stream)

    def checkpoints(self, job):
        folder = os.path.join(self.data, "jobs", job)
        return [name for name in os.listdir(folder)
                if name.startswith("checkpoint-") and name.endswith(".h5")]

    def a_copy(self):
        """A copy with one small job and a study of one, that have ended."""
        with Server(PROGRAM, *OPTIONS, data=self.data) as server:
            job = server.submit(scene(0.05))
            server.wait_for(job, "completed")
            made = server.ask("POST", "/v1/studies", {"name": "kept", "scene": scene(0.05)}).json()
            self.study = made["id"]
            server.wait_for(made["runs"][0]["job"], "completed")
            code, said = script("backup.sh", self.data, self.copy)
            self.assertEqual(code, 0, said)
        return job

    def test_of_a_running_job_goes_on_exactly(self):
        with Server(PROGRAM, *OPTIONS, data=self.data) as server:
            ended = server.submit(scene(0.05), "?label=ended")
            server.wait_for(ended, "completed")
            # Seconds of work, so that it runs while it is copied.
            job = server.submit(scene(1.0, spacing=0.012))
            waiting = server.submit(scene(0.05), "?priority=-1")
            # The one that it begins with, and one with something in it.
            server.wait_until("its start", lambda: self.checkpoints(job))
            self.assertEqual(server.ask("POST", f"/v1/jobs/{job}/checkpoint").status, 202)
            server.wait_until("a checkpoint", lambda: len(self.checkpoints(job)) > 1)
            code, said = script("backup.sh", self.data, self.copy)
            self.assertEqual(code, 0, said)
            self.assertFalse(os.path.exists(os.path.join(self.copy, "jobs", job, "outcome.json")))
            for each in (job, waiting):
                server.wait_for(each, "completed")
        self.assertFalse([name for name in os.listdir(self.data) if name.startswith(".")])

        code, said = script("restore.sh", self.copy, self.restored)
        self.assertEqual(code, 0, said)
        with Server(PROGRAM, *OPTIONS, data=self.restored) as server:
            for each in (job, waiting):
                self.assertEqual(server.wait_for(each, "completed")["state"], "completed")
            again = server.ask("GET", f"/v1/jobs/{ended}").json()
            self.assertEqual((again["state"], again["label"], again["attempts"]),
                             ("completed", "ended", 1))
            log = server.ask("GET", f"/v1/jobs/{job}/log").body.decode()
            self.assertIn('"event":"resumed"', log)
        for each in (job, waiting, ended):
            mine, theirs = self.outcome(self.restored, each), self.outcome(self.data, each)
            self.assertTrue(mine["bit_exact"])
            self.assertEqual(mine["digests"], theirs["digests"])

    def test_that_was_damaged_is_not_restored(self):
        job = self.a_copy()
        path = os.path.join(self.copy, "jobs", job, "series.h5")
        with open(path, "r+b") as stream:
            stream.seek(100)
            byte = stream.read(1)
            stream.seek(100)
            stream.write(bytes([byte[0] ^ 1]))
        code, said = script("restore.sh", self.copy, self.restored)
        self.assertEqual(code, 1)
        self.assertIn("series.h5", said)
        self.assertFalse(os.path.exists(self.restored))

    def test_overwrites_nothing(self):
        self.a_copy()
        self.assertEqual(script("backup.sh", self.data, self.copy)[0], 2)
        before = sorted(os.listdir(self.data))
        self.assertEqual(script("restore.sh", self.copy, self.data)[0], 2)
        self.assertEqual(sorted(os.listdir(self.data)), before)
        self.assertEqual(script("backup.sh", self.copy + "/jobs", self.restored)[0], 2)
        self.assertFalse(os.path.exists(self.restored))

    def test_serves_without_its_rows(self):
        job = self.a_copy()
        self.assertEqual(script("restore.sh", self.copy, self.restored)[0], 0)
        os.remove(os.path.join(self.restored, "jobs.sqlite"))
        with Server(PROGRAM, *OPTIONS, "--rebuild", data=self.restored) as server:
            self.assertEqual(server.ask("GET", f"/v1/jobs/{job}").json()["state"], "completed")
            study = server.ask("GET", f"/v1/studies/{self.study}").json()
            self.assertEqual(study["runs"][0]["state"], "completed")


if __name__ == "__main__":
    PROGRAM, ROOT = os.path.abspath(sys.argv.pop(1)), sys.argv.pop(1)
    if not shutil.which("sqlite3"):
        print("skipped: there is no sqlite3 here")
        sys.exit(SKIPPED)
    sys.path.insert(0, os.path.join(ROOT, "tests", "service"))
    from live import Server, scene
    unittest.main()
