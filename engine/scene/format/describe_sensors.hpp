#pragma once

#include <optional>

#include "engine/scene/format/describe_ranges.hpp"
#include "engine/scene/model/scene.hpp"
#include "engine/scene/model/vocabulary.hpp"

namespace sluice {

// Part of the scene format (describe.hpp): sensors.

template <class Archive>
void describe_position(Archive& a, Sensor& sensor) {
  a.vector("position", sensor.position,
           {.about = "where it sits", .unit = "m", .range = kCoordinate, .need = Need::required});
}

template <class Archive>
void describe_smoothing_length(Archive& a, Sensor& sensor) {
  std::optional<double> given;
  if (sensor.smoothing_length > 0) given = sensor.smoothing_length;
  a.number("smoothing_length", given,
           {.about = "h of the sum of eq. 11",
            .unit = "m",
            .range = kLength,
            .otherwise = "the scene's smoothing length"});
  sensor.smoothing_length = given.value_or(0.0);
}

template <class Archive>
void describe_air_pressure(Archive& a, Sensor& sensor) {
  a.number("air_pressure", sensor.air_pressure,
           {.about = "pressure of the air in what neither fluid nor wall fills around the sensor, "
                     "above that of a free surface, so mostly 0; the value is then the mean over "
                     "fluid and air, which its face feels",
            .unit = "Pa",
            .range = from(-1e12, 1e12),
            .otherwise = "the mean over the fluid alone, eq. 11"});
}

/// Where on the floor a surface is sought; x is needed where `need` says so.
template <class Archive>
void describe_foot(Archive& a, Sensor& sensor, Need need) {
  a.number("x", sensor.position[0],
           {.about = need == Need::required ? "where the surface is sought"
                                            : "where the surface is sought: the left wall",
            .unit = "m",
            .range = kCoordinate,
            .need = need});
  if (sensor.position.size() < 3) return;
  // Not needed in the plane, so that a schema of all scenes does not ask for it.
  a.number("z", sensor.position[2],
           {.about = "where the surface is sought; in space only",
            .unit = "m",
            .range = kCoordinate,
            .need = Archive::kOfAllScenes ? Need::optional : need});
}

template <class Archive>
void describe_kind(Archive& a, Sensor& sensor) {
  switch (sensor.kind) {
    case SensorKind::pressure:
      describe_position(a, sensor);
      describe_smoothing_length(a, sensor);
      describe_air_pressure(a, sensor);
      return;
    case SensorKind::arrival:
      describe_position(a, sensor);
      return;
    case SensorKind::surface_height:
      describe_foot(a, sensor, Need::required);
      return;
    case SensorKind::column_height:
      describe_foot(a, sensor, Need::optional);
      return;
    case SensorKind::surge_front:
    case SensorKind::energy:
      return;
  }
}

template <class Archive>
void describe(Archive& a, Sensor& sensor) {
  a.choice("kind", kSensorWords, sensor.kind, "what it measures",
           [&](auto& branch, SensorKind kind) {
             sensor.kind = kind;
             branch.fit(sensor.position);
             branch.text("name", sensor.name,
                         {.about = "name of its series, unique in the scene",
                          .min = 1,
                          .max = 32,
                          .need = Need::required});
             describe_kind(branch, sensor);
             branch.number("interval", sensor.interval,
                           {.about = "time from one sample to the next; 0: every step",
                            .unit = "s",
                            .range = from(0, 1e6),
                            .need = Need::required});
           });
}

}  // namespace sluice
