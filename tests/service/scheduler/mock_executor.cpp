#include "tests/service/scheduler/mock_executor.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "tests/service/scheduler/scheduler_support.hpp"

namespace sluice::test {

namespace fs = std::filesystem;

/// What the scheduler has of a MockWorker.
class MockProcess final : public RunningProcess {
 public:
  MockProcess(std::shared_ptr<MockWorker> worker, MockHabits habits)
      : worker_(std::move(worker)), habits_(std::move(habits)) {}
  ~MockProcess() override { worker_->die(SIGKILL); }

  /// Beyond the highest number that Linux gives a process.
  [[nodiscard]] pid_t pid() const override { return (1 << 22) + worker_->number(); }
  [[nodiscard]] int end_descriptor() const override { return worker_->life_.reading.get(); }
  [[nodiscard]] int output() const override { return worker_->output_.reading.get(); }
  [[nodiscard]] int errors() const override { return worker_->errors_.reading.get(); }

  void send(int signal_number) override {
    if (!reaped_) habits_.hears(*worker_, signal_number);
  }
  void kill_group() override { worker_->die(SIGKILL); }
  [[nodiscard]] std::optional<ProcessEnd> reap() override {
    const std::lock_guard lock(worker_->mutex_);
    if (reaped_ || !worker_->end_) return {};
    reaped_ = true;
    return worker_->end_;
  }

 private:
  std::shared_ptr<MockWorker> worker_;
  MockHabits habits_;
  bool reaped_ = false;
};

MockWorker::MockWorker(ProcessCommand command, int number)
    : command_(std::move(command)), number_(number) {}

MockWorker::Pipe MockWorker::make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) != 0) {
    throw std::system_error(errno, std::generic_category(), "cannot make a pipe");
  }
  return {FileDescriptor(ends[0]), FileDescriptor(ends[1])};
}

void MockWorker::write_line(const Pipe& pipe, std::string_view line) {
  const std::string text = std::string(line) + "\n";
  if (pipe.writing.get() < 0) return;
  if (::write(pipe.writing.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
    throw std::logic_error("a worker said more than its pipe takes");
  }
}

void MockWorker::say(std::string_view line) {
  const std::lock_guard lock(mutex_);
  write_line(output_, line);
}

void MockWorker::say_error(std::string_view line) {
  const std::lock_guard lock(mutex_);
  write_line(errors_, line);
}

void MockWorker::leave(const std::string& name, std::string_view text) const {
  write_file(command_.folder / name, text);
  fs::last_write_time(command_.folder / name, fs::file_time_type::clock::now());
}

void MockWorker::complete(double end_time) {
  leave(
      "outcome.json",
      fmt::format(R"({{"state":"completed","exit_code":0,"reason":"","end_time":{}}})", end_time));
  exit(0);
}

void MockWorker::end(ProcessEnd end) {
  const std::lock_guard lock(mutex_);
  if (end_) return;
  end_ = end;
  for (Pipe* pipe : {&output_, &errors_, &life_}) pipe->writing = FileDescriptor(-1);
}

void MockExecutor::set_habits(MockHabits habits) {
  const std::lock_guard lock(mutex_);
  habits_ = std::move(habits);
}

int MockExecutor::started() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(workers_.size());
}

std::shared_ptr<MockWorker> MockExecutor::worker_of(const std::string& job) const {
  constexpr std::chrono::seconds kPatience{20};
  std::unique_lock lock(mutex_);
  std::shared_ptr<MockWorker> found;
  const bool started = has_started_.wait_for(lock, kPatience, [&] {
    const auto last = std::find_if(workers_.rbegin(), workers_.rend(),
                                   [&](const auto& worker) { return worker->job() == job; });
    if (last != workers_.rend()) found = *last;
    return found != nullptr;
  });
  if (!started) throw std::logic_error("no worker was started for job " + job);
  return found;
}

std::unique_ptr<RunningProcess> MockExecutor::start(const ProcessCommand& command) {
  if (const int error = refusal_) {
    throw ProcessStartError(error, std::generic_category(), "cannot make a process");
  }
  std::unique_lock lock(mutex_);
  const MockHabits habits = habits_;
  const auto worker = std::make_shared<MockWorker>(command, static_cast<int>(workers_.size()) + 1);
  workers_.push_back(worker);
  lock.unlock();
  has_started_.notify_all();
  habits.begins(*worker);
  return std::make_unique<MockProcess>(worker, habits);
}

}  // namespace sluice::test
