"""What the command line says: help, mistakes in plain words, commands that can be pasted.

usage: command_line.py SLUICE [unittest arguments]
"""

import json
import os
import re
import shlex
import shutil
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
                ("run --fodler x", 'there is no option --fodler: did you mean "--folder"'),
                ("run none.json --fodler x", 'there is no option --fodler: did you mean "--folder"'),
                ("run --thread", 'there is no option --thread: did you mean "--threads"'),
                ("--bogus", "there is no option --bogus: "),
                ("", "a verb is missing, such as run;")):
            with self.subTest(words):
                complaint = self.expect(2, *words.split()).stderr
                self.assertIn(said, complaint)
                self.assertIn("see sluice help", complaint)
                self.assertEqual(complaint.count("\n"), 1)
                self.assertLess(len(complaint), 200 + 120 * ("did you mean" in complaint))
        self.assertEqual([path.name for path in self.folder.iterdir()], ["case.json"])

    def test_names_that_are_empty_can_be_seen_in_what_is_said_of_them(self):
        for words in (["run", ""], ["validate", ""], ["inspect", ""], ["export", ""], [""]):
            self.assertIn('""', self.expect(2, *words).stderr)

    def test_a_file_that_cannot_be_read_ends_every_verb_with_the_same_code(self):
        (self.folder / "shut").mkdir()
        for name in ("closed.json", "shut/case.json"):
            (self.folder / name).write_text(json.dumps(scene(**SHORT)))
        (self.folder / "closed.json").chmod(0)
        (self.folder / "shut").chmod(0)
        self.folder.chmod(0o755)
        nobody = {"user": 65534} if os.geteuid() == 0 else {}
        for words in ("run", "validate", "plan", "inspect", "submit", "study", "report", "sensors", "stability --scheme",
                      "export --format csv"):
            for name in ("closed.json", "shut/case.json"):
                with self.subTest(f"{words} {name}"):
                    done = subprocess.run([run_binary.SLUICE, *words.split(), name], cwd=self.folder, text=True,
                                          capture_output=True, check=False, **nobody)
                    self.assertEqual(done.returncode, 2, done.stderr)
                    self.assertIn(name, done.stderr)
                    if name.startswith("shut"):
                        self.assertNotIn("there is no", done.stderr)

    def test_what_is_no_json_is_told_with_one_place(self):
        for text, said in (("{", "(the whole scene): not JSON at line 1, column 2: unexpected end of input"),
                           ('{"name": "a",\n oops}', "not JSON at line 2, column 2: invalid literal;")):
            (self.folder / "bad.json").write_text(text)
            told = self.expect(3, "validate", "bad.json").stderr
            self.assertIn(said, told)
            self.assertNotIn("parse error", told)
            self.assertNotIn("at byte", told)

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


