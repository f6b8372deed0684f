"""The client verbs of `sluice`: short names for jobs, where the service is, waiting and asking.

Usage: client_names.py SLUICE [-v] [TEST...]
"""

import json
import os
import pty
import re
import select
import subprocess
import sys
import unittest

import client_program
from client_program import (DONE, ENDLESS, FAILING, JOB_FAILED, NOT_FOUND, UNREACHABLE, USAGE, WRONG_STATE, Case,
                            client, closed_port, environment)
from live import scene


class Names(Case):
    def test_an_id_may_be_cut_short_or_be_the_last(self):
        server = self.serve()
        at = ("--server", server.url)
        self.assertIn("no job yet", self.expect(NOT_FOUND, "show", "last", *at).stderr)
        jobs = [server.submit(scene(0.02)) for _ in range(8)]
        for job in jobs:
            server.wait_for(job, "completed")
        # As much of an id as no other one begins with.
        short = next(jobs[3][:n] for n in range(1, 21) if sum(job.startswith(jobs[3][:n]) for job in jobs) == 1)
        for verb in (["show"], ["watch"], ["sensors"], ["report"], ["resume", "--end-time", "0.03"]):
            with self.subTest(verb=verb):
                self.expect(DONE, verb[0], short, *verb[1:], *at)
        server.wait_for(jobs[3], "completed")
        self.assertTrue(self.expect(DONE, "show", "last", *at).stdout.startswith(jobs[-1]))
        self.assertEqual(self.expect(DONE, "delete", "last", short, *at).stdout,
                         f"{jobs[-1]} deleted\n{jobs[3]} deleted\n")
        said = self.expect(USAGE, "delete", "j", *at).stderr
        self.assertEqual(re.findall("j[0-9a-v]{20}", said), sorted(set(jobs) - {jobs[-1], jobs[3]}, reverse=True)[:5])
        self.assertIn("...", said)
        self.assertIn("begins with jv", self.expect(NOT_FOUND, "cancel", "jv", *at).stderr)
        self.assertEqual(len(server.ask("GET", "/v1/jobs").json()["jobs"]), 6)

    def test_a_study_has_short_names_too(self):
        server = self.serve()
        plan = {"name": "two", "scene": scene(0.02), "vary": [{"key": "/end_time", "values": [0.02, 0.03]}]}
        path = self.write(plan, "study.json")
        said = self.expect(DONE, "study", path, "--server", server.url, "--watch").stdout
        study = said.split()[0]
        for word in (study, "last", study[:3]):
            self.assertIn("two", self.expect(DONE, "study", word, "--server", server.url).stdout)
        self.assertEqual(self.expect(DONE, "delete", study[:2], "--server", server.url).stdout, f"{study} deleted\n")

    def test_the_environment_names_the_service_for_every_verb_and_a_folder_goes_first(self):
        server = self.serve()
        job = server.submit(scene(0.05))
        server.wait_for(job, "completed")
        for verb in (["show"], ["sensors"], ["sensors", "P1"], ["report"]):
            self.expect(DONE, verb[0], job, *verb[1:], SLUICE_SERVER=server.url)
        folder = os.path.join(self.data, "jobs", job)
        nowhere = f"http://127.0.0.1:{closed_port()}"
        self.expect(DONE, "sensors", folder, SLUICE_SERVER=nowhere)
        self.expect(DONE, "report", folder, SLUICE_SERVER=nowhere)
        self.expect(UNREACHABLE, "sensors", job, SLUICE_SERVER=nowhere)
        self.expect(DONE, "sensors", job, "--server", server.url, SLUICE_SERVER=nowhere)


