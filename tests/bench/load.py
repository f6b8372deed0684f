"""How the service answers on loopback, idle and while two jobs run: see load.sh."""

import http.client
import json
import os
import platform
import re
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "service"))
from live import Server, scene  # noqa: E402

JOBS = 1000
SAMPLES = 15_000
INTERVAL = 0.001  # s of model time between samples, more than a step
CONNECTIONS = 4
UNITS = {"us": 1e-3, "ms": 1.0, "s": 1e3}  # in ms


def still_water(spacing=0.01, end_time=1e4, **more):
    """Stays at rest for longer than anyone looks on."""
    return {
        "name": "still", "tank": {"width": 0.6, "height": 0.6}, "gravity": [0, -9.81],
        "fluid": [{"shape": "rectangle", "corner": [0, 0], "size": [0.6, 0.3]}],
        "resolution": {"spacing": spacing},
        "numerics": {"scheme": "paper", "reinitialisation": None,
                     "integrator": "kick_drift_kick", "courant": 0.25,
                     "density_diffusion": {"kind": "fourtakas", "delta": 0.1},
                     "artificial_viscosity": {"alpha": 0.1}},
        "end_time": end_time, **more}


def machine():
    with open("/proc/cpuinfo", encoding="utf-8") as stream:
        name = re.search(r"model name\s*: (.*)", stream.read())
    load = os.getloadavg()[0]
    return (f"{name.group(1) if name else platform.processor()}, {os.cpu_count()} cores, "
            f"Linux {platform.release()}, load {load:.1f} before this began")


def line(what, rate, median, high, aim):
    verdict = "" if aim is None else f"  aim: p99 < {aim} ms, {'met' if high < aim else 'MISSED'}"
    print(f"{what:34} {rate:8.0f} /s   p50 {median:7.2f} ms   p99 {high:7.2f} ms{verdict}", flush=True)


def submit_many(server, count):
    """One after another on one connection, each answered once it would survive a power cut."""
    connection = http.client.HTTPConnection("127.0.0.1", server.port)
    body = json.dumps(scene())
    seconds = []
    for _ in range(count):
        begun = time.perf_counter()
        connection.request("POST", "/v1/jobs", body, {"Content-Type": "application/json"})
        answer = connection.getresponse()
        answer.read()
        seconds.append(time.perf_counter() - begun)
        assert answer.status == 202, answer.status
    connection.close()
    high = statistics.quantiles(seconds, n=100)[98]
    line(f"submit, {count} in a row", count / sum(seconds), 1e3 * statistics.median(seconds),
         1e3 * high, 10)


def wrk(server, what, target, aim, seconds):
    report = subprocess.run(
        ["wrk", "-t1", f"-c{CONNECTIONS}", f"-d{seconds}s", "--latency",
         f"http://127.0.0.1:{server.port}{target}"],
        check=True, capture_output=True, text=True).stdout
    assert "Non-2xx" not in report and "Socket errors" not in report, report

    def percentile(name):
        value, unit = re.search(rf"^\s+{name}%\s+([\d.]+)(us|ms|s)$", report, re.M).groups()
        return float(value) * UNITS[unit]

    rate = float(re.search(r"Requests/sec:\s+([\d.]+)", report).group(1))
    line(what, rate, percentile(50), percentile(99), aim)


def make_series(data):
    """The id of a completed job with SAMPLES samples."""
    with Server(sys.argv[1], data=data) as server:
        sensor = {"name": "P1", "kind": "pressure", "position": [0.6, 0.02], "interval": INTERVAL}
        job = server.submit(still_water(0.03, (SAMPLES - 1) * INTERVAL, sensors=[sensor]))
        server.wait_for(job, "completed")
        samples = server.ask("GET", f"/v1/jobs/{job}/sensors/P1").json()["samples"]
        assert abs(samples - SAMPLES) <= 1, samples
        return job


def measure(server, job, series, seconds):
    target = f"/v1/jobs/{series}/sensors/P1?filter=gaussian&tau=0.002"
    submit_many(server, JOBS)
    wrk(server, "status of a job", f"/v1/jobs/{job}", 5, seconds)
    wrk(server, f"list of {JOBS} jobs", f"/v1/jobs?limit={JOBS}", None, seconds)
    wrk(server, "list of 50 jobs", "/v1/jobs?limit=50", None, seconds)
    wrk(server, f"filtered series, {SAMPLES} samples", target, 30, seconds)
    wrk(server, "the same, 500 points", target + "&max_points=500", 30, seconds)


def main():
    program = sys.argv[1]
    seconds = int(sys.argv[2])
    print(machine())
    with tempfile.TemporaryDirectory(prefix="sluice-load-") as data:
        series = make_series(data)
        print(f"\n{CONNECTIONS} connections, {seconds} s each, no job runs")
        with Server(program, "--disk-reserve", "1000TB", data=data) as server:  # starts nothing
            measure(server, series, series, seconds)
        print(f"\n{CONNECTIONS} connections, {seconds} s each, two jobs running on one thread each")
        with Server(program, "--cores", "2", data=data) as server:
            running = [server.submit(still_water(), "?priority=1") for _ in range(2)]
            for job in running:
                server.wait_for(job, "running")
            measure(server, running[0], series, seconds)
            states = [server.ask("GET", f"/v1/jobs/{job}").json()["state"] for job in running]
            assert states == ["running", "running"], states


if __name__ == "__main__":
    main()
