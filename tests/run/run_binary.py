"""Tests of the sluice program as others see it: processes, signals, exit codes, files.

usage: run_binary.py SLUICE [unittest arguments]
"""

import csv
import io
import json
import math
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

SLUICE = ""
EVERY_RUN_ENDS_WITHIN = 600  # s: only so that a hang ends as a failure


def scene(**changes):
    """The quick dam break at 450 particles; about 1 900 steps to the end."""
    result = {
        "name": "small",
        "tank": {"width": 1.61, "height": 0.6},
        "fluid": [{"shape": "rectangle", "corner": [0, 0], "size": [0.6, 0.3]}],
        "gravity": [0, -9.81],
        "resolution": {"spacing": 0.02},
        "numerics": {
            "scheme": "paper",
            "integrator": "kick_drift_kick",
            "courant": 0.5,
            "wall_artificial_viscosity": {"alpha": 0.02},
            "wall_pressure": "clamped",
            "density_diffusion": {"delta": 0.1},
            "artificial_viscosity": {"alpha": 0.02},
            "reinitialisation": {"interval": 20},
        },
        "sensors": [
            {"name": "P1", "kind": "pressure", "position": [1.61, 0.02], "interval": 0.0005},
            {"name": "energy", "kind": "energy", "interval": 0.01},
        ],
        "scales": {"height": 0.3, "width": 0.6},
        "end_time": 1.4,
    }
    result.update(changes)
    return result


def failing_scene():
    """A column thrown against the wall at nearly half of the speed of sound: no scheme holds that."""
    fluid = {"shape": "rectangle", "corner": [0, 0], "size": [0.6, 0.3], "velocity": [11.5, 0.0]}
    return scene(fluid=[fluid], end_time=5.0)


