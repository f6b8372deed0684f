"""Attacks a real server as strangers would and measures that it does not mind: resident memory stays
within 64 MiB of what it was, and healthy requests are answered within two seconds meanwhile.

Usage: attack.py SLUICE [SECONDS]      each attack goes on for SECONDS (default 3)

A program with a sanitizer is attacked, too, but its memory and speed are not judged.
"""

import json
import socket
import subprocess
import sys
import threading
import time

from live import Server, scene

MAX_GROWTH = 64 << 20  # bytes
MAX_SECONDS = 2.0


class Watch:
    """Asks healthy questions and reads the memory while an attack goes on."""

    def __init__(self, server, job):
        self.server, self.job = server, job
        self.slowest, self.peak, self.errors, self.count = 0.0, 0, [], 0
        self.over = threading.Event()
        self.thread = threading.Thread(target=self.look)

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.over.set()
        self.thread.join()

    def look(self):
        targets = (f"/v1/jobs/{self.job}", "/v1/jobs", "/readyz",
                   f"/v1/jobs/{self.job}/sensors/P1?filter=gaussian&tau=0.01&max_points=1000")
        while not self.over.is_set():
            start = time.monotonic()
            try:
                answer = self.server.ask("GET", targets[self.count % len(targets)])
                if answer.status != 200:
                    self.errors.append(f"status {answer.status}: {answer.body[:100]}")
            except OSError as error:
                self.errors.append(str(error))
            self.slowest = max(self.slowest, time.monotonic() - start)
            self.peak = max(self.peak, self.server.resident_bytes())
            self.count += 1
            time.sleep(0.02)


def connect(server):
    return socket.create_connection(("127.0.0.1", server.port), 10)


def pour(server, head, part, seconds, end=b""):
    """Sends `part` over and over until the server has enough; returns the status it answered."""
    stop = time.monotonic() + seconds
    with connect(server) as connection:
        try:
            connection.sendall(head)
            while time.monotonic() < stop:
                connection.sendall(part)
            connection.sendall(end)
        except OSError:
            pass
        try:
            answer = connection.recv(4096)
        except OSError:
            return 0
    return int(answer.split()[1]) if answer else 0


