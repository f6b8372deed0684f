"""The systemd unit: systemd understands each line of it, it is as closed as it should be, and what it
starts is what `sluice serve` takes. Skipped without systemd-analyze.

Usage: check_unit.py SLUICE ROOT [-v] [TEST...]
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM = ""
UNIT = ""
SKIPPED = 77

# Tenths of systemd's exposure level: 2.0.
THRESHOLD = "20"


def run(*command):
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                            timeout=60, check=False)
    return result.returncode, result.stdout


class Unit(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        with open(UNIT, encoding="utf-8") as stream:
            self.text = stream.read()

    def written(self, text):
        """The path of a unit with the program of this build; systemd looks whether there is one."""
        path = os.path.join(self.folder, "sluice.service")
        with open(path, "w", encoding="utf-8") as stream:
            stream.write(text.replace("/usr/local/bin/sluice", PROGRAM))
        return path

    def value(self, key):
        values = re.findall(rf"^{key}=(.*)$", self.text, re.MULTILINE)
        self.assertTrue(values, key)
        return values[-1]

    def seconds(self, key):
        number, unit = re.fullmatch(r"(\d+)(s|min)", self.value(key)).groups()
        return int(number) * {"s": 1, "min": 60}[unit]

    def test_has_no_line_that_systemd_does_not_understand(self):
        self.assertEqual(run("systemd-analyze", "verify", self.written(self.text)), (0, ""))
        # systemd only mumbles about unknown keys, so the check must hear it.
        wrong = self.text.replace("[Install]", "ProtectEverything=yes\n\n[Install]")
        self.assertIn("ProtectEverything",
                      run("systemd-analyze", "verify", self.written(wrong))[1])

    def exposure(self, text):
        return run("systemd-analyze", "security", "--offline=true", "--no-pager",
                   f"--threshold={THRESHOLD}", self.written(text))

    def test_is_exposed_at_most_2_of_10(self):
        code, said = self.exposure(self.text)
        self.assertEqual(code, 0, said)
        opened = re.sub(r"^SystemCallFilter=.*\n", "", self.text, flags=re.MULTILINE)
        self.assertNotEqual(self.exposure(opened)[0], 0)

    def test_gives_the_drain_more_time_than_the_service_takes_for_it(self):
        found = re.search(r"--stop-seconds .*?=(\d+)",
                          run(PROGRAM, "serve", "--help")[1])
        self.assertTrue(found)
        self.assertGreater(self.seconds("TimeoutStopSec"), 2 * int(found.group(1)))

    def test_starts_the_service_with_options_that_it_knows(self):
        words = self.value("ExecStart").split()
        self.assertEqual(words[:2], ["/usr/local/bin/sluice", "serve"])
        given = [word for word in words[2:] if word.startswith("--")]
        self.assertTrue({"--data", "--token-file"} <= set(given))
        known = run(PROGRAM, "serve", "--help")[1]
        for option in given:
            self.assertRegex(known, rf"(?m)^  {option} ")


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    UNIT = os.path.join(sys.argv.pop(1), "deploy", "sluice.service")
    if not shutil.which("systemd-analyze"):
        print("skipped: there is no systemd-analyze here (Debian's package systemd)")
        sys.exit(SKIPPED)
    unittest.main()
