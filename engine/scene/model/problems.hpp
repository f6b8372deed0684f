#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sluice {

/// One thing wrong with a scene: where, as a JSON pointer ("" is the whole text), and what was
/// found, what is allowed and what to do. Both are valid UTF-8.
struct Problem {
  std::string pointer;
  std::string message;
};

/// Limits that hold before anything is read or allocated.
inline constexpr std::size_t kMaxSceneBytes = 256 * 1024;
inline constexpr std::size_t kMaxMeshBytes = 16 * 1024 * 1024;  ///< of one file
inline constexpr std::size_t kMaxMeshTriangles = 200'000;       ///< of all meshes of a scene
inline constexpr std::size_t kMaxSceneDepth = 16;
inline constexpr double kMaxParticles = 50e6;
inline constexpr std::size_t kMaxProblems = 100;

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

/// Collects problems up to kMaxProblems and counts the rest.
class Problems {
 public:
  void add(std::string pointer, std::string message);

  /// Whether nothing at or below these pointers was found wrong: what compares two keys asks first,
  /// so that one mistake is not reported twice.
  [[nodiscard]] bool clean(std::initializer_list<std::string_view> pointers) const;
  [[nodiscard]] bool empty() const { return problems_.empty(); }

  /// All of them, with a last one that says how many more there were.
  [[nodiscard]] std::vector<Problem> take();

 private:
  std::vector<Problem> problems_;
  std::size_t unnamed_ = 0;
};

/// `pointer` with one more reference token, escaped as RFC 6901 says.
[[nodiscard]] std::string at(std::string_view pointer, std::string_view key);
[[nodiscard]] std::string at(std::string_view pointer, std::size_t index);

/// The word nearest to `word` in edits (insert, delete, replace, swap neighbours), "" when none is
/// near enough to have been meant.
[[nodiscard]] std::string_view nearest(std::string_view word, std::span<const std::string_view> in);

/// `did you mean "spacing"? ` or nothing, then `allowed here: a, b, c`.
[[nodiscard]] std::string hint(std::string_view word, std::span<const std::string_view> in);

/// A double as the shortest text that reads back to it.
[[nodiscard]] std::string shortest(double value);

}  // namespace sluice
