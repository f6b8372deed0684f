"""Runs every shipped scene to its end: on each SIMD target of this machine, in both precisions, and
dam breaks as ensembles of members perturbed by 1e-4 of the particle distance.

usage: shipped_scenes.py SLUICE EXAMPLES [--folder DIR] [--members N] [--side-by-side N]
                         [--scene NAME]... [--target NAME]... [--precision WORD]...
                         [--end-time S] [--spacing FACTOR]

Prints one row per scene, target and precision: members that failed, particles excluded, leaked and
overtopped (median, most), and the error against the experiment where the scene has one (mean
relative L2 of the pressures: median of the members, least to most; then the median of those members
that excluded nobody and of those that excluded some). Exit status 1 when a member failed. With
--folder the runs are kept, and those that are complete are not run again. --spacing and --end-time
make a quick form of the scenes.
"""

import argparse
import concurrent.futures
import json
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

AMPLITUDE = 1e-4  # particle distances
DAM_BREAKS = re.compile(r"dambreak|martin-moyce|obstacle")


def targets_of(program, scene):
    """Those that run here, as the program names them when it is asked for another."""
    refused = subprocess.run([program, "run", scene, "--simd", "none"], text=True,
                             capture_output=True, check=False)
    names = list(dict.fromkeys(re.findall(r"\b(?:SSE4|AVX2|AVX3\w*)\b", refused.stderr)))
    assert names, f"no targets in: {refused.stderr}"
    return names


def members_of(name, count):
    return range(1, count + 1) if DAM_BREAKS.search(name) else [None]


def written(scene, precision, seed, options):
    """The scene of one member."""
    member = json.loads(json.dumps(scene))
    member.setdefault("numerics", {})["precision"] = precision
    member.pop("output", None)
    if seed is not None:
        member["jitter"] = {"amplitude": AMPLITUDE, "seed": seed}
    if options.spacing != 1:
        member["resolution"]["spacing"] *= options.spacing
    if options.end_time:
        member["end_time"] = min(member["end_time"], options.end_time)
    return member


def outcome_of(folder):
    path = folder / "outcome.json"
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else None


def run(program, folder, scene, target):
    """The outcome and the error of one member, run unless it is there and complete."""
    outcome = outcome_of(folder)
    if not outcome or outcome["state"] != "completed":
        source = folder.with_suffix(".json")
        source.write_text(json.dumps(scene), encoding="utf-8")
        done = subprocess.run([program, "run", source, "--folder", folder, "--simd", target,
                               "--threads", "1"], text=True, capture_output=True, check=False)
        outcome = outcome_of(folder)
        if not outcome:
            return {"state": f"exit {done.returncode}", "retired": {}, "reason": done.stderr}, None
    report = subprocess.run([program, "report", folder, "--json"], text=True, capture_output=True,
                            check=False)
    evidence = json.loads(report.stdout).get("evidence") if report.returncode == 0 else None
    return outcome, (evidence or {}).get("mean_relative_l2")


def spread(values):
    """"median (most)" of whole numbers."""
    return f"{statistics.median(values):g} ({max(values):g})" if values else "-"


def middle(values):
    return f"{statistics.median(values):.3f} of {len(values)}" if values else "-"


def row_of(name, target, precision, members):
    outcomes = [outcome for outcome, _ in members]
    failed = [outcome for outcome in outcomes if outcome["state"] != "completed"]

    def gone(cause):
        return [outcome["retired"].get(cause, 0) for outcome in outcomes]

    errors = [error for _, error in members if error is not None]
    clean = [error for outcome, error in members
             if error is not None and not outcome["retired"].get("excluded", 0)]
    others = [error for outcome, error in members
              if error is not None and outcome["retired"].get("excluded", 0)]
    error = f"{statistics.median(errors):.3f} ({min(errors):.3f} to {max(errors):.3f})" if errors else "-"
    print(f"| {name} | {target} | {precision} | {len(members)} | {len(failed)} | {spread(gone('excluded'))} "
          f"| {spread(gone('leaked'))} | {spread(gone('overtopped'))} | {error} | {middle(clean)} | {middle(others)} |",
          flush=True)
    for outcome in failed:
        print(f"  {name}, {target}, {precision}: {outcome['state']}: {outcome.get('reason')}", file=sys.stderr)
    return len(failed)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=lambda text: str(pathlib.Path(text).resolve()))
    parser.add_argument("examples", type=pathlib.Path)
    parser.add_argument("--folder", type=pathlib.Path)
    parser.add_argument("--members", type=int, default=8)
    parser.add_argument("--side-by-side", type=int, default=1)
    parser.add_argument("--scene", action="append")
    parser.add_argument("--target", action="append")
    parser.add_argument("--precision", action="append", choices=["mixed", "double"])
    parser.add_argument("--end-time", type=float, default=0.0)
    parser.add_argument("--spacing", type=float, default=1.0)
    return parser.parse_args()


def table(options, folder):
    files = [path for path in sorted(options.examples.glob("*.json"))
             if not options.scene or path.stem in options.scene]
    scenes = {path.stem: json.loads(path.read_text(encoding="utf-8")) for path in files}
    scenes = {name: scene for name, scene in scenes.items() if "fluid" in scene}
    assert scenes, "no such scene"
    targets = options.target or targets_of(options.program, files[0])
    print("| scene | SIMD target | precision | members | failed | excluded | leaked | overtopped | error "
          "| without exclusions | with |\n|---|---|---|---|---|---|---|---|---|---|---|", flush=True)
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(options.side_by_side) as pool:
        rows = []
        for name, scene in scenes.items():
            for target in targets:
                for precision in options.precision or ["mixed", "double"]:
                    members = [pool.submit(run, options.program,
                                           folder / f"{name}-{target}-{precision}-{seed or 0}",
                                           written(scene, precision, seed, options), target)
                               for seed in members_of(name, options.members)]
                    rows.append((name, target, precision, members))
        for name, target, precision, members in rows:
            failed += row_of(name, target, precision, [member.result() for member in members])
    runs = sum(len(members) for _, _, _, members in rows)
    print(f"{runs - failed} passed, {failed} failed")
    return failed


def main():
    options = arguments()
    if options.folder:
        options.folder.mkdir(parents=True, exist_ok=True)
        return 1 if table(options, options.folder) else 0
    with tempfile.TemporaryDirectory(prefix="sluice-scenes-") as folder:
        return 1 if table(options, pathlib.Path(folder)) else 0


if __name__ == "__main__":
    sys.exit(main())
