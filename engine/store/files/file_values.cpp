#include "engine/store/files/file_values.hpp"

#include <fmt/format.h>

#include <string_view>

#include "engine/store/disk/errors.hpp"

namespace sluice {
namespace {

constexpr std::string_view kLeapFrog = "modified_leap_frog";
constexpr std::string_view kKickDriftKick = "kick_drift_kick";

[[noreturn]] void refuse(const std::string& message) {
  throw StorageError(StorageFault::corrupt, message);
}

}  // namespace

std::string to_file(Integrator integrator) {
  return std::string(integrator == Integrator::modified_leap_frog ? kLeapFrog : kKickDriftKick);
}

void from_file(const std::string& text, Integrator& integrator) {
  if (text != kLeapFrog && text != kKickDriftKick) {
    refuse(fmt::format("attribute 'integrator' of / is '{}', which is no integrator", text));
  }
  integrator = text == kLeapFrog ? Integrator::modified_leap_frog : Integrator::kick_drift_kick;
}

void from_file(std::uint64_t number, bool& flag) {
  if (number > 1) {
    refuse(fmt::format("{} where 0 or 1 is expected", number));
  }
  flag = number == 1;
}

void from_file(std::uint64_t number, RemovalCause& cause) {
  if (number >= kRemovalCauses) {
    refuse(fmt::format("data set /retired/cause holds {}, which is no cause", number));
  }
  cause = static_cast<RemovalCause>(number);
}

}  // namespace sluice
