"""Runs the beginning of every shipped scene on SIMD targets, in both precisions and with one thread and two, and
holds the digests of its physics and of its series against a list.

Usage: digests.py SLUICE SCENES LIST [--target T]... [--threads N]... [--jobs N] [--write]

A scene runs to a hundredth of its end time. --write makes the list from what this build computes: a
change that means to leave results alone is checked against the list of the commit before it. One line per scene,
target and precision; exit status 1 when a digest differs from the list or between numbers of
threads.
"""

import argparse
import concurrent.futures
import hashlib
import json
import os
import subprocess
import sys
import tempfile

from shipped_scenes import PRECISIONS, copy_meshes, runs_here, shipped, variant

TARGETS = ("SSE4", "AVX2")  # what nearly every machine has
SHARE = 0.01  # of a scene's end time
LEFT_OUT = ("spheric2", "spheric2-fine", "valley")  # to place their particles takes longer than all the others' beginnings


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("scenes", help="folder of scenes")
    parser.add_argument("list", help="file of digests")
    parser.add_argument("--target", action="append")
    parser.add_argument("--threads", type=int, action="append", help="1 and 2 by default")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    arguments.program = os.path.abspath(arguments.program)
    return arguments


def digests_of(program, folder, scene, target, precision, threads):
    """Digests of the physics and of all series, or how the run ended instead."""
    beginning = argparse.Namespace(end_time=scene["end_time"] * SHARE, spacing=None)
    job = os.path.join(folder, f"{scene['name']}-{target}-{precision}-{threads}")
    with open(job + ".json", "w", encoding="utf-8") as stream:
        stream.write(variant(scene, precision, 0, beginning))
    ended = subprocess.run([program, "run", job + ".json", "--folder", job, "--threads", str(threads),
                            "--progress", "none"],
                           env={**os.environ, "SLUICE_SIMD": target}, capture_output=True, text=True)
    if ended.returncode != 0:
        return f"exit-{ended.returncode}", ended.stderr.strip().replace("\n", " ")
    with open(os.path.join(job, "outcome.json"), encoding="utf-8") as stream:
        outcome = json.load(stream)
    series = json.dumps(outcome["digests"]["series"], sort_keys=True)
    return outcome["digests"]["physics"][:32], hashlib.sha256(series.encode()).hexdigest()[:32]


def read_list(path):
    """{(scene, target, precision): (physics, series)}"""
    try:
        with open(path, encoding="utf-8") as stream:
            rows = [line.split() for line in stream if line.strip() and not line.startswith("#")]
    except FileNotFoundError:
        return {}
    return {tuple(row[:3]): tuple(row[3:]) for row in rows}


def write_list(path, rows):
    with open(path, "w", encoding="utf-8") as stream:
        stream.write("# Made by digests.py --write: scene, SIMD target, sums, digest of the physics, of all series.\n")
        stream.writelines(" ".join((*key, *digests)) + "\n" for key, digests in rows)


def compute(arguments, folder):
    """((scene, target, precision), [digests for each number of threads]) in order."""
    targets = [target for target in arguments.target or TARGETS if runs_here(arguments.program, target)]
    for _, scene in shipped(arguments.scenes, None):
        copy_meshes(arguments.scenes, scene, folder)
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        pending = [((name, target, precision),
                    [pool.submit(digests_of, arguments.program, folder, scene, target, precision, threads)
                     for threads in arguments.threads or (1, 2)])
                   for name, scene in shipped(arguments.scenes, None) if name not in LEFT_OUT
                   for target in targets for precision in PRECISIONS]
        for key, runs in pending:
            yield key, [run.result() for run in runs]


def main():
    arguments = parse_arguments()
    known = read_list(arguments.list)
    rows, wrong = [], 0
    with tempfile.TemporaryDirectory() as folder:
        for key, each in compute(arguments, folder):
            one = each[0]
            rows.append((key, one))
            verdict = "failed" if one[0].startswith("exit-") else \
                "threads differ" if len(set(each)) > 1 else "" if arguments.write else \
                "same" if known.get(key) == one else "not in the list" if key not in known else "differs"
            wrong += verdict not in ("", "same")
            print(" ".join((*key, *one, verdict)), flush=True)
    if arguments.write and not wrong:
        write_list(arguments.list, rows)
    print(f"{len(rows)} rows, {wrong} wrong")
    return 1 if wrong or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
