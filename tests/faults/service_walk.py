"""Faults in the service: every request that changes something, a job's whole life, starts, a rebuild
and the deletion of old jobs. Its workers run undisturbed (worker_walk.py disturbs theirs)."""

import http.client
import itertools
import json
import queue
import shutil
import socket
import subprocess
import time

import faults
from worker_walk import SCENE

HOST = "127.0.0.1"
HANG = 120  # s: only so that a hang ends as a failure
STUDY = {"name": "pair", "scene": SCENE,
         "vary": [{"key": "/resolution/spacing", "values": [0.05, 0.04]}]}
LONG = {**SCENE, "output": {}, "end_time": 4.0,  # a moment
        "numerics": {**SCENE["numerics"], "courant": 0.05}}
LATER_END = 0.15
STORAGE_FAILURE = 5
NO_ROOM = ("--disk-reserve", "8000000GB")  # keeps what is queued from being run
ENDED = ("completed", "failed", "cancelled")
# What a restart may leave beside the jobs.
AT_THE_TOP = {"jobs", "studies", "jobs.sqlite", "jobs.sqlite-journal", "lock"}


class Dead(Exception):
    """The service ended, or does not answer."""


class Place:
    """A service with a data folder and faults of its own."""

    def __init__(self, program, interposer, folder):
        self.program = program
        self.folder = folder
        folder.mkdir(parents=True)
        self.data = folder / "data"
        self.control = faults.Control(interposer, folder / "control")
        self.log = open(folder / "log", "ab")
        with socket.socket() as probe:
            probe.bind((HOST, 0))
            self.port = probe.getsockname()[1]
        self.process = None
        self.keys = itertools.count()
        self.options = ()

    # --- the process

    def launch(self, *options):
        """Returns what it said first: nothing where it ended before it was ready."""
        self.options = options
        self.process = subprocess.Popen(
            [self.program, "serve", "--data", str(self.data), "--port", str(self.port),
             "--cores", "2", "--stop-seconds", "20", *options],
            stdout=subprocess.PIPE, stderr=self.log, stdin=subprocess.DEVNULL,
            env=self.control.environment(), cwd=self.folder)
        return self.process.stdout.readline()

    def start(self, *options):
        if not self.launch(*options):
            raise Dead(f"does not start: {self.last_words()}")

    def end(self):
        """As a power cut of the process."""
        if not self.process:
            return None
        if self.process.poll() is None:
            self.process.kill()
        status = self.process.wait()
        self.process.stdout.close()
        self.process = None
        return status

    def restart(self):
        self.end()
        self.control.disarm()
        self.start(*self.options)

    def died(self):
        return self.process.poll() is not None

    def last_words(self):
        return (self.folder / "log").read_text(errors="replace")[-400:].strip()

    # --- requests

    def ask(self, method, path, body=None, key=None):
        """Status and JSON; (0, None) when the connection was cut."""
        connection = http.client.HTTPConnection(HOST, self.port, timeout=HANG)
        headers = {"Content-Type": "application/json"} if body is not None else {}
        if key:
            headers["Idempotency-Key"] = key
        try:
            connection.request(method, path, None if body is None else json.dumps(body), headers)
            answer = connection.getresponse()
            text = answer.read()
            return answer.status, json.loads(text) if text else None
        except (ConnectionError, http.client.HTTPException):
            return 0, None
        finally:
            connection.close()

    def must(self, method, path, body=None, key=None):
        status, document = self.ask(method, path, body, key)
        if status // 100 != 2:
            raise Dead(f"{method} {path}: {status} {document}")
        return document

    def jobs(self):
        return {job["id"]: job for job in self.must("GET", "/v1/jobs?limit=1000")["jobs"]}

    def studies(self):
        return {study["id"]: study for study in self.must("GET", "/v1/studies?limit=1000")["studies"]}

    def new_key(self):
        return f"key-{next(self.keys)}"

    def history(self, job):
        """The names of the events of a job that has ended."""
        connection = http.client.HTTPConnection(HOST, self.port, timeout=HANG)
        try:
            connection.request("GET", f"/v1/jobs/{job}/events")
            lines = connection.getresponse().read().decode().splitlines()
            return [line[len("event: "):] for line in lines if line.startswith("event: ")]
        finally:
            connection.close()

    def wait_for(self, job, *states):
        end = time.monotonic() + HANG
        while time.monotonic() < end:
            document = self.must("GET", f"/v1/jobs/{job}?wait=5")
            if document["state"] in states:
                return document
            if document["state"] in ENDED:
                break
        raise Dead(f"{job} is {document['state']}, not {' or '.join(states)}: {document['reason']}")

    # --- what must hold at any time

    def contradictions(self):
        """Between the rows, as the service tells them, and the folders."""
        jobs, folders = self.jobs(), self.names("jobs")
        if set(jobs) != folders:
            yield f"rows without folders {set(jobs) - folders}, folders without rows {folders - set(jobs)}"
        for job in set(jobs) & folders:
            yield from self.contradictions_of(jobs[job])
        if set(self.studies()) != self.names("studies"):
            yield f"studies {set(self.studies())}, folders {self.names('studies')}"

    def contradictions_of(self, job):
        folder = self.data / "jobs" / job["id"]
        scene = json.loads((folder / "scene.json").read_text())
        if scene["end_time"] != job["end_time"]:
            yield f"the row ends at {job['end_time']}, the scene at {scene['end_time']}"
        held = json.loads((folder / "job.json").read_text())["held"]
        expected = job["state"] if job["state"] in ("paused", "cancelled", "failed") else None
        if held != expected:
            yield f"job.json says {held}, the row {job['state']}"

    def names(self, part):
        return {path.name for path in (self.data / part).iterdir() if not path.name.startswith(".")}

    def left_over(self):
        """Files that nobody waits for any more."""
        hidden = [str(path.relative_to(self.data)) for path in self.data.rglob(".*")]
        return hidden + sorted(self.names(".") - AT_THE_TOP)

    def clear(self):
        for study in self.studies():
            self.must("POST", f"/v1/studies/{study}/cancel")
            self.must("DELETE", f"/v1/studies/{study}")
        for job, document in self.jobs().items():
            if document["state"] not in ENDED:
                self.must("POST", f"/v1/jobs/{job}/cancel")
            self.must("DELETE", f"/v1/jobs/{job}")


