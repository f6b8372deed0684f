#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/scene/scene.hpp"

namespace sluice {

/// One thing wrong with a scene: where, as a JSON pointer ("" is the whole text), and what was
/// found, what is allowed and what to do. Both are valid UTF-8.
struct Problem {
  std::string pointer;
  std::string message;
};

/// Limits that hold before anything is read or allocated.
inline constexpr std::size_t kMaxSceneBytes = 256 * 1024;
inline constexpr std::size_t kMaxSceneDepth = 16;
inline constexpr double kMaxParticles = 50e6;
inline constexpr std::size_t kMaxProblems = 100;

/// A scene, or why there is none: `scene` holds a value exactly when `problems` is empty.
struct ParseResult {
  std::optional<Scene> scene;
  std::vector<Problem> problems;
};

/// Whether a scene that linear analysis calls unstable is a problem (stability.hpp). The stability
/// suite runs such scenes on purpose.
enum class StabilityCheck { refuse, skip };

/// Reads a scene, fills in every default and checks it. All problems are found at once, as far as
/// they do not follow from one another, and kMaxProblems of them are named. Nothing is thrown for
/// bad text, and nothing is allocated in proportion to what the scene asks for.
[[nodiscard]] ParseResult parse_scene(std::string_view text,
                                      StabilityCheck stability = StabilityCheck::refuse);

/// A scene that reads well but that no particles can be made from.
class SceneError : public std::runtime_error {
 public:
  explicit SceneError(Problem problem)
      : std::runtime_error(problem.pointer + ": " + problem.message),
        problem_(std::move(problem)) {}
  [[nodiscard]] const Problem& problem() const { return problem_; }

 private:
  Problem problem_;
};

}  // namespace sluice
