-- Version 1. Times are Unix times in milliseconds, 0 for "not yet".

-- What a job is and where it stands. All physics is in its folder, jobs/<id>.
CREATE TABLE jobs (
  id           TEXT    NOT NULL PRIMARY KEY,   -- sorts by creation
  state        TEXT    NOT NULL
    CHECK (state IN ('queued', 'running', 'paused', 'completed', 'failed', 'cancelled')),
  pending_stop TEXT    NOT NULL CHECK (pending_stop IN ('none', 'pause', 'cancel')),
  name         TEXT    NOT NULL,
  label        TEXT    NOT NULL,
  priority     INTEGER NOT NULL,               -- higher runs first
  threads      INTEGER NOT NULL CHECK (threads >= 1),
  created_ms   INTEGER NOT NULL,
  updated_ms   INTEGER NOT NULL,
  started_ms   INTEGER NOT NULL,               -- of the last attempt
  ended_ms     INTEGER NOT NULL,
  token        TEXT    NOT NULL,               -- of the running attempt, else empty
  attempts     INTEGER NOT NULL,
  crashes      INTEGER NOT NULL,
  reason       TEXT    NOT NULL,
  scene_hash   TEXT    NOT NULL,
  end_time     REAL    NOT NULL,               -- model time, s
  estimate     TEXT    NOT NULL,               -- JSON
  progress     TEXT    NOT NULL,               -- JSON or empty
  outcome      TEXT    NOT NULL,               -- JSON or empty
  CHECK ((state = 'running') = (token <> '')),
  CHECK (pending_stop = 'none' OR state = 'running'),
  CHECK ((state IN ('completed', 'failed', 'cancelled')) = (ended_ms <> 0))
) STRICT, WITHOUT ROWID;

CREATE INDEX jobs_by_state ON jobs (state, id);
CREATE INDEX jobs_by_label ON jobs (label, id);
CREATE INDEX jobs_in_queue ON jobs (priority DESC, id, threads) WHERE state = 'queued';

-- The history of all jobs. Numbers are never used twice, not even after a job was removed.
CREATE TABLE events (
  number  INTEGER PRIMARY KEY AUTOINCREMENT,
  job     TEXT    NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  time_ms INTEGER NOT NULL,
  name    TEXT    NOT NULL,
  detail  TEXT    NOT NULL                     -- JSON object
) STRICT;

CREATE INDEX events_by_job ON events (job, number);

CREATE TRIGGER events_are_never_changed BEFORE UPDATE ON events
BEGIN
  SELECT RAISE(ABORT, 'events are append-only');
END;

CREATE TRIGGER events_go_with_their_job BEFORE DELETE ON events
WHEN EXISTS (SELECT 1 FROM jobs WHERE id = OLD.job)
BEGIN
  SELECT RAISE(ABORT, 'events are append-only');
END;

-- An Idempotency-Key and the job that it made, for as long as there is that job.
CREATE TABLE idempotency_keys (
  key       TEXT NOT NULL PRIMARY KEY,
  body_hash TEXT NOT NULL,
  job       TEXT NOT NULL UNIQUE REFERENCES jobs (id) ON DELETE CASCADE
) STRICT, WITHOUT ROWID;