class Sandbox(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="sluice-test-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.random = random.Random(20)

    def write_scene(self, content=None, name="case.json"):
        path = self.folder / name
        path.write_text(json.dumps(content or scene()))
        return path

    def sluice(self, *arguments):
        return subprocess.run([SLUICE, *map(str, arguments)], cwd=self.folder, text=True,
                              capture_output=True, timeout=EVERY_RUN_ENDS_WITHIN)

    def start(self, *arguments, stderr=subprocess.DEVNULL, **options):
        process = subprocess.Popen([SLUICE, *map(str, arguments)], cwd=self.folder, text=True,
                                   stdout=subprocess.PIPE, stderr=stderr, **options)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def expect(self, code, *arguments):
        result = self.sluice(*arguments)
        self.assertEqual(result.returncode, code, result.stdout[-2000:] + result.stderr)
        return result

    def wait_for(self, process, event):
        """Reads events until this one; fails when the process ends before."""
        for line in process.stdout:
            fields = json.loads(line)
            if fields["event"] == event:
                return fields
        self.fail(f"the run ended without the event {event}")

    def wait_for_new_checkpoint(self, folder, seconds):
        """Until there is one, or for so long."""
        def names():
            return {path.name for path in (self.folder / folder).glob("checkpoint-*.h5")}

        before = names()
        end = time.monotonic() + seconds
        while time.monotonic() < end and not names() - before:
            time.sleep(0.002)

    def outcome(self, folder):
        return json.loads((self.folder / folder / "outcome.json").read_text())

    def digests(self, folder):
        return self.outcome(folder)["digests"]

    def reference(self, content=None):
        """Digests of a run that nobody interrupts."""
        path = self.write_scene(content, "reference.json")
        self.expect(0, "run", path, "--folder", "reference", "--no-checkpoint", "--threads", 1)
        return self.digests("reference")

    def assert_tidy(self, folder):
        """Every file is one of ours and every HDF5 file is whole."""
        root = self.folder / folder
        known = re.compile(r"scene\.json|lock|log\.jsonl|series\.h5|outcome\.json|frames|report\.(json|md|html)"
                           r"|checkpoint-\d{12}\.h5")
        for path in root.iterdir():
            self.assertRegex(path.name, known)
            if path.suffix == ".h5":
                self.expect(0, "inspect", path)


def scene_in_space(**changes):
    """A column of 1 680 particles that meets a box and a ball."""
    return scene(tank={"width": 0.6, "height": 0.3, "depth": 0.2},
                 fluid=[{"shape": "box", "corner": [0, 0, 0], "size": [0.24, 0.28, 0.2]}],
                 obstacles=[{"shape": "box", "corner": [0.4, 0, 0.06], "size": [0.08, 0.1, 0.08]},
                            {"shape": "sphere", "center": [0.52, 0.06, 0.14], "radius": 0.05}],
                 gravity=[0, -9.81, 0],
                 numerics={"scheme": "recommended"},
                 sensors=[{"name": "P1", "kind": "pressure", "position": [0.4, 0.02, 0.1], "interval": 0},
                          {"name": "H", "kind": "surface_height", "x": 0.2, "z": 0.1, "interval": 0.01}],
                 scales={"height": 0.28, "width": 0.24}, **changes)


class Restart(Sandbox):
    def test_fifty_kills_at_random_instants_change_no_bit(self):
        # Long enough that the kills fall into the run and not behind its end.
        self.assert_kills_change_no_bit(scene(end_time=12.0), 50)

    def test_kills_change_no_bit_in_space(self):
        self.assert_kills_change_no_bit(scene_in_space(end_time=3.0), 8)

    def assert_kills_change_no_bit(self, content, most):
        expected = self.reference(content)
        path = self.write_scene(content)
        started = time.monotonic()
        self.expect(85, "run", path, "--folder", "job", "--stop-after-step", 0)
        startup = time.monotonic() - started
        kills = 0
        steps = []
        while kills < most:
            process = self.start("run", path, "--folder", "job", "--checkpoint-every", 20,
                                 "--threads", self.random.choice([1, 1, 2, 3, 8]))
            # One kill at any instant of the start, one once the run is under way: however slow the machine is
            # at present, none comes later than a little after a checkpoint.
            if kills % 2:
                self.wait_for(process, "checkpoint")
            else:
                self.wait_for_new_checkpoint("job", self.random.uniform(0.0, 1.5 * startup))
            time.sleep(self.random.uniform(0.0, 0.08))
            process.kill()
            process.wait()
            self.assertEqual(process.returncode, -signal.SIGKILL, "the scene is too short")
            kills += 1
            steps += [p.name for p in (self.folder / "job").glob("checkpoint-*.h5")]
        self.assertGreater(len(set(steps)), most / 5, "the kills hardly met a running job")
        self.expect(0, "run", "job", "--threads", 2)
        self.assertEqual(self.digests("job"), expected)
        self.assert_tidy("job")

    def test_terms_in_the_middle_of_checkpoints_lose_nothing(self):
        expected = self.reference()
        path = self.write_scene()
        code = None
        for _ in range(20):
            process = self.start("run", path, "--folder", "job", "--checkpoint-every", 1)
            self.wait_for(process, "checkpoint")
            time.sleep(self.random.uniform(0.0, 0.05))
            process.terminate()
            process.stdout.read()
            code = process.wait()
            self.assertIn(code, (0, 85))
            self.assert_tidy("job")
        self.expect(0, "run", "job")
        self.assertEqual(self.digests("job"), expected)

    def test_stopping_after_a_step_and_going_on_changes_no_bit(self):
        expected = self.reference()
        path = self.write_scene()
        for step in (0, 1, 19, 20, 333, 600):
            self.expect(85, "run", path, "--folder", "job", "--stop-after-step", step)
            self.assertEqual(self.outcome("job")["state"], "stopped")
            self.assertEqual(self.outcome("job")["step"], step)
        self.expect(0, "run", "job")
        self.assertEqual(self.digests("job"), expected)

    def test_extending_the_end_time_is_exact(self):
        expected = self.reference()
        self.expect(0, "run", self.write_scene(scene(end_time=0.5)), "--folder", "job")
        short = self.outcome("job")["step"]
        self.expect(0, "run", self.write_scene(), "--folder", "job")
        self.assertGreater(self.outcome("job")["step"], short)
        self.assertEqual(self.digests("job"), expected)

    def test_running_a_finished_job_again_changes_nothing(self):
        path = self.write_scene()
        self.expect(0, "run", path, "--folder", "job")
        before = self.digests("job")
        self.expect(0, "run", "job")
        self.assertEqual(self.digests("job"), before)

    def test_frames_are_numbered_on_after_a_restart(self):
        content = scene(output={"frames": {"interval": 0.05}})
        self.reference(content)
        path = self.write_scene(content)
        self.expect(85, "run", path, "--folder", "job", "--stop-after-step", 400)
        self.expect(0, "run", "job")
        frames = {}
        for folder in ("reference", "job"):
            root = self.folder / folder / "frames"
            frames[folder] = {p.name: p.read_bytes() for p in root.iterdir()}
        self.assertEqual(len(frames["reference"]), 29)
        self.assertEqual(frames["job"], frames["reference"])

    def test_a_damaged_checkpoint_costs_time_but_no_bit(self):
        expected = self.reference()
        path = self.write_scene()
        self.expect(85, "run", path, "--folder", "job", "--stop-after-step", 300)
        self.expect(85, "run", "job", "--stop-after-step", 500)
        newest = sorted((self.folder / "job").glob("checkpoint-*.h5"))[-1]
        content = bytearray(newest.read_bytes())
        content[len(content) // 2] ^= 1
        newest.write_bytes(content)
        result = self.expect(0, "run", "job")
        self.assertIn('"event":"warning"', result.stdout)
        self.assertTrue(list((self.folder / "job").glob("*.bad")))
        self.assertEqual(self.digests("job"), expected)

    def test_without_a_usable_checkpoint_the_run_does_not_start_over(self):
        self.expect(85, "run", self.write_scene(), "--folder", "job", "--stop-after-step", 300)
        for checkpoint in (self.folder / "job").glob("checkpoint-*.h5"):
            checkpoint.write_bytes(checkpoint.read_bytes()[:1000])
        for _ in range(2):
            result = self.expect(6, "run", "job")
            self.assertIn("checkpoint", result.stderr)
            self.assertEqual(json.loads(result.stdout)["exit_code"], 6)


class Signals(Sandbox):
    def test_usr1_writes_a_checkpoint_and_the_run_goes_on(self):
        expected = self.reference()
        process = self.start("run", self.write_scene(), "--folder", "job", "--no-checkpoint")
        self.wait_for(process, "started")
        process.send_signal(signal.SIGUSR1)
        self.assertLess(self.wait_for(process, "checkpoint")["time"], 1.4)
        self.wait_for(process, "finished")
        self.assertEqual(process.wait(), 0)
        self.assertEqual(self.digests("job"), expected)

    def test_term_and_interrupt_stop_with_a_checkpoint_and_exit_85(self):
        expected = self.reference(scene(end_time=4.0))
        path = self.write_scene(scene(end_time=4.0))
        for number in (signal.SIGTERM, signal.SIGINT):
            process = self.start("run", path, "--folder", "job", "--no-checkpoint")
            self.wait_for(process, "started" if number == signal.SIGTERM else "resumed")
            process.send_signal(number)
            stopped = self.wait_for(process, "stopped")
            self.assertEqual(process.wait(), 85)
            self.assertTrue(
                (self.folder / "job" / f"checkpoint-{stopped['step']:012}.h5").exists())
        self.expect(0, "run", "job")
        self.assertEqual(self.digests("job"), expected)

    def test_a_second_term_ends_the_run_at_once(self):
        if not can_mount():
            self.skipTest("needs a disk that fills up, and may not mount one")
        with Tmpfs(self.folder / "disk", "600k") as disk:
            # The stop cannot be written and waits for room; only the second signal ends it.
            process = self.start("run", self.write_scene(scene(end_time=60.0)), "--folder",
                                 disk / "job", "--no-checkpoint", "--storage-patience", 1000)
            self.wait_for(process, "started")
            time.sleep(0.1)
            fill(disk)
            process.terminate()
            while "next try" not in self.wait_for(process, "warning")["message"]:
                pass
            time.sleep(2.2)  # within two seconds it would be the same wish
            process.terminate()
            self.assertEqual(process.wait(), 128 + signal.SIGTERM)
            self.assertEqual((disk / "job" / "lock").read_text(), "")

    def test_a_reader_that_goes_away_does_not_end_the_run(self):
        process = self.start("run", self.write_scene(), "--folder", "job", "--checkpoint-every", 50)
        self.wait_for(process, "started")
        process.stdout.close()
        self.assertEqual(process.wait(), 0)
        self.assertEqual(self.outcome("job")["state"], "completed")


class Failures(Sandbox):
    def test_a_scheme_that_linear_analysis_calls_unstable_is_refused_with_the_limit(self):
        path = self.write_scene(scene(numerics={
            "scheme": "paper", "integrator": "modified_leap_frog", "courant": 0.9,
            "density_diffusion": {"delta": 0.1}, "artificial_viscosity": {"alpha": 0.02}}))
        for verb in ("validate", "plan", "run"):
            result = self.expect(3, verb, path)
            self.assertIn("/numerics/courant: is 0.9; must be at most 0.", result.stderr)
        self.assertEqual([entry.name for entry in self.folder.iterdir()], [path.name])

    def test_a_run_that_fails_ends_with_a_diagnosis_and_keeps_the_last_good_checkpoint(self):
        path = self.write_scene(failing_scene())
        result = self.expect(4, "run", path, "--folder", "job", "--checkpoint-every", 10)
        outcome = self.outcome("job")
        self.assertEqual(outcome["state"], "failed")
        diagnosis = outcome["diagnosis"]
        self.assertGreater(diagnosis["step"], 0)
        for key in ("reason", "time", "value", "limit", "suggestion"):
            self.assertIn(key, diagnosis)
        self.assertIn(f"step {diagnosis['step']}", result.stderr)
        self.assertTrue(list((self.folder / "job").glob("checkpoint-*.h5")))
        self.assert_tidy("job")
        again = self.expect(4, "run", "job", "--threads", 2)
        self.assertIn('"event":"failed"', again.stdout)
        self.assertEqual(self.outcome("job")["diagnosis"], diagnosis)

    def test_a_full_disk_ends_with_exit_5_and_the_job_goes_on_when_there_is_room(self):
        if not can_mount():
            self.skipTest("may not mount a small disk here")
        expected = self.reference()
        with Tmpfs(self.folder / "disk", "600k") as disk:
            path = self.write_scene()
            self.expect(85, "run", path, "--folder", disk / "job", "--stop-after-step", 200)
            fill(disk)
            result = self.expect(5, "run", disk / "job", "--checkpoint-every", 20,
                                 "--storage-patience", 1)
            self.assertRegex(result.stderr, "(?i)space|room|full")
            (disk / "filler").unlink()
            self.assert_tidy("disk/job")
            disk_size("8m", disk)
            self.expect(0, "run", disk / "job")
            self.assertEqual(self.digests("disk/job"), expected)
            self.assert_tidy("disk/job")

    def test_a_disk_that_is_full_for_a_while_costs_no_bit(self):
        if not can_mount():
            self.skipTest("may not mount a small disk here")
        expected = self.reference()
        with Tmpfs(self.folder / "disk", "4m") as disk:
            process = self.start("run", self.write_scene(), "--folder", disk / "job",
                                 "--checkpoint-every", 20, "--storage-patience", 1000)
            self.wait_for(process, "checkpoint")
            fill(disk)
            while "next try" not in self.wait_for(process, "warning")["message"]:
                pass
            (disk / "filler").unlink()
            self.wait_for(process, "finished")
            self.assertEqual(process.wait(), 0)
            self.assertEqual(self.digests("disk/job"), expected)

    def test_an_outcome_that_cannot_be_written_is_no_success_and_is_made_by_running_again(self):
        expected = self.reference()
        self.expect(85, "run", self.write_scene(), "--folder", "job", "--stop-after-step", 200)
        outcome = self.folder / "job" / "outcome.json"
        outcome.unlink()
        (outcome / "in the way").mkdir(parents=True)
        result = self.expect(5, "run", "job", "--storage-patience", 0)
        self.assertIn("outcome.json", result.stderr)
        shutil.rmtree(outcome)
        self.expect(0, "run", "job")
        self.assertEqual(self.digests("job"), expected)
        self.assert_tidy("job")

    def test_a_report_that_a_run_could_not_leave_is_made_at_the_next_look(self):
        path = self.write_scene(scene(end_time=0.05))
        self.expect(0, "run", path, "--folder", "job")
        kept = {name: (self.folder / "job" / name).read_text()
                for name in ("report.json", "report.md", "report.html")}
        for missing in ([*kept], ["report.html"]):
            for name in missing:
                (self.folder / "job" / name).unlink()
            self.expect(0, "report", "job")
            for name, text in kept.items():
                self.assertEqual((self.folder / "job" / name).read_text(), text)
        self.expect(85, "run", path, "--folder", "half", "--stop-after-step", 10)
        self.expect(0, "report", "half")
        self.assertFalse((self.folder / "half" / "report.json").exists())

    def test_a_folder_in_use_is_refused_with_the_process_that_holds_it(self):
        process = self.start("run", self.write_scene(scene(end_time=60.0)), "--folder", "job")
        self.wait_for(process, "started")
        result = self.expect(7, "run", "job")
        self.assertIn(str(process.pid), result.stderr)

    def test_another_scene_in_the_same_folder_is_refused_and_nothing_changes(self):
        self.expect(85, "run", self.write_scene(), "--folder", "job", "--stop-after-step", 10)
        before = {p.name: p.read_bytes() for p in (self.folder / "job").iterdir() if p.is_file()}
        other = self.write_scene(scene(resolution={"spacing": 0.03}), "other.json")
        result = self.expect(3, "run", other, "--folder", "job")
        self.assertIn("--folder", result.stderr)
        after = {p.name: p.read_bytes() for p in (self.folder / "job").iterdir() if p.is_file()}
        self.assertEqual({k: v for k, v in after.items() if k != "lock"},
                         {k: v for k, v in before.items() if k != "lock"})

    def test_a_folder_that_holds_something_else_is_left_alone(self):
        (self.folder / "mine").mkdir()
        (self.folder / "mine" / "thesis.txt").write_text("years of work")
        self.expect(2, "run", self.write_scene(), "--folder", "mine")
        self.assertEqual([p.name for p in (self.folder / "mine").iterdir()], ["thesis.txt"])

    def test_an_invalid_scene_names_every_problem(self):
        broken = scene(gravty=[0, -9.81], end_time=-1)
        result = self.expect(3, "run", self.write_scene(broken))
        self.assertIn("/end_time", result.stderr)
        self.assertIn("gravity", result.stderr)
        self.assertEqual(self.expect(3, "validate", self.write_scene(broken)).stdout, "")
        report = json.loads(self.expect(3, "validate", self.write_scene(broken), "--json").stdout)
        self.assertGreaterEqual(len(report["problems"]), 2)

    def test_regions_that_overlap_are_a_problem_for_every_verb(self):
        path = self.write_scene(scene(fluid=2 * scene()["fluid"]))
        for verb in ("run", "plan", "validate"):
            self.assertIn("/fluid/1", self.expect(3, verb, path).stderr)
        report = json.loads(self.expect(3, "validate", path, "--json").stdout)
        self.assertFalse(report["valid"])
        self.assertEqual(report["problems"][0]["pointer"], "/fluid/1")

    def test_the_stability_suite_names_what_it_does_not_know(self):
        result = self.expect(2, "stability", "stil-tank")
        self.assertIn("there is no case stil-tank: did you mean \"still-tank\"", result.stderr)
        self.expect(2, "stability", "free-fall", "--scheme", "nowhere.json")
        (self.folder / "mine").mkdir()
        (self.folder / "mine" / "thesis.txt").write_text("years of work")
        self.assertIn("not empty", self.expect(2, "stability", "--folder", "mine").stderr)

    def test_the_stability_suite_leaves_a_table_and_its_files(self):
        files = ["--json", "s.json", "--html", "s.html", "--folder", "kept"]
        result = self.expect(0, "stability", "--quick", "free-fall", "overlap", *files)
        self.assertIn("2 of 2 gates met", result.stdout)
        cases = json.loads((self.folder / "s.json").read_text())["cases"]
        self.assertEqual([case["name"] for case in cases], ["free-fall", "overlap"])
        self.assertIn("free-fall", (self.folder / "s.html").read_text())
        self.assertTrue((self.folder / "kept" / cases[0]["verdict"]["checkpoint"]).exists())

    def test_a_stopped_stability_suite_keeps_its_verdicts_and_says_how_to_go_on(self):
        process = self.start("stability", "free-fall", "column-1-50", "--folder", "kept",
                             stderr=subprocess.PIPE)
        while not list((self.folder / "kept").glob("*column-1-50/series.h5")):
            self.assertIsNone(process.poll())
            time.sleep(0.02)
        process.terminate()
        verdicts, complaint = process.communicate()
        self.assertEqual(process.returncode, 85, complaint)
        self.assertIn("free-fall", verdicts)
        self.assertIn("without a line above", complaint)

    def test_a_full_disk_behind_standard_output_is_told(self):
        self.expect(0, "run", self.write_scene(), "--folder", "job")
        for command in (["report", "job", "--format", "html"], ["sensors", "job"],
                        ["sensors", "job", "P1"], ["stability", "--list"],
                        ["inspect", "job/series.h5"]):
            with open("/dev/full", "w") as full:
                result = subprocess.run([SLUICE, *command], cwd=self.folder, text=True, stdout=full,
                                        stderr=subprocess.PIPE)
            self.assertEqual(result.returncode, 5, command)
            self.assertIn("is not whole", result.stderr)

    def test_a_filter_time_that_is_no_time_is_a_usage_error(self):
        self.expect(0, "run", self.write_scene(), "--folder", "job")
        for tau in ("nan", "inf", "0"):
            self.expect(2, "sensors", "job", "P1", "--filter", "gaussian", "--tau", tau)

    def test_the_stability_suite_fails_for_a_scheme_that_misses_a_gate(self):
        # Molteni-Colagrossi and Shepard lift a film of one layer of particles.
        paper = scene()["numerics"] | {"kernel": "truncated_gaussian"}
        path = self.write_scene(scene(numerics=paper))
        result = self.expect(4, "stability", "--quick", "one-particle-film", "--scheme", path)
        self.assertIn("0 of 1 gates met, 1 missed", result.stdout)

    def test_usage_errors_exit_with_2_and_one_line(self):
        for arguments in (["rnu"], ["run"], ["run", "nowhere.json"], ["sensors", "."],
                          ["run", self.write_scene(), "--threads", "0"],
                          ["run", self.write_scene(), "--checkpoint-every", "-1"], []):
            result = self.expect(2, *arguments)
            self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        self.assertIn('"run"', self.sluice("rnu").stderr)


class Reading(Sandbox):
    def setUp(self):
        super().setUp()
        content = scene(output={"frames": {"interval": 0.5}})
        self.run_result = self.expect(0, "run", self.write_scene(content), "--folder", "job")

    def rows(self, *arguments):
        text = self.expect(0, "sensors", "job", *arguments).stdout
        return list(csv.DictReader(io.StringIO(text)))

    def test_every_line_on_stdout_is_an_event_and_no_eta_is_infinite(self):
        events = [json.loads(line) for line in self.run_result.stdout.splitlines()]
        names = [event["event"] for event in events]
        self.assertEqual(names[0], "started")
        self.assertEqual(names[-1], "finished")
        for event in events:
            if event["event"] == "progress" and event["eta"] is not None:
                self.assertTrue(math.isfinite(event["eta"]))

    def test_the_log_tells_of_every_attempt(self):
        lines = (self.folder / "job" / "log.jsonl").read_text().splitlines()
        names = [json.loads(line)["event"] for line in lines]
        self.assertEqual((names[0], names[-1]), ("started", "finished"))

    def test_raw_and_filtered_series_have_a_head_line_and_empty_cells_when_dry(self):
        raw = self.rows("P1")
        self.assertEqual(list(raw[0]), ["time_s", "value", "weight"])
        self.assertEqual((raw[0]["time_s"], raw[0]["value"], raw[0]["weight"]), ("0", "", "0"))
        wet = [row for row in raw if row["value"]]
        self.assertGreater(max(float(row["value"]) for row in wet), 500.0)
        smooth = self.rows("P1", "--filter", "gaussian", "--tau", "0.01")
        self.assertEqual([r["time_s"] for r in smooth], [r["time_s"] for r in raw])

        def roughness(rows):
            values = [float(r["value"]) for r in rows if r["value"]]
            return sum(abs(a - b) for a, b in zip(values, values[1:]))

        self.assertLess(roughness(smooth), 0.5 * roughness(wet))

    def test_energy_has_its_columns(self):
        self.assertEqual(list(self.rows("energy")[0]),
                         ["time_s", "kinetic", "potential", "internal", "weight"])

    def test_dimensionless_pressure_is_divided_by_that_of_the_column(self):
        raw = self.rows("P1")[-1]
        scaled = self.rows("P1", "--dimensionless")[-1]
        self.assertAlmostEqual(float(scaled["value"]), float(raw["value"]) / (1000 * 9.81 * 0.3))
        self.assertAlmostEqual(float(scaled["time"]), float(raw["time_s"]) * (9.81 / 0.3) ** 0.5)

    def test_json_has_null_where_the_sensor_is_dry(self):
        text = self.expect(0, "sensors", "job", "P1", "--format", "json").stdout
        series = json.loads(text)
        self.assertIsNone(series["columns"][0]["values"][0])
        self.assertIsNone(series["provisional_after"])
        self.assertEqual(series["columns"][0]["unit"], "Pa")

    def test_the_end_of_an_unfinished_filtered_series_is_provisional(self):
        self.expect(85, "run", self.write_scene(), "--folder", "part", "--stop-after-step", 200)
        series = json.loads(self.expect(0, "sensors", "part", "P1", "--filter", "gaussian", "--tau",
                                        "0.01", "--format", "json").stdout)
        self.assertAlmostEqual(series["provisional_after"], series["time"][-1] - 0.03)

    def test_an_unknown_sensor_is_not_found_and_a_filter_without_tau_is_a_usage_error(self):
        self.assertIn('"P1"', self.expect(8, "sensors", "job", "p1").stderr)
        self.assertIn("--tau", self.expect(2, "sensors", "job", "P1", "--filter", "gaussian").stderr)

    def test_frames_are_exported_for_paraview_and_as_tables(self):
        self.expect(0, "export", "job", "--output", "para:view")
        series = json.loads((self.folder / "para:view" / "frames.hdf.series").read_text())
        self.assertEqual(len(series["files"]), 3)
        for one in series["files"]:
            self.assertTrue((self.folder / "para:view" / one["name"]).exists())
        self.expect(0, "export", "job", "--format", "csv", "--output", "tables")
        tables = sorted((self.folder / "tables").iterdir())
        self.assertEqual(len(tables), 3)
        self.assertEqual(len(tables[0].read_text().splitlines()), 1 + 450)

    def test_validate_and_plan_warn_in_a_field_of_their_own(self):
        behind = {"name": "P", "kind": "pressure", "position": [1.65, 0.1], "interval": 0.01}
        path = self.write_scene(scene(sensors=[behind]))
        said = "warning: /sensors/0/position: is (1.65, 0.1) m"
        for verb in ("validate", "plan"):
            self.assertIn(said, self.expect(0, verb, path).stdout)
            report = json.loads(self.expect(0, verb, path, "--json").stdout)
            self.assertEqual([each["pointer"] for each in report["warnings"]],
                             ["/sensors/0/position"])
        report = json.loads(self.expect(0, "validate", path, "--json").stdout)
        self.assertEqual((report["valid"], report["problems"]), (True, []))

    def test_a_scene_without_numerics_runs_with_the_recommended_scheme_and_says_so(self):
        bare = scene(end_time=0.02)
        del bare["numerics"]
        path = self.write_scene(bare)
        self.assertIn("[scheme recommended]", self.expect(0, "plan", path).stdout)
        self.expect(0, "run", path, "--folder", "bare")
        kept = json.loads((self.folder / "bare" / "scene.json").read_text())
        self.assertEqual(kept["numerics"], {"scheme": "recommended"})
        self.expect(0, "run", path, "--folder", "bare")

    def test_plan_tells_what_runs_and_what_it_takes(self):
        text = self.expect(0, "plan", self.write_scene()).stdout
        self.assertIn("wall_artificial_viscosity", text)
        report = json.loads(self.expect(0, "plan", self.write_scene(), "--json").stdout)
        self.assertEqual(report["estimate"]["fluid_particles"], 450)
        self.assertGreater(report["calibration"]["seconds"], 0.0)

    def test_every_verb_has_help_with_an_example(self):
        for verb in ("run", "validate", "plan", "inspect", "sensors", "export"):
            self.assertIn("Example: sluice " + verb, self.expect(0, verb, "--help").stdout)
        self.assertRegex(self.expect(0, "--version").stdout, r"sluice \d+\.\d+\.\d+")


class Tmpfs:
    def __init__(self, path, size):
        self.path, self.size = path, size

    def __enter__(self):
        self.path.mkdir()
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={self.size}", "tmpfs", self.path],
                       check=True, capture_output=True)
        return self.path

    def __exit__(self, *_):
        subprocess.run(["umount", "-l", self.path], check=True)


def can_mount():
    with tempfile.TemporaryDirectory() as folder:
        try:
            with Tmpfs(pathlib.Path(folder) / "probe", "64k"):
                return True
        except (subprocess.CalledProcessError, OSError):
            return False


def disk_size(size, disk):
    subprocess.run(["mount", "-o", f"remount,size={size}", disk], check=True)


def fill(disk):
    """Takes all room that is left."""
    with open(disk / "filler", "wb", buffering=0) as filler:
        try:
            while True:
                filler.write(bytes(4096))
        except OSError:
            pass


if __name__ == "__main__":
    SLUICE = os.path.abspath(sys.argv.pop(1))
    unittest.main(verbosity=2)
