"""What a run does when its folder is moved, removed or replaced, and when its standard streams are closed.

usage: folders.py SLUICE [unittest arguments]
"""

import itertools
import json
import os
import shutil
import subprocess
import sys
import unittest

import run_binary
from run_binary import Sandbox, scene

ENDLESS = scene(end_time=5e3, output={"frames": {"interval": 0.1}})
OFTEN = ("--checkpoint-every", 20)


class Moved(Sandbox):
    def running(self, *options):
        process = self.start("run", self.write_scene(ENDLESS), "--folder", "job", *options, stderr=subprocess.PIPE)
        self.addCleanup(process.stderr.close)
        self.wait_for(process, "checkpoint")
        return process

    def stop(self, process, code):
        """What it said on stderr."""
        said = process.communicate()[1]
        self.assertEqual(process.returncode, code, said)
        return said

    def test_a_folder_that_is_renamed_keeps_its_run(self):
        process = self.running(*OFTEN)
        (self.folder / "job").rename(self.folder / "a new name")
        for _ in range(3):
            self.wait_for(process, "checkpoint")
        process.terminate()
        said = self.stop(process, 85)
        self.assertIn(f"sluice run '{self.folder}/a new name'", said)
        self.assertFalse((self.folder / "job").exists())
        step = self.outcome("a new name")["step"]
        self.assertTrue((self.folder / "a new name" / f"checkpoint-{step:012}.h5").exists())
        self.assert_tidy("a new name")
        self.expect(85, "run", "a new name", "--stop-after-step", step + 1)

    def test_another_folder_in_its_place_is_left_alone(self):
        process = self.running(*OFTEN)
        (self.folder / "job").rename(self.folder / "old")
        (self.folder / "job").mkdir()
        (self.folder / "job" / "thesis.txt").write_text("years of work")
        for _ in range(3):
            self.wait_for(process, "checkpoint")
        process.terminate()
        self.stop(process, 85)
        self.assertEqual([path.name for path in (self.folder / "job").iterdir()], ["thesis.txt"])
        self.assert_tidy("old")

    def test_a_parent_that_is_renamed_keeps_its_run(self):
        (self.folder / "one").mkdir()
        process = self.start("run", self.write_scene(ENDLESS), "--folder", "one/job", *OFTEN)
        self.wait_for(process, "checkpoint")
        (self.folder / "one").rename(self.folder / "two")
        self.wait_for(process, "checkpoint")
        process.terminate()
        process.stdout.read()
        self.assertEqual(process.wait(), 85)
        self.assertFalse((self.folder / "one").exists())
        self.assert_tidy("two/job")

    def test_a_study_whose_folder_is_renamed_keeps_its_runs(self):
        study = {"name": "pair", "scene": ENDLESS, "vary": [{"key": "/end_time", "values": [0.05, 5e3]}]}
        (self.folder / "study.json").write_text(json.dumps(study))
        process = self.start("study", "study.json", "--folder", "out", "--cores", 1)
        while not list(self.folder.glob("out/runs/*/checkpoint-*.h5")):
            self.assertIsNone(process.poll())
        (self.folder / "out").rename(self.folder / "moved")
        while not list(self.folder.glob("moved/runs/pair-end_time-5000/checkpoint-*.h5")):
            self.assertIsNone(process.poll())
        process.terminate()
        process.stdout.read()
        self.assertEqual(process.wait(), 85)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["moved", "study.json"])
        self.assertTrue((self.folder / "moved" / "results.json").exists())

    def test_a_folder_that_is_removed_ends_the_run_with_a_word_and_does_not_come_back(self):
        process = self.running(*OFTEN)
        # Moved first: what is removed file by file may get a new file meanwhile.
        (self.folder / "job").rename(self.folder / "doomed")
        while (self.folder / "doomed").exists():
            shutil.rmtree(self.folder / "doomed", ignore_errors=True)
        said = self.stop(process, 5)
        self.assertIn("was removed or replaced", said)
        self.assertNotIn("to resume", said)
        self.assertEqual([path.name for path in self.folder.iterdir()], ["case.json"])

    def test_a_lock_that_is_removed_ends_the_run_because_another_could_begin(self):
        process = self.running(*OFTEN)
        (self.folder / "job" / "lock").unlink()
        self.assertIn("was removed or replaced", self.stop(process, 5))
        self.assertFalse((self.folder / "job" / "outcome.json").exists())


class Closed(Sandbox):
    def test_closed_streams_get_no_file_of_the_job(self):
        path = self.write_scene(scene(end_time=0.05))
        for streams in itertools.chain.from_iterable(itertools.combinations((0, 1, 2), n) for n in (1, 2, 3)):
            with self.subTest(closed=streams):
                words = " ".join(f"{stream}>&-" for stream in streams)
                command = f'exec "{run_binary.SLUICE}" run "{path}" --folder job --progress json {words}'
                done = subprocess.run(["bash", "-c", command], cwd=self.folder, capture_output=True, check=False)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual((self.folder / "job" / "lock").read_bytes(), b"")
                json.loads((self.folder / "job" / "outcome.json").read_text())
                self.assert_tidy("job")
                shutil.rmtree(self.folder / "job")


if __name__ == "__main__":
    run_binary.SLUICE = os.path.abspath(sys.argv.pop(1))
    unittest.main(verbosity=2)
