#include "engine/run/removal_news.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

/// The number that an exclusion was for, and its limit.
struct Excess {
  std::string_view what;
  double value;
  double limit;
};

std::optional<Excess> excess_of(const RemovedParticle& removed, const Method& method) {
  const double ratio = 1.0 + removed.density_excess / method.reference_density;
  switch (removed.cause) {
    case RemovalCause::too_fast:
      return Excess{"speed (m/s)", std::hypot(removed.vx, removed.vy), method.sound_speed};
    case RemovalCause::too_dense:
      return Excess{"density ratio", ratio, 1.0 + Method::kDensityLeeway};
    case RemovalCause::too_thin:
      return Excess{"density ratio", ratio, 1.0 - Method::kDensityLeeway};
    case RemovalCause::overtopped:
    case RemovalCause::leaked:
    case RemovalCause::not_finite:
      return {};
  }
  return {};
}

std::string message_of(const RemovedParticle& removed, const std::optional<Excess>& excess) {
  const std::string why = excess
                              ? fmt::format("{}, {} {:.4g}, limit {:.4g}", to_string(removed.cause),
                                            excess->what, excess->value, excess->limit)
                              : std::string(to_string(removed.cause));
  return fmt::format("particle {:.0f} at step {}, t = {:.6g} s, ({:.6g}, {:.6g}) m: {}", removed.id,
                     removed.step, removed.time, removed.x, removed.y, why);
}

Json fields_of(const RemovedParticle& removed, const Method& method) {
  const auto excess = excess_of(removed, method);
  return Json{{"particle", removed.id},
              {"cause", to_string(removed.cause)},
              {"step", removed.step},
              {"time", removed.time},
              {"x", removed.x},
              {"y", removed.y},
              {"value", excess ? Json(excess->value) : Json(nullptr)},
              {"limit", excess ? Json(excess->limit) : Json(nullptr)},
              {"message", message_of(removed, excess)}};
}

}  // namespace

RemovalNews::RemovalNews(const Simulation& simulation)
    : seen_(simulation.solver().removed().size()),
      removed_{simulation.leaked(), simulation.excluded()} {}

void RemovalNews::tell(const Simulation& simulation, Reporter& reporter) {
  const std::vector<RemovedParticle>& all = simulation.solver().removed();
  for (; seen_ < all.size(); ++seen_) count(all[seen_], simulation.scene().method, reporter);
}

void RemovalNews::count(const RemovedParticle& removed, const Method& method, Reporter& reporter) {
  if (removed.cause == RemovalCause::overtopped) return;
  const bool excluded = is_exclusion(removed.cause);
  const std::string_view name = excluded ? "excluded" : "leaked";
  const std::size_t number = ++removed_[excluded ? 1 : 0];
  if (number <= kNamed) return reporter.event(name, fields_of(removed, method));
  if (number % kNamed != 0 || !std::has_single_bit(number / kNamed)) return;
  reporter.event(name, {{"step", removed.step},
                        {"time", removed.time},
                        {"count", number},
                        {"message", fmt::format("{} particles up to step {}, t = {:.6g} s", number,
                                                removed.step, removed.time)}});
}

}  // namespace sluice