class Acts(Case):
    def test_the_process_of_a_job_is_named_while_it_runs(self):
        server = self.serve()
        job = server.submit(ENDLESS)
        server.wait_until("progress", lambda: server.ask("GET", f"/v1/jobs/{job}").json()["progress"])
        self.assertEqual(server.ask("GET", f"/v1/jobs/{job}").json()["pid"], server.workers()[0])
        self.assertIn(f"process    {server.workers()[0]}\n", self.expect(DONE, "show", job, "--server", server.url).stdout)
        self.expect(DONE, "pause", job, "--wait", "--server", server.url)
        self.assertIsNone(server.ask("GET", f"/v1/jobs/{job}").json()["pid"])
        self.assertEqual(os.path.getsize(os.path.join(self.data, "jobs", job, "lock")), 0)

    def test_checkpoint_and_pause_wait_for_what_they_ask(self):
        server = self.serve()
        at = ("--server", server.url)
        job = server.submit(ENDLESS)
        folder = os.path.join(self.data, "jobs", job)

        def newest():
            return max(name for name in os.listdir(folder) if name.startswith("checkpoint-"))

        server.wait_until("progress", lambda: server.ask("GET", f"/v1/jobs/{job}").json()["progress"])
        before = newest()
        self.assertIn("running", self.expect(DONE, "checkpoint", job, "--wait", *at).stdout)
        self.assertGreater(newest(), before)
        self.assertEqual(self.expect(DONE, "pause", job, "--wait", *at).stdout, f"{job} paused\n")
        self.assertEqual(server.workers(), [])
        self.expect(WRONG_STATE, "checkpoint", job, "--wait", *at)

    def test_a_cancelled_job_goes_on_to_its_own_end(self):
        server = self.serve()
        at = ("--server", server.url)
        content = scene(1.5, spacing=0.01)
        whole = server.submit(content)
        server.wait_for(whole, "completed")
        digests = server.ask("GET", f"/v1/jobs/{whole}").json()["outcome"]["digests"]
        job = server.submit(content)
        server.wait_until("it to run", lambda: server.ask("GET", f"/v1/jobs/{job}").json()["pid"])
        self.expect(DONE, "cancel", job, *at)
        server.wait_for(job, "cancelled")
        self.assertIn("queued", self.expect(DONE, "resume", job, *at).stdout)
        server.wait_for(job, "completed")
        self.assertEqual(server.ask("GET", f"/v1/jobs/{job}").json()["outcome"]["digests"], digests)
        again = server.submit(ENDLESS)
        self.expect(DONE, "cancel", again, *at)
        server.wait_for(again, "cancelled")
        self.assertIn("queued", self.expect(DONE, "resume", again, "--end-time", ENDLESS["end_time"], *at).stdout)
        self.expect(DONE, "cancel", again, *at)
        self.expect(WRONG_STATE, "resume", job, *at)

    def test_delete_asks_on_a_terminal_only(self):
        server = self.serve()
        jobs = [server.submit(scene(0.02)) for _ in range(4)]
        for job in jobs:
            server.wait_for(job, "completed")

        def typed(answer, job, *options, code=DONE, **streams):
            inner, outer = pty.openpty()
            process = subprocess.Popen([client_program.PROGRAM, "delete", job, "--server", server.url, *options],
                                       stdin=outer, stdout=outer, env=environment(), **{"stderr": outer, **streams})
            os.close(outer)
            said = b""
            while b"[y/N]" not in said and select.select([inner], [], [], 60)[0]:
                try:
                    said += os.read(inner, 4096)
                except OSError:
                    break  # it ended without asking
            if b"[y/N]" in said:
                os.write(inner, answer)
            self.assertEqual(process.wait(), code)
            os.close(inner)
            return said.decode()

        self.assertIn(f"delete {jobs[0]} (tiny, completed)", typed(b"n\n", jobs[0], code=USAGE))
        self.assertIn("[y/N]", typed(b"n\n", jobs[0], code=USAGE, stderr=subprocess.DEVNULL))
        typed(b"y\n", jobs[1])
        self.assertNotIn("[y/N]", typed(b"", jobs[2], "--yes"))
        self.expect(DONE, "delete", jobs[3], "--server", server.url)
        self.assertEqual([job["id"] for job in server.ask("GET", "/v1/jobs").json()["jobs"]], [jobs[0]])

    def test_states_have_colours_on_a_terminal_that_shows_them(self):
        server = self.serve()
        server.wait_for(server.submit(scene(0.02)), "completed")

        def listed(**variables):
            inner, outer = pty.openpty()
            process = subprocess.Popen([client_program.PROGRAM, "list", "--server", server.url], stdin=subprocess.DEVNULL,
                                       stdout=outer, env={**environment(), **variables})
            self.assertEqual(process.wait(), DONE)
            os.close(outer)
            said = os.read(inner, 4096).decode()
            os.close(inner)
            return said

        self.assertIn("\x1b[32mcompleted\x1b[0m", listed(TERM="xterm"))
        self.assertNotIn("\x1b", listed(TERM="xterm", NO_COLOR="1"))
        self.assertNotIn("\x1b", listed(TERM="dumb"))
        self.assertNotIn("\x1b", self.expect(DONE, "list", "--server", server.url).stdout)

    def test_each_job_is_taken_once_and_last_is_what_it_was_at_the_beginning(self):
        server = self.serve()
        at = ("--server", server.url)
        jobs = [server.submit(scene(0.02)) for _ in range(3)]
        for job in jobs:
            server.wait_for(job, "completed")
        self.assertEqual(self.expect(DONE, "delete", "last", jobs[2], "last", *at).stdout, f"{jobs[2]} deleted\n")
        said = client("delete", "last", "x", jobs[0], *at)
        self.assertEqual((said.returncode, said.stdout), (NOT_FOUND, f"{jobs[1]} deleted\n{jobs[0]} deleted\n"))

    def test_a_list_shows_the_newest_so_many(self):
        server = self.serve()
        jobs = [server.submit(scene(0.02)) for _ in range(4)]
        listed = self.expect(DONE, "list", "--limit", "2", "--server", server.url).stdout.splitlines()[1:]
        self.assertEqual([line.split()[0] for line in listed], [jobs[3], jobs[2]])
        self.assertIn("newest first", self.expect(DONE, "list", "--help").stdout)

    def test_advice_is_told_once_and_a_table_has_none(self):
        server = self.serve()
        job = server.submit(FAILING)
        said = self.expect(JOB_FAILED, "watch", job, "--server", server.url).stdout
        advice = server.ask("GET", f"/v1/jobs/{job}").json()["outcome"]["diagnosis"]["suggestion"]
        self.assertEqual(said.count(advice), 1)
        line = self.expect(DONE, "list", "--server", server.url).stdout.splitlines()[1]
        self.assertNotIn(advice, line)
        self.assertIn("at step", line)

    def test_a_problem_is_told_once(self):
        server = self.serve()
        job = server.submit(scene(0.05))
        server.wait_for(job, "completed")
        said = client("resume", job, "--end-time", "0.01", "--server", server.url).stderr
        self.assertEqual(said.count("must be later"), 1)
        self.assertEqual(said.count("\n"), 1)


if __name__ == "__main__":
    client_program.PROGRAM = sys.argv.pop(1)
    unittest.main()
