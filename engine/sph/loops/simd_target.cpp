#include "engine/sph/loops/simd_target.hpp"

#include <hwy/highway.h>
#include <hwy/targets.h>

#include <mutex>
#include <stdexcept>

namespace sluice {
namespace {

std::vector<std::int64_t> target_bits() {
  std::vector<std::int64_t> bits;
  const std::int64_t usable = hwy::SupportedTargets() & HWY_TARGETS;
  // Highway numbers better targets lower.
  for (int bit = 0; bit < 62; ++bit) {
    const std::int64_t target = std::int64_t{1} << bit;
    if ((usable & target) != 0) bits.push_back(target);
  }
  return bits;
}

/// "" for the best.
std::string& default_target() {
  static std::string target;
  return target;
}

}  // namespace

std::vector<std::string> simd_targets() {
  std::vector<std::string> names;
  for (const std::int64_t target : target_bits()) names.emplace_back(hwy::TargetName(target));
  return names;
}

void set_default_simd_target(const std::string& target) {
  with_simd_target(target, [] {});
  default_target() = target;
}

void with_simd_target(const std::string& asked, const std::function<void()>& body) {
  // Highway's choice is one per process.
  static std::mutex mutex;
  const std::lock_guard lock(mutex);

  const std::string target = asked.empty() ? default_target() : asked;
  std::string known;
  for (const std::int64_t bits : target_bits()) {
    const std::string name = hwy::TargetName(bits);
    known += (known.empty() ? "" : ", ") + name;
    if (target.empty() || target == name) {
      hwy::GetChosenTarget().Update(bits);
      body();
      hwy::GetChosenTarget().DeInit();
      return;
    }
  }
  throw std::invalid_argument("SIMD target \"" + target +
                              "\" does not run here; this machine runs " + known);
}

}  // namespace sluice
