#include "service/worker/worker_environment.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdlib>

namespace sluice {
namespace {

constexpr std::array kPassedOn{
    "PATH",         "LANG",         "LC_ALL",        "TZ",         "LD_LIBRARY_PATH",
    "ASAN_OPTIONS", "TSAN_OPTIONS", "UBSAN_OPTIONS", "SLUICE_SIMD"};

}  // namespace

std::vector<std::string> worker_environment(const std::string& token) {
  std::vector<std::string> texts{fmt::format("{}={}", kTokenVariable, token)};
  for (const char* name : kPassedOn) {
    if (const char* value = std::getenv(name)) texts.push_back(fmt::format("{}={}", name, value));
  }
  return texts;
}

}  // namespace sluice
