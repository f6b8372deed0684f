"""Still water for a million steps with kills at random instants: no bit may differ from the run
that nobody disturbed, and what drifts is told.

usage: million_steps.py SLUICE SCENE [--drifting SCENE] [--in-space] [--steps N] [--kills N] [--seed N]

The scheme of SCENE must hold the water for all steps. That of the drifting one may be ended by a
guard before, but then at the same step and with the same diagnosis with kills and without.
Of each scene only the numerics and the smoothing length over the particle distance are taken, for a
tank of 0.2 m x 0.1 m of water with 200 particles, in space of 0.06 m each way with 216.
"""

import argparse
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import time

import h5py

GRAVITY = 9.81  # m/s^2
DENSITY = 1000.0  # kg/m^3
PLANE, SPACE = (0.2, 0.1), (0.06, 0.06, 0.06)  # m, of the water
SPACING = 0.01  # m
STOPPED, FAILED = 85, 4
CHECKPOINTS = 200
SAMPLES = 2000


def still_water(example, steps, size):
    """A tank at rest with the scheme of an example, too long to end by itself."""
    width, height, *depth = size
    sound = 10 * math.sqrt(2 * GRAVITY * height)
    numerics = example["numerics"]
    ratio, courant = {"recommended": (1.5, 1.0), "paper": (1.0, 0.25)}[numerics["scheme"]]
    time = steps * courant * ratio * SPACING / sound  # s, with steps as long as at rest
    return {
        "name": "still",
        "tank": {"width": width, "height": 1.5 * height, **({"depth": depth[0]} if depth else {})},
        "fluid": [{"shape": "box" if depth else "rectangle", "corner": [0] * len(size), "size": list(size)}],
        "gravity": [0, -GRAVITY] + [0] * len(depth),
        "material": {"density": DENSITY, "sound_speed": sound},
        "resolution": {"spacing": SPACING, "smoothing_ratio": ratio},
        "numerics": numerics,
        "sensors": [
            {"name": "floor", "kind": "pressure", "position": [0.5 * width, 0] + [0.5 * each for each in depth],
             "interval": time / SAMPLES},
            {"name": "energy", "kind": "energy", "interval": time / SAMPLES},
        ],
        "end_time": 2 * time,
    }


def command(sluice, target, folder, steps):
    return [sluice, "run", target, *folder, "--threads", "1", "--progress", "json",
            "--stop-after-step", str(steps), "--checkpoint-every", str(max(1, steps // CHECKPOINTS))]


def outcome_of(folder):
    path = folder / "outcome.json"
    if not path.exists():
        sys.exit(f"{folder.name}: the scene was refused")
    return json.loads(path.read_text())


def what_counts(outcome):
    """What must not depend on kills."""
    return [outcome[key] for key in ("state", "step", "time", "diagnosis", "removed", "digests")]


def undisturbed(sluice, scene, folder, steps):
    """Returns the outcome and the seconds that the run took."""
    start = time.monotonic()
    subprocess.run(command(sluice, scene, ["--folder", str(folder)], steps), check=False,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return outcome_of(folder), time.monotonic() - start


def disturbed(sluice, scene, folder, steps, delays):
    """Kills the run after each of the delays. Returns the outcome, the number of kills and the steps
    gone on from."""
    resumed, kills = [], 0
    target, where = scene, ["--folder", str(folder)]
    for delay in [*delays, None]:
        process = subprocess.Popen(command(sluice, target, where, steps), text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        first = json.loads(process.stdout.readline())
        if first["event"] == "resumed":
            resumed.append(first["step"])
        if delay is not None:
            time.sleep(delay)
            process.kill()
        process.stdout.read()
        if process.wait() in (STOPPED, FAILED):
            break
        kills += 1
        if folder.is_dir():
            target, where = str(folder), []
    return outcome_of(folder), kills, resumed


def drift(folder, size):
    """Of the last twentieth of the run: floor pressure over rho g H, and energy over that times the volume."""
    checkpoint = max(folder.glob("checkpoint-*.h5"))
    with h5py.File(checkpoint) as file:
        last = max(1, int(file["series/0000"].attrs["count"]) // 20)
        floor = file["series/0000/values"][-last:, 0, 0].mean() / (DENSITY * GRAVITY * size[1])
        energy = file["series/0001/values"][:, 0, :]
        columns = list(file["series/0001"].attrs["columns"])
        scale = DENSITY * GRAVITY * size[1] * math.prod(size)
        kinetic = energy[-last:, columns.index("kinetic")].mean() / scale
        total = sum(energy[:, columns.index(name)] for name in ("kinetic", "potential", "internal"))
        change = (total[-last:].mean() - total[0]) / scale
        return {"floor pressure": floor, "kinetic energy": kinetic, "energy change": change,
                "particles": file["particles"].attrs["count"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sluice")
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("--drifting", type=pathlib.Path)
    parser.add_argument("--in-space", action="store_true")
    parser.add_argument("--steps", type=int, default=1_000_000)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    size = SPACE if arguments.in_space else PLANE
    dice = random.Random(arguments.seed)
    failed = False
    for example in filter(None, [arguments.scene, arguments.drifting]):
        with tempfile.TemporaryDirectory(prefix="sluice-still-") as name:
            root = pathlib.Path(name)
            scene = root / "scene.json"
            scene.write_text(json.dumps(still_water(json.loads(example.read_text()),
                                                    arguments.steps, size)))
            calm, seconds = undisturbed(arguments.sluice, scene, root / "calm", arguments.steps)
            longest = 1.6 * seconds / (arguments.kills + 1)
            delays = [dice.uniform(0, longest) for _ in range(arguments.kills)]
            storm, kills, resumed = disturbed(arguments.sluice, scene, root / "storm",
                                              arguments.steps, delays)
            same = what_counts(storm) == what_counts(calm)
            held = calm["step"] == arguments.steps and not any(calm["removed"].values())
            failed |= not same or kills < arguments.kills / 2
            failed |= example == arguments.scene and not held
            figures = ", ".join(f"{key} {value:.4g}" for key, value in drift(root / "storm", size).items())
            print(f"{example.name}: {calm['step']} steps, {kills} kills, gone on "
                  f"{len(resumed)} times from steps up to {max(resumed, default=0)}: "
                  f"{'same end and digests' if same else 'THE ENDS DIFFER'}; {figures}", flush=True)
            if not held:
                print(f"  {calm['reason']}", flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
