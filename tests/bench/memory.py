"""The most memory that runs take at once, against what `sluice plan` says, as one table.

Usage: memory.py SLUICE SCENES [--particles N,N...] [--steps S]

For each scene (the paper's and the recommended scheme), precision and number of particles: the
largest resident set of a run of S steps with its checkpoints, per fluid particle too, and the part
of the estimate that it is. The estimate is what the service compares with the memory of a job.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile

from speed import SCENES, numbers, resized


def planned(program, path):
    """Bytes that the plan of a scene states."""
    said = subprocess.run([program, "plan", path, "--json", "--no-calibration"], capture_output=True, text=True,
                          check=True)
    return json.loads(said.stdout)["estimate"]["memory_bytes"]


def resident(program, path, job, steps):
    """Largest resident set of a run, bytes."""
    command = [program, "run", path, "--folder", job, "--progress", "none", "--stop-after-step",
               str(steps)]
    with open(os.devnull, "w", encoding="utf-8") as nowhere:
        child = subprocess.Popen(command, stdout=nowhere, stderr=nowhere)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode not in (0, 85):
        sys.exit(f"memory.py: {' '.join(command)} ended with {child.returncode}")
    return 1024 * usage.ru_maxrss


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sluice")
    parser.add_argument("scenes")
    parser.add_argument("--particles", type=numbers, default=[20_000, 200_000, 1_000_000])
    parser.add_argument("--steps", type=int, default=40)
    arguments = parser.parse_args()
    print(f"largest resident set of {arguments.steps} steps with checkpoints")
    print(f"{'scheme':<16} {'precision':<9} {'particles':>9} {'MB':>7} {'B/particle':>10} "
          f"{'of plan':>8}")
    for name in SCENES:
        for precision in ("mixed", "double"):
            for particles in arguments.particles:
                with open(os.path.join(arguments.scenes, name), encoding="utf-8") as stream:
                    scene = resized(json.load(stream), particles)
                scene["numerics"]["precision"] = precision
                with tempfile.TemporaryDirectory() as folder:
                    path = os.path.join(folder, "scene.json")
                    with open(path, "w", encoding="utf-8") as out:
                        json.dump(scene, out)
                    most = resident(arguments.sluice, path, os.path.join(folder, "job"),
                                    arguments.steps)
                    plan = planned(arguments.sluice, path)
                print(f"{re.sub('.json$', '', name):<16} {precision:<9} {particles:>9} "
                      f"{most / 1e6:>7.0f} {most / particles:>10.0f} {most / plan:>8.2f}", flush=True)


if __name__ == "__main__":
    main()
