#pragma once

#include <cstdint>
#include <string>

#include "engine/sph/method/method.hpp"
#include "engine/sph/method/particles.hpp"

namespace sluice {

// Values that a file holds in another form than memory does. from_file() throws
// StorageError(corrupt) for what to_file() never gives.

[[nodiscard]] std::string to_file(Integrator integrator);
[[nodiscard]] inline std::uint64_t to_file(bool flag) { return flag ? 1 : 0; }
[[nodiscard]] inline double to_file(double value) { return value; }
[[nodiscard]] inline std::uint64_t to_file(std::uint64_t value) { return value; }
[[nodiscard]] inline std::uint64_t to_file(RemovalCause cause) {
  return static_cast<std::uint64_t>(cause);
}

void from_file(const std::string& text, Integrator& integrator);
void from_file(std::uint64_t number, bool& flag);
inline void from_file(double number, double& value) { value = number; }
inline void from_file(std::uint64_t number, std::uint64_t& value) { value = number; }
void from_file(std::uint64_t number, RemovalCause& cause);

}  // namespace sluice