# --- operations. Each prepares, acts, and says what is wrong with what became of it: `answer` is the
# status of the disturbed request, 0 where there was none.

class Operation:
    options = NO_ROOM
    repeated = (2,)  # hundreds of statuses, or statuses, that the same request may be answered with again

    def prepare(self, place):
        """What act() and judge() need."""

    def act(self, place, before):
        raise NotImplementedError

    def judge(self, place, before, answer):
        """After the service has been started again where it was killed."""
        state = self.state(place, before)
        if state not in (before["state"], self.after):
            yield f"is {state}, neither {before['state']} nor {self.after}"
        if answer // 100 == 2 and state != self.after:
            yield f"was answered with {answer} and is {state}"
        again, document = self.act(place, before)
        if again // 100 not in self.repeated and again not in self.repeated:
            yield f"repeated, answers {again} {document}"
        if self.state(place, before) != self.after:
            yield f"repeated, is {self.state(place, before)}, not {self.after}"


class OfAJob(Operation):
    """An action on a queued job that `steps` have brought where it begins."""

    def __init__(self, steps, action, after, body=None, repeated=(2,)):
        self.steps = steps
        self.action = action
        self.after = after
        self.body = body
        self.repeated = repeated

    def prepare(self, place):
        job = place.must("POST", "/v1/jobs", SCENE)["id"]
        for step in self.steps:
            place.must("POST", f"/v1/jobs/{job}/{step}")
        before = {"job": job}
        before["state"] = self.state(place, before)
        return before

    def act(self, place, before):
        path = f"/v1/jobs/{before['job']}"
        if self.action == "delete":
            return place.ask("DELETE", path)
        return place.ask("POST", f"{path}/{self.action}", self.body)

    def state(self, place, before):
        job = place.jobs().get(before["job"])
        return job and (job["state"], job["end_time"])


class Submit(Operation):
    """A job or a study with a key: made once, however often it is asked for."""
    after = 1

    def __init__(self, part, document, times=0):
        self.part = part
        self.document = document
        self.times = times

    def prepare(self, place):
        before = {"key": place.new_key()}
        for _ in range(self.times):
            self.act(place, before)
        before["state"] = self.state(place, before)
        return before

    def act(self, place, before):
        return place.ask("POST", f"/v1/{self.part}", self.document, before["key"])

    def state(self, place, before):
        """How many there are; more than one is never right. A study has all of its jobs or none."""
        studies, jobs = len(place.studies()), len(place.jobs())
        if self.part == "jobs":
            return jobs
        return studies if jobs == 2 * studies else f"{studies} with {jobs} jobs"


