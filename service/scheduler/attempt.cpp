#include "service/scheduler/attempt.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <nlohmann/json.hpp>
#include <utility>

namespace sluice {
namespace {

/// Bytes taken from one pipe at a time, so that a worker that floods it holds up nobody else.
constexpr std::size_t kMostAtOnce = std::size_t{256} << 10;
constexpr double kProgressInterval = 0.9;  // s; workers report once a second
/// Warnings and complaints of one attempt that go into the job's history; its log has them all.
constexpr int kMostWarnings = 100;
constexpr std::size_t kLongestDetail = 4096;
constexpr std::size_t kQuoted = 60;

/// Hands what stands in the pipe to `use`; false once its other end is closed.
template <class Use>
bool drain(int descriptor, const Use& use) {
  std::array<char, 16384> buffer{};
  for (std::size_t total = 0; total < kMostAtOnce;) {
    const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EAGAIN) return true;
    if (count <= 0) return false;
    total += static_cast<std::size_t>(count);
    use(std::string_view(buffer.data(), static_cast<std::size_t>(count)));
  }
  return true;
}

bool begins(const std::string& event) { return event == "started" || event == "resumed"; }
bool ends(const std::string& event) {
  return event == "finished" || event == "stopped" || event == "failed";
}

std::string head_line(const Job& job) {
  return fmt::format("--- attempt {} of job {}\n", job.attempts, job.id);
}

}  // namespace

Attempt::Attempt(Job job, std::filesystem::path folder, std::unique_ptr<RunningProcess> worker,
                 double now)
    : job_(std::move(job)),
      folder_(std::move(folder)),
      worker_(std::move(worker)),
      log_(folder_, head_line(job_)),
      started_(now),
      stalled_(now) {}

std::vector<WorkerMessage> Attempt::read(double now) {
  std::vector<WorkerMessage> messages;
  if (output_is_open_) {
    output_is_open_ = drain(worker_->output(), [&](std::string_view bytes) {
      for (const LineReader::Line& line : lines_.feed(bytes)) take(line, now, messages);
    });
    if (!output_is_open_) {
      const std::string rest = lines_.take_rest();
      if (!rest.empty()) take({rest, false}, now, messages);
    }
  }
  read_errors();
  return messages;
}

void Attempt::read_errors() {
  if (!errors_are_open_) return;
  errors_are_open_ = drain(worker_->errors(), [&](std::string_view bytes) { log_.append(bytes); });
}

void Attempt::take(const LineReader::Line& line, double now, std::vector<WorkerMessage>& messages) {
  if (line.cut) {
    return complain(fmt::format("a line of its output was longer than {} bytes and was cut",
                                kLongestWorkerLine),
                    messages);
  }
  if (line.text.empty()) return;
  std::optional<WorkerMessage> message = parse_worker_line(line.text);
  if (!message) {
    return complain(
        fmt::format("a line of its output is no event: {}", printable(line.text, kQuoted)),
        messages);
  }
  take(*std::move(message), now, messages);
}

void Attempt::take(WorkerMessage message, double now, std::vector<WorkerMessage>& messages) {
  if (begins(message.event)) {
    listens_ = true;
    // What came before the first step, such as reading a checkpoint, is progress, but only once.
    if (!step_) stalled_.restart(now);
    if (std::exchange(checkpoint_wanted_, false)) worker_->send(SIGUSR1);
  }
  if (message.step && (!step_ || *message.step > *step_)) {
    step_ = message.step;
    stalled_.restart(now);
  }
  if (!message.text.empty()) last_words_ = message.text;
  if (ends(message.event)) {
    told_outcome_ = std::move(message.detail);
    return;
  }
  if (message.detail.size() > kLongestDetail) return;
  if (message.event == "progress") {
    progress_ = std::move(message.detail);
    return;
  }
  if (message.event == "checkpoint") {
    if (now < next_checkpoint_event_) return;
    next_checkpoint_event_ = now + kProgressInterval;
  } else if (++warnings_ > kMostWarnings) {
    return;
  }
  messages.push_back(std::move(message));
}

void Attempt::complain(const std::string& what, std::vector<WorkerMessage>& messages) {
  if (++warnings_ > kMostWarnings) return;
  WorkerMessage message;
  message.event = "warning";
  message.detail = nlohmann::json{{"message", what}}.dump();
  messages.push_back(std::move(message));
}

std::optional<std::string> Attempt::progress_due(double now) {
  if (!progress_ || now < next_progress_) return {};
  next_progress_ = now + kProgressInterval;
  return std::exchange(progress_, std::nullopt);
}

bool Attempt::disk_look_due(double now, double interval) {
  if (now < next_disk_look_) return false;
  next_disk_look_ = now + interval;
  return true;
}

void Attempt::stop(StopCause cause, double now) {
  if (cause_ != StopCause::none) return;
  cause_ = cause;
  stop_asked_ = now;
  worker_->send(SIGTERM);
}

void Attempt::kill(StopCause cause) {
  if (cause_ == StopCause::none) cause_ = cause;
  worker_->kill_group();
}

void Attempt::checkpoint() {
  if (listens_) {
    worker_->send(SIGUSR1);
  } else {
    checkpoint_wanted_ = true;
  }
}

std::optional<ProcessEnd> Attempt::end() { return worker_->reap(); }

std::optional<FreshOutcome> Attempt::outcome() const {
  std::optional<FreshOutcome> written = fresh_outcome(paths(), job_);
  return written ? written : told_outcome(told_outcome_, job_);
}

std::string Attempt::last_words() const {
  return last_words_.empty() ? log_.last_line() : last_words_;
}

}  // namespace sluice
