"""Speed and memory of whole runs as one table.

Usage: speed.py SLUICE SCENES [--particles N,N...] [--threads N,N+N...] [--seconds S]
                [--repeat R] [--simd TARGET] [--precision P,P...] [--scheme NAME]

For each scene (the paper's and the recommended scheme), each number of particles, precision and
number of threads: million fluid-particle steps per second, the median of R runs taken in turns
(machines are noisy: compare lines of one table only), bytes per particle, and the share of each
pass. All of a run is included but the checkpoint at its end, which takes a run of seconds as long
as one of hours. A run starts as the scene does and is stopped after about S seconds of a core's
work: the same step for any number of threads, for the flow decides how often lists are made. (In
the first part of a dam break, that is; whole cases: run.sh case.)
Threads 1+1 are two runs side by side, their speeds added: what the machine's cores can do together,
and so the most that two threads of one run could reach.
"""

import argparse
import copy
import json
import math
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

PASSES = ["sort", "wall_pressure", "pair_sums", "reinitialisation", "update", "sample"]
SCENES = ["dambreak-paper.json", "dambreak.json"]
ROUGH_RATE = 1.5e7  # fluid-particle steps per second of a core, to choose the number of steps


def numbers(text):
    return [int(float(word)) for word in text.split(",")]


def side_by_side(text):
    return [[int(word) for word in runs.split("+")] for runs in text.split(",")]


def processor():
    with open("/proc/cpuinfo", encoding="ascii", errors="replace") as stream:
        for line in stream:
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.machine()


def resized(scene, particles):
    """The scene with about so many fluid particles; sensors sample as often per step as before."""
    scene = copy.deepcopy(scene)
    length, height = scene["fluid"][0]["size"]
    across = max(1, round(math.sqrt(particles * height / length)))
    spacing = height / across
    scale = spacing / scene["resolution"]["spacing"]
    scene["resolution"]["spacing"] = spacing
    for sensor in scene["sensors"]:
        sensor["interval"] *= scale
    scene["output"] = {}
    return scene


def measured(program, scene, options):
    """Runs a scene in a folder of its own: its outcome, what the process used, and how long it took."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.json")
        job = os.path.join(folder, "job")
        with open(path, "w", encoding="utf-8") as out:
            json.dump(scene, out)
        command = [program, "run", path, "--folder", job, "--progress", "none", *options]
        with open(os.path.join(folder, "said"), "w+", encoding="utf-8") as said:
            start = time.perf_counter()
            child = subprocess.Popen(command, stdout=said, stderr=said)
            _, status, usage = os.wait4(child.pid, 0)
            seconds = time.perf_counter() - start
            child.returncode = os.waitstatus_to_exitcode(status)
            if child.returncode not in (0, 85):
                said.seek(0)
                sys.exit(f"{' '.join(command)} ended with {child.returncode}: {said.read()}")
        with open(os.path.join(job, "outcome.json"), encoding="utf-8") as stream:
            return json.load(stream), usage, seconds


def run(program, scene, threads, seconds, simd):
    length, height = scene["fluid"][0]["size"]
    particles = length * height / scene["resolution"]["spacing"] ** 2
    steps = max(40, round(seconds * ROUGH_RATE / particles))
    options = ["--threads", str(threads), "--no-checkpoint", "--stop-after-step", str(steps)]
    return measured(program, scene, options + (["--simd", simd] if simd else []))[0]


def speed_of(attempt):
    checkpoints = sum(p["seconds"] for p in attempt["passes"] if p["name"] == "checkpoints")
    return attempt["particle_steps"] / (attempt["seconds"] - checkpoints)


def speed_together(program, scene, threads, options):
    """Of runs with so many threads each, begun at once: (fluid-particle steps/s, an outcome)."""
    with ThreadPoolExecutor() as pool:
        outcomes = list(pool.map(
            lambda each: run(program, scene, each, options.seconds, options.simd), threads))
    return sum(speed_of(o["this_attempt"]) for o in outcomes), outcomes[-1]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("scenes")
    parser.add_argument("--particles", type=numbers, default=numbers("2e4,1e5,5e5,2e6"))
    parser.add_argument("--threads", type=side_by_side, default=[[1], [2], [1, 1]])
    parser.add_argument("--seconds", type=float, default=5.0)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--simd", default="")
    parser.add_argument("--precision", type=lambda text: text.split(","),
                        default=["mixed", "double"])
    parser.add_argument("--scheme", type=lambda text: [text + ".json"], default=SCENES)
    options = parser.parse_args()

    cases = []
    for name in options.scheme:
        with open(os.path.join(options.scenes, name), encoding="utf-8") as stream:
            scene = json.load(stream)
        for particles in options.particles:
            for precision in options.precision:
                sized = resized(scene, particles)
                sized["numerics"]["precision"] = precision
                for threads in options.threads:
                    cases.append((name, precision, threads, sized, []))
    for _ in range(options.repeat):
        for _, _, threads, scene, outcomes in cases:
            outcomes.append(speed_together(options.program, scene, threads, options))

    print(f"{processor()}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}; median of "
          f"{options.repeat}; million fluid-particle steps per second, all but the last checkpoint "
          "included")
    print(f"{'scene':<22}{'particles':>10} {'sums':<7}{'threads':>7} {'target':<6}{'M/s':>7}"
          f"{'B/particle':>11}" + "".join(f"{name[:9]:>10}" for name in PASSES))
    for name, precision, threads, _, outcomes in cases:
        rate = statistics.median(speed for speed, _ in outcomes)
        _, last = outcomes[-1]
        bytes_each = last["this_attempt"]["engine_bytes"] / last["particles"]
        share = {p["name"]: p["share"] for p in last["this_attempt"]["passes"]}
        print(f"{name:<22}{last['particles']:>10} {precision:<7}"
              f"{'+'.join(map(str, threads)):>7} "
              f"{last['simd_target']:<6}{rate * 1e-6:>7.2f}{bytes_each:>11.0f}"
              + "".join(f"{100 * share.get(p, 0):>8.1f} %" for p in PASSES), flush=True)


if __name__ == "__main__":
    main()
