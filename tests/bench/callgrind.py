"""Counts the instructions of a run with valgrind's callgrind, which no load on the machine disturbs."""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

CHECKPOINTED = 85  # exit status of a run that was told to stop


def available():
    return shutil.which("valgrind") is not None


class Profile:
    """What callgrind wrote of `steps` steps of a scene: one thread, AVX2 since valgrind 3.19 does not
    run AVX-512, no checkpoints. `within` leaves out all but that function and what it calls."""

    def __init__(self, program, scene, steps, within=None):
        self._folder = tempfile.TemporaryDirectory(prefix="sluice-callgrind-")
        folder = pathlib.Path(self._folder.name)
        path = folder / "scene.json"
        path.write_text(json.dumps(scene), encoding="utf-8")
        self._report = folder / "callgrind"
        command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={self._report}",
                   *([f"--toggle-collect={within}"] if within else []),
                   program, "run", str(path), "--folder", str(folder / "job"), "--threads", "1",
                   "--progress", "none", "--no-checkpoint", "--simd", "AVX2",
                   "--stop-after-step", str(steps)]
        ended = subprocess.run(command, capture_output=True, text=True, check=False)
        if ended.returncode != CHECKPOINTED or not self._report.exists():
            sys.exit(f"{' '.join(command)} ended with {ended.returncode}: {ended.stderr}")
        self.total = int(re.search(r"Collected : (\d+)", ended.stderr)[1])

    def listing(self, *options):
        """What callgrind_annotate says."""
        return subprocess.run(["callgrind_annotate", *options, self._report], check=True,
                              capture_output=True, text=True).stdout

    def inclusive(self, pattern):
        """Instructions of the first function that matches, with what it calls; 0 where none does."""
        if not hasattr(self, "_inclusive"):
            self._inclusive = self.listing("--inclusive=yes", "--threshold=100")
        found = re.search(r"^\s*([\d,]+) .*" + pattern, self._inclusive, re.MULTILINE)
        return int(found[1].replace(",", "")) if found else 0
