#include "engine/sph/solver/solver.hpp"

namespace sluice {

std::string_view to_string(StepLimit limit) {
  return limit == StepLimit::sound ? "sound" : "force";
}

std::string_view to_string(Pass pass) {
  constexpr std::array<std::string_view, kPassCount> names{
      "sort", "wall_pressure", "pair_sums", "reinitialisation", "update", "sample"};
  return names[static_cast<std::size_t>(pass)];
}

}  // namespace sluice
