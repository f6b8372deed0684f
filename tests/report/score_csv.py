"""Scores filtered pressures from outside and holds the result against report.json, for both schemes.

Usage: score_csv.py SLUICE ROOT

What anybody can do with the CSV of `sluice sensors --filter gaussian` and the experiment's published figures must give what
the report says: the rule for samples without fluid, the shift, the averages and the error are those of engine/report/README.md.
"""

import bisect
import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile

program, root = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
reference = json.loads((root / "schemas/references/lobovsky2014_h300.json").read_text(encoding="utf-8"))
FROM, TO = reference["measures"]["comparison"]
ARRIVAL = reference["measures"]["arrival"]


def sluice(*arguments):
    return subprocess.run([program, *map(str, arguments)], check=True, capture_output=True, text=True).stdout


def coarse(example):
    scene = json.loads((root / "schemas/examples" / f"{example}.json").read_text(encoding="utf-8"))
    scene["resolution"]["spacing"] = 0.015
    scene["sensors"] = [{**one, "interval": 0.0005} for one in scene["sensors"] if one["kind"] == "pressure"]
    scene.pop("output", None)
    return scene


def curve_of(job, name, scene):
    unit = math.sqrt(scene["scales"]["height"] / 9.81)
    pressure = scene["material"]["density"] * 9.81 * scene["scales"]["height"]
    rows = list(csv.DictReader(sluice("sensors", job, name, "--filter", "gaussian", "--tau", 0.002).splitlines()))
    return [float(row["time_s"]) / unit for row in rows], [float(row["value"]) / pressure for row in rows]


def value_at(times, values, time):
    after = min(max(bisect.bisect_right(times, time), 1), len(times) - 1)
    share = (time - times[after - 1]) / (times[after] - times[after - 1])
    return values[after - 1] + share * (values[after] - values[after - 1])


def average(times, values, begin, end):
    begin = max(begin, times[0])
    inner = [k for k in range(len(times)) if begin < times[k] < end]
    x = [begin, *(times[k] for k in inner), end]
    y = [value_at(times, values, begin), *(values[k] for k in inner), value_at(times, values, end)]
    return sum(0.5 * (y[k] + y[k + 1]) * (x[k + 1] - x[k]) for k in range(len(x) - 1)) / (end - begin)


def arrival(times, values):
    for k in range(1, len(times)):
        if times[k] >= 1.0 and values[k] >= ARRIVAL:
            if values[k - 1] >= ARRIVAL or times[k - 1] < 1.0:
                return times[k]
            share = (ARRIVAL - values[k - 1]) / (values[k] - values[k - 1])
            return times[k - 1] + share * (times[k] - times[k - 1])
    raise AssertionError("nothing arrived")


def error(times, values, centres, measured):
    middles = [0.5 * (a + b) for a, b in zip(centres, centres[1:])]
    edges = [2 * centres[0] - middles[0], *middles, 2 * centres[-1] - middles[-1]]
    above = below = 0.0
    for k, centre in enumerate(centres):
        if FROM < centre < TO:
            width = edges[k + 1] - edges[k]
            above += width * (average(times, values, edges[k], edges[k + 1]) - measured[k]) ** 2
            below += width * measured[k] ** 2
    return math.sqrt(above / below)


def check(folder, example, figures):
    scene, job = coarse(example), folder / example
    (folder / "scene.json").write_text(json.dumps(scene), encoding="utf-8")
    sluice("run", folder / "scene.json", "--folder", job, "--progress", "none")
    comparison = json.loads(sluice("report", job, "--json"))["comparison"]
    curves = {one["reference"]: curve_of(job, one["sensor"], scene) for one in comparison["pressures"]}
    shift = figures["event_arrival"]["P1"] - arrival(*curves["P1"])
    assert abs(shift - comparison["pressure_shift"]) < 1e-6, (example, shift, comparison["pressure_shift"])
    for one in comparison["pressures"]:
        name = one["reference"]
        times, values = curves[name]
        for moved, key in ((shift, "relative_l2"), (0.0, "relative_l2_not_shifted")):
            ours = error([t + moved for t in times], values, figures["event"]["t"], figures["event"][name])
            assert abs(ours - one[key]) < 1e-6, (example, name, key, ours, one[key])
    print(f"{example}: {len(curves)} sensors, shift {shift:+.4f} T, mean error {comparison['mean_relative_l2']:.4f}")


with tempfile.TemporaryDirectory() as name:
    for case in ("dambreak", "dambreak-paper"):
        check(pathlib.Path(name), case, reference)
