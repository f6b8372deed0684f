"""How runs and studies are stopped from outside: signals that come twice, terminals that close, nohup.

usage: stops.py SLUICE [unittest arguments]
"""

import json
import os
import pathlib
import pty
import re
import resource
import select
import signal
import subprocess
import sys
import time
import unittest

import run_binary
from run_binary import Sandbox, scene

ENDLESS = scene(end_time=5e3)


def ignore_hangup():
    signal.signal(signal.SIGHUP, signal.SIG_IGN)


class Stopped(Sandbox):
    def assert_checkpointed(self, folder):
        """It stopped where it was, and goes on from there."""
        outcome = self.outcome(folder)
        self.assertEqual(outcome["state"], "stopped")
        self.assertGreater(outcome["step"], 0)
        self.assertTrue((self.folder / folder / f"checkpoint-{outcome['step']:012}.h5").exists())

    def launch(self, *arguments, **options):
        process = subprocess.Popen([run_binary.SLUICE, *map(str, arguments)], cwd=self.folder, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, **options)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def wait_until(self, what, holds):
        for _ in range(2000):
            if holds():
                return
            time.sleep(0.01)
        self.fail(f"waited in vain for {what}")

    def is_running_in(self, folder):
        """Past its first step: the first checkpoint and the handlers are there."""
        return bool(list((self.folder / folder).glob("checkpoint-*.h5")))


    def terminal(self, *arguments):
        """A process alone on a terminal of its own; returns both."""
        process, end = pty.fork()
        if process == 0:
            os.chdir(self.folder)
            os.execv(run_binary.SLUICE, [run_binary.SLUICE, *map(str, arguments)])
        return process, end

    def code_of(self, process):
        return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])


class Runs(Stopped):
    def test_signals_that_come_together_are_one_wish(self):
        path = self.write_scene(ENDLESS)
        pairs = [(signal.SIGTERM, signal.SIGHUP), (signal.SIGHUP, signal.SIGTERM),
                 (signal.SIGINT, signal.SIGTERM), (signal.SIGTERM, signal.SIGTERM)]
        for pair in pairs:
            for gap in (0.0, 0.001, 0.004, 0.02):
                with self.subTest(pair=pair, gap=gap):
                    process = self.start("run", path, "--folder", "job", "--threads", 1)
                    self.wait_for(process, "checkpoint" if pair == pairs[0] and gap == 0.0 else "resumed")
                    time.sleep(0.05)
                    for number in pair:
                        process.send_signal(number)
                        time.sleep(gap)
                    process.stdout.read()
                    self.assertEqual(process.wait(), 85)
                    self.assert_checkpointed("job")

    def test_a_run_under_nohup_stays_when_the_terminal_goes_and_stops_when_asked(self):
        process = self.launch("run", self.write_scene(ENDLESS), "--folder", "job", preexec_fn=ignore_hangup)
        self.wait_until("the run", lambda: self.is_running_in("job"))
        process.send_signal(signal.SIGHUP)
        time.sleep(0.3)
        self.assertIsNone(process.poll())
        process.terminate()
        self.assertEqual(process.wait(), 85)
        self.assert_checkpointed("job")

    def test_a_terminal_that_closes_leaves_a_checkpoint(self):
        process, end = self.terminal("run", self.write_scene(ENDLESS), "--folder", "job")
        self.wait_until("the run", lambda: self.is_running_in("job"))
        time.sleep(0.1)
        os.close(end)
        self.assertEqual(self.code_of(process), 85)
        self.assert_checkpointed("job")

    def test_a_wish_is_heard_while_the_disk_refuses(self):
        """Files may grow no more, which is to a run as a full disk is: it waits for it with a frame
        or in between, and ends as a stop, because an older checkpoint is there to go on from."""
        for name, content in (("between", ENDLESS), ("at-a-frame", scene(end_time=500, output={"frames": {"interval": 0.25}}))):
            with self.subTest(name):
                process = self.start("run", self.write_scene(content), "--folder", name, "--threads", 1,
                                     "--storage-patience", 1000, "--checkpoint-every", 20, stderr=subprocess.PIPE)
                self.addCleanup(process.stderr.close)
                self.wait_for(process, "checkpoint")
                _, most = resource.prlimit(process.pid, resource.RLIMIT_FSIZE)
                resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (100, most))
                self.wait_for(process, "warning")
                time.sleep(2.0)  # well into its waits
                asked = time.monotonic()
                process.terminate()
                process.stdout.read()
                self.assertEqual(process.wait(), 85)
                self.assertLess(time.monotonic() - asked, 30.0)
                said = process.stderr.read()
                match = re.search(r"it resumes from (checkpoint-\d{12}\.h5)", said)
                self.assertTrue(match, said)
                again = self.start("run", name, "--threads", 1)
                self.assertEqual(self.wait_for(again, "resumed")["file"], match[1])
                again.terminate()
                again.stdout.read()
                self.assertEqual(again.wait(), 85)

    def test_the_lock_names_a_process_only_while_it_runs(self):
        path = self.write_scene(scene(end_time=0.05))
        lock = self.folder / "job" / "lock"
        self.expect(0, "run", path, "--folder", "job")
        self.assertEqual(lock.read_text(), "")
        self.expect(85, "run", self.write_scene(scene(end_time=0.1)), "--folder", "job", "--stop-after-step", 100)
        self.assertEqual(lock.read_text(), "")
        process = self.start("run", self.write_scene(ENDLESS), "--folder", "job")
        self.wait_for(process, "resumed")
        self.assertEqual(lock.read_text(), f"{process.pid}\n")
        process.terminate()
        process.stdout.read()
        self.assertEqual(process.wait(), 85)
        self.assertEqual(lock.read_text(), "")
        self.expect(4, "run", self.write_scene(run_binary.failing_scene()), "--folder", "failed")
        self.assertEqual((self.folder / "failed" / "lock").read_text(), "")

    def test_the_stability_suite_hears_a_wish_that_comes_twice(self):
        process = self.start("stability", "free-fall", "column-1-50", "--folder", "kept")
        self.wait_until("a case", lambda: list((self.folder / "kept").glob("*column-1-50/series.h5")))
        process.terminate()
        time.sleep(0.01)
        process.terminate()
        self.assertIn("free-fall", process.stdout.read())
        self.assertEqual(process.wait(), 85)


