"""Jobs with meshes over HTTP: forms, what is refused of them, and what becomes of the files.

usage: meshes.py SLUICE [unittest arguments]
"""

import hashlib
import http.client
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

from live import Server

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "run"))
from meshes_of_tests import ramp, scene_with_mesh  # noqa: E402

SLUICE = ""
LARGEST_MESH = 16 * 1024 * 1024


def form(parts, boundary="xyz"):
    """(body, headers) of (field, file name or None, bytes) each."""
    body = b""
    for field, name, content in parts:
        file = f'; filename="{name}"' if name is not None else ""
        body += f'--{boundary}\r\nContent-Disposition: form-data; name="{field}"{file}\r\n\r\n'.encode()
        body += content + b"\r\n"
    return body + f"--{boundary}--\r\n".encode(), {"Content-Type": f"multipart/form-data; boundary={boundary}"}


def submission(scene, mesh, name="ramp.stl", boundary="xyz"):
    return form([("scene", "case.json", json.dumps(scene).encode()), ("mesh", name, mesh)], boundary)


class Meshes(unittest.TestCase):
    def setUp(self):
        self.server = Server(SLUICE, "--cores", "1")
        self.server.__enter__()
        self.addCleanup(lambda: self.server.__exit__(None, None, None))
        self.scene = scene_with_mesh(end_time=0.004)

    def post(self, body, headers, query="", **more):
        return self.server.ask("POST", "/v1/jobs" + query, body, {**headers, **more})

    def submit(self, scene=None, mesh=None, **more):
        answer = self.post(*submission(scene or self.scene, mesh or ramp(0.16)), **more)
        self.assertEqual(answer.status, 202, answer.body)
        return answer.json()["id"]

    def folder(self, job):
        return pathlib.Path(self.server.data) / "jobs" / job

    def problem(self, answer, status):
        self.assertEqual(answer.status, status, answer.body)
        return answer.json()

    def test_a_job_runs_with_the_mesh_that_came_with_it(self):
        job = self.submit()
        self.server.wait_for(job, "completed")
        self.assertEqual((self.folder(job) / "ramp.stl").read_bytes(), ramp(0.16))
        kept = json.loads((self.folder(job) / "scene.json").read_text())
        self.assertEqual(kept["obstacles"][0]["sha256"], hashlib.sha256(ramp(0.16)).hexdigest())
        files = {file["name"]: file for file in self.server.ask("GET", f"/v1/jobs/{job}/files").json()["files"]}
        self.assertEqual(files["ramp.stl"]["kind"], "mesh")
        self.assertEqual(self.server.ask("GET", files["ramp.stl"]["href"]).body, ramp(0.16))
        self.assertEqual(self.server.ask("GET", f"/v1/jobs/{job}/sensors/H").status, 200)
        # To a later end, and away with all of it.
        later = self.server.ask("POST", f"/v1/jobs/{job}/resume", {"end_time": 0.008})
        self.assertEqual(later.status, 200, later.body)
        self.server.wait_for(job, "completed")
        self.assertEqual(self.server.ask("DELETE", f"/v1/jobs/{job}").status, 204)
        self.assertFalse(self.folder(job).exists())

    def test_a_job_is_submitted_again_from_its_files(self):
        first = self.submit()
        files = f"/v1/jobs/{first}/files/"
        scene = self.server.ask("GET", files + "scene.json").json()
        mesh = self.server.ask("GET", files + "ramp.stl").body
        again = self.submit(scene, mesh)
        self.server.wait_for(again, "completed")
        other = self.post(*submission(scene, ramp(0.15)))
        self.assertEqual(self.problem(other, 422)["errors"][0]["pointer"], "/obstacles/0/sha256")

    def test_a_dry_run_keeps_nothing(self):
        answer = self.post(*submission(self.scene, ramp(0.16)), "?dry_run=1")
        self.assertEqual(answer.status, 200, answer.body)
        self.assertGreater(answer.json()["estimate"]["fluid_particles"], 500)
        self.assertEqual(os.listdir(pathlib.Path(self.server.data) / "jobs"), [])

    def test_one_key_makes_one_job_however_the_form_is_written(self):
        key = {"Idempotency-Key": "one"}
        first = self.post(*submission(self.scene, ramp(0.16)), **key)
        again = self.post(*submission(self.scene, ramp(0.16), boundary="another"), **key)
        self.assertEqual(first.json()["id"], again.json()["id"])
        other = self.post(*submission(self.scene, ramp(0.15)), **key)
        self.assertEqual(self.problem(other, 422)["type"], "/problems/idempotency-key-reused")

    def test_what_is_missing_or_too_much_is_refused_with_what_to_do(self):
        alone = self.server.ask("POST", "/v1/jobs", self.scene)
        missing = self.problem(alone, 422)["errors"][0]
        self.assertEqual(missing["pointer"], "/obstacles/0/file")
        self.assertIn("curl -F scene=@SCENE.json -F mesh=@FILE", missing["detail"])
        self.assertEqual(self.post(*submission(self.scene, ramp(0.16), "rampe.stl")).status, 422)
        text = json.dumps(self.scene).encode()
        for parts in ([("scene", None, text), ("mesh", "ramp.stl", ramp(0.16)), ("mesh", "more.stl", ramp(0.16))],
                      [("scene", None, text), ("mesh", "ramp.stl", ramp(0.16)), ("mesh", "ramp.stl", ramp(0.16))],
                      [("scene", None, text), ("mesh", "ramp.stl", ramp(0.16)), ("label", None, b"x")],
                      [("scene", None, text), ("mesh", "ramp.stl", ramp(0.16)), ("mesh", "\u00e4\x01.stl", b"x")],
                      [("scene", None, text), ("scene", None, text)],
                      [("mesh", "ramp.stl", ramp(0.16))], []):
            self.problem(self.post(*form(parts)), 400)
        leaky = ramp(0.16)[:80] + (11).to_bytes(4, "little") + ramp(0.16)[84:-50]
        detail = self.problem(self.post(*submission(self.scene, leaky)), 422)["errors"][0]["detail"]
        self.assertIn("is not closed", detail)
        self.assertEqual(os.listdir(pathlib.Path(self.server.data) / "jobs"), [])

    def test_bodies_beyond_the_limits_are_refused(self):
        # A client that waits for its answer before it sends: the others meet a closed connection.
        connection = http.client.HTTPConnection("127.0.0.1", self.server.port, timeout=60)
        connection.putrequest("POST", "/v1/jobs")
        for name, value in (*form([])[1].items(), ("Content-Length", str(33 * 1024 * 1024))):
            connection.putheader(name, value)
        connection.endheaders()
        self.assertEqual(connection.getresponse().status, 413)
        connection.close()
        large = self.problem(self.post(*submission(self.scene, bytes(LARGEST_MESH + 1))), 422)
        self.assertIn("at most 16777216", large["errors"][0]["detail"])
        body, headers = submission(self.scene, bytes(300 * 1024))
        self.problem(self.server.ask("POST", "/v1/studies", body, headers), 413)

    def test_a_file_name_leads_nowhere(self):
        for name in ("../ramp.stl", "/etc/ramp.stl", "scene.json", "job.json", "..", "a\\b.stl"):
            scene = json.loads(json.dumps(self.scene))
            scene["obstacles"][0]["file"] = name
            self.problem(self.post(*submission(scene, ramp(0.16), name)), 422)
        self.assertEqual(os.listdir(pathlib.Path(self.server.data) / "jobs"), [])

    def test_a_killed_service_and_worker_go_on_with_it(self):
        job = self.submit(scene_with_mesh(end_time=30.0))
        self.server.wait_until("a checkpoint", lambda: list(self.folder(job).glob("checkpoint-*.h5")))
        workers = self.server.workers()
        self.server.process.send_signal(signal.SIGKILL)
        for worker in workers:
            os.kill(worker, signal.SIGKILL)
        self.server.process.wait()
        with Server(SLUICE, "--cores", "1", data=self.server.data) as second:
            second.wait_until("the job to run", lambda: second.ask("GET", f"/v1/jobs/{job}").json()["progress"])
            self.assertEqual(second.ask("POST", f"/v1/jobs/{job}/cancel").status, 202)
            second.wait_for(job, "cancelled")

    def test_rows_are_made_anew_with_it(self):
        job = self.submit()
        self.server.wait_for(job, "completed")
        self.server.tell_to_stop()
        self.server.process.wait()
        os.remove(pathlib.Path(self.server.data) / "jobs.sqlite")
        with Server(SLUICE, "--rebuild", data=self.server.data) as second:
            self.assertEqual(second.ask("GET", f"/v1/jobs/{job}").json()["state"], "completed")

    def test_the_client_sends_the_files_along(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "case.json"
            path.write_text(json.dumps(self.scene))
            server = ("--server", f"http://127.0.0.1:{self.server.port}")
            missing = subprocess.run([SLUICE, "submit", path, *server], capture_output=True, text=True)
            self.assertEqual(missing.returncode, 3, missing.stderr)
            self.assertIn("there is no such file in", missing.stderr)
            (pathlib.Path(folder) / "ramp.stl").write_bytes(ramp(0.16))
            done = subprocess.run([SLUICE, "submit", path, "--json", *server], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            job = json.loads(done.stdout)["id"]
            self.server.wait_for(job, "completed")
            report = subprocess.run([SLUICE, "report", job, "--output", pathlib.Path(folder) / "report", *server],
                                    capture_output=True, text=True)
            self.assertEqual(report.returncode, 0, report.stderr)

    def test_a_study_says_that_it_takes_no_files(self):
        study = {"name": "ramps", "scene": self.scene, "vary": [{"key": "/end_time", "values": [0.002, 0.004]}]}
        refused = self.problem(self.server.ask("POST", "/v1/studies", study), 422)
        self.assertIn("run it with sluice study", json.dumps(refused))


if __name__ == "__main__":
    SLUICE = os.path.abspath(sys.argv.pop(1))
    unittest.main(verbosity=2)
