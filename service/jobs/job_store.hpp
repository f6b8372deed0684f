#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "service/jobs/job.hpp"
#include "service/jobs/job_locks.hpp"

namespace sluice {

/// Thrown by JobStore.
class JobStoreError : public std::runtime_error {
 public:
  enum class Fault {
    not_found,   ///< no such job
    conflict,    ///< the transition is not allowed in the job's state, or the attempt's token is
                 ///< stale
    key_reused,  ///< the Idempotency-Key came with another request before
    full,        ///< the queue's limit
    in_use,      ///< another service has this data folder
    disk_full,
    damaged,        ///< the integrity check failed
    newer_version,  ///< the file was written by a newer program
    uncertain,  ///< whether the change is there cannot be read now: nothing may be undone; the next
                ///< start brings rows and folders together
    io,
  };
  JobStoreError(Fault fault, const std::string& message)
      : std::runtime_error(message), fault_(fault) {}
  [[nodiscard]] Fault fault() const { return fault_; }

 private:
  Fault fault_;
};

/// What a transition changes beside the state. Absent members stay as they are, but a resume clears
/// the reason and the crashes, and a claim the reason.
struct JobChange {
  std::optional<std::string> reason;
  std::optional<std::string> outcome;
  std::optional<int> crashes;
  std::optional<double> end_time;
  std::optional<std::string> estimate;
  std::string event_detail = "{}";  ///< JSON object for the event row
};

struct JobFilter {
  std::optional<JobState> state;
  std::optional<std::string> label;
  std::string after;  ///< cursor: the id that the last page ended with; empty: from the newest
  std::size_t limit = 50;
};

/// Job rows, events and idempotency keys in one SQLite file, DATA/jobs.sqlite. One connection,
/// journal_mode=PERSIST, synchronous=EXTRA, STRICT tables, user_version migrations. What a call
/// acknowledged survives a power cut. A call that throws changed nothing, also where the disk
/// failed at a commit; only Fault::uncertain tells of no more. All calls may come from any thread;
/// each write is one BEGIN IMMEDIATE transaction with its event row.
class JobStore {
 public:
  /// Opens or creates; takes the lock of the data folder (in_use) and migrates. After an unclean
  /// stop it runs the integrity check (damaged: says how to rebuild).
  explicit JobStore(const std::filesystem::path& data);
  ~JobStore();
  JobStore(const JobStore&) = delete;
  JobStore& operator=(const JobStore&) = delete;

  /// Alone with a job, as long as the guard lives: for changes of its row together with its folder.
  [[nodiscard]] JobLocks::Guard alone_with(const std::string& id) { return locks_.hold(id); }
  /// Why nothing can be kept in the data folder now, such as that somebody moved it away; empty
  /// when all is well.
  [[nodiscard]] std::string trouble() const;

  /// A fresh id; ids sort by creation.
  [[nodiscard]] std::string new_id();

  struct Submitted {
    Job job;
    bool repeated = false;  ///< the key was known: this is the job that it made
  };
  /// Adds a queued job. `key` (may be empty) with `body_hash` makes repetition harmless, also at
  /// the same instant: key_reused when the key came with another hash. `limit` queued jobs at most
  /// (full).
  Submitted submit(const Job& job, const std::string& key, const std::string& body_hash,
                   std::size_t limit);
  /// Adds queued jobs without keys, all in one transaction: all of them or none (full).
  std::vector<Job> submit_all(const std::vector<Job>& jobs, std::size_t limit);
  /// The job that a key made, before any work is done for it. Throws key_reused.
  [[nodiscard]] std::optional<Job> find_by_key(const std::string& key,
                                               const std::string& body_hash) const;

  [[nodiscard]] std::optional<Job> find(const std::string& id) const;
  /// Newest first.
  [[nodiscard]] std::vector<Job> list(const JobFilter& filter) const;
  /// All states, those without a job too.
  [[nodiscard]] std::vector<std::pair<JobState, std::size_t>> count_by_state() const;

  /// Of the jobs with this label; only states that there are.
  [[nodiscard]] std::vector<std::pair<JobState, std::size_t>> count_by_state(
      const std::string& label) const;

  /// Claims the queued job with the highest priority, then age, that needs at most `threads`: one
  /// UPDATE ... RETURNING, with a new token. Jobs in `except` are passed over.
  std::optional<Job> claim(int threads, const std::vector<std::string>& except);

  /// Applies the transition that the table gives for `action` in the job's state. `token` guards
  /// actions of an attempt: conflict when it is not the running one's; empty for requests of users.
  /// A pause or cancel of a running job only marks `pending_stop`, and a cancel wins over a pause;
  /// what was asked for is obeyed however the attempt ends, requeue included, unless it completes
  /// or fails. Idempotent for users: pausing a paused job returns it unchanged, without an event.
  /// An end time may only become later, and only by a resume that puts the job into the queue.
  Job apply(const std::string& id, JobAction action, const std::string& token,
            const JobChange& change);
  /// The last progress line of an attempt; no event. Seen at once, but on the disk only every ten
  /// seconds and with the job's next transition (live_progress.hpp).
  void record_progress(const std::string& id, const std::string& token,
                       const std::string& progress);
  void record_event(const std::string& id, const std::string& name, const std::string& detail);
  /// The job, if it has ended: throws not_found or conflict. It then stays so for whoever is alone
  /// with it.
  [[nodiscard]] Job require_ended(const std::string& id) const;
  /// Ended jobs only (conflict otherwise), with their events and key. The folder is the caller's to
  /// remove (retention.hpp).
  void remove(const std::string& id);

  /// Events with number > after; of one job when `id` is not empty.
  [[nodiscard]] std::vector<JobEvent> events(const std::string& id, std::int64_t after,
                                             std::size_t limit) const;
  /// Waits until there is an event with number > after (of the job, if given) or the time is over.
  void wait_for_event(const std::string& id, std::int64_t after, double seconds) const;
  /// Number of the newest event; 0 before the first.
  [[nodiscard]] std::int64_t last_event() const;
  /// Wakes all waiters, for a stop; from then on nobody waits.
  void wake();

  struct Adoption {
    Job job;
    std::string key;  ///< may be empty
    std::string body_hash;
  };
  /// Inserts rows made from jobs' folders, with their Idempotency-Keys, all in one transaction;
  /// used by --rebuild. Returns for each an empty text, or why it was not taken: its id is there,
  /// or another job has its key.
  std::vector<std::string> adopt_all(const std::vector<Adoption>& adoptions);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
  JobLocks locks_;
};

}  // namespace sluice
