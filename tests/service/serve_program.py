"""`sluice serve` as a service manager and a user see it: start, stop, signals, refusals.

Usage: serve_program.py SLUICE [-v] [TEST...]
"""

import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

from live import Server, scene

PROGRAM = ""


def refused(*options, data=None, port=0):
    """Runs a `serve` that is expected to refuse; returns its exit code and what it said."""
    with tempfile.TemporaryDirectory() as folder:
        result = subprocess.run(
            [PROGRAM, "serve", "--data", data or os.path.join(folder, "data"), "--port", str(port),
             *options], capture_output=True, text=True, timeout=300, check=False)
    return result.returncode, result.stderr


class Serve(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def token_file(self, mode):
        path = os.path.join(self.folder, "token")
        with open(os.open(path, os.O_CREAT | os.O_WRONLY, mode), "w", encoding="ascii") as out:
            out.write("0123456789abcdef\n")
        os.chmod(path, mode)
        return path

    def test_tells_the_service_manager_when_it_is_ready_and_when_it_stops(self):
        path = os.path.join(self.folder, "notify")
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
            manager.bind(path)
            manager.settimeout(300)
            os.environ["NOTIFY_SOCKET"] = path
            try:
                server = Server(PROGRAM)
            finally:
                del os.environ["NOTIFY_SOCKET"]
            with server:
                self.assertEqual(manager.recv(100), b"READY=1")
                self.assertEqual(server.ask("GET", "/readyz").status, 200)
                server.tell_to_stop()
                self.assertEqual(manager.recv(100), b"STOPPING=1")
                self.assertEqual(server.process.wait(300), 0)

    def test_drains_running_jobs_and_goes_on_with_them_at_the_next_start(self):
        data = os.path.join(self.folder, "data")
        options = ("--cores", "1", "--disk-reserve", "0")

        def steps(server, job, more_than):
            progress = server.ask("GET", f"/v1/jobs/{job}").json()["progress"]
            return progress["step"] if progress and progress["step"] > more_than else None

        with Server(PROGRAM, *options, data=data) as server:
            # Long enough to be running still however fast the machine is.
            job = server.submit(scene(1e4, spacing=0.01, interval=1.0))
            before = server.wait_until("progress", lambda: steps(server, job, 0))
            server.tell_to_stop()
            self.assertEqual(server.process.wait(300), 0)
        with Server(PROGRAM, *options, data=data) as server:
            server.wait_until("more progress", lambda: steps(server, job, before))
            self.assertEqual(server.ask("POST", f"/v1/jobs/{job}/cancel").status // 100, 2)
            ended = server.wait_until("its end", lambda: (
                lambda shown: shown if shown["state"] == "cancelled" else None)(
                    server.ask("GET", f"/v1/jobs/{job}").json()))
            self.assertEqual(ended["attempts"], 2)
            self.assertEqual(ended["crashes"], 0)

    def test_a_second_signal_ends_it_at_once(self):
        with Server(PROGRAM, "--cores", "1", "--disk-reserve", "0") as server:
            job = server.submit(scene(1e4, spacing=0.01, interval=1.0))
            server.wait_until("progress", lambda: server.ask(
                "GET", f"/v1/jobs/{job}").json()["progress"])
            worker = server.workers()[0]
            os.kill(worker, signal.SIGSTOP)  # so that the first signal alone cannot end it
            server.process.send_signal(signal.SIGTERM)
            server.wait_until("the drain", lambda: server.ask("GET", "/readyz").status == 503)
            time.sleep(2.2)  # within two seconds it would be the same wish
            server.process.send_signal(signal.SIGTERM)
            self.assertEqual(server.process.wait(30), 128 + signal.SIGTERM)
            os.kill(worker, signal.SIGCONT)

    def test_a_folder_has_one_service(self):
        with Server(PROGRAM) as server:
            code, said = refused(data=server.data)
            self.assertEqual(code, 7)
            self.assertIn(str(server.process.pid), said)

    def test_a_port_has_one_server(self):
        with Server(PROGRAM) as server:
            code, said = refused(port=server.port)
            self.assertEqual(code, 2)
            self.assertIn("--port", said)

    def test_other_machines_need_a_token(self):
        code, said = refused("--host", "0.0.0.0")
        self.assertEqual(code, 2)
        self.assertIn("--token-file", said)

    def test_a_token_file_that_others_can_read_is_refused(self):
        code, said = refused("--token-file", self.token_file(0o644))
        self.assertEqual(code, 2)
        self.assertIn("chmod 600", said)

    def test_asks_for_the_token(self):
        with Server(PROGRAM, "--token-file", self.token_file(0o600)) as server:
            self.assertEqual(server.ask("GET", "/v1/jobs").status, 401)
            self.assertEqual(server.ask("GET", "/livez").status, 200)
            answer = server.ask("GET", "/v1/jobs",
                                headers={"Authorization": "Bearer 0123456789abcdef"})
            self.assertEqual(answer.status, 200)

    def test_log_lines_stay_lines_whatever_is_asked_for(self):
        with Server(PROGRAM, "--access-log", "all") as server:
            server.ask("GET", "/%0a%7b%22event%22:%22forged%22%7d%1b[2J%ff")
            self.assertEqual(server.ask("GET", "/livez").status, 200)
            server.tell_to_stop()
            server.process.wait(300)
            server.log.seek(0)
            text = server.log.read()
        self.assertTrue(all(line.startswith('{"at":"') for line in text.splitlines()))
        self.assertIn(r"\u001b[2J", text)
        self.assertTrue(text.isascii())

    def test_rows_are_made_anew_from_the_folders(self):
        data = os.path.join(self.folder, "data")
        with Server(PROGRAM, "--disk-reserve", "0", data=data) as server:
            job = server.submit(scene(0.1), "?label=kept")
            server.wait_for(job, "completed")
        with Server(PROGRAM, "--rebuild", data=data) as server:
            again = server.ask("GET", f"/v1/jobs/{job}").json()
            self.assertEqual(again["state"], "completed")
            self.assertEqual(again["label"], "kept")
        self.assertTrue([name for name in os.listdir(data) if re.match(r"jobs\.sqlite\.bad", name)])

    def test_a_submission_that_was_cut_short_is_found_at_the_next_start(self):
        data = os.path.join(self.folder, "data")
        with Server(PROGRAM, "--disk-reserve", "0", data=data) as server:
            job = server.submit(scene(0.1))
            server.wait_for(job, "completed")
            # A folder without its row, as a crash between the two leaves it.
            orphan = job[:-1] + ("0" if job[-1] != "0" else "1")
            subprocess.run(["cp", "-r", f"{data}/jobs/{job}", f"{data}/jobs/{orphan}"], check=True)
        with Server(PROGRAM, "--disk-reserve", "0", data=data) as server:
            self.assertEqual(server.ask("GET", f"/v1/jobs/{orphan}").status, 200)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
