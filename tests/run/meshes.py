"""Runs of scenes with meshes: files beside the scene, kept in the job's folder, and not to be changed.

usage: meshes.py SLUICE [unittest arguments]
"""

import json
import os
import sys
import unittest

import run_binary
from meshes_of_tests import ramp, scene_with_mesh
from run_binary import Sandbox


class Meshes(Sandbox):
    def setUp(self):
        super().setUp()
        self.mesh = self.folder / "ramp.stl"
        self.mesh.write_bytes(ramp(0.16))

    assert_kills_change_no_bit = run_binary.Restart.assert_kills_change_no_bit

    def assert_tidy(self, folder):
        self.assertEqual((self.folder / folder / "ramp.stl").read_bytes(), self.mesh.read_bytes())
        (self.folder / folder / "ramp.stl").unlink()
        super().assert_tidy(folder)

    def test_kills_change_no_bit(self):
        self.assert_kills_change_no_bit(scene_with_mesh(end_time=2.5), 6)

    def test_the_verbs_read_the_mesh_beside_the_scene(self):
        path = self.write_scene(scene_with_mesh())
        self.assertIn("is a valid scene", self.expect(0, "validate", path).stdout)
        self.expect(0, "plan", path, "--no-calibration")
        self.mesh.unlink()
        refused = self.expect(3, "validate", path).stderr
        self.assertIn("/obstacles/0/file", refused)
        self.assertIn("there is no such file in", refused)

    def test_the_folder_needs_no_other_file(self):
        path = self.write_scene(scene_with_mesh())
        self.expect(85, "run", path, "--folder", "job", "--stop-after-step", 2)
        self.mesh.unlink()
        self.expect(85, "run", "job", "--stop-after-step", 4)
        self.expect(0, "validate", self.folder / "job" / "scene.json")
        kept = json.loads((self.folder / "job" / "scene.json").read_text())
        self.assertRegex(kept["obstacles"][0]["sha256"], "^[0-9a-f]{64}$")

    def test_a_run_does_not_resume_with_another_mesh(self):
        path = self.write_scene(scene_with_mesh())
        self.expect(85, "run", path, "--folder", "job", "--stop-after-step", 2)
        (self.folder / "job" / "ramp.stl").write_bytes(ramp(0.15))
        refused = self.expect(3, "run", "job").stderr
        self.assertIn("/obstacles/0/sha256", refused)
        self.assertIn("the file was changed", refused)
        (self.folder / "job" / "ramp.stl").write_bytes(ramp(0.16))
        self.expect(85, "run", "job", "--stop-after-step", 4)

    def test_a_folder_is_not_taken_by_a_scene_with_another_mesh(self):
        path = self.write_scene(scene_with_mesh())
        self.expect(85, "run", path, "--folder", "job", "--stop-after-step", 2)
        self.mesh.write_bytes(ramp(0.15))
        refused = self.expect(3, "run", path, "--folder", "job").stderr
        self.assertIn("holds a run of another scene: /obstacles/0/sha256 is", refused)

    def test_a_mesh_is_no_link_in_a_job_folder(self):
        path = self.write_scene(scene_with_mesh())
        self.expect(85, "run", path, "--folder", "job", "--stop-after-step", 2)
        kept = self.folder / "job" / "ramp.stl"
        kept.unlink()
        kept.symlink_to(self.mesh)
        self.assertIn("cannot be read", self.expect(3, "run", "job").stderr)

    def test_a_folder_whose_making_was_cut_short_is_made_again(self):
        (self.folder / "job").mkdir()
        (self.folder / "job" / "lock").touch()
        (self.folder / "job" / "ramp.stl").write_bytes(ramp(0.15))
        self.expect(85, "run", self.write_scene(scene_with_mesh()), "--folder", "job", "--stop-after-step", 2)
        self.assertEqual((self.folder / "job" / "ramp.stl").read_bytes(), self.mesh.read_bytes())

    def test_a_study_reads_its_meshes_beside_it(self):
        self.write_scene(scene_with_mesh(end_time=0.002))
        study = {"name": "ramps", "scene": "case.json", "vary": [{"key": "/numerics/courant", "values": [0.5, 1]}]}
        self.write_scene(study, "study.json")
        self.expect(0, "study", "study.json", "--folder", "study", "--cores", 1)
        runs = sorted((self.folder / "study" / "runs").glob("*/ramp.stl"))
        self.assertEqual(len(runs), 2)


if __name__ == "__main__":
    run_binary.SLUICE = os.path.abspath(sys.argv.pop(1))
    unittest.main(verbosity=2)
