#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>
#include <string_view>

#include "engine/scene/vocabulary.hpp"
#include "engine/study/report.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::string_view kNone = "-";

std::string number(const std::optional<double>& value, int decimals = 3) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : std::string(kNone);
}

std::string scheme_text(const Scene& scene) {
  const Method& method = scene.method;
  std::string text =
      fmt::format("{}, precision {}, C = {:g}", word_for(kIntegratorWords, method.integrator),
                  word_for(kPrecisionWords, method.precision), method.courant);
  if (method.diffusion) {
    text += fmt::format(", diffusion {} delta {:g}",
                        word_for(kDiffusionWords, method.diffusion->kind), method.diffusion->delta);
  }
  if (method.viscosity) text += fmt::format(", viscosity alpha {:g}", method.viscosity->alpha);
  if (method.wall_friction) {
    text += fmt::format(", wall friction alpha {:g}", method.wall_friction->alpha);
  } else if (scene.tank || !scene.obstacles.empty()) {
    text += ", free slip";
  }
  if (method.wall_pressure == WallPressure::clamped) text += ", wall pressure clamped";
  if (method.reinitialisation) {
    text += fmt::format(", reinitialisation every {} steps", method.reinitialisation->interval);
  }
  return text;
}

std::string head_text(const Report& report) {
  const Method& method = report.scene.method;
  return fmt::format("{}\nspacing {:g} mm, h = {:g} mm, c = {:.4g} m/s\n{}\n\n", report.scene.name,
                     method.spacing * 1e3, method.smoothing_length * 1e3, method.sound_speed,
                     scheme_text(report.scene));
}

/// One table line: a label, then a cell per sensor.
std::string line(std::string_view label, const std::vector<std::string>& cells) {
  std::string text = fmt::format("{:<38}", label);
  for (const std::string& cell : cells) text += fmt::format("{:>11}", cell);
  return text + "\n";
}

using Cell = std::function<std::string(const PressureEvidence&)>;
std::string line(std::string_view label, const std::vector<PressureEvidence>& all,
                 const Cell& cell) {
  std::vector<std::string> cells;
  for (const PressureEvidence& one : all) cells.push_back(cell(one));
  return line(label, cells);
}

std::optional<double> peak_time(const std::optional<Peak>& peak) {
  return peak ? std::optional(peak->time) : std::nullopt;
}
std::optional<double> peak_value(const std::optional<Peak>& peak) {
  return peak ? std::optional(peak->value) : std::nullopt;
}
std::optional<double> rise_time(const std::optional<Rise>& rise) {
  return rise ? std::optional(rise->time) : std::nullopt;
}
std::optional<double> rise_height(const std::optional<Rise>& rise) {
  return rise ? std::optional(rise->height) : std::nullopt;
}

std::string percent(const std::optional<double>& share) {
  return share ? fmt::format("{:.0f} %", 100.0 * *share) : std::string(kNone);
}

/// A measure of the simulation and, below it, of the experiment.
std::string two_lines(std::string_view label, const std::vector<PressureEvidence>& all,
                      const std::function<std::optional<double>(const PressureMeasures&)>& get) {
  return line(fmt::format("{:<26}simulation", label), all,
              [&](const auto& one) { return number(get(one.simulation)); }) +
         line(fmt::format("{:<26}experiment", ""), all,
              [&](const auto& one) { return number(get(one.experiment)); });
}

std::string pressures_text(const Evidence& evidence) {
  const auto& all = evidence.pressures;
  std::string text =
      line("pressure P = p/(rho0 g h0) at", all, [](const auto& one) { return one.sensor; });
  text += line("  height above the floor, mm", all,
               [](const auto& one) { return fmt::format("{:g}", one.height * 1e3); });
  text += line("  h of the sensor, mm", all,
               [](const auto& one) { return fmt::format("{:g}", one.smoothing_length * 1e3); });
  text += line("relative L2", all, [](const auto& one) { return number(one.relative_l2); });
  text += two_lines("arrival, T", all, [](const auto& m) { return m.arrival; });
  text += line("first peak, P             simulation", all,
               [](const auto& one) { return number(peak_value(one.simulation.peak)); });
  text += line("                          100 tests", all, [](const auto& one) {
    return fmt::format("{:.2f}-{:.2f}", one.peak_statistics.low, one.peak_statistics.high);
  });
  text += line("  place in that band (0-100 %)", all,
               [](const auto& one) { return percent(one.place_in_band()); });
  text +=
      line("  at T", all, [](const auto& one) { return number(peak_time(one.simulation.peak)); });
  text += two_lines("impulse, P T", all, [](const auto& m) { return m.impulse; });
  text += two_lines("plateau (T 3.5-5), P", all, [](const auto& m) { return m.plateau; });
  text += two_lines("second rise, T", all, [](const auto& m) { return rise_time(m.second_rise); });
  text +=
      two_lines("second rise, P", all, [](const auto& m) { return rise_height(m.second_rise); });
  return text + fmt::format("mean relative L2 of P1-P4: {}\n\n", number(evidence.mean_relative_l2));
}

