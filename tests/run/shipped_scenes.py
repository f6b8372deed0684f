"""Runs the shipped scenes on every SIMD target of this machine, in both precisions, and prints how they ended.

Usage: shipped_scenes.py SLUICE SCENES [--folder DIR] [--scene NAME]... [--target T]... [--precision P]...
                         [--members N] [--end-time S] [--spacing S] [--jobs N]

A dam break is run --members times (8 by default), each with its particles displaced by 1e-4 of their distance with
another seed; any other scene once. A row says how many runs failed, how many particles were excluded, leaked and
overtopped (median and most), and the mean relative L2 error of the pressures against the experiment where there is
one: median and spread of all, and the medians of the members with and without excluded particles.

What is complete in --folder is not run again. Without --folder all is done in a temporary one. Exit status 1 when any
run failed.
"""

import argparse
import concurrent.futures
import glob
import hashlib
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile

TARGETS = ("SSE4", "AVX2", "AVX3")
PRECISIONS = ("mixed", "double")
AMPLITUDE = 1e-4


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("scenes", help="folder of scenes")
    parser.add_argument("--folder")
    parser.add_argument("--scene", action="append", help="name of a file without .json")
    parser.add_argument("--target", action="append", choices=TARGETS)
    parser.add_argument("--precision", action="append", choices=PRECISIONS)
    parser.add_argument("--members", type=int, default=8)
    parser.add_argument("--end-time", type=float)
    parser.add_argument("--spacing", type=float)
    parser.add_argument("--jobs", type=int, default=1)
    return parser.parse_args()


def runs_here(program, target):
    environment = {**os.environ, "SLUICE_SIMD": target}
    asked = subprocess.run([program, "validate", "-"], input=b"", env=environment, capture_output=True)
    return asked.returncode != 2  # a wrong use: so that is no target of this machine


def shipped(folder, wanted):
    for path in sorted(glob.glob(os.path.join(folder, "*.json"))):
        with open(path, encoding="utf-8") as stream:
            scene = json.load(stream)
        name = os.path.splitext(os.path.basename(path))[0]
        if "fluid" in scene and (not wanted or name in wanted):
            yield name, scene


def copy_meshes(scenes, scene, folder):
    """Puts the files that a scene names beside the file that it is run from."""
    for shape in scene["fluid"] + scene.get("obstacles", []):
        if "file" in shape:
            os.makedirs(folder, exist_ok=True)
            shutil.copy(os.path.join(scenes, shape["file"]), folder)


def is_dam_break(name):
    return name.startswith(("dambreak", "martin-moyce")) or name == "spheric2"


def variant(scene, precision, seed, arguments):
    scene = json.loads(json.dumps(scene))
    scene.setdefault("numerics", {})["precision"] = precision
    if seed:
        scene["perturbation"] = {"amplitude": AMPLITUDE, "seed": seed}
    if arguments.end_time:
        scene["end_time"] = arguments.end_time
    if arguments.spacing:
        scene["resolution"]["spacing"] = arguments.spacing
    scene["output"] = {}
    return json.dumps(scene, indent=1)


def load(path):
    try:
        with open(path, encoding="utf-8") as stream:
            return json.load(stream)
    except (OSError, ValueError):
        return None


def run(program, folder, text, target):
    """The outcome and the report of a run that is complete, or was made so."""
    key = hashlib.sha256(text.encode()).hexdigest()[:12]
    job = f"{folder}-{key}"
    outcome = load(os.path.join(job, "outcome.json"))
    if outcome is None or outcome["state"] == "stopped":
        os.makedirs(os.path.dirname(job), exist_ok=True)
        scene = job + ".json"
        with open(scene, "w", encoding="utf-8") as stream:
            stream.write(text)
        subprocess.run([program, "run", scene, "--folder", job, "--threads", "1", "--progress", "none"],
                       env={**os.environ, "SLUICE_SIMD": target}, capture_output=True)
        outcome = load(os.path.join(job, "outcome.json"))
    return outcome, load(os.path.join(job, "report.json"))


def error_of(report):
    return ((report or {}).get("comparison") or {}).get("mean_relative_l2")


def middle(values):
    return f"{statistics.median(values):.3f}" if values else "-"


def counts(outcomes, cause):
    values = [one["removed"][cause] for one in outcomes if one and "removed" in one]
    return f"{statistics.median(values):g} ({max(values)})" if values else "-"


def row(name, target, precision, results):
    outcomes = [outcome for outcome, _ in results]
    failed = [one for one in outcomes if one is None or one["state"] != "completed"]
    errors = [(error_of(report), outcome["removed"]["excluded"]) for outcome, report in results
              if outcome and error_of(report) is not None]
    all_errors = [error for error, _ in errors]
    spread = f"{min(all_errors):.3f}-{max(all_errors):.3f}" if all_errors else "-"
    print(f"{name:<24} {target:<5} {precision:<7} {len(failed):>3}/{len(results):<3}"
          f" {counts(outcomes, 'excluded'):>10} {counts(outcomes, 'leaked'):>10} {counts(outcomes, 'overtopped'):>10}"
          f" {middle(all_errors):>7} {spread:>12}"
          f" {middle([e for e, n in errors if n == 0]):>8} {middle([e for e, n in errors if n > 0]):>8}", flush=True)
    for one in failed:
        print("    failed: " + (one["reason"] if one else "no outcome"))
    return len(failed)


def table(arguments, folder):
    targets = [t for t in arguments.target or TARGETS if runs_here(arguments.program, t)]
    print(f"{'scene':<24} {'SIMD':<5} {'sums':<7} {'failed':>7} {'excluded':>10} {'leaked':>10} {'overtopped':>10}"
          f" {'error':>7} {'from-to':>12} {'none out':>8} {'some out':>8}")
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        rows = []
        for name, scene in shipped(arguments.scenes, arguments.scene):
            seeds = range(1, arguments.members + 1) if is_dam_break(name) else [0]
            for target in targets:
                copy_meshes(arguments.scenes, scene, os.path.join(folder, target))
                for precision in arguments.precision or PRECISIONS:
                    place = os.path.join(folder, target, f"{name}-{precision}")
                    members = [pool.submit(run, arguments.program, f"{place}-{seed}",
                                           variant(scene, precision, seed, arguments), target) for seed in seeds]
                    rows.append((name, target, precision, members))
        for name, target, precision, members in rows:
            failed += row(name, target, precision, [member.result() for member in members])
    return failed, len(rows)


def main():
    arguments = parse_arguments()
    arguments.program = os.path.abspath(arguments.program)
    if arguments.folder:
        failed, rows = table(arguments, os.path.abspath(arguments.folder))
    else:
        with tempfile.TemporaryDirectory() as folder:
            failed, rows = table(arguments, folder)
    print(f"{failed} runs failed")
    return 1 if failed or rows == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
