#pragma once

#include <array>
#include <cstddef>

#include "engine/run/reporter.hpp"
#include "engine/run/simulation.hpp"

namespace sluice {

/// Tells of each particle that was excluded or has leaked: the first ones of either kind by name,
/// then only how many they are, each time that their number has doubled.
class RemovalNews {
 public:
  static constexpr std::size_t kNamed = 20;

  /// Of what is removed from now on: earlier attempts have told of the others.
  explicit RemovalNews(const Simulation& simulation);
  void tell(const Simulation& simulation, Reporter& reporter);

 private:
  void count(const RemovedParticle& removed, const Method& method, Reporter& reporter);

  std::size_t seen_ = 0;
  std::array<std::size_t, 2> removed_{};  ///< leaked, excluded, since the start of the run
};

}  // namespace sluice
