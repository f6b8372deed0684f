#include "engine/scene/forecast/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "engine/scene/filling/initial.hpp"
#include "engine/scene/forecast/workload.hpp"
#include "engine/scene/format/json_text.hpp"
#include "engine/scene/format/numerics_json.hpp"
#include "engine/scene/format/term_line.hpp"
#include "engine/scene/model/vocabulary.hpp"
#include "engine/sph/method/particles.hpp"

namespace sluice {
namespace {

/// Whose a key of `numerics` is, written with dots, and its value; or why it has none.
std::string source_of(std::string_view key, bool has_value, const NumericsSource& source) {
  std::string pointer = fmt::format("/{}", key);
  std::replace(pointer.begin(), pointer.end(), '.', '/');
  if (source.names(pointer)) {
    return fmt::format("{} numerics.{}", has_value ? "key" : "null at", key);
  }
  if (!source.scheme) return fmt::format("{}key numerics.{}", has_value ? "" : "no ", key);
  const std::string_view scheme = word_for(kSchemeWords, *source.scheme);
  const nlohmann::json whole = numerics_json(method_of(source.scheme));
  const auto of_scheme = whole.find(key.substr(0, key.find('.')));
  const bool replaced = !has_value && of_scheme != whole.end() && !of_scheme->is_null();
  return replaced ? fmt::format("scheme {}, but excluded by another key", scheme)
                  : fmt::format("scheme {}", scheme);
}

/// Two lists, one of which an item goes to with its reason.
struct Lists {
  std::vector<PlanItem>& in;
  std::vector<PlanItem>& out;

