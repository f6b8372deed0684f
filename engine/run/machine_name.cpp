#include "engine/run/machine_name.hpp"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <array>
#include <cstring>
#include <thread>

#if defined(__x86_64__)
#include <cpuid.h>
#endif

namespace sluice {
namespace {

/// The processor's name for itself; empty where it has none.
std::string brand() {
#if defined(__x86_64__)
  constexpr unsigned kFirst = 0x80000002;
  std::array<unsigned, 12> words{};
  if (__get_cpuid_max(0x80000000, nullptr) < kFirst + 2) return {};
  for (unsigned part = 0; part < 3; ++part) {
    unsigned* const to = words.data() + 4 * std::size_t{part};
    __get_cpuid(kFirst + part, to, to + 1, to + 2, to + 3);
  }
  std::array<char, sizeof words + 1> text{};
  std::memcpy(text.data(), words.data(), sizeof words);
  std::string name = text.data();
  name.erase(name.find_last_not_of(' ') + 1);
  name.erase(0, name.find_first_not_of(' '));
  return name;
#else
  return {};
#endif
}

std::string architecture() {
  utsname system{};
  return uname(&system) == 0 ? system.machine : "unknown processor";
}

}  // namespace

const std::string& machine_name() {
  static const std::string name = [] {
    const std::string processor = brand();
    const unsigned cores = std::thread::hardware_concurrency();
    return fmt::format("{}, {} core{}", processor.empty() ? architecture() : processor, cores,
                       cores == 1 ? "" : "s");
  }();
  return name;
}

}  // namespace sluice
