"""The study as its users run it: results, interruptions, failed runs, bad input.

Usage: study_program.py SLUICE
"""

import csv
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

SLUICE = os.path.abspath(sys.argv.pop(1))


def puddle(**changes):
    """Still water; its level should stay where it is, 0.1 m."""
    scene = {
        "name": "puddle",
        "tank": {"width": 0.2, "height": 0.2},
        "fluid": [{"shape": "rectangle", "corner": [0, 0], "size": [0.2, 0.1]}],
        "gravity": [0, -9.81],
        "resolution": {"spacing": 0.01},
        "numerics": {"scheme": "paper", "reinitialisation": None,
                     "integrator": "kick_drift_kick", "courant": 0.5,
                     "density_diffusion": {"kind": "fourtakas", "delta": 0.1},
                     "artificial_viscosity": {"alpha": 0.1}},
        "sensors": [{"name": "level", "kind": "surface_height", "x": 0.1, "interval": 0.005}],
        "reference": {"kind": "series", "title": "level at rest",
                      "curves": [{"sensor": "level", "time": [0.02, 0.06], "value": [0.1, 0.1]}]},
        "end_time": 0.1,
    }
    scene.update(changes)
    return scene


class StudyProgram(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def write(self, **study):
        path = self.folder / "study.json"
        path.write_text(json.dumps({"name": "small", "scene": puddle(), **study}))
        return path

    def command(self, *more):
        return [SLUICE, "study", self.folder / "study.json", "--folder", self.folder / "out", *more]

    def study(self, *more, code=0):
        done = subprocess.run(self.command(*more), capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def results(self):
        return json.loads((self.folder / "out" / "results.json").read_text())

    def test_runs_a_ladder_and_leaves_table_csv_json_and_picture(self):
        self.write(vary=[{"key": "/resolution/spacing", "values": [0.02, 0.01, 0.005]}],
                   targets=[10])
        shown = self.study().stdout
        self.assertIn("small-spacing-0.005", shown)
        results = self.results()
        self.assertEqual([run["state"] for run in results["runs"]], ["completed"] * 3)
        for run in results["runs"]:
            self.assertLess(run["error"], 0.5)
            self.assertGreater(run["core_seconds"], 0)
        self.assertIn("small-spacing", results["cheapest"][0]["setup"])
        self.assertTrue(any(one["quantity"] == "error" for one in results["convergence"]))
        with open(self.folder / "out" / "results.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["/resolution/spacing"] for row in rows], ["0.02", "0.01", "0.005"])
        self.assertIn("<svg", (self.folder / "out" / "error-cost.svg").read_text())
        self.assertIn("| set-up |", (self.folder / "out" / "results.md").read_text())

    def test_warns_once_of_what_all_its_runs_have(self):
        outside = {"name": "outside", "kind": "pressure", "position": [-0.03, 0.05], "interval": 0.01}
        self.write(scene=puddle(sensors=[*puddle()["sensors"], outside]), members={"count": 3})
        told = self.study("--no-run").stderr
        self.assertEqual(told.count("warning: run small-r1: /sensors/1/position: "), 1)
        self.assertEqual(told.count("warning"), 1)

    def test_shows_a_failed_run_as_failed_and_does_not_try_it_again(self):
        # A jet that is faster than sound after its fall trips the guard of the speed.
        jet = [{"shape": "rectangle", "corner": [0, 0], "size": [0.2, 0.1],
                "velocity": [0, -19.5], "pressure": "zero"}]
        self.write(cases=[{"name": "calm"},
                          {"name": "wild", "set": {"/fluid": jet, "/material/sound_speed": 20}}])
        self.study()
        states = {run["run"]: run for run in self.results()["runs"]}
        self.assertEqual(states["calm"]["state"], "completed")
        self.assertEqual(states["wild"]["state"], "failed")
        self.assertTrue(states["wild"]["reason"])
        self.assertIsNone(states["wild"]["error"])
        outcome = self.folder / "out" / "runs" / "wild" / "outcome.json"
        before = outcome.stat().st_mtime_ns
        self.assertIn("2 of 2 runs are done", self.study().stderr)
        self.assertEqual(outcome.stat().st_mtime_ns, before)

    def interrupted(self, how):
        """Stops a study in its first run, lets it go on, and returns what the two printed."""
        long = puddle(end_time=3.0)
        self.write(scene=long, vary=[{"key": "/numerics/courant", "values": [0.5, 0.4]}])
        process = subprocess.Popen(self.command("--cores", "1"), stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        first = self.folder / "out" / "runs" / "small-courant-0.5"
        while not list(first.glob("checkpoint-*.h5")):
            self.assertIsNone(process.poll())
            time.sleep(0.01)
        how(process)
        text = process.communicate()[1]
        # Its run outlives a killed study for as long as its last checkpoint takes.
        again = self.study("--cores", "1")
        while "locked" in again.stderr:
            again = self.study("--cores", "1")
        return process.returncode, text, first

    def assert_complete(self, first):
        self.assertEqual([run["state"] for run in self.results()["runs"]], ["completed"] * 2)
        events = [json.loads(line)["event"] for line in
                  (first / "log.jsonl").read_text().splitlines()]
        self.assertIn("resumed", events)
        self.assertEqual(events.count("started"), 1)

    def test_goes_on_after_being_asked_to_stop(self):
        code, text, first = self.interrupted(lambda process: process.terminate())
        self.assertEqual(code, 85, text)
        self.assertIn("stopping", text)
        self.assert_complete(first)

    def test_a_killed_study_goes_on_where_it_was(self):
        def kill(process):
            process.send_signal(signal.SIGKILL)
            process.wait()
            lock = self.folder / "out" / "runs" / "small-courant-0.5" / "outcome.json"
            while not lock.exists():
                time.sleep(0.01)
        code, text, first = self.interrupted(kill)
        self.assertEqual(code, -signal.SIGKILL, text)
        self.assert_complete(first)

    def test_goes_on_with_new_cases_and_keeps_the_old_runs(self):
        self.write(cases=[{"name": "a"}])
        self.study()
        outcome = self.folder / "out" / "runs" / "a" / "outcome.json"
        before = outcome.stat().st_mtime_ns
        self.write(cases=[{"name": "a"}, {"name": "b", "set": {"/numerics/courant": 0.3}}])
        self.study()
        self.assertEqual(len(self.results()["runs"]), 2)
        self.assertEqual(outcome.stat().st_mtime_ns, before)

    def test_refuses_a_run_of_another_scene_in_its_folder_and_keeps_it(self):
        self.write(cases=[{"name": "a"}])
        self.study()
        before = (self.folder / "out" / "runs" / "a" / "scene.json").read_text()
        self.write(cases=[{"name": "a", "set": {"/numerics/courant": 0.3}}])
        refused = self.study(code=3)
        self.assertIn("another scene", refused.stderr)
        self.assertEqual((self.folder / "out" / "runs" / "a" / "scene.json").read_text(), before)

    def test_refuses_a_bad_study_naming_every_problem_and_makes_no_folder(self):
        self.write(vary=[{"key": "/resolution/spacin", "values": [0.1, 0.2]}])
        refused = self.study(code=3)
        self.assertEqual(refused.stderr.count("/resolution/spacin"), 2)
        self.assertFalse((self.folder / "out").exists())
        (self.folder / "study.json").write_text("{")
        self.study(code=3)

    def test_two_studies_in_one_folder_are_refused(self):
        self.write(scene=puddle(end_time=100.0))
        process = subprocess.Popen(self.command(), stderr=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL)
        try:
            while not (self.folder / "out" / "runs" / "small").exists():
                self.assertIsNone(process.poll())
                time.sleep(0.01)
            self.study(code=7)
        finally:
            process.terminate()
            self.assertEqual(process.wait(), 85)


unittest.main()
