"""Faults in the life of a run: `sluice run` and `sluice report` on a job of a few hundred steps."""

import json
import pathlib
import re
import shutil
import subprocess
import threading

import faults

SCENE = {
    "name": "tiny", "tank": {"width": 0.6, "height": 0.4}, "gravity": [0, -9.81],
    "fluid": [{"shape": "rectangle", "corner": [0, 0], "size": [0.3, 0.2]}],
    "resolution": {"spacing": 0.04},
    "numerics": {"scheme": "paper", "integrator": "kick_drift_kick", "courant": 0.5,
                 "reinitialisation": None},
    "sensors": [{"name": "P1", "kind": "pressure", "position": [0.6, 0.02], "interval": 0.01}],
    "output": {"frames": {"interval": 0.05}}, "end_time": 0.1}
LATER = {**SCENE, "end_time": 0.15}
HANG = 300  # s: only so that a hang ends as a failure
DONE, UNREADABLE_SCENE, STORAGE_FAILURE, CHECKPOINTED = 0, 2, 5, 85
RUN = ("run", "--threads", "1", "--progress", "json", "--checkpoint-every", "40")

# Name, what is there before, the command in a folder that holds scene.json, later.json and the job,
# how it ends, and the job that it comes to in the end.
OPERATIONS = {
    "begin": ("nothing", (*RUN, "scene.json", "--folder", "job"), DONE, "complete"),
    "stop": ("nothing", (*RUN, "scene.json", "--folder", "job", "--stop-after-step", "60"),
             CHECKPOINTED, "stopped"),
    "go on": ("stopped", (*RUN, "job"), DONE, "complete"),
    "go on to a later end": ("complete", (*RUN, "later.json", "--folder", "job"), DONE, "longer"),
    "run again": ("complete", (*RUN, "job"), DONE, "complete"),
    "report": ("unreported", ("report", "job"), DONE, "complete"),
}


def names_in(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


def names_in_but_older_checkpoints(folder):
    """Which ones are kept is a matter of when they were written."""
    names = names_in(folder)
    checkpoints = [name for name in names if name.startswith("job/checkpoint-") and name.endswith(".h5")]
    return [name for name in names if name not in checkpoints[:-1]]


def results_of(job):
    """What interruptions must not change: digests, frames, the report without its costs."""
    outcome = json.loads((job / "outcome.json").read_text())
    frames = {path.name: path.read_bytes() for path in (job / "frames").iterdir()}
    report = job / "report.json"
    figures = json.loads(report.read_text()).get("sensors") if report.exists() else None
    return {"state": outcome["state"], "digests": outcome["digests"], "frames": frames,
            "report": figures}


class WorkerWalk:
    def __init__(self, program, interposer, folder):
        self.program = program
        self.interposer = interposer
        self.folder = folder
        self.operations = list(OPERATIONS)
        self.starts = folder / "starts"
        self.number = 0
        self.lock = threading.Lock()
        self.make_starts()

    def make_starts(self):
        """Undisturbed jobs, at the stages that operations begin from."""
        def at(stage, *commands):
            folder = self.starts / stage
            folder.mkdir(parents=True)
            (folder / "scene.json").write_text(json.dumps(SCENE))
            (folder / "later.json").write_text(json.dumps(LATER))
            for command in commands:
                self.run(folder, command)
            return folder
        begin, stop, later = (OPERATIONS[name][1] for name in ("begin", "stop", "go on to a later end"))
        at("nothing")
        complete = at("complete", begin)
        at("stopped", stop)
        longer = at("longer", begin, later)
        unreported = at("unreported", begin)
        for report in (unreported / "job").glob("report.*"):
            report.unlink()
        self.expected = {stage: (names_in_but_older_checkpoints(self.starts / stage),
                                 results_of(self.starts / stage / "job"))
                         for stage in ("complete", "stopped", "longer")}
        assert complete and longer

    def run(self, folder, command, environment=None):
        return subprocess.run([self.program, *command], cwd=folder, env=environment, timeout=HANG,
                              capture_output=True, text=True, stdin=subprocess.DEVNULL)

    def place(self):
        with self.lock:
            self.number += 1
            return self.folder / f"case-{self.number}"

    def close(self):
        """Nothing goes on here."""

    def calls(self, operation):
        """The kinds of the calls that it makes undisturbed."""
        _, _, kinds = self.disturbed(operation, self.place(), 0, 0)
        return kinds

    def disturbed(self, operation, folder, at, fault):
        stage, command, _, _ = OPERATIONS[operation]
        shutil.copytree(self.starts / stage, folder)
        control = faults.Control(self.interposer, f"{folder}.control")
        try:
            control.arm(at, fault)
            ended = self.run(folder, command, control.environment())
            return ended, control.what(), control.calls()
        finally:
            control.close()

    def problems_of(self, case):
        """The call that failed, and what went wrong with it, as sentences."""
        folder = self.place()
        ended, what, _ = self.disturbed(case.operation, folder, case.number, case.fault)
        found = list(self.judged(case, folder, ended, what)) if what else []
        if not found:
            shutil.rmtree(folder)
        return what, found

    def judged(self, case, folder, ended, what):
        _, command, expected, _ = OPERATIONS[case.operation]
        status = ended.returncode
        if case.fault == faults.KILL:
            # The one that was killed may be a child that reads files, which is tried once more.
            if not faults.was_killed(status) and status != expected:
                yield f"ended with {status}, but was killed: {ended.stderr.strip()}"
        elif status == UNREADABLE_SCENE and (folder / what.split()[-1]).parent == folder:
            pass  # the scene that it was given: nothing has begun
        elif status not in (expected, STORAGE_FAILURE):
            yield f"ended with {status}: {ended.stderr.strip()}"
        elif faults.must_pass_unseen(case.fault) and status != expected:
            yield f"was not taken as a matter of course: {ended.stderr.strip()}"
        elif status == STORAGE_FAILURE and not re.search("^sluice: ", ended.stderr, re.MULTILINE):
            yield f"says nothing about what failed: {ended.stderr!r}"
        # Where a look could not leave the report in the folder, the next one does.
        if status != expected or case.operation == "report":
            again = self.run(folder, command)
            if again.returncode != expected:
                yield f"then ended with {again.returncode}: {again.stderr.strip()}"
                return
        yield from self.differences(case, folder)

    def differences(self, case, folder):
        if not (folder / "job" / "outcome.json").exists():
            yield f"left no outcome, but {names_in(folder)}"
            return
        names, results = self.expected[OPERATIONS[case.operation][3]]
        found = names_in_but_older_checkpoints(folder)
        if found != names:
            yield f"left {sorted(set(found) - set(names))}, lacks {sorted(set(names) - set(found))}"
        for key, value in results_of(folder / "job").items():
            if value != results[key]:
                yield f"other {key} than undisturbed"
