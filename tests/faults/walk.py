"""Lets one system call after the other fail, in the life of a run and of the service.

usage: walk.py SLUICE INTERPOSER [worker] [service] [--every K] [--seed N] [--operation NAME]

Each operation is done once undisturbed, which counts its calls; then once for each of its calls and
each fault that fits the call (faults.py). Prints the number of calls walked per operation, and every
finding with the case that shows it again. --every K takes a K-th of the cases, at random.
"""

import argparse
import concurrent.futures
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

import faults
from service_walk import ServiceWalk
from worker_walk import WorkerWalk

SIDE_BY_SIDE = 2
SKIPPED = 77


def is_sanitized(program):
    """A sanitizer's runtime has to be the first library."""
    shown = subprocess.run(["ldd", program], capture_output=True, text=True, check=False).stdout
    return "libasan" in shown or "libtsan" in shown


def walk(target, arguments):
    """The number of faults after which something was wrong."""
    findings = 0
    chosen = random.Random(arguments.seed)
    operations = [name for name in target.operations if arguments.operation in (None, name)]
    for operation in operations:
        begun = time.monotonic()
        kinds = target.calls(operation)
        cases = faults.cases_of(operation, kinds)
        if arguments.only:
            cases = [case for case in cases if case.number == arguments.only]
        cases = chosen.sample(cases, max(1, len(cases) // arguments.every))
        with concurrent.futures.ThreadPoolExecutor(target.side_by_side) as pool:
            for case, (what, found) in zip(cases, pool.map(target.problems_of, cases)):
                if found:
                    findings += 1
                    print(f"  {case}, {what}:", *dict.fromkeys(found), sep="\n    ", flush=True)
        print(f"{operation}: {len(kinds)} calls, {len(cases)} faults, "
              f"{time.monotonic() - begun:.0f} s", flush=True)
    return findings


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sluice")
    parser.add_argument("interposer")
    parser.add_argument("parts", nargs="*", metavar="worker, service")
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--operation")
    parser.add_argument("--burst", type=int, default=1, help="so many calls in a row fail")
    parser.add_argument("--only", type=int, help="only faults at this call")
    arguments = parser.parse_args()
    faults.Control.burst = arguments.burst
    if is_sanitized(arguments.sluice):
        print("skipped: sanitized")
        return SKIPPED
    folder = pathlib.Path(tempfile.mkdtemp(prefix="sluice-faults-"))
    findings = 0
    parts = {"worker": WorkerWalk, "service": ServiceWalk}
    for part in arguments.parts or parts:
        place = folder / part
        place.mkdir()
        target = parts[part](arguments.sluice, arguments.interposer, place)
        target.side_by_side = SIDE_BY_SIDE
        try:
            findings += walk(target, arguments)
        finally:
            target.close()
    if findings:
        print(f"{findings} findings; left for a look: {folder}")
        return 1
    shutil.rmtree(folder)
    print("0 findings")
    return 0


if __name__ == "__main__":
    sys.exit(main())
