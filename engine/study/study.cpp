#include "engine/study/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <stdexcept>

#include "engine/scene/format/former_words.hpp"
#include "engine/scene/format/json_text.hpp"
#include "engine/scene/format/numerics_json.hpp"
#include "engine/scene/format/reader.hpp"
#include "engine/scene/format/schema_writer.hpp"

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

/// A value as names and tables show it: short, whatever it is.
std::string word_of(const json& value) {
  constexpr std::size_t kLongest = 100;
  const bool whole = value.is_string() && value.get_ref<const std::string&>().size() <= kLongest;
  return whole ? value.get<std::string>() : excerpt(value);
}

std::string last_token(const std::string& pointer) {
  return pointer.substr(pointer.rfind('/') + 1);
}

/// Letters, digits, _ . - as names of scenes and folders allow; at most 64 of them.
std::string plain_name(const std::string& text) {
  constexpr std::size_t kLongest = 64;
  std::string name;
  for (const char letter : text) {
    const bool plain = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
                       (letter >= '0' && letter <= '9') || letter == '_' || letter == '-' ||
                       (letter == '.' && !name.empty());
    if (plain) {
      name += letter;
    } else if (!name.empty() && name.back() != '-') {
      name += '-';
    }
  }
  while (!name.empty() && name.back() == '-') name.pop_back();
  return name.substr(0, kLongest);
}

std::vector<std::string> tokens_of(const std::string& pointer) {
  std::vector<std::string> tokens;
  for (json::json_pointer rest(pointer); !rest.empty(); rest.pop_back()) {
    tokens.push_back(rest.back());
  }
  std::ranges::reverse(tokens);
  return tokens;
}

/// The element that a token names. An index never makes an array longer: a short text could ask for
/// more elements than any machine holds.
json& element(json& array, const std::string& token) {
  std::size_t index = 0;
  const char* const end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, index);
  const bool plain = token == "0" || !token.starts_with('0');
  if (error != std::errc() || stop != end || !plain || index >= array.size()) {
    throw std::invalid_argument(
        fmt::format("{} is no index of an array that has {} elements, counted from 0",
                    excerpt(token), array.size()));
  }
  return array[index];
}

/// Puts a value at a pointer, or takes the key away for null. Objects on the way are made; nothing
/// else is. Throws json::exception and std::invalid_argument where the pointer leads nowhere.
void apply(json& scene, const std::string& key, const json& value) {
  const bool leaves_out = value.is_null() && !takes_null(key);
  const std::vector<std::string> tokens = tokens_of(key);
  if (tokens.empty()) throw std::invalid_argument("the whole scene cannot be replaced");
  json* place = &scene;
  for (const std::string& token : tokens) {
    const bool last = &token == &tokens.back();
    if (place->is_null()) *place = json::object();
    if (place->is_array()) {
      if (last && leaves_out) {
        throw std::invalid_argument("only a key of an object can be left out");
      }
      place = &element(*place, token);
    } else if (!place->is_object()) {
      throw std::invalid_argument(
          fmt::format("{} stands in {}, which has no keys", excerpt(token), name_value(*place)));
    } else if (leaves_out && (last || !place->contains(token))) {
      place->erase(token);
      return;
    } else {
      place = &(*place)[token];
    }
  }
  *place = value;
}

/// Makes the runs of a study whose own keys are in order.
class Planner {
 public:
  /// `bases`: the scene of each case.
  Planner(StudyPlan& plan, Problems& problems, std::vector<json> bases, SceneOrigin origin)
      : plan_(plan), problems_(problems), bases_(std::move(bases)), origin_(origin) {}

  void make_all() {
    std::vector<StudyCase> cases = plan_.study.cases;
    if (cases.empty()) cases.push_back({plan_.study.name, nullptr, json::object()});
    for (std::size_t k = 0; k < cases.size(); ++k) {
      json scene = bases_[k];
      StudyRun run;
      run.of_case = cases[k].name;
      run.setup = cases[k].name;
      for (const auto& [key, value] : cases[k].set.items()) {
        change(scene, key, value, at(at(at("/cases", k), "set"), key));
      }
      walk(scene, run, 0);
    }
  }

 private:
  void change(json& scene, const std::string& key, const json& value, const std::string& pointer) {
    try {
      apply(scene, present_pointer(key, kFormerSceneWords), value);
    } catch (const std::exception& error) {
      problems_.add(pointer, fmt::format("cannot set {} in the scene: {}", key, error.what()));
    }
  }

  /// The grid, axis by axis.
  void walk(const json& scene, const StudyRun& run, std::size_t axis) {
    if (full_) return;
    if (axis == plan_.study.vary.size()) return make_members(scene, run);
    const StudyAxis& varied = plan_.study.vary[axis];
    for (std::size_t k = 0; k < varied.values.size(); ++k) {
      const json& value = varied.values[k];
      json changed = scene;
      change(changed, varied.key, value, at(at(at("/vary", axis), "values"), k));
      StudyRun next = run;
      next.setup += fmt::format("-{}-{}", last_token(varied.key), word_of(value));
      next.values.emplace_back(varied.key, word_of(value));
      walk(changed, next, axis + 1);
    }
  }

  void make_members(const json& scene, const StudyRun& run) {
    if (!plan_.study.members) return finish(scene, run, "");
    for (int k = 1; k <= plan_.study.members->count && !full_; ++k) {
      json member = scene;
      member["perturbation"] = {{"amplitude", plan_.study.members->perturbation}, {"seed", k}};
      finish(member, run, fmt::format("-r{}", k));
    }
  }

  void finish(json scene, StudyRun run, const std::string& suffix) {
    run.setup = plain_name(run.setup);
    run.name = plain_name(run.setup + suffix);
    if (!names_.insert(run.name).second) {
      problems_.add("", fmt::format("makes two runs of the name {}: give the cases other names, or "
                                    "name each value once",
                                    run.name));
    }
    scene["name"] = run.name;
    // On one line first: how long it is on many, only a valid scene bounds.
    run.scene_text = scene.dump();
    bytes_ += run.scene_text.size();
    if (bytes_ > kMaxStudyBytes) {
      problems_.add("", fmt::format("its scenes have more than {} MiB together; study less at once",
                                    kMaxStudyBytes >> 20));
      full_ = true;
      return;
    }
    ParseResult parsed = parse_scene(run.scene_text, StabilityCheck::skip, origin_);
    for (const Problem& problem : parsed.problems) {
      problems_.add("", fmt::format("run {}: {}: {}", run.name, problem.pointer, problem.message));
    }
    if (!parsed.scene) {
      refused_bytes_ += run.scene_text.size();
      full_ = refused_bytes_ > kMostRefusedBytes;
      return;
    }
    run.scene = *std::move(parsed.scene);
    run.warnings = std::move(parsed.warnings);
    std::string readable = text_for_folder(scene.dump(2) + "\n");
    if (readable.size() <= kMaxSceneBytes) run.scene_text = std::move(readable);
    plan_.runs.push_back(std::move(run));
  }

  StudyPlan& plan_;
  Problems& problems_;
  std::vector<json> bases_;
  SceneOrigin origin_;
  std::set<std::string> names_;
  /// Once so much of it is wrong, the rest of a study is not looked at.
  static constexpr std::size_t kMostRefusedBytes = std::size_t{1} << 20;

  std::size_t bytes_ = 0;  ///< of all scenes so far
  std::size_t refused_bytes_ = 0;
  bool full_ = false;
};

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
                     SceneOrigin origin) {
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
      if (problems.empty()) Planner(plan, problems, std::move(bases), origin).make_all();
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
