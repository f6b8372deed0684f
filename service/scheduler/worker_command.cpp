#include "service/scheduler/worker_command.hpp"

#include <csignal>
#include <cstdint>
#include <string>

#include "service/worker/worker_environment.hpp"

namespace sluice {
namespace {

/// Beyond what the limit counts: code, libraries, and per thread its stack and the heap's reserve.
constexpr std::uint64_t kFixedAddresses = std::uint64_t{1} << 30;
constexpr std::uint64_t kThreadAddresses = std::uint64_t{256} << 20;

constexpr std::uint64_t kMostDescriptors = 256;

/// The service stays responsive while workers take all cores, and has short slices to itself.
constexpr int kNiceness = 5;
constexpr std::uint64_t kUsualSlices = 0;
/// Short of memory, the system should take a worker: it goes on from its checkpoint.
constexpr int kOomScore = 500;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // they reserve more addresses than there is memory
#else
constexpr bool kSanitized = false;
#endif

ProcessSignals worker_signals() {
  ProcessSignals signals;
  signals.actions = ProcessSignals::Actions::usual;
  // A request for a checkpoint must not kill a worker that does not listen yet.
  signals.ignored = {SIGUSR1};
  signals.at_parents_end = SIGTERM;
  return signals;
}

ProcessLimits process_limits(const Job& job, const ServiceLimits& limits) {
  ProcessLimits result;
  result.address_space = kSanitized
                             ? ProcessLimits::kMost
                             : memory_limit(limits) + kFixedAddresses +
                                   static_cast<std::uint64_t>(job.threads) * kThreadAddresses;
  result.largest_file = limits.disk_per_job == 0 ? ProcessLimits::kMost : limits.disk_per_job;
  result.core_dump = 0;
  result.descriptors = kMostDescriptors;
  return result;
}

}  // namespace

ProcessCommand worker_command(const std::filesystem::path& program,
                              const std::filesystem::path& folder, const Job& job,
                              const ServiceLimits& limits) {
  ProcessCommand command;
  command.program = program;
  command.folder = folder;
  // By its working directory: what it says is shown to users, who need not know where that is.
  command.arguments = {"run", ".", "--threads", std::to_string(job.threads), "--progress", "json"};
  command.environment = worker_environment(job.token);
  command.others = ProcessCommand::Others::closed;
  command.signals = worker_signals();
  command.limits = process_limits(job, limits);
  command.priority = {kNiceness, kOomScore, kUsualSlices};
  command.confinement = limits.confinement;
  return command;
}

}  // namespace sluice
