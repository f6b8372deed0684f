"""What the storms share: small scenes, and a service that is killed and started again."""

import contextlib
import json
import os
import pathlib
import signal
import socket
import subprocess
import time
import urllib.error
import urllib.request

HANG = 3000  # s: only so that a hang ends as a failure
KINDS = 4  # different scenes
HOST = "127.0.0.1"


def scene(kind):
    """A dam break of about 110 particles; two to eight seconds of work, by kind."""
    return {
        "name": f"storm-{kind}",
        "tank": {"width": 1.61, "height": 0.6},
        "fluid": [{"shape": "rectangle", "corner": [0, 0], "size": [0.6, 0.3]}],
        "gravity": [0, -9.81],
        "resolution": {"spacing": 0.04},
        "numerics": {
            "scheme": "paper",
            "reinitialisation": None,
            "integrator": "kick_drift_kick",
            "courant": 0.5,
            "density_diffusion": {"delta": 0.1},
            "artificial_viscosity": {"alpha": 0.02},
        },
        "sensors": [
            {"name": "P1", "kind": "pressure", "position": [1.61, 0.02], "interval": 0.01}],
        "end_time": 20.0 + 10.0 * kind,
    }


def digests_of(outcome_path):
    return json.loads(outcome_path.read_text())["digests"]


def undisturbed(program, folder):
    """The digests of each kind of scene, run alone."""
    digests = []
    for kind in range(KINDS):
        path = folder / f"{kind}.json"
        path.write_text(json.dumps(scene(kind)))
        subprocess.run([program, "run", str(path), "--folder", str(folder / str(kind)),
                        "--threads", "1", "--progress", "none"],
                       check=True, capture_output=True, timeout=HANG)
        digests.append(digests_of(folder / str(kind) / "outcome.json"))
    return digests


def workers(data):
    """{process id: job id} of all workers of this data folder."""
    wanted = str(data.resolve() / "jobs")
    found = {}
    for entry in pathlib.Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            arguments = (entry / "cmdline").read_bytes().split(b"\0")
            folder = (entry / "cwd").readlink()
        except OSError:
            continue
        if arguments[1:3] == [b"run", b"."] and str(folder.parent) == wanted:
            found[int(entry.name)] = folder.name
    return found


def kill_workers(data):
    """All of them; returns when they are gone."""
    while running := workers(data):
        for pid in running:
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        time.sleep(0.01)


class Service:
    """`sluice serve` on a port that stays the same through its deaths."""

    def __init__(self, program, data, log, *options):
        with socket.socket() as probe:
            probe.bind((HOST, 0))
            self.port = probe.getsockname()[1]
        self.command = [program, "serve", "--data", str(data), "--port", str(self.port),
                        "--crash-limit", "1000000", *options]
        self.log = open(log, "ab")
        self.process = None

    def start(self):
        self.process = subprocess.Popen(self.command, stdout=self.log, stderr=self.log,
                                        stdin=subprocess.DEVNULL)

    def kill(self):
        if self.process and self.process.poll() is None:
            self.process.kill()
            self.process.wait()

    def stop(self):
        """A clean stop: returns its exit status."""
        self.process.terminate()
        return self.process.wait(HANG)

    def request(self, method, path, body=None, headers=None):
        """The JSON answer; None when nobody answered, or that it cannot be done now."""
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(f"http://{HOST}:{self.port}{path}", data, headers or {},
                                         method=method)
        if data:
            request.add_header("Content-Type", "application/json")
        try:
            with urllib.request.urlopen(request, timeout=30) as answer:
                return json.load(answer)
        except urllib.error.HTTPError as error:
            if error.code == 409 or error.code >= 500:
                return None
            raise RuntimeError(f"{method} {path}: {error.code} {error.read().decode()}") from error
        except (OSError, ValueError):
            return None

    def submit(self, number):
        """Tries once to submit job `number`, with its key; returns its id once acknowledged."""
        answer = self.request("POST", "/v1/jobs", scene(number % KINDS),
                              {"Idempotency-Key": f"storm-{number}"})
        return answer and answer["id"]

    def unfinished(self, acknowledged):
        """How many of these jobs have not ended; None when nobody answers. A submission that was cut
        short after its folder and before its answer leaves a paused job, which is none of them."""
        jobs = set()
        for state in ("queued", "running", "paused"):
            answer = self.request("GET", f"/v1/jobs?state={state}&limit=1000")
            if answer is None:
                return None
            jobs.update(job["id"] for job in answer["jobs"])
        return len(jobs & set(acknowledged))
