#include "engine/study/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "engine/scene/format/former_words.hpp"
#include "engine/scene/format/json_text.hpp"
#include "engine/scene/format/reader.hpp"
#include "engine/scene/format/schema_writer.hpp"
#include "engine/study/study_planner.hpp"

namespace sluice {

using nlohmann::json;

namespace {

constexpr FormerWord kFormerStudyWords[] = {
    {"/repeats/jitter", "/repeats/perturbation"},
    {"/repeats", "/members"},
};

}  // namespace

template <class Archive>
void describe(Archive& a, StudyCase& one) {
  a.text("name", one.name,
         {.about = "name of the case", .min = 1, .max = 32, .need = Need::required});
  a.any("scene", one.scene,
        {.about = "a base of its own: a scene, or the name of a scene's file, from the study's "
                  "folder",
         .otherwise = "the study's"},
        {"object", "string"});
  a.any("set", one.set,
        {.about = "what it changes in its base scene: JSON pointers and their new values, such as "
                  "\"/numerics/courant\": 1; null leaves a key out, or a term that the scheme has"},
        {"object"});
}

template <class Archive>
void describe(Archive& a, StudyAxis& axis) {
  a.text("key", axis.key,
         {.about = "JSON pointer of a key of the scene, such as /resolution/spacing",
          .characters = Characters::sentence,
          .min = 2,
          .max = 200,
          .need = Need::required});
  a.any("values", axis.values, {.about = "the values it takes", .need = Need::required}, {"array"});
}

template <class Archive>
void describe(Archive& a, StudyMembers& members) {
  a.integer("count", members.count,
            {.about = "runs of each set-up", .range = from(1, 100), .need = Need::required});
  a.number("perturbation", members.perturbation,
           {.about = "largest displacement of a particle at the start, in spacings; each run has "
                     "its own seed",
            .range = above(0, 0.5)});
}

template <class Archive>
void describe(Archive& a, Study& study) {
  a.text("name", study.name,
         {.about = "name of the study", .min = 1, .max = 32, .need = Need::required});
  a.text("description", study.description,
         {.about = "what it is for", .characters = Characters::sentence, .max = 2000});
  a.any("scene", study.scene,
        {.about = "the base: a scene, or the name of a scene's file, from the study's folder",
         .need = Need::required},
        {"object", "string"});
  a.list("cases", study.cases, {.about = "named changes of the base; none: the base", .max = 200});
  a.list(
      "vary", study.vary,
      {.about = "keys that every case is run with each value of; several make a grid", .max = 6});
  a.section("members", study.members,
            {.about = "an ensemble of each set-up", .otherwise = "one run of each"});
  a.integer("threads", study.threads, {.about = "threads of each run", .range = from(1, 1024)});
  a.numbers("targets", study.targets,
            {.about = "errors for which the cheapest set-up is sought", .max = 20},
            {.about = "relative error", .range = above(0, 1e6)});
}

namespace {

void check_values(const Study& study, std::size_t most, Problems& problems) {
  for (std::size_t k = 0; k < study.vary.size(); ++k) {
    if (study.vary[k].values.empty()) {
      problems.add(at(at("/vary", k), "values"), "is empty; must hold at least one value");
    }
  }
  // Before any run is made: a short text can ask for more than any machine holds.
  double runs = static_cast<double>(std::max<std::size_t>(study.cases.size(), 1));
  for (const StudyAxis& axis : study.vary) runs *= static_cast<double>(axis.values.size());
  if (study.members) runs *= study.members->count;
  if (runs > static_cast<double>(most)) {
    problems.add("",
                 fmt::format("makes {:.6g} runs, more than {}; study less at once", runs, most));
  }
}

/// What a case or an axis sets has present names, or gets them: so has its base.
json with_present_words(json scene, const std::string& pointer, const std::string& where,
                        Problems& problems) {
  Problems inner;
  use_present_words(scene, kFormerSceneWords, inner);
  for (const Problem& problem : inner.take()) {
    problems.add(pointer, fmt::format("{}{}: {}", where, problem.pointer, problem.message));
  }
  return scene;
}

/// A base scene as JSON, which stands in the study at `pointer` or names a file there.
std::optional<json> base_scene(const json& given, const std::string& pointer,
                               const SceneLoader& load, Problems& problems) {
  if (given.is_object()) return with_present_words(given, pointer, "", problems);
  const std::string name = given.get<std::string>();
  if (!load) {
    problems.add(pointer, "names a file; must be the scene itself here");
    return std::nullopt;
  }
  try {
    Problems inner;
    auto scene = read_json(load(name), inner);
    for (const Problem& problem : inner.take()) {
      problems.add(pointer, fmt::format("{}: {}: {}", name, problem.pointer, problem.message));
    }
    if (scene && scene->is_object()) {
      return with_present_words(*std::move(scene), pointer, name + ": ", problems);
    }
    problems.add(pointer, fmt::format("{} holds no scene", name));
  } catch (const std::runtime_error& error) {
    problems.add(pointer, error.what());
  }
  return std::nullopt;
}

/// The base of each case, or of the study where it has none; incomplete when there are problems.
std::vector<json> base_scenes(const Study& study, const SceneLoader& load, Problems& problems) {
  std::vector<json> bases;
  const auto common = base_scene(study.scene, "/scene", load, problems);
  if (study.cases.empty() && common) bases.push_back(*common);
  for (std::size_t k = 0; k < study.cases.size(); ++k) {
    const json& own = study.cases[k].scene;
    const auto base =
        own.is_null() ? common : base_scene(own, at(at("/cases", k), "scene"), load, problems);
    if (base) bases.push_back(*base);
  }
  return bases;
}

}  // namespace

StudyPlan plan_study(std::string_view text, const SceneLoader& load, std::size_t most,
                     SceneOrigin origin, const SceneParts& parts) {
  StudyPlan plan;
  Problems problems;
  std::vector<FormerWord> former;
  if (auto document = read_json(text, problems)) {
    former = use_present_words(*document, kFormerStudyWords, problems);
    Reader reader(*document, "", problems);
    describe(reader, plan.study);
    reader.finish();
    check_values(plan.study, most, problems);
    if (problems.empty()) {
      std::vector<json> bases = base_scenes(plan.study, load, problems);
      if (problems.empty()) make_runs(plan, std::move(bases), {origin, parts}, problems);
    }
  }
  plan.problems = at_written_places(problems.take(), former);
  if (!plan.problems.empty()) plan.runs.clear();
  return plan;
}

std::string study_schema_text() {
  Study fresh;
  SchemaWriter writer;
  describe(writer, fresh);
  SchemaWriter::json schema = {
      {"$schema", "https://json-schema.org/draft/2020-12/schema"},
      {"$id", "urn:sluice:study:1"},
      {"title", "Sluice study"},
      {"description",
       "Runs of one scene with some of its keys changed, compared by their error and "
       "their cost."}};
  schema.update(writer.schema());
  add_former_words(schema, kFormerStudyWords);
  return schema.dump(2) + "\n";
}

}  // namespace sluice