  void always(std::string_view name, std::string_view description) const {
    in.push_back({std::string(name), std::string(description), "always"});
  }
  void run(std::string_view name, std::string_view description, std::string reason) const {
    in.push_back({std::string(name), std::string(description), std::move(reason)});
  }
  void leave_out(std::string_view name, std::string_view description, std::string reason) const {
    out.push_back({std::string(name), std::string(description), std::move(reason)});
  }
  void either(bool asked, std::string_view name, std::string_view description,
              std::string_view key) const {
    if (asked) {
      run(name, description, fmt::format("key {}", key));
    } else {
      leave_out(name, description, fmt::format("no key {}", key));
    }
  }
  /// A term of the method.
  template <class Term>
  void term(const Scene& scene) const {
    constexpr TermText text = Term::kText;
    const auto& term = scene.method.term<Term>();
    const std::string line = term ? filled_in(text.plan, *term) : std::string(text.plan_without);
    (term ? in : out)
        .push_back(
            {std::string(text.key), line, source_of(text.key, term.has_value(), scene.numerics)});
  }
};

bool has_walls(const Scene& scene) { return scene.tank || !scene.obstacles.empty(); }

void plan_walls(const Scene& scene, const Lists& passes) {
  const std::string about = fmt::format("wall pressure of eq. 9, {}",
                                        word_for(kWallPressureWords, scene.method.wall_pressure));
  constexpr std::string_view kGate = "dummy particles of the lifted gate";
  if (!has_walls(scene)) {
    passes.leave_out("wall_pressure", about, "no key tank and no key obstacles");
  } else {
    passes.run("wall_pressure", about, scene.tank ? "key tank" : "key obstacles");
  }
  for_each_term(RateTerms{}, [&]<class Term>() {
    if constexpr (Term::kSummation.over_walls_alone()) {
      if (has_walls(scene)) return passes.term<Term>(scene);
      passes.leave_out(Term::kText.key, Term::kText.plan_without, "no walls to rub on");
    }
  });
  passes.either(scene.gate.has_value(), "gate", kGate, "gate");
}

// Larger scenes are not filled to plan them.
constexpr double kFilledToPlan = 5e6;

/// A scene that cannot be filled has its problem told elsewhere.
std::optional<StartPlan> start_of(const Scene& scene) {
  if (count_fluid_cells(scene) > kFilledToPlan) return std::nullopt;
  try {
    return start_plan(scene);
  } catch (const SceneError&) {
    return std::nullopt;
  }
}

void plan_start(const Scene& scene, const Lists& passes) {
  const std::string about = fmt::format(
      "once, before t = 0: particles moved to fit their container, at most {} iterations, each "
      "about as long as one or two steps of one core",
      kMaxPackingIterations);
  const std::optional<StartPlan> start = start_of(scene);
  if (start && start->packed) {
    passes.run("packing", about, start->reason);
  } else {
    passes.leave_out("packing", about,
                     start ? "the lattice fits" : "not looked at: the run finds out");
  }
}

void plan_passes(const Scene& scene, const Lists& passes) {
  const Method& m = scene.method;
  plan_start(scene, passes);
  passes.always("sort", "particles into rows of cells, every so many steps or when one has left");
  passes.always("continuity", "density rate of eq. 4");
  passes.always("momentum", "pressure part of eq. 5");
  for_each_term(RateTerms{}, [&]<class Term>() {
    if constexpr (!Term::kSummation.over_walls_alone()) passes.term<Term>(scene);
  });
  plan_walls(scene, passes);
  passes.either(!m.gravity.isZero(0.0), "gravity", "body acceleration of eq. 5", "gravity");
  passes.run("update", "time step of eq. 18 and integration",
             fmt::format("numerics.integrator {}", word_for(kIntegratorWords, m.integrator)));
  for_each_term(Corrections{}, [&]<class Term>() { passes.term<Term>(scene); });
  passes.either(!scene.sensors.empty(), "sample", fmt::format("{} sensors", scene.sensors.size()),
                "sensors");
}

void plan_fields(const Scene& scene, const Lists& fields) {
  const Integrator integrator = scene.method.integrator;
  for (const Field& field : fields_in(static_cast<std::size_t>(scene.dimensions()))) {
    const std::string about = fmt::format("{}, {}", field.description, field.unit);
    if (field.carried_by == CarriedBy::every_scheme) {
      fields.always(field.name, about);
      continue;
    }
    const std::string reason =
        fmt::format("numerics.integrator {}", word_for(kIntegratorWords, integrator));
    if (carries(integrator, field)) {
      fields.run(field.name, about, reason);
    } else {
      fields.leave_out(field.name, about, reason + " does not carry it");
    }
  }
}

void plan_files(const Scene& scene, const Lists& files) {
  files.always("checkpoints", "all that is needed to resume");
  files.either(!scene.sensors.empty(), "series", "samples of the sensors", "sensors");
  files.either(scene.frames.has_value(), "frames", "snapshots of all particles", "output.frames");
  files.either(scene.scales.has_value(), "dimensionless results", "eqs. 19-22, when read",
               "scales");
}

void plan_numerics(const Scene& scene, std::vector<PlanItem>& items) {
  const nlohmann::json flat = numerics_json(scene.method).flatten();
  for (const auto& [pointer, value] : flat.items()) {
    std::string key = pointer.substr(1);
    std::replace(key.begin(), key.end(), '/', '.');
    const std::string text = value.is_null()     ? "none"
                             : value.is_string() ? value.get<std::string>()
                                                 : write_json(value);
    items.push_back({key, text, source_of(key, !value.is_null(), scene.numerics)});
  }
}

nlohmann::ordered_json to_json(const std::vector<PlanItem>& items) {
  auto all = nlohmann::ordered_json::array();
  for (const PlanItem& item : items) {
    all.push_back(
        {{"name", item.name}, {"description", item.description}, {"reason", item.reason}});
  }
  return all;
}

}  // namespace

Plan plan(const Scene& scene) {
  Plan p;
  plan_numerics(scene, p.numerics);
  plan_passes(scene, {p.passes, p.passes_left_out});
  plan_fields(scene, {p.fields, p.fields_left_out});
  plan_files(scene, {p.files, p.files_left_out});
  return p;
}

std::string plan_json(const Plan& p) {
  return nlohmann::ordered_json{{"numerics", to_json(p.numerics)},
                                {"passes", to_json(p.passes)},
                                {"passes_left_out", to_json(p.passes_left_out)},
                                {"fields", to_json(p.fields)},
                                {"fields_left_out", to_json(p.fields_left_out)},
                                {"files", to_json(p.files)},
                                {"files_left_out", to_json(p.files_left_out)}}
      .dump();
}

}  // namespace sluice
