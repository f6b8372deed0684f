#include "engine/report/reference.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sluice/reference_texts.hpp"

#include "engine/space/axes.hpp"

namespace sluice {
namespace {

using nlohmann::json;

std::vector<double> numbers(const json& values, std::size_t expected, const char* what) {
  auto result = values.get<std::vector<double>>();
  if (result.size() != expected) {
    throw std::runtime_error(
        fmt::format("{} has {} numbers, its times {}", what, result.size(), expected));
  }
  return result;
}

/// Where a file has percentiles of a sensor, under its name and _band.
std::optional<PressureBand> read_band(const json& file, const std::string& name,
                                      std::size_t count) {
  const auto found = file.find(name + "_band");
  if (found == file.end()) return std::nullopt;
  if (found->at("t") != file.at("event").at("t")) {
    throw std::runtime_error(fmt::format("{}_band has other times than event", name));
  }
  return PressureBand{numbers(found->at("p2.5"), count, "p2.5 of a band"),
                      numbers(found->at("p97.5"), count, "p97.5 of a band")};
}

std::vector<PressureReference> read_pressures(const json& file, std::size_t count) {
  std::vector<PressureReference> all;
  for (const auto& [name, height] : file.at("geometry_m").at("pressure_z").items()) {
    const json& peak = file.at("peak_statistics").at(name);
    PressureReference sensor;
    sensor.name = name;
    sensor.place = {file.at("geometry_m").at("tank").at(0).get<double>(), height.get<double>()};
    sensor.arrival = file.at("event_arrival").at(name).get<double>();
    sensor.values = numbers(file.at("event").at(name), count, name.c_str());
    sensor.peak = {peak.at("median").get<double>(), peak.at("p2.5").get<double>(),
                   peak.at("p97.5").get<double>()};
    sensor.band = read_band(file, name, count);
    all.push_back(std::move(sensor));
  }
  return all;
}

/// Mean over the tests, whose columns are named SENSOR_TEST.
LevelReference read_level(const json& levels, const std::string& name, double x,
                          std::size_t count) {
  LevelReference level{name, Vec2(x, 0.0), std::vector<double>(count, 0.0)};
  double tests = 0.0;
  for (const auto& [column, values] : levels.items()) {
    if (!column.starts_with(name + "_")) continue;
    const auto one = numbers(values, count, column.c_str());
    for (std::size_t k = 0; k < count; ++k) level.values[k] += one[k];
    tests += 1.0;
  }
  if (tests == 0.0) throw std::runtime_error(fmt::format("no test of level {}", name));
  for (double& value : level.values) value /= tests;
  return level;
}

std::vector<LevelReference> read_levels(const json& file, std::size_t count) {
  std::vector<LevelReference> all;
  for (const auto& [name, x] : file.at("geometry_m").at("level_x").items()) {
    all.push_back(read_level(file.at("levels"), name, x.get<double>(), count));
  }
  return all;
}

/// Points without a value are left out.
Curve read_front(const json& front) {
  Curve curve;
  for (std::size_t k = 0; k < front.at("t").size(); ++k) {
    if (front.at("x").at(k).is_null()) continue;
    curve.time.push_back(front.at("t").at(k).get<double>());
    curve.value.push_back(front.at("x").at(k).get<double>());
  }
  return curve;
}

Window read_window(const json& window) {
  return {window.at(0).get<double>(), window.at(1).get<double>()};
}

ReferenceMeasures read_measures(const json& file) {
  // Ends that are a time of the figures belong to these windows.
  constexpr double kIncluded = 1e-9;
  ReferenceMeasures measures;
  measures.arrival = file.at("arrival").get<double>();
  measures.comparison = read_window(file.at("comparison"));
  measures.impact = read_window(file.at("impact"));
  measures.plateau = read_window(file.at("plateau"));
  measures.plateau.from -= kIncluded;
  measures.plateau.to += kIncluded;
  measures.second_rise.base = read_window(file.at("second_rise").at("base"));
  measures.second_rise.base.from -= kIncluded;
  measures.second_rise.rise = read_window(file.at("second_rise").at("rise"));
  measures.pictures = file.at("pictures").get<std::vector<double>>();
  measures.front_axis = read_window(file.at("front_axis"));
  measures.pressure_axis = read_window(file.at("pressure_axis"));
  return measures;
}

Reference read_reference(const std::string& name, const json& file) {
  const json& geometry = file.at("geometry_m");
  Intervals pressure_times(file.at("event").at("t").get<std::vector<double>>());
  Intervals level_times(file.at("levels").at("t").get<std::vector<double>>());
  const std::size_t pressure_count = pressure_times.size();
  const std::size_t level_count = level_times.size();
  return {name,
          file.at("case").get<std::string>(),
          file.at("citation").get<std::string>(),
          geometry.at("column").at(1).get<double>(),
          geometry.at("column").at(0).get<double>(),
          geometry.at("tank").at(0).get<double>(),
          geometry.at("tank").at(1).get<double>(),
          std::move(pressure_times),
          read_pressures(file, pressure_count),
          std::move(level_times),
          read_levels(file, level_count),
          read_front(file.at("front")),
          file.at("peak_statistics").at("tests").get<int>(),
          read_measures(file.at("measures"))};
}

bool about(double value, double expected) { return std::abs(value / expected - 1.0) <= 0.01; }

}  // namespace

std::string Reference::pressures_text() const {
  if (pressures.empty()) return "no sensor";
  if (pressures.size() == 1) return pressures.front().name;
  return pressures.front().name + "-" + pressures.back().name;
}

Reference parse_reference(const std::string& name, const std::string& text) {
  try {
    return read_reference(name, json::parse(text));
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("reference {}: {}", name, error.what()));
  }
}

const std::vector<Reference>& references() {
  static const std::vector<Reference> all = [] {
    std::vector<Reference> read;
    for (const auto& [name, text] : kReferenceTexts) {
      read.push_back(parse_reference(std::string(name), std::string(text)));
    }
    return read;
  }();
  return all;
}

const Reference& reference_of(std::string_view name) {
  for (const Reference& reference : references()) {
    if (reference.name == name) return reference;
  }
  throw std::logic_error(fmt::format("no built-in reference {}", name));
}

const Reference* matching_reference(const Scene& scene) {
  if (!scene.tank || !scene.scales || !points_straight_down(scene.method.gravity)) return nullptr;
  const double height = scene.scales->height;
  for (const Reference& reference : references()) {
    if (about(scene.tank->width / height, reference.tank_width / reference.height) &&
        about(scene.scales->width / height, reference.width / reference.height)) {
      return &reference;
    }
  }
  return nullptr;
}

}  // namespace sluice
