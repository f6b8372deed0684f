"""A running `sluice serve` for the tests that talk to it, and scenes for it."""

import http.client
import json
import os
import re
import signal
import subprocess
import tempfile
import time


def scene(end_time=0.1, spacing=0.06, interval=0.001, **more):
    """A dam break of about 50 particles at the default spacing, of 20 000 at 0.003."""
    return {
        "name": "tiny", "tank": {"width": 1.61, "height": 0.6}, "gravity": [0, -9.81],
        "fluid": [{"shape": "rectangle", "corner": [0, 0], "size": [0.6, 0.3]}],
        "resolution": {"spacing": spacing},
        "numerics": {"scheme": "paper", "reinitialisation": None,
                     "integrator": "kick_drift_kick", "courant": 0.5,
                     "density_diffusion": {"delta": 0.1},
                     "artificial_viscosity": {"alpha": 0.02}},
        "sensors": [{"name": "P1", "kind": "pressure", "position": [1.61, 0.02],
                     "interval": interval}],
        "end_time": end_time, **more}


class Answer:
    def __init__(self, status, headers, body):
        self.status = status
        self.headers = {name.lower(): value for name, value in headers}
        self.body = body

    def json(self):
        return json.loads(self.body)


class Server:
    """Starts the program on a free port, or on `port`; leaving the `with` block stops it."""

    def __init__(self, program, *options, data=None, port=0):
        self.scratch = tempfile.TemporaryDirectory(prefix="sluice-live-")
        self.data = data or os.path.join(self.scratch.name, "data")
        self.log = open(os.path.join(self.scratch.name, "log"), "w+", encoding="utf-8")
        self.process = subprocess.Popen(
            [program, "serve", "--data", self.data, "--port", str(port), *options],
            stdout=subprocess.PIPE, stderr=self.log, text=True)
        first = self.process.stdout.readline()
        found = re.search(r"http://127\.0\.0\.1:(\d+)", first)
        if not found:
            self.log.seek(0)
            raise RuntimeError(f"no address in {first!r}: {self.log.read()}")
        self.port = int(found.group(1))
        self.told_to_stop = False

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.tell_to_stop()
        try:
            self.process.wait(120)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        # The workers of a service that was killed write their checkpoints before they go.
        self.wait_until("the workers to go", lambda: not self.is_worked_in())
        self.process.stdout.close()
        self.log.close()
        self.scratch.cleanup()

    def tell_to_stop(self):
        """Once: a second signal ends the service before its workers."""
        if self.process.poll() is None and not self.told_to_stop:
            self.told_to_stop = True
            self.process.send_signal(signal.SIGTERM)

    def ask(self, method, target, body=None, headers=None, timeout=60):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=timeout)
        try:
            if isinstance(body, dict):
                body = json.dumps(body)
            connection.request(method, target, body=body, headers=headers or {})
            response = connection.getresponse()
            return Answer(response.status, response.getheaders(), response.read())
        finally:
            connection.close()

    def submit(self, document, query=""):
        answer = self.ask("POST", "/v1/jobs" + query, document)
        assert answer.status == 202, answer.body
        return answer.json()["id"]

    def wait_for(self, job, *states):
        while True:
            answer = self.ask("GET", f"/v1/jobs/{job}?wait=10").json()
            if answer["state"] in states:
                return answer
            if answer["state"] in ("completed", "failed", "cancelled"):
                raise AssertionError(f"{job} is {answer['state']}: {answer['reason']}")

    def wait_until(self, what, condition):
        for _ in range(6000):
            value = condition()
            if value:
                return value
            time.sleep(0.05)
        raise AssertionError(f"waited in vain for {what}")

    def workers(self):
        """Processes that the service started."""
        path = f"/proc/{self.process.pid}/task"
        children = []
        for thread in os.listdir(path):
            try:
                with open(f"{path}/{thread}/children", encoding="ascii") as stream:
                    children += [int(pid) for pid in stream.read().split()]
            except FileNotFoundError:
                pass
        return children

    def is_worked_in(self):
        """Whether a worker, of this service or one before it, is still there."""
        for process in filter(str.isdigit, os.listdir("/proc")):
            try:
                if os.readlink(f"/proc/{process}/cwd").startswith(os.path.realpath(self.data)):
                    return True
            except OSError:
                pass  # gone, or not ours to look at
        return False

    def is_sanitized(self):
        """Whether the program was built with a sanitizer, which takes memory and time of its own."""
        with open(f"/proc/{self.process.pid}/maps", encoding="utf-8") as stream:
            return re.search(r"lib[a-z]*san\.so", stream.read()) is not None

    def resident_bytes(self):
        with open(f"/proc/{self.process.pid}/status", encoding="ascii") as stream:
            for line in stream:
                if line.startswith("VmRSS:"):
                    return int(line.split()[1]) * 1024
        raise AssertionError("the service is gone")
