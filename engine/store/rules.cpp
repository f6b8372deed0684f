#include "engine/store/rules.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>

namespace sluice {
namespace {

/// Throws with one fault.
class Rules {
 public:
  explicit Rules(StorageFault fault) : fault_(fault) {}

  [[noreturn]] void refuse(const std::string& message) const {
    throw StorageError(fault_, message);
  }
  void require_count(std::string_view what, std::size_t found, std::size_t wanted) const {
    if (found != wanted) {
      refuse(fmt::format("{} holds {} numbers where {} are expected", what, found, wanted));
    }
  }
  void require_finite(std::string_view what, double value) const {
    if (!std::isfinite(value)) {
      refuse(fmt::format("{} is {}, which is not finite", what, value));
    }
  }
  void require_finite(std::string_view what, const std::vector<double>& values) const {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i])) {
        refuse(fmt::format("{}[{}] is {}, which is not finite", what, i, values[i]));
      }
    }
  }

 private:
  StorageFault fault_;
};

void require_particles(const Rules& rules, Integrator integrator, const Particles& particles) {
  for (const Field& field : kFields) {
    const std::vector<double>& values = particles.*field.member;
    const std::string what = fmt::format("particle field '{}'", field.name);
    rules.require_count(what, values.size(), carries(integrator, field) ? particles.size() : 0);
    rules.require_finite(what, values);
  }
}

void require_retired(const Rules& rules, const std::vector<Retired>& list) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string what = fmt::format("retired particle {}: ", i);
    rules.require_finite(what + "id", list[i].id);
    rules.require_finite(what + "time", list[i].time);
    rules.require_finite(what + "x", list[i].x);
    rules.require_finite(what + "y", list[i].y);
  }
}

void require_values(const Rules& rules, const std::string& what, const Series& series) {
  const std::size_t width = series.columns.size();
  for (std::size_t i = 0; i < series.values.size(); ++i) {
    const double value = series.values[i];
    const bool dry = std::isnan(value) && series.weight[i / width] == 0.0;
    if (!std::isfinite(value) && !dry) {
      rules.refuse(
          fmt::format("{} value of sample {} is {} with weight {}; only a dry one, of "
                      "weight 0, may be no number",
                      what, i / width, value, series.weight[i / width]));
    }
  }
}

void require_series(const Rules& rules, const Series& series) {
  const std::string what = fmt::format("series '{}':", series.name);
  const std::size_t count = series.time.size();
  rules.require_count(what + " duration", series.duration.size(), count);
  rules.require_count(what + " weight", series.weight.size(), count);
  rules.require_count(what + " values", series.values.size(), count * series.columns.size());
  rules.require_finite(what + " time", series.time);
  rules.require_finite(what + " duration", series.duration);
  rules.require_finite(what + " weight", series.weight);
  for (std::size_t i = 1; i < count; ++i) {
    if (series.time[i] <= series.time[i - 1]) {
      rules.refuse(fmt::format("{} time of sample {} is {}, not after {}", what, i, series.time[i],
                               series.time[i - 1]));
    }
  }
  require_values(rules, what, series);
}

}  // namespace

void require_sound(const Checkpoint& checkpoint, StorageFault fault) {
  const Rules rules(fault);
  rules.require_finite("time", checkpoint.solver.time);
  rules.require_finite("time_step", checkpoint.solver.time_step);
  require_particles(rules, checkpoint.integrator, checkpoint.solver.particles);
  require_retired(rules, checkpoint.solver.retired);
  for (const GuardNumber& number : kGuardNumbers) {
    rules.require_finite(fmt::format("guard number {}", number.name),
                         checkpoint.guards.*number.member);
  }
  require_sound(checkpoint.series, fault);
}

void require_sound(const std::vector<Series>& series, StorageFault fault) {
  const Rules rules(fault);
  for (const Series& one : series) {
    require_series(rules, one);
  }
}

}  // namespace sluice
