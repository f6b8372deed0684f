"""Runs the commands of README.md as they stand: those in the blocks marked <!-- tested -->, one
after the other in one shell, in a fresh folder that stands for the clone.

Three things differ from what a reader types: the port is a free one, so that the test does not meet
another service; the scene is coarser, unless --as-it-is is given; and between two blocks the
shell waits until the service answers and its job runs or has ended, which is less than the time that
a reader takes.

Usage: readme_commands.py SLUICE ROOT [--as-it-is]
"""

import csv
import json
import os
import re
import socket
import subprocess
import sys
import tempfile

BLOCK = re.compile(r"^<!-- tested -->\n```sh\n(.*?)^```$", re.MULTILINE | re.DOTALL)
SCENE = "schemas/examples/dambreak.json"
FINE = "0.0015"  # m, the spacing that the reader writes
COARSE = "0.003"  # and the test; coarser, quick machines end the run before it is killed

# What a reader does meanwhile: wait until the service answers and the job's last attempt has begun,
# with a checkpoint when one was asked for. The service is a background job of this shell; it is
# killed however the script ends.
PREAMBLE = r"""set -eu -o pipefail
trap 'kill $(jobs -p) 2>/dev/null || true; wait' EXIT
has_settled() {
  curl -s http://127.0.0.1:8080/v1/jobs >jobs.now || return 1
  if grep -qE '"jobs":\[\]|"state":"completed"' jobs.now; then return; fi
  local begun
  begun=$(cat data/jobs/*/log.jsonl | grep -cE '"event":"(started|resumed)"')
  grep -q "\"state\":\"running\".*\"attempts\":$begun,.*\"step\":" jobs.now
}
has_checkpoint() { find data/jobs -name 'checkpoint-*[1-9]*.h5' | grep -q .; }
read_on() {
  for _ in $(seq 1200); do
    if "$1"; then return; fi
    sleep 0.1
  done
  echo "waited in vain: $1" >&2
  return 1
}
"""


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def make_clone(folder, program, root):
    """What the commands need of a clone with a build: the program and the scenes."""
    os.makedirs(os.path.join(folder, "build/release/cli"))
    os.symlink(program, os.path.join(folder, "build/release/cli/sluice"))
    os.symlink(os.path.join(os.path.abspath(root), "schemas"), os.path.join(folder, "schemas"))


def script_of(readme):
    with open(readme, encoding="utf-8") as stream:
        blocks = BLOCK.findall(stream.read())
    script = PREAMBLE
    for block in blocks:
        script += "set -x\n" + block + "{ set +x; } 2>/dev/null\n"
        if "/checkpoint\n" in block:
            script += "read_on has_checkpoint\n"
        if block != blocks[-1]:
            script += "read_on has_settled\n"
    return len(blocks), script


def check(folder, said):
    """What the reader was promised."""
    jobs = os.listdir(os.path.join(folder, "data/jobs"))
    assert len(jobs) == 1, f"jobs: {jobs}"
    with open(os.path.join(folder, "data/jobs", jobs[0], "outcome.json"), encoding="utf-8") as out:
        outcome = json.load(out)
    assert outcome["state"] == "completed", outcome["state"]
    assert outcome["bit_exact"] is True
    # Once for the killed worker, unless the service was killed before it saw that, once for the service.
    resumed = re.findall(r'"name":"resumed".*?"step":(\d+)', said)
    assert len(resumed) in (1, 2) and int(resumed[0]) > 0, f"resumed at steps {resumed}"
    assert re.search(r"^relative L2", said, re.MULTILINE), "no report"
    with open(os.path.join(folder, "P1.csv"), encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    # T = 8 in the paper's units is 1.399 s; the column stands still and P1 feels air alone at first.
    assert float(rows[0]["value"]) == 0.0, rows[0]
    assert abs(float(rows[-1]["time"]) - 8.0) < 0.01, rows[-1]
    wet = [float(row["value"]) for row in rows if row["value"]]
    # The hydrostatic pressure of a column as high as the water stood is 1; the impact exceeds it.
    assert 1.0 < max(wet) < 100.0, f"highest pressure {max(wet)}"


def main():
    program, root = os.path.abspath(sys.argv[1]), sys.argv[2]
    as_it_is = "--as-it-is" in sys.argv[3:]
    count, script = script_of(os.path.join(root, "README.md"))
    assert count >= 5, f"README.md has only {count} blocks marked <!-- tested -->"
    with tempfile.TemporaryDirectory(prefix="sluice-readme-") as folder:
        make_clone(folder, program, root)
        script = script.replace("8080", str(free_port()))
        if not as_it_is:
            assert FINE in script, f"README.md makes no scene with a spacing of {FINE}"
            script = script.replace(FINE, COARSE)
        result = subprocess.run(["bash", "-c", script], cwd=folder, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True, timeout=3600, check=False)
        try:
            assert result.returncode == 0, f"bash ended with {result.returncode}"
            check(folder, result.stdout)
        except Exception:
            print(result.stdout)
            raise
    print(f"{count} blocks of README.md ran as they stand")


if __name__ == "__main__":
    main()
