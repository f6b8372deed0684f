"""The client verbs of `sluice` against a running service, as people and scripts use them.

Usage: client_program.py SLUICE [-v] [TEST...]
"""

import http.server
import json
import os
import pty
import re
import select
import shlex
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import unittest

from live import Server, scene

PROGRAM = ""
EVERY_VERB_ENDS_WITHIN = 300  # s: only so that a hang ends as a failure

DONE, USAGE, INVALID_SCENE, JOB_FAILED = 0, 2, 3, 4
NOT_FOUND, WRONG_STATE, UNREACHABLE, JOB_CANCELLED, REFUSED, SERVICE_FAILED = 8, 9, 10, 11, 12, 13
JOB_PAUSED = 85

ENDLESS = scene(1e4, spacing=0.01, interval=1.0)  # still running however fast the machine is
# A column thrown against the wall at nearly the speed of sound: no scheme holds that.
FAILING = scene(5.0, spacing=0.02, fluid=[{"shape": "rectangle", "corner": [0, 0],
                                           "size": [0.6, 0.3], "velocity": [23.0, 0.0]}])
NO_SUCH_JOB = "j" + 20 * "0"


def environment(**variables):
    plain = {name: value for name, value in os.environ.items() if not name.startswith("SLUICE_")}
    return {**plain, **variables}


def client(*arguments, stdin="", **variables):
    """Runs a verb to its end."""
    return subprocess.run([PROGRAM, *map(str, arguments)], input=stdin, capture_output=True,
                          text=True, timeout=EVERY_VERB_ENDS_WITHIN, check=False,
                          env=environment(**variables))


