#include "cli/machine.hpp"

#include <algorithm>
#include <thread>

#include "cli/checks.hpp"
#include "engine/scene/estimate.hpp"

namespace sluice {

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
      ->check(one_of(std::vector<std::string>{"SSE4", "AVX2", "AVX3"}));
}

}  // namespace sluice
