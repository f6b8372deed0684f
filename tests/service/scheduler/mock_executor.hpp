#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/execute/executor.hpp"
#include "engine/store/disk/file_system.hpp"

namespace sluice::test {

/// A worker that is no process: it says and ends what a test has it say and how. Thread-safe.
class MockWorker {
 public:
  MockWorker(ProcessCommand command, int number);

  [[nodiscard]] const ProcessCommand& command() const { return command_; }
  /// The job that it runs.
  [[nodiscard]] std::string job() const { return command_.folder.filename().string(); }
  /// Which start of its executor it is; 1 is the first.
  [[nodiscard]] int number() const { return number_; }

  // Nothing once it has ended.
  void say(std::string_view line);
  void say_error(std::string_view line);
  void exit(int code) { end({code, 0}); }
  void die(int signal) { end({-1, signal}); }
  /// Writes a file into its job's folder, dated to the millisecond: a file system's own dates lag
  /// behind by a tick, and this worker may have begun less than that ago.
  void leave(const std::string& name, std::string_view text) const;
  /// Leaves an outcome as a job with this end time has it when it is done, and exits.
  void complete(double end_time = 0.1);

 private:
  friend class MockProcess;
  struct Pipe {
    FileDescriptor reading{-1};
    FileDescriptor writing{-1};
  };
  static Pipe make_pipe();
  static void write_line(const Pipe& pipe, std::string_view line);
  void end(ProcessEnd end);

  ProcessCommand command_;
  int number_;
  Pipe output_ = make_pipe();
  Pipe errors_ = make_pipe();
  Pipe life_ = make_pipe();
  std::mutex mutex_;
  std::optional<ProcessEnd> end_;
};

/// What workers do. Both are called on the thread of the scheduler.
struct MockHabits {
  std::function<void(MockWorker&)> begins = [](MockWorker&) {};
  /// Of every signal but SIGKILL, which it does not live through.
  std::function<void(MockWorker&, int)> hears = [](MockWorker& worker, int) { worker.exit(85); };
};

/// Starts workers that are no processes, or refuses to. Thread-safe.
class MockExecutor : public Executor {
 public:
  /// For workers that are started from now on.
  void set_habits(MockHabits habits);
  /// The errno with which starts are refused from now on; 0: they are not.
  void refuse(int error) { refusal_ = error; }
  /// How many workers were started.
  [[nodiscard]] int started() const;
  /// The worker of the job that was started last, waited for. Throws std::logic_error when there is
  /// none after 20 s.
  [[nodiscard]] std::shared_ptr<MockWorker> worker_of(const std::string& job) const;

  [[nodiscard]] std::unique_ptr<RunningProcess> start(const ProcessCommand& command) override;
  [[nodiscard]] std::string missing_confinement() const override { return {}; }

 private:
  std::atomic<int> refusal_ = 0;
  mutable std::mutex mutex_;
  mutable std::condition_variable has_started_;
  MockHabits habits_;
  std::vector<std::shared_ptr<MockWorker>> workers_;
};

}  // namespace sluice::test