def closed_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.data = os.path.join(self.folder, "data")

    def serve(self, *options, port=0):
        server = Server(PROGRAM, "--disk-reserve", "0", "--cores", "1", *options, data=self.data,
                        port=port)
        self.addCleanup(server.__exit__)
        server.url = f"http://127.0.0.1:{server.port}"
        return server

    def expect(self, code, *arguments, **keywords):
        result = client(*arguments, **keywords)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def start(self, *arguments, **variables):
        process = subprocess.Popen([PROGRAM, *map(str, arguments)], text=True, env=environment(
            **variables), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def write(self, content, name="scene.json"):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as out:
            out.write(content if isinstance(content, str) else json.dumps(content))
        return path

    def read_until(self, stream, words):
        """Lines of a stream up to the first with these words; fails at its end."""
        lines = []
        for line in stream:
            lines.append(line)
            if words in line:
                return lines
        self.fail(f"{words!r} did not come: {lines}")


class Story(Case):
    def test_a_scene_becomes_a_job_that_is_watched_listed_shown_and_deleted(self):
        server = self.serve()
        at = ("--server", server.url)
        path = self.write(scene(0.1))
        said = self.expect(DONE, "submit", path, "--label", "a b&c", "--priority", "3", *at).stdout
        job = said.split()[0]
        self.assertEqual(server.ask("GET", f"/v1/jobs/{job}").json()["label"], "a b&c")
        self.assertEqual(server.ask("GET", f"/v1/jobs/{job}").json()["priority"], 3)

        watched = self.expect(DONE, "watch", job, *at).stdout
        self.assertIn("completed at step", watched)
        listed = self.expect(DONE, "list", "--label", "a b&c", *at).stdout.splitlines()
        self.assertEqual(len(listed), 2)
        for words in (job, "completed", "100.0 %", "tiny", "[a b&c]"):
            self.assertIn(words, listed[1])
        self.assertEqual(self.expect(DONE, "list", "--label", "other", *at).stdout,
                         "no jobs of this kind\n")
        shown = self.expect(DONE, "show", job, *at).stdout
        self.assertTrue(shown.startswith(f"{job} completed\n"), shown)
        self.expect(DONE, "delete", job, *at)
        self.assertEqual(self.expect(DONE, "list", *at).stdout, "no jobs\n")

    def test_the_commands_that_submit_prints_do_what_they_say(self):
        server = self.serve()
        said = self.expect(DONE, "submit", "-", "--server", server.url,
                           stdin=json.dumps(scene(0.1))).stdout
        commands = dict(re.findall(r"^  to ([a-z ]+): +sluice (.*)$", said, re.MULTILINE))
        self.assertEqual(set(commands), {"watch", "look in", "stop"})
        watched = self.expect(DONE, *shlex.split(commands["watch"])).stdout
        series = self.expect(DONE, *shlex.split(commands["look in"])).stdout
        self.assertTrue(series.startswith("time_s,value,weight\n"))
        self.assertIn("cannot cancel",
                      self.expect(WRONG_STATE, *shlex.split(commands["stop"])).stderr)
        after = re.findall(r"^  to look in: sluice (.*)$", watched, re.MULTILINE)
        self.assertEqual(len(after), 2)
        for command in after:
            self.expect(DONE, *shlex.split(command))

    def test_commands_leave_out_what_the_environment_says(self):
        server = self.serve()
        said = self.expect(DONE, "submit", "-", stdin=json.dumps(scene(0.1)),
                           SLUICE_SERVER=server.url + "/").stdout
        self.assertRegex(said, r"to watch: +sluice watch j[0-9a-v]{20}\n")

    def test_series_and_report_are_those_of_the_folder(self):
        server = self.serve()
        job = server.submit(scene(0.3, scales={"height": 0.3, "width": 0.6}, output={"frames": {"interval": 0.02}}))
        server.wait_for(job, "completed")
        folder = os.path.join(self.data, "jobs", job)
        for options in ([], ["P1"], ["P1", "--filter", "gaussian", "--tau", "0.002"],
                        ["P1", "--dimensionless"], ["P1", "--format", "csv"]):
            with self.subTest(options=options):
                here = self.expect(DONE, "sensors", folder, *options).stdout
                there = self.expect(DONE, "sensors", job, *options, "--server", server.url).stdout
                self.assertEqual(there, here)
        def shown(*words):
            done = subprocess.run([PROGRAM, "report", *words], capture_output=True, check=False, env=environment())
            self.assertEqual(done.returncode, DONE, done.stderr)
            return done.stdout
        for options in ([], ["--json"], ["--tau", "0.004"], ["--format", "markdown"], ["--format", "html"],
                        ["--format", "apng"]):
            with self.subTest(options=options):
                self.assertEqual(shown(job, *options, "--server", server.url), shown(folder, *options))
        written = os.path.join(self.folder, "written")
        shown(job, "--output", written, "--server", server.url)
        with open(os.path.join(written, "report.html"), "rb") as page:
            self.assertEqual(page.read(), shown(folder, "--format", "html"))

    def test_what_is_wrong_with_a_request_for_a_series_is_the_same_for_a_folder(self):
        server = self.serve()
        job = server.submit(scene(0.05))
        server.wait_for(job, "completed")
        folder = os.path.join(self.data, "jobs", job)
        for code, options in ((USAGE, "P1 --from 0.2 --to 0.1"), (USAGE, "P1 --from 1e300"), (USAGE, "P1 --to -1e300"),
                              (USAGE, "P1 --filter gaussian --tau 1e9"), (USAGE, "P1 --dimensionless"),
                              (NOT_FOUND, "P2"), (USAGE, "--json --format csv"), (USAGE, "--max-points 20"),
                              (USAGE, "--filter gaussian --tau 0.002"), (USAGE, "--from 0"), (USAGE, "--to 1"),
                              (USAGE, "--dimensionless")):
            with self.subTest(options):
                here = self.expect(code, "sensors", folder, *options.split()).stderr
                there = self.expect(code, "sensors", job, *options.split(), "--server", server.url).stderr
                self.assertEqual(here, there)

    def test_a_report_of_a_job_without_snapshots_names_the_job_and_no_folder(self):
        server = self.serve()
        job = server.submit(scene(0.05))
        server.wait_for(job, "completed")
        said = self.expect(USAGE, "report", job, "--format", "apng", "--server", server.url).stderr
        self.assertIn(f"{job} has no snapshots to show", said)

    def test_a_part_of_a_series_and_few_of_its_samples(self):
        server = self.serve()
        job = server.submit(scene(0.3))
        server.wait_for(job, "completed")
        at = ("--server", server.url)
        part = self.expect(DONE, "sensors", job, "P1", "--from", "0.1", "--to", "0.2", *at)
        times = [float(line.split(",")[0]) for line in part.stdout.splitlines()[1:]]
        self.assertTrue(0.1 <= min(times) and max(times) <= 0.2)
        self.assertEqual(part.stderr, "")
        few = self.expect(DONE, "sensors", job, "P1", "--max-points", "10", *at)
        self.assertLessEqual(len(few.stdout.splitlines()), 11)
        self.assertIn("--max-points", few.stderr)
        folder = os.path.join(self.data, "jobs", job)
        for options in (("--from", "0.1", "--to", "0.2"), ("--max-points", "10")):
            here = self.expect(DONE, "sensors", folder, "P1", *options)
            there = self.expect(DONE, "sensors", job, "P1", *options, *at)
            self.assertEqual((here.stdout, here.stderr), (there.stdout, there.stderr))

    def test_what_programs_read_is_json(self):
        server = self.serve()
        at = ("--server", server.url, "--json")
        path = self.write(scene(0.1))

        def document(*arguments):
            return json.loads(self.expect(DONE, *arguments, *at).stdout)

        job = document("submit", path)["id"]
        watched = self.expect(DONE, "watch", job, *at).stdout.splitlines()
        self.assertEqual(json.loads(watched[-1])["state"], "completed")
        self.assertTrue(all(json.loads(line)["id"] == job for line in watched))
        self.assertEqual([one["id"] for one in document("list")["jobs"]], [job])
        self.assertEqual(document("show", job), server.ask("GET", f"/v1/jobs/{job}").json())
        self.assertEqual(document("sensors", job)["sensors"][0]["name"], "P1")
        self.assertEqual(document("sensors", job, "P1")["name"], "P1")
        self.assertEqual(document("report", job)["sensors"][0]["name"], "P1")
        self.assertEqual(document("resume", job, "--end-time", "0.2")["end_time"], 0.2)
        plan = document("submit", path, "--dry-run")
        self.assertGreater(plan["estimate"]["fluid_particles"], 0)

    def test_a_dry_run_makes_no_job(self):
        server = self.serve()
        said = self.expect(DONE, "submit", self.write(scene()), "--dry-run", "--server",
                           server.url).stdout
        self.assertIn("would be taken", said)
        self.assertIn("momentum", said)
        self.assertEqual(server.ask("GET", "/v1/jobs").json()["jobs"], [])

    def test_a_job_is_paused_resumed_checkpointed_and_cancelled(self):
        server = self.serve()
        at = ("--server", server.url)
        job, other = server.submit(ENDLESS), server.submit(ENDLESS)
        server.wait_until("progress", lambda: server.ask("GET", f"/v1/jobs/{job}").json()["progress"])
        server.wait_until("why the other one waits", lambda: "needs 1 thread, 0 of 1 are free" in (
            self.expect(DONE, "list", "--state", "queued", *at).stdout))
        self.expect(DONE, "checkpoint", job, *at)
        self.expect(WRONG_STATE, "checkpoint", other, *at)
        self.assertIn("paused", self.expect(DONE, "pause", other, *at).stdout)
        self.assertIn("queued", self.expect(DONE, "resume", other, *at).stdout)
        self.expect(WRONG_STATE, "delete", job, *at)
        both = self.expect(NOT_FOUND, "cancel", job, NO_SUCH_JOB, other, *at)
        self.assertEqual([line.split()[0] for line in both.stdout.splitlines()], [job, other])
        self.expect(JOB_CANCELLED, "watch", job, *at)
        self.assertEqual(server.ask("GET", f"/v1/jobs/{other}").json()["state"], "cancelled")


class Errors(Case):
    def test_a_wrong_id_is_not_found_by_any_verb(self):
        server = self.serve()
        for job in (NO_SUCH_JOB, "x", "..", "a/b", "ü"):
            for verb in ("show", "watch", "cancel", "pause", "resume", "checkpoint", "delete",
                         "sensors", "report"):
                with self.subTest(verb=verb, job=job):
                    result = client(verb, job, "--server", server.url)
                    self.assertEqual(result.returncode, NOT_FOUND, result.stderr)
                    self.assertIn("job", result.stderr)
        job = server.submit(scene(0.1))
        server.wait_for(job, "completed")
        said = self.expect(NOT_FOUND, "sensors", job, "P2", "--server", server.url).stderr
        self.assertIn('did you mean "P1"', said)

    def test_every_problem_of_a_scene_is_a_line_with_its_place(self):
        server = self.serve()
        bad = scene(-1.0, spacing="fine", colour="blue")
        path = self.write(bad)
        said = self.expect(INVALID_SCENE, "submit", path, "--server", server.url).stderr
        for pointer in ("/end_time", "/resolution/spacing", "/colour"):
            self.assertIn(f"\n{path}: {pointer}: ", "\n" + said)
        self.assertIn(f"{path} is no valid scene: 3 problems", said)
        said = self.expect(INVALID_SCENE, "submit", "-", "--server", server.url, stdin="{").stderr
        self.assertIn("stdin: (the whole scene): ", said)
        self.assertEqual(server.ask("GET", "/v1/jobs").json()["jobs"], [])

    def test_a_scene_that_cannot_be_read_never_leaves(self):
        nowhere = f"http://127.0.0.1:{closed_port()}"
        for path, code in ((os.path.join(self.folder, "none.json"), USAGE), (self.folder, USAGE),
                           (self.write(" " * (256 * 1024 + 1)), INVALID_SCENE)):
            with self.subTest(path=path):
                said = self.expect(code, "submit", path, "--server", nowhere).stderr
                self.assertIn(path, said)
        self.expect(INVALID_SCENE, "submit", "-", "--server", nowhere, stdin=" " * 300000)

    def test_what_a_service_does_not_allow_is_named(self):
        server = self.serve("--max-particles", "60")
        said = self.expect(INVALID_SCENE, "submit", self.write(scene()), "--server",
                           server.url).stderr
        self.assertRegex(said, "particles = [0-9]+, allowed are at most 60\n")
        said = self.expect(USAGE, "submit", self.write(scene()), "--label", "x" * 101, "--server",
                           server.url).stderr
        self.assertIn("label", said)

    def test_a_service_that_is_not_there_is_unreachable(self):
        nowhere = f"http://127.0.0.1:{closed_port()}"
        for verb in (["list"], ["show", NO_SUCH_JOB], ["cancel", NO_SUCH_JOB],
                     ["watch", NO_SUCH_JOB, "--retry", "0"], ["sensors", NO_SUCH_JOB],
                     ["report", NO_SUCH_JOB]):
            with self.subTest(verb=verb):
                said = self.expect(UNREACHABLE, *verb, "--server", nowhere).stderr
                self.assertIn(nowhere, said)
        said = self.expect(UNREACHABLE, "submit", self.write(scene()), "--retry", "0", "--server",
                           nowhere).stderr
        self.assertRegex(said, "--idempotency-key sluice-[0-9a-f]{32}")

    def test_an_address_that_is_none_is_refused(self):
        for address in ("", "localhost", "ftp://x", "http://", "http://a:b", "http://a:0",
                        "http://a:70000", "http://a/b", "http://u@a", "http://[::1", "http://a b",
                        "http://a:1:2", "http://a\r\nX: y"):
            with self.subTest(address=address):
                result = client("list", "--server", address)
                self.assertEqual(result.returncode, USAGE, result.stderr)

    def test_a_token_is_sent_from_its_file(self):
        token = self.write("0123456789abcdef\n", "token")
        other = self.write("fedcba9876543210\n", "other")
        for path in (token, other):
            os.chmod(path, 0o600)
        server = self.serve("--token-file", token)
        at = ("--server", server.url)
        self.expect(DONE, "list", "--token-file", token, *at)
        self.expect(DONE, "list", *at, SLUICE_TOKEN_FILE=token)
        self.assertIn("--token-file", self.expect(REFUSED, "list", *at).stderr)
        self.expect(REFUSED, "list", "--token-file", other, *at)
        said = self.expect(DONE, "submit", "-", "--token-file", token, *at,
                           stdin=json.dumps(scene(0.1))).stdout
        watch = re.search(r"to watch: +sluice (.*)", said).group(1)
        self.expect(DONE, *shlex.split(watch))
        os.chmod(token, 0o644)
        said = self.expect(USAGE, "list", "--token-file", token, *at).stderr
        self.assertIn("chmod 600", said)
        self.assertNotIn("openssl", said, "what makes a token would overwrite this one")
        said = self.expect(USAGE, "list", "--token-file", os.path.join(self.folder, "none"), *at).stderr
        self.assertIn("openssl rand", said)

    def test_a_folder_that_is_none_points_to_the_service(self):
        self.assertIn("--server", self.expect(USAGE, "sensors", "nowhere").stderr)

    def test_each_verb_helps_with_an_example(self):
        for verb in ("submit", "list", "show", "watch", "cancel", "pause", "resume", "checkpoint",
                     "delete", "sensors", "report"):
            self.assertIn(f"sluice {verb} ", self.expect(DONE, verb, "--help").stdout)


class Watching(Case):
    def test_the_exit_code_says_how_the_job_ended(self):
        server = self.serve()
        at = ("--server", server.url)
        failed = self.expect(JOB_FAILED, "submit", self.write(FAILING), "--watch", *at)
        self.assertRegex(failed.stdout, "\nfailed: .*step")
        job = server.submit(ENDLESS)
        watch = self.start("watch", job, *at)
        self.read_until(watch.stdout, "%")
        self.expect(DONE, "pause", job, *at)
        self.assertIn("sluice resume", watch.stdout.read())
        self.assertEqual(watch.wait(), JOB_PAUSED)
        self.expect(DONE, "resume", job, *at)
        watch = self.start("watch", job, *at)
        self.read_until(watch.stdout, "%")
        self.expect(DONE, "cancel", job, *at)
        self.assertEqual(watch.wait(), JOB_CANCELLED)

    def test_a_watch_outlives_the_service(self):
        server = self.serve()
        job = server.submit(ENDLESS)
        watch = self.start("watch", job, "--interval", "0", "--server", server.url)
        self.read_until(watch.stdout, "%")
        server.process.send_signal(signal.SIGTERM)
        self.assertEqual(server.process.wait(), 0)
        self.read_until(watch.stderr, "trying again")
        again = self.serve(port=server.port)
        self.read_until(watch.stderr, "answers again")
        self.read_until(watch.stdout, "running, attempt 2")
        self.read_until(watch.stdout, "%")
        again.ask("POST", f"/v1/jobs/{job}/cancel")
        self.assertEqual(watch.wait(), JOB_CANCELLED)

    def test_a_watch_outlives_a_kill_of_the_worker(self):
        server = self.serve()
        job = server.submit(ENDLESS)
        watch = self.start("watch", job, "--interval", "0", "--server", server.url)
        self.read_until(watch.stdout, "%")
        os.kill(server.workers()[0], signal.SIGKILL)
        self.read_until(watch.stdout, "queued")
        self.read_until(watch.stdout, "running, attempt 2")
        server.ask("POST", f"/v1/jobs/{job}/cancel")
        self.assertEqual(watch.wait(), JOB_CANCELLED)
        self.assertEqual(watch.stderr.read(), "")

    def test_ctrl_c_ends_the_watching_and_not_the_job(self):
        server = self.serve()
        job = server.submit(ENDLESS)
        watch = self.start("watch", job, "--server", server.url)
        self.read_until(watch.stdout, "%")
        watch.send_signal(signal.SIGINT)
        self.assertEqual(watch.wait(), 128 + signal.SIGINT)
        self.assertIn("the job continues", watch.stderr.read())
        self.assertEqual(server.ask("GET", f"/v1/jobs/{job}").json()["state"], "running")

    def test_a_reader_that_goes_away_ends_the_watching(self):
        server = self.serve()
        job = server.submit(ENDLESS)
        watch = self.start("watch", job, "--interval", "0", "--server", server.url)
        self.read_until(watch.stdout, "%")
        watch.stdout.close()
        self.assertEqual(watch.wait(), DONE)

    def test_a_terminal_gets_a_bar(self):
        server = self.serve()
        job = server.submit(ENDLESS)
        inner, outer = pty.openpty()
        watch = subprocess.Popen([PROGRAM, "watch", job, "--server", server.url], stdout=outer,
                                 stderr=outer, env=environment())
        os.close(outer)
        self.addCleanup(os.close, inner)
        self.addCleanup(watch.wait)
        self.addCleanup(watch.kill)
        text = ""
        while len(re.findall(r"\r\[[#.]+\] +[0-9.]+ % t ", text)) < 2:
            self.assertTrue(select.select([inner], [], [], 60)[0], text)
            text += os.read(inner, 65536).decode()
        self.assertRegex(text, r"running(\x1b\[0m)?\r\n")
        server.ask("POST", f"/v1/jobs/{job}/cancel")
        self.assertEqual(watch.wait(), JOB_CANCELLED)
        try:
            while select.select([inner], [], [], 1)[0]:
                text += os.read(inner, 65536).decode()
        except OSError:
            pass  # its other end is closed
        last = text.replace("\r\n", "\n").split("\n")
        self.assertTrue(any(re.sub(r"\x1b\[[0-9]+m", "", line.split("\r")[-1]).startswith("cancelled") for line in last), text)


class Retries(Case):
    def test_a_submission_waits_for_its_service(self):
        port = closed_port()
        path = self.write(scene(0.1))
        submit = self.start("submit", path, "--server", f"http://127.0.0.1:{port}")
        self.read_until(submit.stderr, "trying again")
        server = self.serve(port=port)
        self.read_until(submit.stderr, "answers again")
        self.assertEqual(submit.wait(), DONE)
        self.assertEqual(len(server.ask("GET", "/v1/jobs").json()["jobs"]), 1)

    def test_a_submission_whose_answer_was_lost_makes_one_job(self):
        server = self.serve()
        with LossyProxy(server.port) as proxy:
            said = self.expect(DONE, "submit", self.write(scene(0.1)), "--server", proxy.url)
        self.assertEqual(proxy.requests, 2)
        jobs = server.ask("GET", "/v1/jobs").json()["jobs"]
        self.assertEqual([job["id"] for job in jobs], [said.stdout.split()[0]])
        self.assertIn("submitted before", said.stdout)

    def test_a_key_of_ones_own_makes_one_job(self):
        server = self.serve()
        submit = ("submit", self.write(scene(0.1)), "--idempotency-key", "mine", "--server",
                  server.url)
        first, second = (self.expect(DONE, *submit).stdout for _ in range(2))
        self.assertEqual(first.split()[0], second.split()[0])
        self.expect(USAGE, *submit, "--priority", "1")


class LossyProxy:
    """Passes requests on to a port; closes the first connection instead of answering."""

    def __init__(self, port):
        self.port = port
        self.requests = 0
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.url = f"http://127.0.0.1:{self.listener.getsockname()[1]}"
        self.thread = threading.Thread(target=self.run, daemon=True)

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.thread.join()
        self.listener.close()

    def run(self):
        for self.requests in (1, 2):
            near, _ = self.listener.accept()
            with near, socket.create_connection(("127.0.0.1", self.port)) as far:
                request = b""
                while True:
                    request += near.recv(65536)
                    head, _, body = request.partition(b"\r\n\r\n")
                    length = re.search(rb"(?i)content-length: (\d+)", head)
                    if length and len(body) == int(length.group(1)):
                        break
                far.sendall(request)
                answer = b""
                while part := far.recv(65536):
                    answer += part
                if self.requests == 2:
                    near.sendall(answer)


class Impostor(http.server.BaseHTTPRequestHandler):
    """Answers what the test gave its path, as some other server might."""

    answers = {}
    asked = []

    def do_GET(self):
        status, headers, body = self.answers[self.path.partition("?")[0]]
        self.asked.append(self.path)
        body = body(self.path) if callable(body) else body
        self.send_response(status)
        for name, value in headers.items():
            self.send_header(name, value)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    do_POST = do_DELETE = do_GET

    def log_message(self, *_):
        pass


class Strangers(Case):
    def answer_with(self, **answers):
        """A server for /v1/jobs (`jobs`) and one job of it (`job`)."""
        paths = {"jobs": "/v1/jobs", "job": f"/v1/jobs/{NO_SUCH_JOB}"}
        handler = type("Handler", (Impostor,), {
            "answers": {paths[name]: answer for name, answer in answers.items()}, "asked": []})
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        thread = threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True)
        thread.start()
        self.addCleanup(thread.join)
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        return f"http://127.0.0.1:{server.server_port}", handler.asked

    def test_all_pages_of_a_list_are_read(self):
        pages = {"": ([1, 2], "c&1"), "c&1": ([3], None)}

        def page(path):
            cursor = path.partition("cursor=")[2].replace("%26", "&")
            jobs, following = pages[cursor]
            return json.dumps({"jobs": [{"id": f"j{n}", "state": "queued"} for n in jobs],
                               "next_cursor": following}).encode()

        url, asked = self.answer_with(jobs=(200, {}, page))
        lines = self.expect(DONE, "list", "--server", url).stdout.splitlines()
        self.assertEqual([line.split()[0] for line in lines], ["ID", "j1", "j2", "j3"])
        self.assertEqual(len(asked), 2)
        everything = json.loads(self.expect(DONE, "list", "--json", "--server", url).stdout)
        self.assertEqual(len(everything["jobs"]), 3)

    def test_a_server_that_is_no_service_of_ours_is_said_to_be_none(self):
        for status, body in ((200, b"<html>"), (200, b"[]"), (200, b"[" * 200000), (404, b"no"),
                             (302, b""), (500, b'{"type": 5}'), (418, b'{"type": "about:blank"}')):
            with self.subTest(status=status, body=body[:20]):
                url, _ = self.answer_with(jobs=(status, {"Location": "/elsewhere"}, body))
                self.assertIn("--server", self.expect(UNREACHABLE, "list", "--server", url).stderr)

    def test_a_list_of_anything_but_jobs_is_no_crash(self):
        for jobs in (None, 5, "x", {}, [None, 5, "x", {}], [{"id": 5, "progress": {"step": "x"}}],
                     [{"progress": {"time": 1e308, "end_time": -1, "step": -5}}]):
            with self.subTest(jobs=jobs):
                url, _ = self.answer_with(jobs=(200, {}, json.dumps({"jobs": jobs}).encode()))
                self.assertIn(client("list", "--server", url).returncode, (DONE, UNREACHABLE))

    def test_no_text_of_a_server_moves_the_cursor(self):
        nasty = "a\x1b[2Jb\x9bc\rd\ne\x7f\u0085"
        job = {"id": NO_SUCH_JOB, "state": "failed", "name": nasty, "label": nasty, "reason": nasty,
               "outcome": {"state": nasty, "diagnosis": {"suggestion": nasty}}}
        problem = {"type": "/problems/wrong-state", "title": nasty, "detail": nasty,
                   "errors": [{"pointer": nasty, "detail": nasty}]}
        url, _ = self.answer_with(jobs=(200, {}, json.dumps({"jobs": [job]}).encode()),
                                  job=(200, {"ETag": '"x"'}, json.dumps(job).encode()))
        results = [client("list", "--server", url), client("show", NO_SUCH_JOB, "--server", url),
                   client("watch", NO_SUCH_JOB, "--server", url)]
        url, _ = self.answer_with(job=(409, {}, json.dumps(problem).encode()))
        results.append(self.expect(WRONG_STATE, "show", NO_SUCH_JOB, "--server", url))
        for result in results:
            text = result.stdout + result.stderr
            self.assertIn("a?[2Jb?c?d?e??", text)
            self.assertNotRegex(text, "[\x00-\x09\x0b-\x1f\x7f-\x9f]")

    def test_a_service_that_cannot_now_is_told_apart_from_none(self):
        def problem(slug, status):
            return (status, {}, json.dumps({"type": f"/problems/{slug}", "title": "t",
                                            "status": status, "detail": "d"}).encode())

        for slug, status in (("internal", 500), ("queue-full", 503), ("disk-full", 507)):
            url, _ = self.answer_with(jobs=problem(slug, status))
            submit = client("submit", "-", "--server", url, stdin="{}")
            self.assertEqual((submit.returncode, submit.stderr), (SERVICE_FAILED, "sluice: t: d\n"))


