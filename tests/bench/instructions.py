"""Instructions per particle and step of the engine, counted by callgrind: a guard against slower
code that no load on the machine can disturb.

Usage: instructions.py SLUICE SCENES [--profile]

Counts inside Solver::step only, on 800 particles over 130 steps (with sorts, lists and
reinitialisations in them). Each count is held against what it was when this file was last changed: more than 5 % above fails, more than 5 %
below asks to lower the figure here. --profile also prints the functions that they go to.
"""

import json
import os
import re
import sys

import callgrind

# Instructions per particle and step, g++ 12.2 of Debian 12.
EXPECTED = {"dambreak-paper.json": 498.0, "dambreak.json": 832.0}
SPACING = 0.015
STEPS = 130
PARTICLES = 800
TOLERANCE = 0.05


def small(scene):
    scale = SPACING / scene["resolution"]["spacing"]
    scene["resolution"]["spacing"] = SPACING
    for sensor in scene["sensors"]:
        sensor["interval"] *= scale
    scene["output"] = {}
    return scene


def print_shares(profile):
    """The functions with the largest shares, one line each."""
    lines = re.findall(r"^ *([\d,]+) \( *([\d.]+)%\) +\S*?:(.*?)(?: \[.*)?$", profile.listing(), re.M)
    for count, share, name in lines[:14]:
        per_step = int(count.replace(",", "")) / (PARTICLES * STEPS)
        print(f"  {per_step:8.1f}  {share:>5} %  {name[:110]}")


def main():
    program, scenes = sys.argv[1:3]
    with_profile = "--profile" in sys.argv[3:]
    if not callgrind.available():
        print("skipped: valgrind is not installed (deploy/install-dependencies.sh --tests)")
        return 77
    failed = 0
    for name, expected in EXPECTED.items():
        with open(os.path.join(scenes, name), encoding="utf-8") as stream:
            scene = small(json.load(stream))
        profile = callgrind.Profile(program, scene, STEPS, within="sluice::SolverN<2>::step()")
        if with_profile:
            print_shares(profile)
        seen = profile.total / (PARTICLES * STEPS)
        off = seen / expected - 1.0
        print(f"{name}: {seen:.1f} instructions per particle and step, {off:+.1%} of {expected:.1f}")
        if abs(off) > TOLERANCE:
            failed += 1
            print("  too many: what made the engine slower?" if off > 0 else
                  "  fewer: lower EXPECTED, so that it stays so")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
