"""Opens exported frames of the plane and of space in ParaView, where it is installed (5.11 or newer).

usage: open_in_paraview.py SLUICE

Each folder of frames must open without a choice of reader, with the times, particles and fields of
its run. Exit status 77 without pvpython (Debian: paraview, python3-paraview).
"""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

# What ParaView's own Python prints of a series: times and, of the last frame, bounds and fields.
LOOK = """
import json, sys
from paraview.simple import OpenDataFile
from paraview import servermanager
reader = OpenDataFile(sys.argv[1])
reader.UpdatePipelineInformation()
times = list(reader.TimestepValues)
reader.UpdatePipeline(times[-1])
data = servermanager.Fetch(reader)
arrays = [data.GetPointData().GetArray(k) for k in range(data.GetPointData().GetNumberOfArrays())]
print(json.dumps({"times": times, "points": data.GetNumberOfPoints(),
                  "cells": data.GetNumberOfCells(), "bounds": data.GetBounds(),
                  "fields": {a.GetName(): a.GetNumberOfComponents() for a in arrays}}))
"""


def scene(dimensions):
    depth = [0.1] * (dimensions - 2)
    return {
        "name": "frames", "dimensions": dimensions,
        "tank": {"width": 0.4, "height": 0.3, **({"depth": depth[0]} if depth else {})},
        "fluid": [{"shape": "box" if depth else "rectangle", "corner": [0.0] * dimensions,
                   "size": [0.1, 0.2, *depth]}],
        "gravity": [0, -9.81] + [0] * len(depth),
        "resolution": {"spacing": 0.02}, "numerics": {"scheme": "recommended"},
        "output": {"frames": {"interval": 0.05}}, "end_time": 0.2}


def seen_by_paraview(series, folder):
    script = folder / "look.py"
    script.write_text(LOOK)
    result = subprocess.run(["pvpython", script, series], text=True, capture_output=True, check=True)
    return json.loads(result.stdout.splitlines()[-1])


def check(sluice, dimensions, folder):
    path, job, output = folder / "scene.json", folder / "job", folder / "frames"
    path.write_text(json.dumps(scene(dimensions)))
    subprocess.run([sluice, "run", path, "--folder", job], check=True, capture_output=True)
    subprocess.run([sluice, "export", job, "--output", output], check=True, capture_output=True)
    seen = seen_by_paraview(output / "frames.hdf.series", folder)
    outcome = json.loads((job / "outcome.json").read_text())
    assert len(seen["times"]) == 5, seen
    assert all(0 <= time - 0.05 * k < 0.01 for k, time in enumerate(seen["times"])), seen
    assert seen["points"] == seen["cells"] == outcome["particles"], seen
    assert seen["fields"] == {"pressure": 1, "velocity": 3, "id": 1}, seen
    thickness = seen["bounds"][5] - seen["bounds"][4]
    assert (thickness > 0.05) if dimensions == 3 else thickness == 0, seen


def main():
    if not shutil.which("pvpython"):
        print("skipped: no pvpython here (packages paraview and python3-paraview)")
        return 77
    for dimensions in (2, 3):
        with tempfile.TemporaryDirectory(prefix="sluice-paraview-") as name:
            check(sys.argv[1], dimensions, pathlib.Path(name))
        print(f"{dimensions} dimensions: times, particles and fields are there")
    return 0


if __name__ == "__main__":
    sys.exit(main())