class Studies(Stopped):
    RUNS = ("endless-courant-0.4", "endless-courant-0.5")

    def setUp(self):
        super().setUp()
        study = {"name": "endless", "scene": ENDLESS, "vary": [
            {"key": "/numerics/courant", "values": [0.4, 0.5]}]}
        (self.folder / "study.json").write_text(json.dumps(study))
        self.command = ["study", "study.json", "--folder", "out", "--cores", "1"]
        self.first = "out/runs/" + self.RUNS[0]

    def assert_stopped(self):
        self.wait_until("its run to go", lambda: (self.folder / self.first / "outcome.json").exists())
        self.assert_checkpointed(self.first)
        self.assertFalse((self.folder / "out/runs" / self.RUNS[1]).exists())

    def wait_for_run(self):
        self.wait_until("the first run", lambda: self.is_running_in(self.first))
        time.sleep(0.1)

    def test_ctrl_c_in_a_terminal_leaves_a_checkpoint(self):
        process, end = self.terminal(*self.command)
        self.wait_for_run()
        os.write(end, b"\x03")
        try:
            while select.select([end], [], [], 60)[0] and os.read(end, 65536):
                pass
        except OSError:
            pass  # its other end is closed
        os.close(end)
        self.assertEqual(self.code_of(process), 85)
        self.assert_stopped()
        self.assertTrue((self.folder / "out/results.json").exists())

    def test_a_terminal_that_closes_leaves_a_checkpoint(self):
        process, end = self.terminal(*self.command)
        self.wait_for_run()
        os.close(end)
        self.assertEqual(self.code_of(process), 85)
        self.assert_stopped()

    def test_timeout_and_a_session_that_ends_leave_a_checkpoint(self):
        process = subprocess.Popen(["timeout", "--preserve-status", "600", run_binary.SLUICE, *self.command],
                                   cwd=self.folder, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   start_new_session=True)
        self.addCleanup(process.kill)
        self.wait_for_run()
        process.terminate()  # which it passes on twice
        self.assertEqual(process.wait(), 85)
        self.assert_stopped()

    def test_a_group_that_is_told_twice_leaves_a_checkpoint(self):
        process = self.launch(*self.command, start_new_session=True)
        self.wait_for_run()
        for number in (signal.SIGTERM, signal.SIGHUP):
            os.killpg(process.pid, number)
        self.assertEqual(process.wait(), 85)
        self.assert_stopped()

    def test_a_killed_study_leaves_a_checkpoint(self):
        process = self.launch(*self.command, start_new_session=True)
        self.wait_for_run()
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        self.assert_stopped()

    def test_a_study_under_nohup_stays_when_the_terminal_goes(self):
        process = self.launch(*self.command, preexec_fn=ignore_hangup)
        self.wait_for_run()
        process.send_signal(signal.SIGHUP)
        time.sleep(0.3)
        self.assertIsNone(process.poll())
        process.terminate()
        self.assertEqual(process.wait(), 85)
        self.assert_stopped()

    def test_a_study_that_is_suspended_rests_with_its_runs(self):
        process = self.launch(*self.command, preexec_fn=lambda: os.setpgid(0, 0))
        self.wait_for_run()
        run = int((self.folder / self.first / "lock").read_text())

        def state(pid):
            return pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]

        process.send_signal(signal.SIGTSTP)
        self.wait_until("all to rest", lambda: state(process.pid) == state(run) == "T")
        process.send_signal(signal.SIGCONT)
        self.wait_until("the run to go on", lambda: state(run) != "T")
        process.terminate()
        self.assertEqual(process.wait(), 85)
        self.assert_stopped()


class Services(Stopped):
    def test_a_service_under_nohup_stays_when_the_terminal_goes(self):
        process = self.start("serve", "--data", "data", "--port", 0, preexec_fn=ignore_hangup)
        self.assertIn("serves", process.stdout.readline())
        process.send_signal(signal.SIGHUP)
        time.sleep(0.3)
        self.assertIsNone(process.poll())
        for _ in range(2):  # together: one wish
            process.terminate()
        process.stdout.read()
        self.assertEqual(process.wait(), 0)


if __name__ == "__main__":
    run_binary.SLUICE = os.path.abspath(sys.argv.pop(1))
    unittest.main(verbosity=2)
