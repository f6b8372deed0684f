"""deploy/nginx.conf in front of a running service: what a browser and curl get through it. Skipped
without nginx or openssl.

Usage: nginx_proxy.py SLUICE ROOT [-v] [TEST...]
"""

import http.client
import json
import os
import shutil
import signal
import socket
import ssl
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = ""
ROOT = ""
SKIPPED = 77
NAME = "sluice.example.org"

# Whatever nginx writes goes into a folder of its own; one process, so that no user is changed.
MAIN = """daemon off; master_process off; pid {folder}/pid; error_log {folder}/error;
events {{}}
http {{
  access_log off;
  client_body_temp_path {folder}/body; proxy_temp_path {folder}/proxy;
  fastcgi_temp_path {folder}/fastcgi; uwsgi_temp_path {folder}/uwsgi; scgi_temp_path {folder}/scgi;
  include {folder}/site;
}}
"""


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Proxy:
    """nginx with the snippet as it stands but for ports and certificate."""

    def __init__(self, service_port):
        self.scratch = tempfile.TemporaryDirectory()
        folder = self.scratch.name
        self.port = free_port()
        subprocess.run(
            ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256",
             "-nodes", "-days", "2", "-subj", f"/CN={NAME}", "-addext",
             f"subjectAltName=DNS:{NAME}", "-keyout", f"{folder}/key", "-out", f"{folder}/cert"],
            check=True, capture_output=True)
        with open(os.path.join(ROOT, "deploy", "nginx.conf"), encoding="utf-8") as stream:
            site = stream.read()
        for there, here in (("127.0.0.1:8080", f"127.0.0.1:{service_port}"),
                            ("listen 443", f"listen 127.0.0.1:{self.port}"),
                            ("/etc/ssl/certs/sluice.pem", f"{folder}/cert"),
                            ("/etc/ssl/private/sluice.key", f"{folder}/key")):
            assert there in site, there
            site = site.replace(there, here)
        for name, text in (("site", site), ("main", MAIN.format(folder=folder))):
            with open(os.path.join(folder, name), "w", encoding="utf-8") as stream:
                stream.write(text)
        self.command = [NGINX, "-p", folder, "-c", f"{folder}/main", "-e", f"{folder}/error"]
        checked = subprocess.run([*self.command, "-t"], capture_output=True, text=True, check=False)
        assert checked.returncode == 0 and "warn" not in checked.stderr, checked.stderr
        self.process = subprocess.Popen(self.command)
        self.trust = ssl.create_default_context(cafile=f"{folder}/cert")
        while self.process.poll() is None:
            try:
                socket.create_connection(("127.0.0.1", self.port)).close()
                return
            except ConnectionRefusedError:
                time.sleep(0.02)
        raise RuntimeError("nginx does not start")

    def connect(self):
        connection = http.client.HTTPSConnection(NAME, self.port, context=self.trust, timeout=60)
        # The name is nobody's; the proxy is here.
        connection._create_connection = lambda address, *rest: socket.create_connection(
            ("127.0.0.1", address[1]), *rest)
        return connection

    def ask(self, method, target, body=None, headers=None):
        connection = self.connect()
        try:
            connection.request(method, target, body=body, headers=headers or {})
            response = connection.getresponse()
            return response.status, response.read()
        finally:
            connection.close()

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(60)
        self.scratch.cleanup()


class Nginx(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server(PROGRAM, "--disk-reserve", "0", "--cores", "1", "--allow-host", NAME)
        cls.addClassCleanup(cls.server.__exit__)
        cls.proxy = Proxy(cls.server.port)
        cls.addClassCleanup(cls.proxy.stop)

    def submit(self, document, headers=None):
        return self.proxy.ask("POST", "/v1/jobs", json.dumps(document), headers)

    def test_passes_a_job_its_series_and_its_files(self):
        status, body = self.submit(scene(0.05))
        self.assertEqual(status, 202, body)
        job = json.loads(body)["id"]
        self.server.wait_for(job, "completed")
        status, body = self.proxy.ask("GET", f"/v1/jobs/{job}/sensors/P1?format=csv")
        self.assertEqual(status, 200)
        direct = self.server.ask("GET", f"/v1/jobs/{job}/sensors/P1?format=csv")
        self.assertEqual(body, direct.body)
        status, body = self.proxy.ask("GET", f"/v1/jobs/{job}/files/series.h5",
                                      headers={"Range": "bytes=1-3"})
        self.assertEqual((status, body), (206, b"HDF"))

    def test_passes_pages_of_the_same_origin_and_no_others(self):
        for origin, expected in ((f"https://{NAME}:{self.proxy.port}", 202),
                                 ("https://elsewhere.example.org", 403)):
            self.assertEqual(self.submit(scene(0.05), {"Origin": origin})[0], expected, origin)

    def test_passes_events_as_they_come(self):
        job = self.server.submit(scene(1e4, spacing=0.02, interval=1.0))
        connection = self.proxy.connect()
        connection.request("GET", f"/v1/jobs/{job}/events")
        response = connection.getresponse()
        # The job would go on for days, so only what is passed on at once can be read.
        lines = iter(response.readline, b"")
        self.assertTrue(any(line.startswith(b"event: started") for line in lines))
        self.assertTrue(any(line.startswith(b"event: progress") for line in lines))
        connection.close()
        self.proxy.ask("POST", f"/v1/jobs/{job}/cancel")
        self.server.wait_for(job, "cancelled")

    def test_gives_chunked_bodies_a_length(self):
        connection = self.proxy.connect()
        body = json.dumps(scene(0.05)).encode()
        connection.request("POST", "/v1/jobs", body=iter([body[:50], body[50:]]),
                           headers={"Transfer-Encoding": "chunked"}, encode_chunked=True)
        self.assertEqual(connection.getresponse().status, 202)
        connection.close()

    def test_leaves_it_to_the_service_to_say_what_is_too_large(self):
        status, body = self.proxy.ask("POST", "/v1/jobs", b" " * 300000)
        self.assertEqual(status, 413)
        self.assertEqual(json.loads(body)["status"], 413)


if __name__ == "__main__":
    PROGRAM, ROOT = os.path.abspath(sys.argv.pop(1)), sys.argv.pop(1)
    NGINX = shutil.which("nginx", path=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")
    if not NGINX or not shutil.which("openssl"):
        print("skipped: there is no nginx, or no openssl, here")
        sys.exit(SKIPPED)
    sys.path.insert(0, os.path.join(ROOT, "tests", "service"))
    from live import Server, scene
    unittest.main()
