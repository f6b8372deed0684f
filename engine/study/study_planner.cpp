#include "engine/study/study_planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <stdexcept>
#include <string>

#include "engine/scene/format/former_words.hpp"
#include "engine/scene/format/json_text.hpp"
#include "engine/scene/format/numerics_json.hpp"

namespace sluice {
namespace {

using nlohmann::json;

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

class Planner {
 public:
  /// `bases`: the scene of each case.
  Planner(StudyPlan& plan, Problems& problems, std::vector<json> bases, const SceneSource& source)
      : plan_(plan), problems_(problems), bases_(std::move(bases)), source_(source) {}

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
    ParseResult parsed =
        parse_scene(run.scene_text, StabilityCheck::skip, source_.origin, source_.parts);
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
    std::string readable = text_for_folder(scene.dump(2) + "\n", source_.parts);
    if (readable.size() <= kMaxSceneBytes) run.scene_text = std::move(readable);
    plan_.runs.push_back(std::move(run));
  }

  StudyPlan& plan_;
  Problems& problems_;
  std::vector<json> bases_;
  SceneSource source_;
  std::set<std::string> names_;
  /// Once so much of it is wrong, the rest of a study is not looked at.
  static constexpr std::size_t kMostRefusedBytes = std::size_t{1} << 20;

  std::size_t bytes_ = 0;  ///< of all scenes so far
  std::size_t refused_bytes_ = 0;
  bool full_ = false;
};

}  // namespace

void make_runs(StudyPlan& plan, std::vector<json> bases, const SceneSource& source,
               Problems& problems) {
  Planner(plan, problems, std::move(bases), source).make_all();
}

}  // namespace sluice
