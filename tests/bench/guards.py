"""What the guards of a run cost, in instructions, so that the load of the machine does not matter.

usage: guards.py SLUICE SCENE... [--steps N]

Each scene, less its sensors, runs for some steps under callgrind (valgrind; AVX2, which it can run), and the
instructions of Simulation::step() are told apart: what the run asks and sums for its guards alone
(all but the solver's step), and the engine's pass `measure`, which the guards share
with the time step (largest speed) and with the domain (who left it).
"""

import argparse
import json
import pathlib
import sys

from callgrind import Profile

PARTS = {
    "step": r"sluice::Simulation::step\(\)",
    "solver": r"sluice::SolverN<2>::step\(\)",
    "measure": r"::measure<2>\(sluice::ParticleSpan<2> const&, sluice::MethodN<2> const&, ",
}
ALLOWED = 0.01  # of a step's instructions, for what is the guards' alone


def instructions(program, scene, steps):
    """Instructions of each part, with what it calls."""
    content = json.loads(pathlib.Path(scene).read_text(encoding="utf-8"))
    for key in ("sensors", "reference"):
        content.pop(key, None)
    profile = Profile(program, content, steps)
    return {part: profile.inclusive(pattern) for part, pattern in PARTS.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sluice")
    parser.add_argument("scene", nargs="+")
    parser.add_argument("--steps", type=int, default=100)
    arguments = parser.parse_args()
    failed = False
    for scene in arguments.scene:
        count = instructions(arguments.sluice, scene, arguments.steps)
        whole = count["step"]
        if not whole or not count["measure"]:
            sys.exit(f"callgrind did not see the steps of {scene}")
        alone = (whole - count["solver"]) / whole
        shared = count["measure"] / whole
        failed |= alone > ALLOWED
        print(f"{pathlib.Path(scene).name}: {whole / arguments.steps / 1e6:.2f} million instructions "
              f"a step; guards alone {100 * alone:.2f} %, the pass they share {100 * shared:.2f} %")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