std::string levels_text(const Evidence& evidence) {
  std::string text;
  if (!evidence.levels.empty()) {
    std::vector<std::string> names, cells;
    for (const LevelEvidence& one : evidence.levels) {
      names.push_back(one.sensor);
      cells.push_back(number(one.rms_difference));
    }
    text += line("surface level h/h0 at", names) + line("rms difference", cells);
  }
  if (evidence.front) {
    text += fmt::format("surge front {}: rms difference {} h0; {} T later than measured\n",
                        evidence.front->sensor, number(evidence.front->rms_difference),
                        number(evidence.front->delay));
  }
  return text.empty() ? text : text + "\n";
}

std::string evidence_text(const Evidence& evidence) {
  const Reference& reference = *evidence.reference;
  std::string text = fmt::format(
      "experiment: {}\n  {}\nT = t sqrt(g/h0), one T is {:.4f} s; pressures: time filter tau = "
      "{:g} ms, "
      "dry counts as P = 0,\nshifted by {} T to arrive at the first sensor as measured; averages "
      "over "
      "the figure's intervals,\ncompared over {:g} < T < {:g}\n\n",
      reference.title, reference.citation, evidence.time_unit, evidence.tau * 1e3,
      evidence.shift ? fmt::format("{:+.3f}", *evidence.shift) : std::string(kNone),
      kComparisonWindow.from, kComparisonWindow.to);
  if (!evidence.pressures.empty()) text += pressures_text(evidence);
  return text + levels_text(evidence);
}

std::string sensors_text(const Report& report) {
  std::string text =
      fmt::format("{:<16}{:<16}{:<12}{:>6}{:>9}{:>12}{:>12}{:>12}\n", "sensor", "kind", "column",
                  "unit", "samples", "wet from, s", "highest", "at, s");
  for (const SensorSummary& one : report.sensors) {
    text += fmt::format("{:<16}{:<16}{:<12}{:>6}{:>9}{:>12}{:>12}{:>12}\n", one.name, one.kind,
                        one.column, one.unit, one.samples, number(one.first_wet, 4),
                        one.highest ? fmt::format("{:.5g}", *one.highest) : std::string(kNone),
                        number(one.highest_at, 4));
  }
  return text + fmt::format("(pressures filtered with tau = {:g} ms)\n\n", report.tau * 1e3);
}

/// A member of an outcome that may have been written by another version.
double number_in(const Json& object, const char* pointer) {
  const Json::json_pointer place(pointer);
  if (!object.contains(place) || !object.at(place).is_number()) return std::nan("");
  return object.at(place).get<double>();
}

std::string word_in(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "?";
}

std::string passes_text(const Json& outcome) {
  std::string text;
  const Json::json_pointer place("/this_attempt/passes");
  if (!outcome.contains(place) || !outcome.at(place).is_array()) return text;
  for (const Json& pass : outcome.at(place)) {
    if (!pass.is_object()) continue;
    text += fmt::format("  {:<20}{:>10.3f} s{:>7.1f} %\n", word_in(pass, "name"),
                        number_in(pass, "/seconds"), 100.0 * number_in(pass, "/share"));
  }
  return text;
}

std::string outcome_text(const Json& outcome) {
  if (outcome.is_null()) return "the run has not ended yet: no outcome.json\n";
  return fmt::format(
             "{} at step {:.0f}, t = {:.6g} s; {:.0f} fluid particles: {:.0f} overtopped, {:.0f} "
             "leaked\n{:.2f} million fluid-particle steps per second in the last attempt ({:.2f} "
             "s, "
             "{:.0f} threads, {})\n",
             word_in(outcome, "state"), number_in(outcome, "/step"), number_in(outcome, "/time"),
             number_in(outcome, "/particles"), number_in(outcome, "/retired/overtopped"),
             number_in(outcome, "/retired/leaked"),
             number_in(outcome, "/this_attempt/particle_steps_per_second") * 1e-6,
             number_in(outcome, "/this_attempt/seconds"), number_in(outcome, "/threads"),
             word_in(outcome, "simd_target")) +
         passes_text(outcome);
}

}  // namespace

std::string report_text(const Report& report) {
  std::string text = head_text(report);
  text += report.evidence ? evidence_text(*report.evidence)
                          : std::string("no experiment in the program matches this scene\n\n");
  return text + sensors_text(report) + outcome_text(report.outcome);
}

}  // namespace sluice
