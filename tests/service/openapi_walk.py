"""Walks schemas/openapi.json against a real server: every answer is one that the document
describes, and validates; every answer that it describes is provoked.

Usage: openapi_walk.py SLUICE ROOT
"""

import json
import os
import re
import signal
import socket
import sys
import time

import jsonschema
from live import Answer, Server, scene

METHODS = ("get", "post", "delete")
# What no request can bring about in a healthy server: unit tests provoke these.
NOT_HERE = {"internal", "damaged-files", "overloaded", "not-ready", "disk-full"}
# What the connection answers before a route is looked for: the same on every path.
TRANSPORT = {"bad-request", "request-timeout", "body-too-large", "uri-too-long",
             "unsupported-media-type", "headers-too-large", "not-implemented"}


class Walk:
    def __init__(self, document, schemas):
        self.document = document
        self.schemas = schemas  # by their paths
        self.seen = set()  # (operation, status, problem slug or "")
        self.failures = []

    def resolve(self, node):
        while "$ref" in node:
            target = self.document
            for part in node["$ref"].removeprefix("#/").split("/"):
                target = target[part]
            node = target
        return node

    def operations(self):
        for path, item in self.document["paths"].items():
            for method in METHODS:
                if method in item:
                    yield path, method, item[method]

    def find(self, method, target):
        path = target.split("?")[0]
        for pattern, known, operation in self.operations():
            if known == method.lower() and re.fullmatch(
                    re.sub(r"\{[^}]+\}", "[^/]+", pattern), path):
                return operation
        raise AssertionError(f"{method} {path} is not in the document")

    def validate(self, schema, value):
        resolver = jsonschema.RefResolver("", self.document, store=self.schemas)
        jsonschema.Draft202012Validator(schema, resolver=resolver).validate(value)

    def check(self, method, target, answer):
        """Holds an answer against the document and notes that it was seen."""
        operation = self.find(method, target)
        name = operation["operationId"]
        where = f"{name} {target} -> {answer.status}"
        described = operation["responses"].get(str(answer.status))
        if described is None:
            self.failures.append(f"{where}: status is not described: {answer.body[:200]}")
            return answer
        described = self.resolve(described)
        slug = ""
        try:
            for header in ("ETag", "Location", "Content-Range", "Accept-Ranges"):
                if header in described.get("headers", {}) and header.lower() not in answer.headers:
                    raise AssertionError(f"header {header} is missing")
            content = described.get("content")
            kind = answer.headers.get("content-type", "").split(";")[0]
            if not content:
                assert not answer.body, "a body that is not described"
            elif answer.body or answer.status != 200:
                assert kind in content, f"content type {kind} is not described"
                if kind.endswith("json") and kind != "application/x-ndjson":
                    if answer.status != 206:
                        self.validate(content[kind]["schema"], answer.json())
                if kind == "application/problem+json":
                    slug = answer.json()["type"].removeprefix("/problems/")
        except (AssertionError, ValueError, jsonschema.ValidationError) as error:
            self.failures.append(f"{where}: {str(error)[:600]}")
        self.seen.add((name, str(answer.status), slug))
        return answer

    def ask(self, server, method, target, body=None, headers=None):
        return self.check(method, target, server.ask(method, target, body, headers))

    def missing(self):
        """Answers that are described but were not seen."""
        transport = {slug for _, _, slug in self.seen}
        for _, _, operation in self.operations():
            for status, described in operation["responses"].items():
                content = self.resolve(described).get("content", {})
                problem = content.get("application/problem+json")
                if problem is None:
                    if (operation["operationId"], status, "") not in self.seen:
                        yield f"{operation['operationId']} {status}"
                    continue
                for uri in problem["schema"]["allOf"][1]["properties"]["type"]["enum"]:
                    slug = uri.removeprefix("/problems/")
                    if slug in NOT_HERE or (slug in TRANSPORT and slug in transport):
                        continue
                    if (operation["operationId"], status, slug) not in self.seen:
                        yield f"{operation['operationId']} {status} {slug}"


def broken_references(node, document, files):
    """The references that lead nowhere in the file itself and those beside it."""
    if isinstance(node, dict):
        reference = node.get("$ref")
        if isinstance(reference, str):
            file, _, pointer = reference.partition("#")
            target = files.get(file) if file else document
            for part in pointer.split("/")[1:]:
                part = part.replace("~1", "/").replace("~0", "~")
                target = target.get(part) if isinstance(target, dict) else None
            if target is None:
                yield reference
        node = list(node.values())
    if isinstance(node, list):
        for part in node:
            yield from broken_references(part, document, files)