class Completion(Sandbox):
    def completed(self, *words):
        """What bash offers for the last of these words."""
        script = ('source <("$0" completion bash) && COMP_WORDS=(sluice "$@") COMP_CWORD=$# && _sluice && '
                  'printf "%s\\n" "${COMPREPLY[@]}"')
        done = subprocess.run(["bash", "-c", script, run_binary.SLUICE, *words], text=True, capture_output=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout.split()

    def test_bash_completes_verbs_options_and_their_words(self):
        self.assertEqual(self.completed("st"), ["study", "stability"])
        self.assertEqual(len(self.completed("")), len(re.findall("^  [a-z]", self.expect(0, "help").stdout, re.MULTILINE)))
        self.assertEqual(self.completed("help", "exp"), ["export"])
        self.assertEqual(self.completed("run", "--th"), ["--threads"])
        self.assertEqual(self.completed("run", "--no-checkpoint", "--th"), ["--threads"])
        self.assertEqual(self.completed("run", "--simd", ""), ["SSE4", "AVX2", "AVX3"])
        self.assertEqual(self.completed("report", "job", "--format", "a"), ["apng"])
        self.assertEqual(self.completed("run", "--folder", ""), [])
        self.assertEqual(self.completed("run", "q"), [])


class ManualPage(Sandbox):
    def test_has_every_verb_with_its_options_and_every_exit_code(self):
        page = self.expect(0, "man").stdout
        verbs = re.findall("^  ([a-z]+) ", self.expect(0, "help").stdout, re.MULTILINE)
        self.assertGreater(len(verbs), 20)
        for verb in verbs:
            self.assertRegex(page, rf"(?m)^\.SS sluice {verb}\b")
            for option in re.findall(r"^  (?:-\w,)?--([a-z-]+)", self.expect(0, "help", verb).stdout, re.MULTILINE):
                if option != "help":
                    self.assertIn("\\-\\-" + option.replace("-", "\\-"), page, verb)
        for code in (0, 2, 7, 13, 85):
            self.assertIn(f"\\fB{code}\\fR", page)

    def test_is_text_that_troff_understands(self):
        page = self.expect(0, "man").stdout
        for line in page.splitlines():
            if line.startswith((".", "'")):
                self.assertRegex(line, r"^\.(TH|SH|SS|TP|PP|nf|fi)( |$)")
        if shutil.which("groff"):
            done = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-z"], input=page, text=True, capture_output=True,
                                  check=False)
            self.assertEqual((done.returncode, done.stderr), (0, ""))


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

    def test_a_run_that_had_nothing_to_do_tells_no_table_of_zeros(self):
        self.expect(0, "run", self.write_scene(scene(end_time=0.1)), "--folder", "job")
        step = self.outcome("job")["step"]
        earlier = self.write_scene(scene(**SHORT), "earlier.json")
        for missing in ("outcome.json", "series.h5"):
            (self.folder / "job" / missing).unlink()
            said = self.expect(0, "run", "job").stderr
            self.assertIn(f"job is complete already: step {step}, t = 0.1", said)
            self.assertNotIn("0.000 s", said)
            self.assertTrue((self.folder / "job" / missing).exists())
        said = self.expect(0, "run", earlier, "--folder", "job").stderr
        self.assertIn(f"job is complete already: step {step}, t = 0.1", said)
        self.assertNotIn("0.000 s", said)

    def test_a_scene_that_is_missing_beside_its_checkpoints_is_to_be_put_back(self):
        path = self.write_scene()
        self.expect(85, "run", path, "--folder", "job", "--stop-after-step", 10)
        text = (self.folder / "job" / "scene.json").read_text()
        (self.folder / "job" / "scene.json").unlink()
        said = self.expect(2, "run", "job").stderr
        self.assertIn("scene.json is missing", said)
        self.assertIn("put the scene of this run back", said)
        (self.folder / "job" / "scene.json").write_text(text)
        process = self.start("run", "job", stderr=subprocess.PIPE)
        self.wait_for(process, "resumed")
        (self.folder / "job" / "scene.json").unlink()
        process.terminate()
        process.stdout.read()
        said = process.stderr.read()
        process.stderr.close()
        self.assertEqual(process.wait(), 85)
        self.assertIn("put the scene of this run back", said)

    def test_messages_name_the_folder_that_was_given(self):
        path = self.write_scene()
        for given in ("job", "./here", str(self.folder / "whole")):
            with self.subTest(given):
                self.expect(85, "run", path, "--folder", given, "--stop-after-step", 10)
                (self.folder / given / "scene.json").write_text(json.dumps(scene(gravity=[0, -1])))
                done = self.expect(3, "run", given)
                checkpoint = max(path.name for path in (self.folder / given).glob("checkpoint-*.h5"))
                self.assertTrue(done.stderr.startswith(f"sluice: {given}/{checkpoint}: of another scene"), done.stderr)
                self.assertIn(f'"{given}/{checkpoint}: ', done.stdout)
        study = {"name": "pair", "scene": scene(**SHORT), "vary": [{"key": "/end_time", "values": [0.01, 0.02]}]}
        (self.folder / "study.json").write_text(json.dumps(study))
        self.expect(0, "study", "study.json", "--folder", "out")
        study["scene"]["gravity"] = [0, -1]
        (self.folder / "study.json").write_text(json.dumps(study))
        self.assertIn("sluice: out/runs/pair-", self.expect(3, "study", "study.json", "--folder", "out").stderr)

    def test_nothing_is_advised_after_a_failure_that_would_come_again(self):
        said = self.expect(4, "run", self.write_scene(failing_scene()), "--folder", "job").stderr
        self.assertNotIn("to resume", said)

    def test_another_scene_is_refused_with_the_keys_that_differ(self):
        self.expect(85, "run", self.write_scene(), "--folder", "job", "--stop-after-step", 1)
        other = scene(resolution={"spacing": 0.03})
        said = self.expect(3, "run", self.write_scene(other), "--folder", "job").stderr
        self.assertIn("/resolution/spacing is 0.02 there and 0.03 here", said)
        other = scene(gravity=[0, -1], tank={"width": 2.0, "height": 1.0})
        other["numerics"].pop("wall_artificial_viscosity")
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

    def test_inspect_says_what_a_file_is_and_calls_none_damaged_that_has_no_sum(self):
        content = scene(**SHORT, output={"frames": {"interval": 0.05}})
        self.expect(0, "run", self.write_scene(content), "--folder", "job")
        self.expect(0, "export", "job")
        self.expect(0, "export", "job", "--format", "csv")
        (self.folder / "jobs.sqlite").write_bytes(b"SQLite format 3\0")
        (self.folder / "results.csv").write_text("run,error\n")
        (self.folder / "worker.log").write_text("")
        files = [path for path in (self.folder / "job").rglob("*") if path.is_file()]
        self.assertGreater(len(files), 10)
        for path in files + [self.folder / name for name in ("jobs.sqlite", "results.csv", "worker.log")]:
            with self.subTest(path.name):
                self.assertNotIn("damaged", self.expect(0, "inspect", path).stdout)
                json.loads(self.expect(0, "inspect", path, "--json").stdout)
        for stranger, text in (("notes.txt", "hello"), ("empty", ""), ("table.csv", "a,b\n")):
            (self.folder / stranger).write_text(text)
            said = self.expect(2, "inspect", stranger)
            self.assertIn(f"{stranger} is none of the files that inspect explains", said.stderr)
            self.assertEqual(said.stdout, "")
        (self.folder / "cut.h5").write_bytes((self.folder / "job" / "series.h5").read_bytes()[:-1])
        self.assertIn("damaged", self.expect(5, "inspect", "cut.h5").stdout)

    def test_a_simd_target_that_this_machine_lacks_is_a_mistake_before_anything_is_made(self):
        path = self.write_scene(scene(**SHORT))
        for target in ("SSE4", "AVX2", "AVX3"):
            planned = self.sluice("plan", path, "--no-calibration", "--simd", target)
            if planned.returncode == 0:
                continue
            for done in (planned, self.sluice("run", path, "--folder", "job", "--simd", target)):
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn(f'--simd: is "{target}", but this machine runs only ', done.stderr)
            self.assertFalse((self.folder / "job").exists())

    def test_a_wrong_target_in_the_environment_hides_neither_version_nor_help(self):
        def with_target(*words):
            return subprocess.run([run_binary.SLUICE, *words], env={**os.environ, "SLUICE_SIMD": "FOO"}, text=True,
                                  capture_output=True, check=False)
        for words in (["version"], ["--version"], ["help"], ["help", "run"], ["--help"], ["run", "--help"]):
            self.assertEqual(with_target(*words).returncode, 0, words)
        done = with_target("stability", "--list")
        self.assertEqual(done.returncode, 2)
        self.assertIn("SLUICE_SIMD: ", done.stderr)

    def test_what_cannot_be_said_on_stderr_changes_no_exit_code(self):
        (self.folder / "bad.json").write_text(json.dumps(scene(gravity="down")))
        (self.folder / "study.json").write_text("{}")
        for code, words in ((3, "validate bad.json"), (3, "study study.json"), (3, "run bad.json"), (2, "run none.json")):
            with self.subTest(words), open("/dev/full", "w", encoding="utf-8") as full:
                done = subprocess.run([run_binary.SLUICE, *words.split()], cwd=self.folder, stderr=full, check=False)
                self.assertEqual(done.returncode, code)

    def test_an_output_goes_through_links_and_into_pipes_and_replaces_neither(self):
        (self.folder / "link").symlink_to("there")
        os.mkfifo(self.folder / "pipe")
        self.expect(0, "stability", "--quick", "still-tank", "--json", "link")
        self.assertTrue((self.folder / "link").is_symlink())
        json.loads((self.folder / "there").read_text())
        reader = os.open(self.folder / "pipe", os.O_RDONLY | os.O_NONBLOCK)
        self.addCleanup(os.close, reader)
        self.expect(0, "stability", "--quick", "still-tank", "--json", "pipe")
        json.loads(os.read(reader, 1 << 16))
        self.assertTrue((self.folder / "pipe").is_fifo())
        self.expect(0, "run", self.write_scene(scene(**SHORT)), "--folder", "job")
        (self.folder / "written").mkdir()
        for name in ("report.txt", "report.html"):
            (self.folder / "written" / name).symlink_to(f"../linked-{name}")
        self.expect(0, "report", "job", "--output", "written")
        for name in ("report.txt", "report.html"):
            self.assertTrue((self.folder / "written" / name).is_symlink())
            self.assertIn("small", (self.folder / f"linked-{name}").read_text())


if __name__ == "__main__":
    run_binary.SLUICE = os.path.abspath(sys.argv.pop(1))
    unittest.main(verbosity=2)
