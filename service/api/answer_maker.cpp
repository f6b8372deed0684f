#include "service/api/answer_maker.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <system_error>
#include <thread>

#include "engine/store/disk/errors.hpp"
#include "service/http/problem.hpp"
#include "service/jobs/worker_exit.hpp"

namespace sluice {
namespace {

using MakerClock = std::chrono::steady_clock;

constexpr std::size_t kMostDamaged = 64;  // known
/// Of the children: below the service's threads, which answer everybody else, and above its
/// workers, which would leave them nothing.
constexpr int kGivesWay = 3;

// What the first byte of a child's answer says of the rest.
constexpr char kText = 't';
constexpr char kProblem = 'p';  // a JSON object

/// A child with its heap, and what reading a file and working it up takes, bytes.
std::int64_t memory_for(std::uint64_t bytes) {
  return (std::int64_t{16} << 20) + 8 * static_cast<std::int64_t>(bytes);
}

ApartLimits limits_for(std::uint64_t bytes) {
  ApartLimits limits = ApartLimits::for_bytes(bytes);
  limits.nice = kGivesWay;
  return limits;
}

/// Where the system refuses a child, others may soon end.
template <class Work>
auto or_overloaded(const Work& work) {
  try {
    return work();
  } catch (const std::system_error& error) {
    throw ApiError(ProblemType::overloaded,
                   fmt::format("{}: try again in some seconds", error.what()));
  }
}

/// The exit codes of our own programs that tell of files (worker_exit.hpp).
StorageFault fault_of(const ApartEnd& end) {
  const bool of_files = end.exit_code == WorkerExit::storage_failure ||
                        end.exit_code == WorkerExit::no_usable_checkpoint ||
                        end.exit_code == WorkerExit::invalid_scene ||
                        end.exit_code == WorkerExit::usage;
  return of_files || !end.death.empty() ? StorageFault::corrupt : StorageFault::io;
}

/// In the child: the ApiError too becomes a text.
std::string told(const std::function<std::string()>& work) {
  try {
    std::string text = work();
    text.insert(text.begin(), kText);
    return text;
  } catch (const ApiError& error) {
    const ProblemFields problem{{"type", static_cast<int>(error.type())},
                                {"detail", error.what()},
                                {"fields", error.fields()}};
    return kProblem + problem.dump(-1, ' ', false, ProblemFields::error_handler_t::replace);
  }
}

std::string understood(std::string text) {
  const bool problem = text.front() == kProblem;
  text.erase(0, 1);
  if (!problem) return text;
  const auto object = ProblemFields::parse(text);
  throw ApiError(static_cast<ProblemType>(object["type"].get<int>()),
                 object["detail"].get<std::string>(), object["fields"]);
}

}  // namespace

int AnswerMaker::default_children() {
  return std::max(2, static_cast<int>(std::thread::hardware_concurrency()));
}

AnswerMaker::Stamp AnswerMaker::stamp_of(const std::filesystem::path& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) return {};
  return {status.st_dev, status.st_ino, status.st_size, status.st_mtim.tv_sec,
          status.st_mtim.tv_nsec};
}

AnswerMaker::Share AnswerMaker::share_for(std::uint64_t bytes) {
  const auto until = MakerClock::now() + std::chrono::duration<double>(limits_.patience);
  const auto left = [&] {
    return std::max(0.0, std::chrono::duration<double>(until - MakerClock::now()).count());
  };
  Share share{threads_.try_take(), nullptr, nullptr};
  if (share.thread) share.child = children_.try_take(1, left());
  if (share.child) share.memory = memory_.try_take(memory_for(bytes), left());
  if (share.memory) return share;
  throw ApiError(ProblemType::overloaded,
                 "too many series and reports are being made: try again in some seconds");
}

void AnswerMaker::refuse_damaged(const Stamp& stamp) {
  const std::scoped_lock lock(mutex_);
  const auto found = std::ranges::find(damaged_, stamp, &Damaged::stamp);
  if (found != damaged_.end()) throw StorageError(StorageFault::corrupt, found->message);
}

std::string AnswerMaker::from_file(const std::filesystem::path& path,
                                   const std::function<std::string()>& work) {
  const Stamp stamp = stamp_of(path);
  refuse_damaged(stamp);
  const auto bytes = static_cast<std::uint64_t>(stamp.size);
  const Share share = share_for(bytes);
  try {
    return understood(
        or_overloaded([&] { return work_apart(limits_for(bytes), [&] { return told(work); }); }));
  } catch (const ApartFailure& failure) {
    const std::string message = damage_message(path, failure);
    const std::scoped_lock lock(mutex_);
    if (damaged_.size() == kMostDamaged) damaged_.pop_front();
    damaged_.push_back({stamp, message});
    throw StorageError(StorageFault::corrupt, message);
  }
}

std::string AnswerMaker::by_program(std::uint64_t bytes, const std::filesystem::path& program,
                                    const std::filesystem::path& folder,
                                    const std::vector<std::string>& arguments) {
  const Share share = share_for(bytes);
  ApartEnd end =
      or_overloaded([&] { return program_apart(limits_for(bytes), program, folder, arguments); });
  if (end.death.empty() && end.exit_code == 0) return std::move(end.output);
  throw StorageError(fault_of(end), fmt::format("{}: it cannot be made: {}", folder.string(),
                                                end.death.empty() ? end.errors : end.death));
}

}  // namespace sluice
