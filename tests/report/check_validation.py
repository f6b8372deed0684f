"""Holds two reports of `sluice report --json` against what the two schemes must show.

Usage: check_validation.py PAPER.json RECOMMENDED.json --peaks PAPER.json... --errors RECOMMENDED.json...
with displaced runs of the two schemes behind the options. Prints a line per requirement; exit status 1 when one is not
met or cannot be told.
"""

import argparse
import json
import statistics
import sys


def path(data, *keys):
    """The value at keys, or None where any of them is missing."""
    for key in keys:
        if data is None:
            return None
        data = data.get(key)
    return data


class Checks:
    def __init__(self):
        self.passed = 0
        self.failed = 0

    def between(self, what, value, low, high):
        met = value is not None and low <= value <= high
        self.passed, self.failed = self.passed + met, self.failed + (not met)
        shown = "none" if value is None else f"{value:.4g}"
        print(f"{'pass' if met else 'FAIL'}  {what}: {shown} (must be {low:.4g} to {high:.4g})")

    def above(self, what, value, limit):
        self.compare(what, value, limit, "above", lambda a, b: a > b)

    def below(self, what, value, limit):
        self.compare(what, value, limit, "below", lambda a, b: a < b)

    def compare(self, what, value, limit, word, holds):
        met = value is not None and limit is not None and holds(value, limit)
        self.passed, self.failed = self.passed + met, self.failed + (not met)
        shown = "none" if value is None else f"{value:.4g}"
        print(f"{'pass' if met else 'FAIL'}  {what}: {shown} (must be {word} {limit:.4g})")


def leaked_share(report):
    outcome = report.get("outcome")
    leaked = path(outcome, "removed", "leaked")
    if leaked is None:
        return None
    return leaked / (outcome["particles"] + leaked + outcome["removed"]["overtopped"])


def sensors_of(report):
    return {one["reference"]: one for one in (report.get("comparison") or {}).get("pressures", [])}


def first_peak(report):
    return path(sensors_of(report).get("P1"), "simulation", "peak", "value")


def listed(values):
    return ", ".join("none" if value is None else f"{value:.3f}" for value in values)


def check_first_peak(checks, paper, displaced):
    """What happens at the impact is chaotic: one run's peak is one draw of many."""
    peaks = [first_peak(report) for report in displaced]
    print(f"first peak at P1, P, tau = 2 ms: on the lattice {first_peak(paper):.3f}, displaced {listed(peaks)}")
    median = None if None in peaks else statistics.median(peaks)
    checks.between(f"paper's scheme: first peak at P1, median of {len(peaks)} displaced runs, P",
                   median, 0.85 * 3.3, 1.15 * 3.3)


def check_paper(checks, report):
    comparison = report.get("comparison") or {}
    sensors = sensors_of(report)
    checks.between("paper's scheme: state completed", float(path(report, "outcome", "state") == "completed"), 1, 1)
    for name in ("P1", "P2", "P3", "P4"):
        simulated = path(sensors.get(name), "simulation", "plateau")
        measured = path(sensors.get(name), "experiment", "plateau") or float("nan")
        verdict = checks.below if name == "P4" else checks.above
        verdict(f"paper's scheme: plateau at {name} against the experiment's, P", simulated, measured)
    checks.between("paper's scheme: second rise at P1, T", path(sensors.get("P1"), "simulation", "second_rise", "time"), 6.4, 6.9)
    checks.between("paper's scheme: mean relative L2 of P1-P4", comparison.get("mean_relative_l2"), 0, 0.36)
    checks.between("paper's scheme: share of particles that leaked", leaked_share(report), 0, 0.001)


def error_of(report):
    return (report.get("comparison") or {}).get("mean_relative_l2")


def not_shifted(report):
    return (report.get("comparison") or {}).get("mean_relative_l2_not_shifted")


def check_recommended(checks, report, displaced):
    errors = [error_of(one) for one in displaced]
    print("recommended, on the lattice and displaced: mean relative L2 of P1-P4 " + listed([error_of(report), *errors])
          + " after the shift, " + listed([not_shifted(one) for one in [report, *displaced]])
          + " not shifted; first peak at P1, P " + listed([first_peak(one) for one in [report, *displaced]]))
    checks.between("recommended: state completed", float(path(report, "outcome", "state") == "completed"), 1, 1)
    checks.between("recommended: mean relative L2 of P1-P4, on the lattice", error_of(report), 0, 0.20)
    median = None if None in errors else statistics.median(errors)
    checks.between(f"recommended: the same, median of {len(errors)} displaced runs", median, 0, 0.20)
    checks.between("recommended: first peak at P1, P", first_peak(report), 2.56, 4.46)
    checks.between("recommended: particles that leaked", path(report, "outcome", "removed", "leaked"), 0, 0)


def load(name):
    with open(name, encoding="utf-8") as stream:
        return json.load(stream)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("paper", type=load)
    parser.add_argument("recommended", type=load)
    parser.add_argument("--peaks", type=load, nargs="+", required=True)
    parser.add_argument("--errors", type=load, nargs="+", required=True)
    reports = parser.parse_args()
    checks = Checks()
    check_first_peak(checks, reports.paper, reports.peaks)
    check_paper(checks, reports.paper)
    check_recommended(checks, reports.recommended, reports.errors)
    print(f"{checks.passed} passed, {checks.failed} failed")
    return 1 if checks.failed else 0


if __name__ == "__main__":
    sys.exit(main())
