"""Runs random scenes over the whole schema: each must end completed, or failed with a reason.

usage: random_scenes.py SLUICE SCHEMA [--count N] [--seed N]

A scene's numerics are drawn from the published schema, so that a term which is new there is drawn
too; shapes, units and sensors from random_scene.py. After each run its files are opened: a value
that is not finite, a state beyond the guards' limits that was kept, a particle that is in no
account, a series that goes back in time, a crash or a hang is a finding, printed with its scene.
"""

import argparse
import collections
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

import h5py
import numpy

from random_scene import random_scene

HANG = 300  # s
COMPLETED, INVALID, FAILED = 0, 3, 4


class Finding(Exception):
    """What a run must not do."""


def require(condition, text):
    if not condition:
        raise Finding(text)


def sluice(*arguments):
    try:
        return subprocess.run([*map(str, arguments)], text=True, capture_output=True, timeout=HANG)
    except subprocess.TimeoutExpired as error:
        raise Finding(f"{arguments[1]} hangs") from error


def check_refusal(program, path):
    """A scene that is not run must be told why and where."""
    result = sluice(program, "validate", path, "--json")
    problems = json.loads(result.stdout)["problems"]
    named = problems and all(p["message"] and p["pointer"].startswith("/") for p in problems)
    require(named, f"refused without a reason: {problems}")


def check_diagnosis(outcome):
    diagnosis = outcome["diagnosis"]
    require(outcome["reason"] and diagnosis, "failed without a reason")
    require(diagnosis["reason"] and diagnosis["suggestion"], f"diagnosis is empty: {diagnosis}")
    require(isinstance(diagnosis["step"], int), f"diagnosis names no step: {diagnosis}")


def check_particles(file, scene, started):
    fields = {name: data[:] for name, data in file["particles"].items()}
    for name, values in fields.items():
        require(numpy.isfinite(values).all(), f"{name} is not finite")
    ids = numpy.concatenate([fields["id"], file["retired/id"][:]])
    require(sorted(ids) == list(range(started["particles"])), "particles are lost or doubled")
    density = scene["material"]["density"]
    ratio = 1.0 + fields["density_excess"] / density
    require(ratio.size == 0 or (ratio.min() >= 0.7 and ratio.max() <= 1.3), "density beyond guards")
    if "sound_speed" in scene["material"]:
        speed = numpy.sqrt(sum(fields[axis] ** 2 for axis in ("vx", "vy", "vz") if axis in fields))
        require(speed.size == 0 or speed.max() <= scene["material"]["sound_speed"], "faster than c")


def check_series(file):
    for table in file["series"].values():
        names = list(table.attrs["names"])
        time, weight, values = (table[key][:] for key in ("time", "weight", "values"))
        require(numpy.isfinite(time).all() and (numpy.diff(time) > 0).all(), f"times of {names}")
        require(numpy.isfinite(weight).all(), f"weights of {names}")
        require(numpy.isfinite(values[weight > 0]).all(), f"values of {names} are not finite")


def check_energy(outcome):
    extremes = outcome["extremes"]
    require(all(math.isfinite(value) for value in extremes.values()), f"extremes: {extremes}")
    growth = extremes["highest_energy"] - extremes["initial_energy"]
    require(growth <= 0.05 * extremes["energy_scale"], "energy grew beyond the guard's limit")


def check_run(program, path, folder, scene):
    """Runs the scene and returns how it ended."""
    result = sluice(program, "run", path, "--folder", folder, "--threads", 1, "--progress", "json")
    if result.returncode == INVALID:
        check_refusal(program, path)
        return "refused"
    require(result.returncode in (COMPLETED, FAILED),
            f"exit code {result.returncode}: {result.stderr[-500:]}")
    outcome = json.loads((folder / "outcome.json").read_text())
    events = [json.loads(line) for line in result.stdout.splitlines()]
    started = next((event for event in events if event["event"] == "started"), None)
    checkpoints = sorted(folder.glob("checkpoint-*.h5"))
    for checkpoint in checkpoints:
        with h5py.File(checkpoint) as file:
            check_particles(file, scene, started)
            check_series(file)
    if result.returncode == FAILED:
        check_diagnosis(outcome)
        require(outcome["state"] == "failed", f"state {outcome['state']}")
        return outcome["diagnosis"]["reason"]
    require(checkpoints, "completed without a checkpoint")
    require(outcome["state"] == "completed" and outcome["time"] >= scene["end_time"], "not at its end")
    removed = outcome["removed"]
    require(outcome["particles"] + sum(removed.values()) == started["particles"],
            "alive + overtopped + leaked + excluded is not what started")
    check_energy(outcome)
    return "completed"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sluice")
    parser.add_argument("schema", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=25)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    schema = json.loads(arguments.schema.read_text())
    dice = random.Random(arguments.seed)
    ends = collections.Counter()
    findings = 0
    while sum(ends.values()) - ends["refused"] < arguments.count:
        scene = random_scene(dice, schema)
        with tempfile.TemporaryDirectory(prefix="sluice-random-") as name:
            path = pathlib.Path(name) / "scene.json"
            path.write_text(json.dumps(scene))
            try:
                ends[check_run(arguments.sluice, path, pathlib.Path(name) / "job", scene)] += 1
            except Finding as finding:
                findings += 1
                ends["finding"] += 1
                print(f"FINDING: {finding}\n  {json.dumps(scene)}", flush=True)
    for end, count in ends.most_common():
        print(f"{count:5} {end}")
    few = ends["completed"] < 0.3 * arguments.count
    if few:
        print("too few scenes ran to their end for this to show much")
    sys.exit(1 if findings or few else 0)


if __name__ == "__main__":
    main()
