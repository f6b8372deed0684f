#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/scene/checks/parse.hpp"
#include "engine/scene/model/scene.hpp"

namespace sluice {

inline constexpr std::size_t kMaxStudyRuns = 1000;
inline constexpr std::size_t kMaxStudyBytes = std::size_t{8} << 20;  ///< of its scenes together

/// A named way to change the base scene: values by JSON pointer, null leaves the key out; a
/// term of the method is then left out too where the scheme has it.
struct StudyCase {
  std::string name;
  nlohmann::json scene;  ///< its own base in place of the study's; null: the study's
  nlohmann::json set = nlohmann::json::object();
};

/// One key and the values it takes: every case runs with each of them.
struct StudyAxis {
  std::string key;  ///< JSON pointer into the scene
  nlohmann::json values = nlohmann::json::array();
};

/// Several runs of each set-up that differ by a displacement of the particles at the start.
struct StudyMembers {
  int count = 1;
  double perturbation = 1e-4;  ///< amplitude, in spacings
};

/// A study as it is written.
struct Study {
  std::string name;
  std::string description;
  nlohmann::json scene;  ///< the base: a scene, or the name of its file beside the study's
  std::vector<StudyCase> cases;
  std::vector<StudyAxis> vary;
  std::optional<StudyMembers> members;
  int threads = 1;              ///< of each run
  std::vector<double> targets;  ///< errors that the cheapest set-up is sought for
};

/// One run of a study: an ordinary job.
struct StudyRun {
  std::string name;   ///< of its folder: letters, digits, _ . -
  std::string setup;  ///< the same for all members
  std::string of_case;
  std::vector<std::pair<std::string, std::string>> values;  ///< varied key and value, as texts
  std::string scene_text;
  Scene scene;
  std::vector<Problem> warnings;  ///< of its scene
};

/// A study with its runs, or why there is none: exactly one of `runs` and `problems` is not empty.
struct StudyPlan {
  Study study;
  std::vector<StudyRun> runs;
  std::vector<Problem> problems;  ///< pointers into the study; a scene's own follow the run's name
};

/// Gives the text of a scene's file named in a study. Throws std::runtime_error with the reason.
using SceneLoader = std::function<std::string(const std::string& name)>;

/// Reads a study and makes every run's scene. Nothing is thrown for bad text. Scenes that are
/// predicted to be unstable are accepted: finding out is what a study is for. `origin` is that of
/// the study: user's or one that was taken before. `load` may be empty:
/// then the scene must stand in the study itself. `parts` has the files that scenes name. A study
/// of more than `most` runs is refused before any is made, one of more than kMaxStudyBytes as soon
/// as that shows: what it takes of memory and time is bounded by these two.
[[nodiscard]] StudyPlan plan_study(std::string_view text, const SceneLoader& load,
                                   std::size_t most = kMaxStudyRuns,
                                   SceneOrigin origin = SceneOrigin::user,
                                   const SceneParts& parts = no_parts);

/// The JSON Schema 2020-12 of a study: schemas/study.schema.json is this text.
[[nodiscard]] std::string study_schema_text();

}  // namespace sluice
