"""What the command line says: help, mistakes in plain words, commands that can be pasted.

usage: command_line.py SLUICE [unittest arguments]
"""

import json
import os
import re
import shlex
import subprocess
import sys
import unittest

import run_binary
from run_binary import Sandbox, failing_scene, scene

SHORT = {"end_time": 0.05}


class Words(Sandbox):
    def test_help_and_version_are_verbs_too(self):
        self.assertEqual(self.expect(0, "help").stdout, self.expect(0, "--help").stdout)
        for verb in ("run", "sensors", "help"):
            self.assertEqual(self.expect(0, "help", verb).stdout, self.expect(0, verb, "--help").stdout)
        self.assertEqual(self.expect(0, "version").stdout, self.expect(0, "--version").stdout)
        self.assertIn('did you mean "run"', self.expect(2, "help", "rnu").stderr)

    def test_mistakes_are_told_in_plain_words_with_what_was_found_and_what_is_allowed(self):
        self.write_scene()
        for words, said in (
                ("sensors q --filter foo", '--filter: is "foo", but must be one of gaussian, none;'),
                ("sensors q --tau -1", '--tau: is "-1", but must be a number above 0;'),
                ("sensors q --tau nan", '--tau: is "nan", but must be a number above 0;'),
                ("sensors q --from abc", '--from: is "abc", but must be a number;'),
                ("sensors q --max-points 5", "--max-points: is \"5\", but must be a whole number from 10 to 200000;"),
                ("run case.json --threads 0", '--threads: is "0", but must be a whole number from 1 to 1024;'),
                ("run case.json --threads 1.5", '--threads: is "1.5", but must be a whole number'),
                ("run case.json --stop-after-step -1", '--stop-after-step: is "-1", but must be a whole number, 0 or'),
                ("run case.json --simd FOO", '--simd: is "FOO", but must be one of SSE4, AVX2, AVX3;'),
                ("run", "target is missing: a scene (JSON)"),
                ("run case.json more", '"more" is more than the verb takes;'),
                ("run case.json --thread 1", 'there is no option --thread: did you mean "--threads"'),
                ("sensors q --tau", "--tau needs a value: its smoothing time, s;"),
                ("run case.json --threads 1 --threads 2", "--threads is given more than once;"),
                ("run case.json --no-checkpoint --checkpoint-every 3", "cannot go together;"),
                ("run case.json --no-checkpoint=foo", "--no-checkpoint takes no value;"),
                ("stability --svg x", "--svg goes only with --map;"),
                ("serve --data d --max-memory 3x", '--max-memory: is "3x", but must be a size in bytes, such as'),
                ("serve --data d --max-queued -1", '--max-queued: is "-1", but must be a whole number, 0 or more;'),
                ("report q --tau 0", '--tau: is "0", but must be a number above 0;'),
                ("", "a verb is missing, such as run;")):
            with self.subTest(words):
                complaint = self.expect(2, *words.split()).stderr
                self.assertIn(said, complaint)
                self.assertIn("see sluice help", complaint)
                self.assertEqual(complaint.count("\n"), 1)
                self.assertLess(len(complaint), 200 + 120 * ("did you mean" in complaint))
        self.assertEqual([path.name for path in self.folder.iterdir()], ["case.json"])

    def test_a_file_that_is_not_there_ends_every_verb_with_the_same_code(self):
        for words in ("run", "validate", "plan", "inspect", "submit", "study", "report", "sensors",
                      "stability --scheme", "export --format csv"):
            with self.subTest(words):
                self.assertIn("none.json", self.expect(2, *words.split(), "none.json").stderr)

    def test_scenes_come_from_standard_input_as_well(self):
        text = json.dumps(scene(**SHORT))
        for words in (["validate", "-"], ["validate", "-", "--json"], ["plan", "-", "--no-calibration"],
                      ["run", "-", "--folder", "job"]):
            done = subprocess.run([run_binary.SLUICE, *words], input=text, cwd=self.folder, text=True,
                                  capture_output=True, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
        bad = subprocess.run([run_binary.SLUICE, "validate", "-"], input="{", text=True, capture_output=True, check=False)
        self.assertEqual(bad.returncode, 3)
        self.assertIn("stdin: (the whole scene)", bad.stderr)


class Folders(Sandbox):
    def test_commands_that_are_printed_can_be_pasted_whatever_the_folder_is_called(self):
        names = ("two words", "it's", "a;b&c", "$HOME", "-x", "*")
        for name in names:
            with self.subTest(name):
                said = self.expect(85, "run", self.write_scene(), f"--folder={name}", "--stop-after-step", 10).stderr
                commands = re.findall(r"^  to [a-z ]+: +sluice (.*)$", said, re.MULTILINE)
                self.assertEqual(len(commands), 3, said)
                self.assertEqual(shlex.split(commands[0]), ["run", name if name != "-x" else "./-x"])
                for command in commands[1:]:
                    done = subprocess.run(f"{shlex.quote(run_binary.SLUICE)} {command}", shell=True, cwd=self.folder,
                                          capture_output=True, text=True, check=False)
                    self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_run_that_is_complete_says_so_and_keeps_its_account(self):
        path = self.write_scene(scene(**SHORT))
        self.expect(0, "run", path, "--folder", "job")
        before = self.outcome("job")
        self.assertGreater(before["this_attempt"]["steps"], 0)
        for target in (["job"], [path, "--folder", "job"]):
            said = self.expect(0, "run", *target).stderr
            self.assertIn("job is complete already: step ", said)
            self.assertIn(f"{before['this_attempt']['steps']} steps in ", said)
            self.assertNotIn("0.000 s", said)
            self.assertEqual(self.outcome("job"), before)
            self.assertTrue((self.folder / "job" / "report.html").exists())

    def test_nothing_is_advised_after_a_failure_that_would_come_again(self):
        said = self.expect(4, "run", self.write_scene(failing_scene()), "--folder", "job").stderr
        self.assertNotIn("to go on", said)

    def test_another_scene_is_refused_with_the_keys_that_differ(self):
        self.expect(85, "run", self.write_scene(), "--folder", "job", "--stop-after-step", 1)
        other = scene(resolution={"spacing": 0.03})
        said = self.expect(3, "run", self.write_scene(other), "--folder", "job").stderr
        self.assertIn("/resolution/spacing is 0.02 there and 0.03 here", said)
        other = scene(gravity=[0, -1], tank={"width": 2.0, "height": 1.0})
        other["numerics"].pop("wall_friction")
        said = self.expect(3, "run", self.write_scene(other), "--folder", "job").stderr
        self.assertIn("/gravity/1 is -9.81 there and -1 here, ", said)
        self.assertRegex(said, r", and \d more; choose another folder")

    def test_no_dimensionless_form_without_scales_is_a_mistake_and_no_defect(self):
        content = scene(**SHORT)
        content.pop("scales")
        self.expect(0, "run", self.write_scene(content), "--folder", "job")
        said = self.expect(2, "sensors", "job", "P1", "--dimensionless").stderr
        self.assertIn("scales", said)

    def test_a_part_of_a_series_is_read_from_a_folder_too(self):
        self.expect(0, "run", self.write_scene(scene(end_time=0.2)), "--folder", "job")
        def rows(*options):
            return self.expect(0, "sensors", "job", "P1", *options).stdout.splitlines()[1:]
        whole = rows()
        self.assertEqual(rows("--from", "0.05", "--to", "0.1"),
                         [row for row in whole if 0.05 <= float(row.split(",")[0]) <= 0.1])
        few = self.expect(0, "sensors", "job", "P1", "--max-points", 12)
        self.assertLessEqual(len(few.stdout.splitlines()), 13)
        self.assertIn(f" of {len(whole)} samples", few.stderr)
        shown = json.loads(self.expect(0, "sensors", "job", "P1", "--max-points", 12, "--json").stdout)
        self.assertEqual((shown["samples"], shown["decimated"]), (len(whole), True))

    def test_inspect_explains_the_texts_of_a_job_as_well(self):
        self.expect(0, "run", self.write_scene(scene(**SHORT)), "--folder", "job")
        said = self.expect(0, "inspect", "job/scene.json").stdout
        self.assertRegex(said, r"kind +scene\n")
        self.assertRegex(said, r"fluid_particles +450\n")
        self.assertEqual(json.loads(self.expect(0, "inspect", "case.json", "--json").stdout)["verdict"], "whole")
        self.assertIn("digests", self.expect(0, "inspect", "job/outcome.json").stdout)
        (self.folder / "broken.json").write_text("{")
        self.expect(5, "inspect", "broken.json")


if __name__ == "__main__":
    run_binary.SLUICE = os.path.abspath(sys.argv.pop(1))
    unittest.main(verbosity=2)