class OfAStudy(Operation):
    """Its jobs one after the other: what was cut short is done by the same request again."""

    def __init__(self, action, after, repeated=(2,)):
        self.action = action
        self.after = after
        self.repeated = repeated

    def prepare(self, place):
        study = place.must("POST", "/v1/studies", STUDY)["id"]
        if self.action == "delete":
            place.must("POST", f"/v1/studies/{study}/cancel")
        return {"study": study}

    def act(self, place, before):
        path = f"/v1/studies/{before['study']}"
        if self.action == "delete":
            return place.ask("DELETE", path)
        return place.ask("POST", f"{path}/{self.action}")

    def state(self, place, before):
        return [job["state"] for job in place.jobs().values()]

    def judge(self, place, before, answer):
        if answer // 100 == 2 and self.state(place, before) != self.after:
            yield f"was answered with {answer} and its jobs are {self.state(place, before)}"
        again, document = self.act(place, before)
        if again // 100 not in self.repeated and again not in self.repeated:
            yield f"repeated, answers {again} {document}"
        if self.state(place, before) != self.after:
            yield f"repeated, its jobs are {self.state(place, before)}"


class Life(Operation):
    """A job that a worker runs to its end, through a checkpoint, a pause and a later end of it."""
    options = ("--crash-limit", "1000000")

    def __init__(self, scene, wishes=()):
        self.scene = scene
        self.wishes = wishes
        self.digests = None

    def prepare(self, place):
        return {"key": place.new_key()}

    def act(self, place, before):
        status, document = place.ask("POST", "/v1/jobs", self.scene, before["key"])
        if status // 100 == 2:
            before["job"] = document["id"]
            for state, wish in self.wishes:
                self.look_until(place, before["job"], state)
                place.ask("POST", f"/v1/jobs/{before['job']}/{wish}")
            self.look_until(place, before["job"])
        return status, document

    def look_until(self, place, job, *states):
        """Until it is in one of these states, at rest, or the service is gone."""
        end = time.monotonic() + HANG
        while time.monotonic() < end and not place.died():
            status, document = place.ask("GET", f"/v1/jobs/{job}")
            if status == 200 and document["state"] in (*states, *ENDED, "paused"):
                return
            time.sleep(0.01)

    def judge(self, place, before, answer):
        job = place.must("POST", "/v1/jobs", self.scene, before["key"])["id"]
        if before.get("job") not in (None, job):
            yield f"was acknowledged as {before['job']} and is {job}"
        if set(place.jobs()) != {job}:
            yield f"made {set(place.jobs())}"
        if place.wait_for(job, "completed", "paused")["state"] == "paused":
            place.must("POST", f"/v1/jobs/{job}/resume")
            place.wait_for(job, "completed")
        history = place.history(job)
        if history.count("completed") != 1:
            yield f"was completed {history.count('completed')} times: {history}"
        outcome = json.loads((place.data / "jobs" / job / "outcome.json").read_text())
        self.digests = self.digests or outcome["digests"]
        if outcome["digests"] != self.digests:
            yield "has other digests than undisturbed"


class Start(Operation):
    """Of a service over jobs at several stages, after one that was killed in the midst of things."""

    def __init__(self, *options):
        self.more_options = options

    def prepare(self, place):
        jobs = [place.must("POST", "/v1/jobs", SCENE, place.new_key())["id"] for _ in range(3)]
        place.must("POST", f"/v1/jobs/{jobs[0]}/pause")
        place.must("POST", f"/v1/jobs/{jobs[1]}/cancel")
        place.must("POST", "/v1/studies", STUDY)
        before = {"state": self.state(place)}
        place.end()
        folder = place.data / "jobs"
        shutil.copytree(folder / jobs[1], folder / ".deleted-j01k8htt89gfl8kk69ie1")
        shutil.copytree(folder / jobs[1], folder / ".j01k8htt89gfl8kk69ie2.new")
        shutil.copy(folder / jobs[1] / "job.json", folder / jobs[1] / ".job.json.4711.1.tmp")
        return before

    def act(self, place, before):
        """It starts, or says why not; a signal is neither."""
        if place.launch(*self.options, *self.more_options):
            return 200, None
        status = place.process.wait(HANG)
        place.end()
        return (500 if status == STORAGE_FAILURE else 400), {"status": status, "said": place.last_words()}

    def state(self, place):
        studies = {study["id"]: study["run_count"] for study in place.studies().values()}
        return {job["id"]: (job["state"], job["end_time"], job["label"])
                for job in place.jobs().values()}, studies

    def judge(self, place, before, answer):
        if answer // 100 != 2 or self.more_options:
            place.end()
            place.start(*self.options)
        if self.state(place) != before["state"]:
            yield f"is {self.state(place)}, was {before['state']}"
        for aside in place.data.glob("jobs.sqlite.bad-*"):
            aside.unlink()