def raw(server, text, linger=b""):
    """Sends bytes as they are and reads one answer."""
    with socket.create_connection(("127.0.0.1", server.port), 60) as connection:
        connection.sendall(text)
        if linger:
            connection.sendall(linger)
        received = b""
        while True:
            part = connection.recv(65536)
            if not part:
                break
            received += part
    head, _, body = received.partition(b"\r\n\r\n")
    lines = head.decode("latin-1").split("\r\n")
    return Answer(int(lines[0].split()[1]), [line.split(": ", 1) for line in lines[1:]], body)


def fill(path, job):
    if path.startswith("/v1/studies/"):
        job = "s" + job[1:]
    return (path.replace("{id}", job).replace("{slug}", "no-such-job")
            .replace("sensors/{name}", "sensors/P1").replace("files/{name}", "files/scene.json")
            .replace("schemas/{name}", "schemas/scene"))


def walk_every_operation(walk, server, guarded, job):
    """What any operation can answer, whatever it does."""
    for path, method, _ in list(walk.operations()):
        method = method.upper()
        target = fill(path, job)
        walk.ask(server, method, target + "?nonsense=1", "")
        walk.ask(server, method, target, "", {"Host": "evil.example"})
        if "{id}" in path:
            walk.ask(server, method, fill(path, "j" + 20 * "0"))
        if method != "GET":
            walk.ask(server, method, target, "", {"Origin": "http://evil.example"})
        if path not in ("/livez", "/readyz"):
            walk.ask(guarded, method, target)
        for line in (b"Content-Encoding: gzip", b"Transfer-Encoding: chunked",
                     b"Content-Length: 262145", b"Content-Length: x", 101 * b"X: y\r\n" + b"X: y"):
            walk.check(method, target, raw(server, b"%s %s HTTP/1.1\r\nHost: localhost\r\n%s\r\n\r\n"
                                           % (method.encode(), target.encode(), line)))
        walk.check(method, target, raw(
            server, b"%s %s?%s HTTP/1.1\r\nHost: localhost\r\n\r\n"
            % (method.encode(), target.encode(), 5000 * b"a")))
    walk.check("GET", "/livez", raw(server, b"GET /livez HTTP/1.1\r\n"))  # after ten seconds


def walk_meta(walk, server):
    for target in ("/", "/openapi.json", "/livez", "/readyz", "/metrics", "/v1/schemas",
                   "/v1/schemas/scene", "/v1/schemas/study", "/v1/schemas/none", "/problems/none"):
        walk.ask(server, "GET", target)
    for name in walk.document["components"]["schemas"]["Problem"]["properties"]["type"]["enum"]:
        walk.ask(server, "GET", name)


def walk_submissions(walk, server):
    walk.ask(server, "POST", "/v1/jobs?dry_run=1", scene())
    walk.ask(server, "POST", "/v1/jobs", "{}")
    walk.ask(server, "POST", "/v1/jobs", scene(spacing=0.0005))
    walk.ask(server, "POST", "/v1/jobs", "<scene/>", {"Content-Type": "text/xml"})
    key = {"Idempotency-Key": "walk"}
    first = walk.ask(server, "POST", "/v1/jobs?label=walk", scene(), key).json()["id"]
    assert walk.ask(server, "POST", "/v1/jobs?label=walk", scene(), key).json()["id"] == first
    walk.ask(server, "POST", "/v1/jobs", scene(0.2), key)
    return first


def study(**more):
    """Two tiny runs."""
    return {"name": "walk", "scene": scene(), "targets": [0.5],
            "vary": [{"key": "/end_time", "values": [0.05, 0.1]}], **more}


def walk_study(walk, server):
    walk.ask(server, "POST", "/v1/studies?dry_run=1", study())
    walk.ask(server, "POST", "/v1/studies", "{}")
    walk.ask(server, "POST", "/v1/studies", study(threads=1000))
    walk.ask(server, "POST", "/v1/studies", "<study/>", {"Content-Type": "text/xml"})
    key = {"Idempotency-Key": "walk-study"}
    made = walk.ask(server, "POST", "/v1/studies", study(), key).json()
    target = f"/v1/studies/{made['id']}"
    assert walk.ask(server, "POST", "/v1/studies", study(), key).json()["id"] == made["id"]
    walk.ask(server, "POST", "/v1/studies?priority=1", study(), key)
    for run in made["runs"]:
        server.wait_for(run["job"], "completed")
    for query in ("", "?format=json", "?format=markdown", "?format=csv", "?format=svg",
                  "?format=pdf"):
        walk.ask(server, "GET", target + query)
    walk.ask(server, "GET", "/v1/studies?limit=1")
    walk.ask(server, "POST", target + "/cancel")
    walk.ask(server, "DELETE", target)
    walk.ask(server, "GET", target)


