#include "engine/store/files/rules.hpp"

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
  for (const Field& field : fields_in(particles.position.size())) {
    const std::vector<double>& values = field.values.of(particles);
    const std::string what = fmt::format("particle field '{}'", field.name);
    rules.require_count(what, values.size(), carries(integrator, field) ? particles.size() : 0);
    rules.require_finite(what, values);
  }
}

void require_removed(const Rules& rules, const std::vector<RemovedParticle>& list) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string what = fmt::format("removed particle {}: ", i);
    rules.require_finite(what + "id", list[i].id);
    rules.require_finite(what + "time", list[i].time);
    for (const RemovedField& field :
         removed_fields_in(static_cast<std::size_t>(list[i].position.size()))) {
      rules.require_finite(what + std::string(field.name), field.value.of(list[i]));
    }
  }
}

std::string describe(const SampleTable& table) {
  const std::string first = table.names.empty() ? "" : fmt::format(" '{}'", table.names.front());
  return table.sensors() < 2 ? "series" + first
                             : fmt::format("series{} to '{}'", first, table.names.back());
}

void require_values(const Rules& rules, const SampleTable& table) {
  const double* value = table.values.data();
  for (std::size_t entry = 0; entry < table.weight.size(); ++entry) {
    const double weight = table.weight[entry];
    for (std::size_t column = 0; column < table.columns.size(); ++column, ++value) {
      const bool dry = std::isnan(*value) && weight == 0.0;
      if (std::isfinite(*value) || dry) continue;
      rules.refuse(fmt::format(
          "series '{}': value of sample {} is {} with weight {}; only a dry one, of weight 0, may "
          "be no number",
          table.names[entry % table.sensors()], entry / table.sensors(), *value, weight));
    }
  }
}

void require_table(const Rules& rules, const SampleTable& table) {
  const std::string what = describe(table) + ":";
  const std::size_t count = table.size();
  rules.require_count(what + " places", table.places.size(), table.sensors());
  rules.require_count(what + " duration", table.duration.size(), count);
  rules.require_count(what + " weight", table.weight.size(), count * table.sensors());
  rules.require_count(what + " values", table.values.size(), count * table.width());
  rules.require_finite(what + " time", table.time);
  rules.require_finite(what + " duration", table.duration);
  rules.require_finite(what + " weight", table.weight);
  for (std::size_t i = 1; i < count; ++i) {
    if (table.time[i] <= table.time[i - 1]) {
      rules.refuse(fmt::format("{} time of sample {} is {}, not after {}", what, i, table.time[i],
                               table.time[i - 1]));
    }
  }
  require_values(rules, table);
}

/// Each sensor of the scene's list is in one table.
void require_places(const Rules& rules, const std::vector<SampleTable>& tables) {
  const std::size_t count = sensor_count(tables);
  std::vector<bool> taken(count, false);
  for (const SampleTable& table : tables) {
    for (const std::uint64_t place : table.places) {
      if (place >= count || taken[static_cast<std::size_t>(place)]) {
        rules.refuse(fmt::format("{}: place {} is taken twice or beyond the {} sensors",
                                 describe(table), place, count));
      }
      taken[static_cast<std::size_t>(place)] = true;
    }
  }
}

}  // namespace

void require_sound(const Checkpoint& checkpoint, StorageFault fault) {
  const Rules rules(fault);
  rules.require_finite("time", checkpoint.solver.time);
  rules.require_finite("time_step", checkpoint.solver.time_step);
  require_particles(rules, checkpoint.integrator, checkpoint.solver.particles);
  require_removed(rules, checkpoint.solver.removed);
  for (const GuardNumber& number : kGuardNumbers) {
    rules.require_finite(fmt::format("guard number {}", number.name),
                         checkpoint.guards.*number.member);
  }
  require_sound(checkpoint.samples, fault);
}

void require_sound(const std::vector<SampleTable>& tables, StorageFault fault) {
  const Rules rules(fault);
  for (const SampleTable& table : tables) {
    require_table(rules, table);
  }
  require_places(rules, tables);
}

}  // namespace sluice
