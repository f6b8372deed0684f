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
import tempfile

from speed import SCENES, measured, numbers, resized


def planned(program, scene):
    """Bytes that the plan of a scene states."""
    with tempfile.NamedTemporaryFile("w", suffix=".json", encoding="utf-8") as out:
        json.dump(scene, out)
        out.flush()
        said = subprocess.run([program, "plan", out.name, "--json", "--no-calibration"],
                              capture_output=True, text=True, check=True)
    return json.loads(said.stdout)["estimate"]["memory_bytes"]


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
                _, usage, _ = measured(arguments.sluice, scene,
                                       ["--stop-after-step", str(arguments.steps)])
                most = 1024 * usage.ru_maxrss
                plan = planned(arguments.sluice, scene)
                print(f"{re.sub('.json$', '', name):<16} {precision:<9} {particles:>9} "
                      f"{most / 1e6:>7.0f} {most / particles:>10.0f} {most / plan:>8.2f}",
                      flush=True)


if __name__ == "__main__":
    main()
