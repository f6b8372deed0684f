#include "service/scheduler/worker_command.hpp"

#include <cstdint>
#include <string>

#include "service/jobs/limits.hpp"

namespace sluice {
namespace {

/// Beyond what the limit counts: code, libraries, and per thread its stack and the heap's reserve.
constexpr std::uint64_t kFixedAddresses = std::uint64_t{1} << 30;
constexpr std::uint64_t kThreadAddresses = std::uint64_t{256} << 20;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // they reserve more addresses than there is memory
#else
constexpr bool kSanitized = false;
#endif

}  // namespace

WorkerCommand worker_command(const std::filesystem::path& program,
                             const std::filesystem::path& folder, const Job& job,
                             const ServiceLimits& limits) {
  WorkerCommand command;
  command.program = program;
  command.folder = folder;
  // By its working directory: what it says is shown to users, who need not know where that is.
  command.arguments = {"run", ".", "--threads", std::to_string(job.threads), "--progress", "json"};
  command.token = job.token;
  if (!kSanitized) {
    command.address_space = memory_limit(limits) + kFixedAddresses +
                            static_cast<std::uint64_t>(job.threads) * kThreadAddresses;
  }
  command.largest_file = limits.disk_per_job;
  command.confinement = limits.confinement;
  return command;
}

}  // namespace sluice