def repeat(action, seconds, threads=8):
    """Calls `action` from several threads for a while; returns all that it returned."""
    stop = time.monotonic() + seconds
    results = []

    def work():
        while True:
            results.append(action())
            if time.monotonic() >= stop:
                return

    workers = [threading.Thread(target=work) for _ in range(threads)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    return results


HEAD = b"POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\n"
GET = b"GET / HTTP/1.1\r\nHost: localhost\r\n"


def refused_with(status):
    return lambda results: all(result in (status, 0) for result in results) and status in results


def post(server, text, **headers):
    return server.ask("POST", "/v1/jobs", text, headers).status


def attack_chunked(server, _, seconds):
    return repeat(lambda: pour(server, HEAD + b"Transfer-Encoding: chunked\r\n\r\n",
                               b"ffff\r\n" + 0xffff * b"x" + b"\r\n", seconds), seconds)


def attack_gzip(server, _, seconds):
    return repeat(lambda: pour(
        server, HEAD + b"Content-Encoding: gzip\r\nContent-Length: 60000\r\n\r\n",
        60000 * b"\0", 0.1), seconds)


def attack_headers(server, _, seconds):
    return repeat(lambda: pour(server, GET, 1000 * b"X-Header: 1\r\n", seconds), seconds)


def attack_header_line(server, _, seconds):
    return repeat(lambda: pour(server, GET + b"X: ", 10000 * b"x", seconds), seconds)


def attack_ranges(server, job, seconds):
    text = "bytes=" + ",".join(1300 * ["0-0"])
    return repeat(lambda: server.ask("GET", f"/v1/jobs/{job}/files/series.h5",
                                     headers={"Range": text}).status, seconds)


def attack_paths(server, _, seconds):
    return repeat(lambda: server.ask("GET", "/" + 8191 * "a").status, seconds)


def read_slowly(server, job, seconds):
    """64 connections that ask for much and take nothing."""
    connections = []
    for _ in range(64):
        connection = socket.socket()
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        connection.connect(("127.0.0.1", server.port))
        connection.sendall(20 * f"GET /v1/jobs/{job}/sensors/P1 HTTP/1.1\r\nHost: localhost\r\n\r\n"
                           .encode())
        connections.append(connection)
    time.sleep(max(seconds, 12))
    for connection in connections:
        connection.close()


def attack_slowly(server, job, seconds):
    """64 connections that write a byte now and then, beside as many that do not read."""
    readers = threading.Thread(target=read_slowly, args=(server, job, seconds))
    readers.start()
    connections = [connect(server) for _ in range(64)]
    for connection in connections:
        connection.sendall(GET + b"X: ")
    stop = time.monotonic() + max(seconds, 12)
    statuses = []
    while connections and time.monotonic() < stop:
        for connection in list(connections):
            try:
                connection.sendall(b"x")
                connection.settimeout(0.001)
                answer = connection.recv(4096)
            except TimeoutError:
                continue
            except OSError:
                answer = b""
            if answer:
                statuses.append(int(answer.split()[1]))
            connections.remove(connection)
        time.sleep(0.2)
    for connection in connections:
        connection.close()
    readers.join()
    return statuses


def attack_streams(server, job, seconds):
    connections = [connect(server) for _ in range(64)]
    statuses = []
    for connection in connections:
        connection.sendall(f"GET /v1/jobs/{job}/events HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
        statuses.append(int(connection.recv(4096).split()[1]))
    time.sleep(seconds)
    for connection in connections:
        connection.close()
    return statuses


def attack_waits(server, job, seconds):
    connections = [connect(server) for _ in range(64)]
    for connection in connections:
        connection.sendall(
            f"GET /v1/jobs/{job}?wait=60 HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
    time.sleep(seconds)
    for connection in connections:
        connection.close()
    return [200]


def attack_never_reading(server, _, seconds):
    """400 connections, each with six requests for 100 kB."""
    connections = []
    for _ in range(400):
        connection = connect(server)
        connection.sendall(6 * b"GET /openapi.json HTTP/1.1\r\nHost: localhost\r\n\r\n")
        connections.append(connection)
    time.sleep(seconds)
    for connection in connections:
        connection.close()
    return [200]


def attack_without_body(server, _, seconds):
    return repeat(lambda: pour(server, HEAD + b"\r\n", b"", 0), seconds)


def attack_deep_json(server, _, seconds):
    return repeat(lambda: post(server, 32000 * "[" + 32000 * "]"), seconds)


def attack_deeper_json(server, _, seconds):
    return repeat(lambda: pour(server, HEAD + b"Content-Length: 400000\r\n\r\n",
                               200000 * b"[", 0.1), seconds)


def attack_numbers(server, _, seconds):
    def replace(value):
        if isinstance(value, dict):
            return {key: replace(member) for key, member in value.items()}
        if isinstance(value, list):
            return [replace(member) for member in value]
        return value if isinstance(value, (str, bool)) else 1e308
    text = json.dumps(replace(scene()))
    return repeat(lambda: post(server, text), seconds)


def attack_particles(server, _, seconds):
    text = json.dumps(scene(spacing=4.2e-7))  # 0.18 m^2 in 1e12 cells
    return repeat(lambda: post(server, text), seconds)


def attack_forged(server, _, seconds):
    return repeat(lambda: server.ask(
        "GET", "/livez", headers={"REMOTE_ADDR": "10.0.0.1", "X-Forwarded-For": "10.0.0.1"}).status,
        seconds)


def attack_traversal(server, job, seconds):
    names = ("..%2f..%2fjobs.sqlite", "%2e%2e/%2e%2e/jobs.sqlite", "..%5c..%5cjobs.sqlite", "lock",
             "%2fetc%2fpasswd", "....//lock")
    return [status for name in names for status in repeat(
        lambda: server.ask("GET", f"/v1/jobs/{job}/files/{name}").status,  # noqa: B023
        seconds / len(names))]


def attack_host(server, _, seconds):
    return repeat(lambda: server.ask("POST", "/v1/jobs", scene(),
                                     {"Host": "evil.example"}).status, seconds)


def attack_one_key(server, _, _seconds):
    barrier = threading.Barrier(100)
    ids = []

    def submit():
        barrier.wait()
        answer = server.ask("POST", "/v1/jobs", scene(), {"Idempotency-Key": "attack"})
        ids.append(answer.json().get("id", answer.status))

    threads = [threading.Thread(target=submit) for _ in range(100)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    listed = server.ask("GET", "/v1/jobs?limit=1000").json()["jobs"]
    return [len(ids), len(set(ids)), sum(job["id"] == ids[0] for job in listed)]


def attack_port(server, _, __):
    second = subprocess.run(
        [server.process.args[0], "serve", "--data", server.data + "2", "--port", str(server.port)],
        capture_output=True, text=True, timeout=60, check=False)
    return [second.returncode]


ATTACKS = (
    ("chunked bodies without end", attack_chunked, refused_with(501)),
    ("gzip bodies", attack_gzip, refused_with(415)),
    ("200 000 headers and more", attack_headers, refused_with(431)),
    ("one endless header line", attack_header_line, refused_with(431)),
    ("1300 ranges", attack_ranges, refused_with(416)),
    ("8 KiB paths", attack_paths, refused_with(414)),
    ("64 that write slowly, 64 that do not read", attack_slowly, refused_with(408)),
    ("64 event streams", attack_streams,
     lambda found: found.count(200) <= 16 and found.count(503) >= 48),
    ("64 long polls", attack_waits, refused_with(200)),
    ("400 that never read", attack_never_reading, refused_with(200)),
    ("POST without a body", attack_without_body, refused_with(422)),
    ("JSON 32 000 deep", attack_deep_json, refused_with(422)),
    ("JSON 200 000 deep", attack_deeper_json, refused_with(413)),
    ("1e308 everywhere", attack_numbers, refused_with(422)),
    ("1e12 particles", attack_particles, refused_with(422)),
    ("forged REMOTE_ADDR", attack_forged, refused_with(200)),
    ("..%2f", attack_traversal, refused_with(404)),
    ("a wrong Host", attack_host, refused_with(403)),
    ("100 submits with one key", attack_one_key, lambda found: found == [100, 1, 1]),
    ("a second server on the port", attack_port, lambda found: found == [2]),
)


def main():
    seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 3.0
    failures = 0
    with Server(sys.argv[1], "--cores", "1", "--disk-reserve", "0", "--access-log",
                "none") as server:
        job = server.submit(scene(10.0, interval=0))
        server.wait_for(job, "completed")
        running = server.submit(scene(1e4, spacing=0.01, interval=1.0))
        server.wait_until("the job to run", lambda: server.ask(
            "GET", f"/v1/jobs/{running}").json()["progress"])
        for _ in range(20):
            server.ask("GET", f"/v1/jobs/{job}/sensors/P1?filter=gaussian&tau=0.01")
        idle = server.resident_bytes()
        print(f"idle: {idle / 2**20:.1f} MiB resident")
        print(f"{'attack':<42} {'done':>6} {'MiB more':>9} {'healthy':>8} {'slowest s':>10}")
        for name, attack, verdict in ATTACKS:
            target = running if attack in (attack_streams, attack_waits) else job
            with Watch(server, job) as watch:
                found = attack(server, target, seconds)
            growth = watch.peak - idle
            bad = [] if verdict(found) else [f"answers {sorted(set(found))}"]
            bad += watch.errors[:3]
            if not server.is_sanitized():
                bad += ["too much memory"] if growth > MAX_GROWTH else []
                bad += ["too slow"] if watch.slowest > MAX_SECONDS else []
            print(f"{name:<42} {len(found):>6} {growth / 2**20:>9.1f} {watch.count:>8} "
                  f"{watch.slowest:>10.3f}  {'; '.join(bad) or 'ok'}", flush=True)
            failures += bool(bad)
        server.ask("POST", f"/v1/jobs/{running}/cancel")
    print(f"{len(ATTACKS)} attacks, {failures} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
