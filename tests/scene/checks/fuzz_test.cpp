#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/scene/checks/parse.hpp"
#include "engine/scene/filling/initial.hpp"
#include "engine/scene/forecast/estimate.hpp"
#include "engine/scene/forecast/plan.hpp"
#include "engine/scene/format/canonical.hpp"
#include "tests/scene/support.hpp"

namespace sluice {
namespace {

using nlohmann::json;

const std::vector<std::string>& seeds() {
  static const std::vector<std::string> texts = [] {
    std::vector<std::string> result;
    for (const char* folder : {"schemas/examples", "tests/scene/fixtures/valid"}) {
      for (const auto& path : testing::json_files(testing::source_dir() / folder)) {
        result.push_back(testing::read_text(path));
      }
    }
    return result;
  }();
  return texts;
}

/// What must hold of any text at all.
void require_sound(const std::string& text) {
  const ParseResult result = parse_scene(text);
  RC_ASSERT(result.scene.has_value() == result.problems.empty());
  for (const Problem& each : result.problems) {
    RC_ASSERT(each.pointer.empty() || each.pointer.front() == '/');
    RC_ASSERT(!each.message.empty());
    (void)json(each.pointer + each.message).dump();  // throws where it is not UTF-8
  }
  if (!result.scene) return;
  const ParseResult again = parse_scene(canonical_text(*result.scene));
  if (!again.scene) RC_FAIL(canonical_text(*result.scene) + "\n" + testing::list(again.problems));
  RC_ASSERT(canonical_text(*again.scene) == canonical_text(*result.scene));
  (void)plan_json(plan(*result.scene));
  const Estimate e = estimate(*result.scene);
  RC_ASSERT(e.time_step > 0 && std::isfinite(e.time_step));
  RC_ASSERT(e.fluid_particles + e.wall_particles <= static_cast<std::uint64_t>(kMaxParticles));
  if (e.fluid_particles + e.wall_particles > 20000) return;
  try {
    const Particles particles = create_particles(*result.scene).state.particles;
    for (const double x : particles.position[0]) {
      RC_ASSERT(std::isfinite(x));
    }
  } catch (const SceneError& error) {
    RC_ASSERT(error.problem().pointer.front() == '/');
  }
}

const json& odd_value() {
  static const std::vector<json> values = [] {
    std::vector<json> all = {json(),
                             json::array(),
                             json::object(),
                             "",
                             "rectangle",
                             "energy",
                             true,
                             -1,
                             0,
                             1,
                             2,
                             1e-320,
                             1e-9,
                             1e6,
                             -1e6,
                             1e300,
                             -1.7976931348623157e308,
                             std::numeric_limits<std::int64_t>::min(),
                             std::numeric_limits<std::uint64_t>::max()};
    all.push_back(json::array({0, 0}));
    all.push_back(json::array({1e-9, 1e6}));
    all.push_back(json::array({json::array({0, 0}), json::array({1, 0}), json::array({0, 1})}));
    return all;
  }();
  return values[*rc::gen::inRange<std::size_t>(0, values.size())];
}

RC_GTEST_PROP(FuzzedScene, WithChangedBytesNeverCrashes, ()) {
  std::string text = seeds()[*rc::gen::inRange<std::size_t>(0, seeds().size())];
  const int edits = *rc::gen::inRange(1, 6);
  for (int i = 0; i < edits && !text.empty(); ++i) {
    const std::size_t at = *rc::gen::inRange<std::size_t>(0, text.size());
    switch (*rc::gen::inRange(0, 4)) {
      case 0:
        text[at] = *rc::gen::arbitrary<char>();
        break;
      case 1:
        text.erase(at, *rc::gen::inRange<std::size_t>(1, 20));
        break;
      case 2:
        text.insert(at, 1, "{}[],:\"\\0123456789-+.eE"[*rc::gen::inRange(0, 23)]);
        break;
      default:
        text.insert(at, text.substr(text.size() / 3, *rc::gen::inRange<std::size_t>(0, 60)));
    }
  }
  require_sound(text);
}

RC_GTEST_PROP(FuzzedScene, WithChangedValuesNeverCrashes, ()) {
  json scene = json::parse(seeds()[*rc::gen::inRange<std::size_t>(0, seeds().size())]);
  const int edits = *rc::gen::inRange(1, 4);
  for (int i = 0; i < edits; ++i) {
    const json flat = scene.flatten();
    if (flat.empty() || !flat.is_object()) break;
    auto chosen = flat.begin();
    std::advance(chosen,
                 *rc::gen::inRange<std::ptrdiff_t>(0, static_cast<std::ptrdiff_t>(flat.size())));
    json::json_pointer pointer(chosen.key());
    // A value, or a whole branch above it.
    if (*rc::gen::inRange(0, 3) == 0 && !pointer.parent_pointer().empty()) {
      pointer = pointer.parent_pointer();
    }
    json& value = scene[pointer];
    const bool scale = value.is_number() && *rc::gen::inRange(0, 2) == 0;
    if (scale) {
      value = value.get<double>() * std::pow(10.0, *rc::gen::inRange(-12, 13));
    } else {
      value = odd_value();
    }
  }
  require_sound(scene.dump());
}

RC_GTEST_PROP(FuzzedScene, OfBareBytesNeverCrashes, (const std::string& text)) {
  require_sound(text);
}

}  // namespace
}  // namespace sluice
