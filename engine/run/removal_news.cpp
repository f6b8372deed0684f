#include "engine/run/removal_news.hpp"

#include <bit>

#include "engine/run/events.hpp"

namespace sluice {

RemovalNews::RemovalNews(const Simulation& simulation)
    : seen_(simulation.solver().removed_count()),
      removed_{simulation.leaked(), simulation.excluded()} {}

void RemovalNews::tell(const Simulation& simulation, Reporter& reporter) {
  const Solver& solver = simulation.solver();
  for (; seen_ < solver.removed_count(); ++seen_) {
    count(solver.removed(seen_), simulation.scene().method, reporter);
  }
}

void RemovalNews::count(const RemovedParticle& removed, const Method& method, Reporter& reporter) {
  if (removed.cause == RemovalCause::overtopped) return;
  const std::size_t number = ++removed_[is_exclusion(removed.cause) ? 1 : 0];
  if (number <= kNamed) return reporter.event(removal_event(removed, method));
  if (number % kNamed != 0 || !std::has_single_bit(number / kNamed)) return;
  reporter.event(removals_event(removed, number));
}

}  // namespace sluice
