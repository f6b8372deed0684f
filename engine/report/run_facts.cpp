#include "engine/report/run_facts.hpp"

#include <algorithm>
#include <cmath>

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

const Json* find(const Json& object, const char* pointer) {
  const Json::json_pointer place(pointer);
  return object.is_structured() && object.contains(place) ? &object.at(place) : nullptr;
}

std::optional<double> number_in(const Json& object, const char* pointer) {
  const Json* found = find(object, pointer);
  if (found == nullptr || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

std::string text_in(const Json& object, const char* pointer) {
  const Json* found = find(object, pointer);
  return found != nullptr && found->is_string() ? found->get<std::string>() : std::string{};
}

std::vector<PassCost> passes_in(const Json& outcome) {
  std::vector<PassCost> passes;
  const Json* found = find(outcome, "/this_attempt/passes");
  if (found == nullptr || !found->is_array()) return passes;
  for (const Json& pass : *found) {
    const auto seconds = number_in(pass, "/seconds");
    if (!seconds) continue;
    passes.push_back({text_in(pass, "/name"), *seconds, number_in(pass, "/share").value_or(0.0)});
  }
  return passes;
}

/// A run that was stopped or killed has only its last attempt in its outcome.
void find_cost(RunFacts& facts, const Json& outcome) {
  facts.seconds = number_in(outcome, "/this_attempt/seconds");
  facts.particle_steps_per_second = number_in(outcome, "/this_attempt/particle_steps_per_second");
  const auto steps = number_in(outcome, "/this_attempt/steps");
  auto cost = number_in(outcome, "/this_attempt/core_seconds");
  if (!cost && facts.seconds && facts.threads) cost = *facts.seconds * *facts.threads;
  if (!cost || !steps || !facts.step || !(*steps > 0.0)) return;
  facts.core_seconds_scaled = *steps < *facts.step;
  facts.core_seconds = *cost * *facts.step / *steps;
}

void find_digests(RunFacts& facts, const Json& outcome) {
  facts.physics_digest = text_in(outcome, "/digests/physics");
  const Json* series = find(outcome, "/digests/series");
  if (series == nullptr || !series->is_object()) return;
  for (const auto& [name, digest] : series->items()) {
    if (digest.is_string()) facts.series_digests.emplace_back(name, digest.get<std::string>());
  }
}

double total_at(const Series& series, std::size_t sample) {
  double sum = 0.0;
  const std::size_t width = series.columns.size();
  for (std::size_t column = 0; column < width; ++column) {
    sum += series.values[sample * width + column];
  }
  return sum;
}

}  // namespace

RunFacts run_facts(const Json& outcome) {
  RunFacts facts;
  facts.state = text_in(outcome, "/state");
  facts.reason = text_in(outcome, "/reason");
  facts.machine = text_in(outcome, "/machine");
  facts.simd_target = text_in(outcome, "/simd_target");
  facts.build = text_in(outcome, "/build");
  facts.threads = number_in(outcome, "/threads");
  facts.step = number_in(outcome, "/step");
  facts.time = number_in(outcome, "/time");
  facts.particles = number_in(outcome, "/particles");
  facts.wall_particles = number_in(outcome, "/wall_particles");
  // "removed" is the word of builds before.
  const std::string removed = outcome.contains("removed") ? "/removed/" : "/retired/";
  facts.overtopped = number_in(outcome, (removed + "overtopped").c_str());
  facts.leaked = number_in(outcome, (removed + "leaked").c_str());
  facts.excluded = number_in(outcome, (removed + "excluded").c_str());
  facts.max_speed = number_in(outcome, "/extremes/max_speed");
  facts.min_density_ratio = number_in(outcome, "/extremes/min_density_ratio");
  facts.max_density_ratio = number_in(outcome, "/extremes/max_density_ratio");
  facts.min_time_step = number_in(outcome, "/extremes/min_time_step");
  facts.max_neighbours = number_in(outcome, "/extremes/max_neighbours");
  facts.initial_energy = number_in(outcome, "/extremes/initial_energy");
  facts.highest_energy = number_in(outcome, "/extremes/highest_energy");
  facts.energy_scale = number_in(outcome, "/extremes/energy_scale");
  facts.last_energy = number_in(outcome, "/energy");
  facts.passes = passes_in(outcome);
  find_cost(facts, outcome);
  find_digests(facts, outcome);
  return facts;
}

Conservation conservation_of(const std::vector<Series>& series, const RunFacts& facts) {
  Conservation result;
  result.energy_scale = facts.energy_scale;
  result.first_energy = facts.initial_energy;
  result.last_energy = facts.last_energy;
  result.highest_energy = facts.highest_energy;
  if (facts.particles && facts.overtopped && facts.leaked) {
    const double lost = *facts.overtopped + *facts.leaked + facts.excluded.value_or(0.0);
    const double all = *facts.particles + lost;
    if (all > 0.0) result.lost_mass = lost / all;
  }
  for (const Series& one : series) {
    if (one.kind != "energy" || one.size() == 0) continue;
    result.first_energy = total_at(one, 0);
    result.last_energy = total_at(one, one.size() - 1);
    result.highest_energy = result.first_energy;
    for (std::size_t n = 1; n < one.size(); ++n) {
      result.highest_energy = std::max(*result.highest_energy, total_at(one, n));
    }
    break;
  }
  return result;
}

}  // namespace sluice
