#pragma once

#include "engine/scene/format/describe_ranges.hpp"
#include "engine/scene/model/scene.hpp"
#include "engine/scene/model/vocabulary.hpp"

namespace sluice {

// Part of the scene format (describe.hpp): what sensors should have measured.

template <class Archive>
void describe(Archive& a, ReferenceCurve& curve) {
  constexpr std::size_t kMost = kMaxReferencePoints;
  constexpr NumberSpec kValue{.about = "number", .range = from(-1e12, 1e12)};
  a.text("sensor", curve.sensor,
         {.about = "name of the sensor that should measure this; of its columns the first",
          .min = 1,
          .max = 32,
          .need = Need::required});
  a.numbers("time", curve.time,
            {.about = "times, increasing; each value stands for the time up to half way to its "
                      "neighbours",
             .min = 2,
             .max = kMost,
             .need = Need::required},
            kValue);
  a.numbers("value", curve.value,
            {.about = "one value per time", .min = 2, .max = kMost, .need = Need::required},
            kValue);
  a.numbers("low", curve.low,
            {.about = "lower edge of a band around the values, one number per time", .max = kMost},
            kValue);
  a.numbers("high", curve.high, {.about = "upper edge of that band", .max = kMost}, kValue);
}

template <class Archive>
void describe_reference_series(Archive& a, SceneReference& reference) {
  a.text("title", reference.title,
         {.about = "what it is, for headings",
          .characters = Characters::sentence,
          .min = 1,
          .max = 200,
          .need = Need::required});
  a.text("citation", reference.citation,
         {.about = "where it is from", .characters = Characters::sentence, .max = 500});
  a.word("units", kReferenceUnitWords, reference.units, {.about = "units of times and values"});
  a.list("curves", reference.curves,
         {.about = "what sensors should have measured",
          .min = 1,
          .max = kMaxReferenceCurves,
          .need = Need::required});
}

template <class Archive>
void describe(Archive& a, SceneReference& reference) {
  a.choice("kind", kReferenceWords, reference.kind, "where its figures are",
           [&](auto& branch, ReferenceKind kind) {
             reference.kind = kind;
             if (kind == ReferenceKind::experiment) {
               branch.word("name", kExperimentWords, reference.experiment, {.about = "which one"});
             }
             if (kind == ReferenceKind::series) describe_reference_series(branch, reference);
           });
}

}  // namespace sluice
