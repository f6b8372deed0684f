#include "cli/machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <thread>
#include <vector>

#include "cli/checks.hpp"
#include "engine/scene/forecast/estimate.hpp"
#include "engine/sph/loops/simd_target.hpp"

namespace sluice {
namespace {

/// Before anything is made for a run that this machine cannot do.
CLI::Validator simd_target_of_this_machine() {
  return {[](std::string& target) {
            const std::vector<std::string> here = simd_targets();
            return std::ranges::find(here, target) != here.end()
                       ? std::string()
                       : fmt::format("is \"{}\", but this machine runs only {}", target,
                                     fmt::join(here, ", "));
          },
          "", ""};
}

}  // namespace

int default_threads(const Scene& scene) {
  const std::uint64_t useful = estimate(scene).fluid_particles / 2000;
  const std::uint64_t cores = std::max(1U, std::thread::hardware_concurrency());
  return static_cast<int>(std::clamp<std::uint64_t>(useful, 1, cores));
}

void add_execution_options(CLI::App& verb, int& threads, std::string& simd) {
  verb.add_option("--threads", threads, "Threads; by default as many as there are cores and use")
      ->check(whole_between(1, 1024));
  verb.add_option("--simd", simd,
                  "SIMD target instead of that of SLUICE_SIMD, else this machine's best")
      ->check(one_of(std::vector<std::string>{"SSE4", "AVX2", "AVX3"}))
      ->check(simd_target_of_this_machine());
}

}  // namespace sluice
