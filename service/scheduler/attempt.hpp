#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/execute/executor.hpp"
#include "service/http/line_reader.hpp"
#include "service/jobs/job.hpp"
#include "service/scheduler/attempt_end.hpp"
#include "service/worker/core_use.hpp"
#include "service/worker/worker_log.hpp"
#include "service/worker/worker_message.hpp"

namespace sluice {

/// One attempt at a job: its worker, what it said, and since when it has said nothing. The worker
/// ends with it. Times are seconds of a steady clock that the caller reads. For one thread.
class Attempt {
 public:
  /// `worker` runs the job in `folder`, since `now`; its output and errors are pipes.
  Attempt(Job job, std::filesystem::path folder, std::unique_ptr<RunningProcess> worker,
          double now);

  [[nodiscard]] const Job& job() const { return job_; }
  [[nodiscard]] JobPaths paths() const { return JobPaths(folder_); }
  [[nodiscard]] const RunningProcess& worker() const { return *worker_; }
  [[nodiscard]] bool output_is_open() const { return output_is_open_; }
  [[nodiscard]] bool errors_are_open() const { return errors_are_open_; }

  /// Takes what the worker has written by now, a bounded amount. Progress is kept, other messages
  /// are handed out.
  [[nodiscard]] std::vector<WorkerMessage> read(double now);
  /// The newest progress, at most one a second; nothing when it was handed out already.
  [[nodiscard]] std::optional<std::string> progress_due(double now);

  [[nodiscard]] double age(double now) const { return now - started_; }
  /// Seconds without a further step, as StallClock counts them; `use` is of its worker.
  double stalled_for(double now, const CoreUse& use) { return stalled_.look(now, use); }

  /// True once every `interval` seconds: when to look how much of the disk the job takes.
  [[nodiscard]] bool disk_look_due(double now, double interval);

  /// SIGTERM, once; the first cause stays.
  void stop(StopCause cause, double now);
  void kill(StopCause cause);
  [[nodiscard]] StopCause stop_cause() const { return cause_; }
  [[nodiscard]] double stopping_for(double now) const { return now - stop_asked_; }
  /// SIGUSR1, as soon as the worker listens.
  void checkpoint();

  /// How the worker ended, if it did; everything that it wrote has been read then.
  [[nodiscard]] std::optional<ProcessEnd> end();
  /// Its outcome, read from disk or from what it wrote last; nothing without either.
  [[nodiscard]] std::optional<FreshOutcome> outcome() const;
  /// What it said last about why it ended.
  [[nodiscard]] std::string last_words() const;

 private:
  void take(const LineReader::Line& line, double now, std::vector<WorkerMessage>& messages);
  void take(WorkerMessage message, double now, std::vector<WorkerMessage>& messages);
  void complain(const std::string& what, std::vector<WorkerMessage>& messages);
  void read_errors();

  Job job_;
  std::filesystem::path folder_;
  std::unique_ptr<RunningProcess> worker_;
  WorkerLog log_;
  LineReader lines_{kLongestWorkerLine};
  bool output_is_open_ = true;
  bool errors_are_open_ = true;

  double started_;
  StallClock stalled_;
  std::optional<std::uint64_t> step_;
  std::optional<std::string> progress_;
  double next_progress_ = 0.0;
  double next_disk_look_ = 0.0;
  bool listens_ = false;  ///< it takes signals: it has said that it began
  bool checkpoint_wanted_ = false;
  StopCause cause_ = StopCause::none;
  double stop_asked_ = 0.0;
  int warnings_ = 0;
  double next_checkpoint_event_ = 0.0;
  std::string last_words_;
  std::string told_outcome_;
};

}  // namespace sluice
