#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/run/guards.hpp"
#include "engine/run/sampling.hpp"
#include "engine/scene/filling/packing.hpp"
#include "engine/scene/model/scene.hpp"
#include "engine/sph/method/removed.hpp"
#include "engine/sph/solver/solver.hpp"
#include "engine/store/files/checkpoint.hpp"

namespace sluice {

/// Where a simulation begins.
enum class Origin { scene, checkpoint };

/// A scene in motion: the solver, its sensors and its guards. The same scene and SIMD target give
/// the same bits whatever the threads, the interruptions and the checkpoints taken: everything
/// periodic is a function of step or model time, and checkpoint() only looks.
class Simulation {
 public:
  /// Starts from the scene. Step 0 is sampled at once. Throws NumericalFailure when the initial
  /// state already violates a guard.
  Simulation(Scene scene, const Execution& execution);

  /// Goes on from a checkpoint of a scene with the same identity; the end time may differ. Throws
  /// StorageError(wrong_scene) otherwise.
  Simulation(Scene scene, const Execution& execution, Checkpoint checkpoint);

  /// One time step, then guards, then samples. Throws NumericalFailure when a guard trips; the
  /// simulation is then over and takes no step or checkpoint any more (std::logic_error).
  void step();

  /// True from the first step with time >= end_time on. The last step is not cut to the end time:
  /// that would make a run that is extended later differ from one that was long from the start.
  [[nodiscard]] bool finished() const { return solver_.time() >= scene_.end_time; }

  /// All that is needed to go on exactly.
  [[nodiscard]] Checkpoint checkpoint() const;

  /// A violation that the periodic guards have not come to yet. A state that has one must not be
  /// kept; whether it is looked for changes nothing in the run.
  [[nodiscard]] std::optional<Diagnosis> violation() const;

  /// Index of the frame that is due now, if any. Stays until snapshot_written().
  [[nodiscard]] std::optional<std::uint64_t> due_snapshot() const;
  void snapshot_written();

  /// The first breach of each warning guard since construction, handed out once.
  [[nodiscard]] std::vector<Diagnosis> take_warnings();

  /// How the particles were packed before t = 0; absent where they were not, or not by this object.
  [[nodiscard]] const std::optional<PackingReport>& packing() const { return packing_; }
  /// Of one core, to make the particles of step 0.
  [[nodiscard]] double start_seconds() const { return start_seconds_; }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const Solver& solver() const { return solver_; }
  [[nodiscard]] const std::vector<SampleTable>& samples() const { return samples_; }
  [[nodiscard]] const GuardBaselines& baselines() const { return baselines_; }
  /// What particles took along that left for this cause.
  [[nodiscard]] const Departed& departed(RemovalCause cause) const {
    return departed_[static_cast<std::size_t>(cause)];
  }
  [[nodiscard]] std::size_t leaked() const { return departed(RemovalCause::leaked).count; }
  [[nodiscard]] std::size_t overtopped() const { return departed(RemovalCause::overtopped).count; }
  [[nodiscard]] std::size_t excluded() const { return excluded_at_.size(); }
  [[nodiscard]] bool bit_exact() const { return bit_exact_; }
  /// Since construction: sum of the fluid particles over all steps, and seconds spent on samples.
  [[nodiscard]] std::uint64_t particle_steps() const { return particle_steps_; }
  [[nodiscard]] double sample_seconds() const { return sample_seconds_; }

 private:
  void count_removed();
  void note_extremes();
  void sample();
  void note_warnings(const StepFacts& facts);
  [[nodiscard]] StepFacts facts(std::optional<Energy> energy) const;
  [[nodiscard]] std::size_t initial_particles() const;
  [[nodiscard]] Solver start_solver(const Execution& execution);

  Scene scene_;
  std::string scene_hash_;
  GuardLimits limits_;
  SensorArray sensors_;
  std::optional<PackingReport> packing_;
  double start_seconds_ = 0.0;
  Solver solver_;
  std::vector<SampleTable> samples_;
  GuardBaselines baselines_;
  std::uint64_t next_snapshot_ = 0;
  bool bit_exact_ = true;
  bool failed_ = false;

  std::size_t removed_counted_ = 0;
  std::array<Departed, kRemovalCauses> departed_;
  std::vector<double> excluded_at_;  ///< s, increasing
  double energy_that_left_ = 0.0;    ///< J/m, see guards.hpp
  std::uint64_t particle_steps_ = 0;
  double sample_seconds_ = 0.0;
  std::vector<Diagnosis> warnings_;
  std::vector<std::string> warned_;
};

}  // namespace sluice