REQUESTS = {
    "submit": Submit("jobs", SCENE),
    "submit again": Submit("jobs", SCENE, times=1),
    "pause": OfAJob([], "pause", ("paused", 0.1)),
    "resume": OfAJob(["pause"], "resume", ("queued", 0.1)),
    "extend": OfAJob(["pause"], "resume", ("queued", LATER_END), {"end_time": LATER_END}, (2, 400, 409)),
    "extend what was cancelled": OfAJob(["cancel"], "resume", ("queued", LATER_END),
                                        {"end_time": LATER_END}, (2, 400, 409)),
    "cancel": OfAJob([], "cancel", ("cancelled", 0.1)),
    "delete": OfAJob(["cancel"], "delete", None, repeated=(2, 404)),
    "submit a study": Submit("studies", STUDY),
    "cancel a study": OfAStudy("cancel", ["cancelled", "cancelled"]),
    "delete a study": OfAStudy("delete", [], (2, 404)),
    "start": Start(),
    "rebuild": Start("--rebuild"),
    "run a job": Life(SCENE),
    "checkpoint, pause and resume a running job": Life(
        LONG, [("running", "checkpoint"), ("running", "pause"), ("paused", "resume")]),
}


class ServiceWalk:
    def __init__(self, program, interposer, folder):
        self.program = program
        self.interposer = interposer
        self.folder = folder
        self.number = itertools.count()
        self.all_places = []
        self.places = queue.SimpleQueue()  # that nobody uses
        self.operations = list(REQUESTS)

    def new_place(self):
        place = Place(self.program, self.interposer, self.folder / f"place-{next(self.number)}")
        self.all_places.append(place)
        return place

    def place(self, operation):
        """A running one that nobody uses, of the same options."""
        try:
            place = self.places.get_nowait()
        except queue.Empty:
            place = self.new_place()
        if place.options != operation.options:
            place.end()
            place.start(*operation.options)
        return place

    def close(self):
        for place in self.all_places:
            place.end()

    def calls(self, name):
        operation = REQUESTS[name]
        place = self.place(operation)
        before = operation.prepare(place)
        place.control.arm()
        status, document = operation.act(place, before)
        place.control.stop()
        kinds = place.control.calls()
        problems = list(operation.judge(place, before, status))
        if status // 100 != 2 or problems:
            raise Dead(f"{name}, undisturbed: {status} {document} {problems}")
        place.clear()
        self.places.put(place)
        return kinds

    def problems_of(self, case):
        operation = REQUESTS[case.operation]
        place = self.place(operation)
        what, found = "", []
        try:
            before = operation.prepare(place)
            place.control.arm(case.number, case.fault)
            answer, document = operation.act(place, before)
            what = place.control.what()
            place.control.stop()
            if what:
                found = list(self.judged(case, operation, place, before, answer, document))
            place.clear()
        except (Dead, OSError, ValueError, KeyError, TypeError) as error:
            found.append(f"{type(error).__name__} {error}; {place.last_words()}")
        if found:
            place.end()
        else:
            self.places.put(place)
        return what, found

    def judged(self, case, operation, place, before, answer, document):
        if case.fault == faults.KILL:
            place.restart()
        elif not place.process:
            if answer != 500:  # it did not start, which has to be for the disk
                yield f"does not start: {document}"
        elif place.died():
            yield f"the service ended: {place.last_words()}"
            place.restart()
        elif faults.must_pass_unseen(case.fault) and case.kind != "sync" and answer // 100 != 2:
            yield f"was not taken as a matter of course: {answer} {document}"
        elif answer // 100 not in (2, 5):
            yield f"is answered with {answer} {document}"
        if place.process:
            yield from place.contradictions()
        yield from operation.judge(place, before, answer)
        yield from place.contradictions()
        if place.left_over():
            place.restart()
            yield from place.contradictions()
            if place.left_over():
                yield f"leaves {place.left_over()}"