class Studies(Case):
    def files(self, **more):
        """A study of a scene that stands in a file beside it."""
        self.write(scene(0.05), "base.json")
        return self.write({"name": "pair", "scene": "base.json", "targets": [0.5],
                           "vary": [{"key": "/resolution/spacing", "values": [0.06, 0.05]}],
                           **more}, "study.json")

    def test_a_study_is_run_by_the_service_watched_shown_and_deleted(self):
        at = ("--server", self.serve().url)
        said = self.expect(DONE, "study", self.files(), "--watch", *at)
        study = said.stdout.split()[0]
        self.assertRegex(study, "^s[0-9a-v]{20}$")
        self.assertIn("pair-spacing-0.06: completed", said.stderr)
        self.assertIn("pair-spacing-0.05: completed", said.stderr)
        self.assertIn("| pair-spacing-0.06 | completed |", said.stdout)
        shown = self.expect(DONE, "study", study, "--json", *at).stdout
        self.assertEqual([run["state"] for run in json.loads(shown)["runs"]], 2 * ["completed"])
        self.assertEqual(len(self.expect(DONE, "list", "--label", study, *at).stdout.splitlines()), 3)
        self.assertEqual(self.expect(DONE, "cancel", study, *at).stdout, f"{study} ended\n")
        self.expect(DONE, "delete", study, *at)
        self.expect(NOT_FOUND, "study", study, *at)

    def test_one_key_makes_one_study(self):
        at = ("--server", self.serve().url, "--idempotency-key", "once")
        path = self.files()
        ids = {self.expect(DONE, "study", path, *at).stdout.split()[0] for _ in range(2)}
        self.assertEqual(len(ids), 1)

    def test_what_is_wrong_with_a_study_is_said_line_by_line_and_options_of_folders_are_refused(self):
        at = ("--server", self.serve("--max-study-runs", "1").url)
        refused = self.expect(INVALID_SCENE, "study", self.files(), *at).stderr
        self.assertIn("makes 2 runs, more than 1", refused)
        wrong = self.expect(INVALID_SCENE, "study", self.files(vary=[{"key": "/end_tim",
                                                                      "values": [1]}]), *at).stderr
        self.assertIn("/end_tim", wrong)
        self.expect(USAGE, "study", self.files(), "--folder", self.folder, *at)
        self.expect(USAGE, "study", self.files(), "--watch")
        self.expect(USAGE, "study", os.path.join(self.folder, "none.json"))


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