def walk_open_study(walk, server):
    """With room in the queue and the only core taken: a study that waits, or does not fit."""
    many = {"key": "/end_time", "values": [0.01, 0.02, 0.03, 0.04]}
    walk.ask(server, "POST", "/v1/studies", study(vary=[many]))
    made = walk.ask(server, "POST", "/v1/studies?priority=1", study()).json()["id"]
    walk.ask(server, "DELETE", f"/v1/studies/{made}")
    walk.ask(server, "POST", f"/v1/studies/{made}/cancel")


def walk_running_study(walk, server):
    """A study whose job runs: its cancel has to wait for the worker."""
    endless = study(scene=scene(1000.0, spacing=0.01, interval=0.1), vary=[])
    made = walk.ask(server, "POST", "/v1/studies", endless).json()
    server.wait_until("the study's job to run", lambda: server.ask(
        "GET", f"/v1/jobs/{made['runs'][0]['job']}").json()["progress"])
    worker = server.workers()[0]
    os.kill(worker, signal.SIGSTOP)
    try:
        walk.ask(server, "POST", f"/v1/studies/{made['id']}/cancel")
    finally:
        os.kill(worker, signal.SIGCONT)
    while server.ask("GET", f"/v1/studies/{made['id']}").json()["state"] != "ended":
        time.sleep(0.05)


def walk_queue(walk, server, running):
    """With the only core taken by `running`: jobs that wait, and the end of the queue."""
    waiting = walk.ask(server, "POST", "/v1/jobs", scene()).json()["id"]
    while walk.ask(server, "POST", "/v1/jobs", scene()).status == 202:
        pass
    job = f"/v1/jobs/{waiting}"
    walk.ask(server, "GET", job + "/sensors/P1")
    walk.ask(server, "GET", job + "/report")
    walk.ask(server, "DELETE", job)
    walk.ask(server, "POST", job + "/checkpoint")
    walk.ask(server, "POST", job + "/pause")
    walk.ask(server, "POST", job + "/resume")
    walk.ask(server, "POST", job + "/cancel")
    walk.ask(server, "POST", job + "/pause")
    walk.ask(server, "POST", job + "/resume")
    walk.ask(server, "POST", job + "/cancel")
    walk.ask(server, "DELETE", job)
    walk.ask(server, "POST", f"/v1/jobs/{running}/checkpoint")


