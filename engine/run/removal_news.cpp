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

std::optional<Excess> excess_of(const Retired& retired, const Method& method) {
  const double ratio = 1.0 + retired.density_excess / method.reference_density;
  switch (retired.cause) {
    case RetireCause::too_fast:
      return Excess{"speed (m/s)", std::hypot(retired.vx, retired.vy), method.sound_speed};
    case RetireCause::too_dense:
      return Excess{"density ratio", ratio, 1.0 + Method::kDensityLeeway};
    case RetireCause::too_thin:
      return Excess{"density ratio", ratio, 1.0 - Method::kDensityLeeway};
    case RetireCause::overtopped:
    case RetireCause::leaked:
    case RetireCause::not_finite:
      return {};
  }
  return {};
}

std::string message_of(const Retired& retired, const std::optional<Excess>& excess) {
  const std::string why = excess
                              ? fmt::format("{}, {} {:.4g}, limit {:.4g}", to_string(retired.cause),
                                            excess->what, excess->value, excess->limit)
                              : std::string(to_string(retired.cause));
  return fmt::format("particle {:.0f} at step {}, t = {:.6g} s, ({:.6g}, {:.6g}) m: {}", retired.id,
                     retired.step, retired.time, retired.x, retired.y, why);
}

Json fields_of(const Retired& retired, const Method& method) {
  const auto excess = excess_of(retired, method);
  return Json{{"particle", retired.id},
              {"cause", to_string(retired.cause)},
              {"step", retired.step},
              {"time", retired.time},
              {"x", retired.x},
              {"y", retired.y},
              {"value", excess ? Json(excess->value) : Json(nullptr)},
              {"limit", excess ? Json(excess->limit) : Json(nullptr)},
              {"message", message_of(retired, excess)}};
}

}  // namespace

RemovalNews::RemovalNews(const Simulation& simulation)
    : seen_(simulation.solver().retired().size()),
      removed_{simulation.leaked(), simulation.excluded()} {}

void RemovalNews::tell(const Simulation& simulation, Reporter& reporter) {
  const std::vector<Retired>& all = simulation.solver().retired();
  for (; seen_ < all.size(); ++seen_) count(all[seen_], simulation.scene().method, reporter);
}

void RemovalNews::count(const Retired& retired, const Method& method, Reporter& reporter) {
  if (retired.cause == RetireCause::overtopped) return;
  const bool excluded = is_exclusion(retired.cause);
  const std::string_view name = excluded ? "excluded" : "leaked";
  const std::size_t number = ++removed_[excluded ? 1 : 0];
  if (number <= kNamed) return reporter.event(name, fields_of(retired, method));
  if (number % kNamed != 0 || !std::has_single_bit(number / kNamed)) return;
  reporter.event(name, {{"step", retired.step},
                        {"time", retired.time},
                        {"count", number},
                        {"message", fmt::format("{} particles up to step {}, t = {:.6g} s", number,
                                                retired.step, retired.time)}});
}

}  // namespace sluice
