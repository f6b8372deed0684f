"""What many sensors cost a run, everything included.

Usage: sensors.py SLUICE SCENES [--sensors N] [--interval S] [--end S] [--repeat R] [--threads T]

The recommended dam break without frames to END model seconds, with no sensor and with N pressure
sensors in the column, one sample each INTERVAL seconds. The cost is the time that a process takes
beside its engine's passes (sampling, series, checkpoints, digests, report), over the time in them,
with sensors less without: the median of R runs each, taken in turns. Both parts of such a ratio are
of one run and one clock, so that a machine that changes its speed between runs, and other work on
it, do not spoil it. Then the shares of the run's own account.
"""

import argparse
import json
import os
import statistics

from speed import PASSES, measured

ENGINE = [name for name in PASSES if name != "sample"]


def scene_with(scenes, arguments, count):
    with open(os.path.join(scenes, "dambreak.json"), encoding="utf-8") as stream:
        scene = json.load(stream)
    scene.pop("reference", None)
    scene["output"] = {}
    scene["end_time"] = arguments.end
    length, height = scene["fluid"][0]["size"]
    across = 40
    up = max(1, -(-count // across))
    scene["sensors"] = [
        {"name": f"s{i}", "kind": "pressure", "interval": arguments.interval,
         "position": [length * (i % across + 0.5) / across, height * (i // across + 0.5) / up]}
        for i in range(count)]
    return scene


def run(arguments, scene):
    """Time beside the engine's passes over the time in them, and the shares of the account."""
    outcome, _, seconds = measured(arguments.sluice, scene, ["--threads", str(arguments.threads)])
    passes = outcome["this_attempt"]["passes"]
    engine = sum(line["seconds"] for line in passes if line["name"] in ENGINE)
    shares = {line["name"]: line["share"] for line in passes}
    return seconds / engine - 1.0, shares


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sluice")
    parser.add_argument("scenes")
    parser.add_argument("--sensors", type=int, default=1000)
    parser.add_argument("--interval", type=float, default=1e-3)
    parser.add_argument("--end", type=float, default=0.5)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--threads", type=int, default=1)
    arguments = parser.parse_args()
    bare = scene_with(arguments.scenes, arguments, 0)
    many = scene_with(arguments.scenes, arguments, arguments.sensors)
    without, with_all, shares = [], [], []
    for _ in range(arguments.repeat):
        without.append(run(arguments, bare)[0])
        beside, share = run(arguments, many)
        with_all.append(beside)
        shares.append(share)
    cost = statistics.median(with_all) - statistics.median(without)
    print(f"{arguments.sensors} pressure sensors, a sample each {arguments.interval:g} s to "
          f"{arguments.end:g} s, {arguments.threads} thread(s), median of {arguments.repeat}")
    print(f"  cost: {100 * cost:.1f} % "
          f"(beside the engine {100 * statistics.median(with_all):.1f} % "
          f"with and {100 * statistics.median(without):.1f} % without)")
    for name in ("sample", "checkpoints", "output"):
        part = statistics.median(share[name] for share in shares)
        print(f"  {name:<12} {100 * part:5.1f} % of the run's time")


if __name__ == "__main__":
    main()