def walk_streams(walk, server, running):
    target = f"/v1/jobs/{running}/events"
    connections = []
    for _ in range(16):
        connection = socket.create_connection(("127.0.0.1", server.port), 60)
        connection.sendall(f"GET {target} HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
        assert b"200 OK" in connection.recv(4096)
        connections.append(connection)
    walk.ask(server, "GET", target)
    for connection in connections:
        connection.close()


def walk_ended_job(walk, server, done):
    job = f"/v1/jobs/{done}"
    shown = walk.ask(server, "GET", job)
    walk.ask(server, "GET", job, headers={"If-None-Match": shown.headers["etag"]})
    walk.ask(server, "GET", "/v1/jobs?limit=1&state=completed")
    events = walk.ask(server, "GET", job + "/events")
    last = re.findall(rb"id: (\d+)", events.body)[-1].decode()
    walk.ask(server, "GET", job + "/events", headers={"Last-Event-ID": last})
    walk.ask(server, "GET", job + "/sensors")
    for query in ("", "?format=json", "?format=markdown", "?format=html", "?format=pdf"):
        walk.ask(server, "GET", job + "/report" + query)
    sensor = job + "/sensors/P1"
    for query in ("", "?filter=gaussian&tau=0.01&from=0.1&to=0.5&max_points=50", "?format=csv",
                  "?dimensionless=1", "?filter=gaussian&tau=100000"):
        walk.ask(server, "GET", sensor + query)
    walk.ask(server, "GET", sensor, headers={"Accept": "image/png"})
    walk.ask(server, "GET", job + "/sensors/none")
    walk.ask(server, "GET", job + "/files/none")
    for target in (job + "/log", *(file["href"] for file in walk.ask(
            server, "GET", job + "/files").json()["files"])):
        whole = walk.ask(server, "GET", target)
        walk.ask(server, "GET", target, headers={"Range": "bytes=0-9"})
        walk.ask(server, "GET", target, headers={"Range": "bytes=999999999-"})
        walk.ask(server, "GET", target, headers={"If-None-Match": whole.headers["etag"]})
    for body in ({"end_time": 1e12}, {"end_time": "x"}):
        walk.ask(server, "POST", job + "/resume", body)
    walk.ask(server, "POST", job + "/cancel")
    walk.ask(server, "POST", job + "/resume")
    walk.ask(server, "POST", job + "/resume", {"end_time": 12.5})


def walk_stop(walk, server, running):
    """While a worker that cannot move keeps the service from stopping."""
    worker = server.workers()[0]
    os.kill(worker, signal.SIGSTOP)
    try:
        walk.ask(server, "POST", f"/v1/jobs/{running}/pause")
        walk.ask(server, "POST", f"/v1/jobs/{running}/cancel")
        server.tell_to_stop()
        server.wait_until("the service to drain",
                          lambda: server.ask("GET", "/readyz").status == 503)
        for path, method, _ in list(walk.operations()):
            if method != "get" or path.endswith(("/events", "/readyz")):
                walk.ask(server, method.upper(), fill(path, running))
    finally:
        os.kill(worker, signal.SIGCONT)


def refuse_unknown(server, failures):
    """Every path answers HEAD and OPTIONS, and refuses other methods and other paths."""
    for path in json.loads(server.ask("GET", "/openapi.json").body)["paths"]:
        target = fill(path, "j" + 20 * "0")
        options = server.ask("OPTIONS", target)
        if options.status != 204 or "OPTIONS" not in options.headers.get("allow", ""):
            failures.append(f"OPTIONS {target}: {options.status}")
        other = server.ask("PATCH", target)
        if other.status != 405 or other.json()["type"] != "/problems/method-not-allowed":
            failures.append(f"PATCH {target}: {other.status}")
        lost = server.ask("GET", target.rstrip("/") + "/nothing/here")
        if lost.status != 404 or lost.json()["type"] != "/problems/not-found":
            failures.append(f"GET {target}/nothing/here: {lost.status}")


def main():
    program, root = sys.argv[1:3]
    with open(os.path.join(root, "schemas/openapi.json"), encoding="utf-8") as stream:
        document = json.load(stream)
    schemas = {}
    for name in ("scene", "study"):
        with open(os.path.join(root, f"schemas/{name}.schema.json"), encoding="utf-8") as stream:
            schemas[f"{name}.schema.json"] = json.load(stream)
    broken = list(broken_references(document, document, schemas))
    assert not broken, broken
    walk = Walk(document, schemas)
    for path, method, operation in walk.operations():
        body = operation.get("requestBody", {}).get("content", {}).get("application/json", {})
        if path == "/v1/jobs" and method == "post":
            walk.validate({"$ref": "scene.schema.json"}, body["example"])
        if path == "/v1/studies" and method == "post":
            walk.validate({"$ref": "study.schema.json"}, body["example"])

    with Server(program, "--cores", "1", "--max-queued", "3", "--max-particles", "100000",
                "--max-disk", "100000000", "--disk-reserve", "0") as server:
        token = os.path.join(server.scratch.name, "token")
        with open(os.open(token, os.O_CREAT | os.O_WRONLY, 0o600), "w", encoding="ascii") as out:
            out.write(32 * "t")
        served = server.ask("GET", "/openapi.json").body.decode()
        for name in ("scene", "study"):
            assert server.ask("GET", f"/v1/schemas/{name}").json() == schemas[f"{name}.schema.json"]
            served = served.replace(f'"/v1/schemas/{name}"', f'"{name}.schema.json"')
        # Only how it names the schemas differs, and in descriptions no path of theirs stands alone.
        assert json.loads(served) == document
        done = server.submit(scene(12.0, interval=0, scales={"height": 0.3, "width": 0.6}))
        with Server(program, "--token-file", token) as guarded:
            walk_every_operation(walk, server, guarded, done)
        refuse_unknown(server, walk.failures)
        walk_meta(walk, server)
        extra = walk_submissions(walk, server)
        server.wait_for(done, "completed")
        server.wait_for(extra, "completed")
        walk.ask(server, "GET", f"/v1/jobs/{extra}/sensors/P1?dimensionless=1")
        walk.ask(server, "POST", f"/v1/jobs/{extra}/resume", {"end_time": 1e4})  # 1e7 samples
        walk_ended_job(walk, server, done)
        server.wait_for(done, "completed")
        walk_study(walk, server)
        walk_running_study(walk, server)
        running = server.submit(scene(1000.0, spacing=0.01, interval=0.1))
        server.wait_until("the job to run", lambda: server.ask(
            "GET", f"/v1/jobs/{running}").json()["progress"])
        walk_open_study(walk, server)
        walk_queue(walk, server, running)
        walk_streams(walk, server, running)
        walk_stop(walk, server, running)

    failures = walk.failures + [f"not seen: {missing}" for missing in walk.missing()]
    for failure in failures:
        print(failure)
    print(f"{len(walk.seen)} kinds of answers seen, {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
