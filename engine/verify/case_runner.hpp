#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/run/outcome.hpp"
#include "engine/scene/checks/parse.hpp"
#include "engine/store/files/checkpoint.hpp"

namespace sluice {

/// How large the suite's cases are.
enum class SuiteForm { quick, full };

/// What became of one scene of the suite.
struct CaseRun {
  std::vector<Problem> problems;  ///< why the scene was refused; empty when it ran
  Scene scene;
  Outcome outcome;
  std::vector<std::string> warnings;
  std::vector<Series> series;
  std::optional<Checkpoint> last;  ///< the newest checkpoint: the end, or the last good state
  std::string checkpoint;          ///< its file, from the bench's folder

  [[nodiscard]] bool completed() const;
  /// Throws std::logic_error when the scene has no such sensor.
  [[nodiscard]] const Series& sensor(std::string_view name) const;
};

/// A signal asked to stop: what was judged before stays, the case at hand has no verdict.
class SuiteStopped : public std::runtime_error {
 public:
  SuiteStopped() : std::runtime_error("stopped by a signal") {}
};

/// Runs scenes of the suite as ordinary jobs, each in a folder of its own, with one scheme.
class CaseRunner {
 public:
  CaseRunner(std::filesystem::path folder, SuiteForm form, nlohmann::ordered_json scheme)
      : folder_(std::move(folder)), form_(form), scheme_(std::move(scheme)) {}

  /// Changes the particles of a scene before its first step: what a scene cannot say.
  using Prepare = std::function<void(Particles&)>;

  /// Runs `scene` to its end or failure, with the bench's scheme unless it has numerics of its own.
  /// `stability` skip: also what linear analysis refuses.
  /// Throws StorageError; SuiteStopped.
  [[nodiscard]] CaseRun run(const nlohmann::ordered_json& scene,
                            StabilityCheck stability = StabilityCheck::refuse,
                            const Prepare& prepare = {});

  [[nodiscard]] SuiteForm form() const { return form_; }
  [[nodiscard]] const nlohmann::ordered_json& scheme() const { return scheme_; }
  /// `quick` or `full`, as the form is.
  template <class T>
  [[nodiscard]] T pick(T quick, T full) const {
    return form_ == SuiteForm::quick ? quick : full;
  }

 private:
  std::filesystem::path folder_;
  SuiteForm form_;
  nlohmann::ordered_json scheme_;
  int runs_ = 0;
};

}  // namespace sluice
