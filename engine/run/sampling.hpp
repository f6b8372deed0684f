#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/scene/model/scene.hpp"
#include "engine/sph/solver/solver.hpp"
#include "engine/store/files/sample_table.hpp"

namespace sluice {

/// What one sensor measures. One small type per kind (sampling.cpp); a new kind is a new type and
/// one line in make_sampler().
class Sampler {
 public:
  virtual ~Sampler() = default;
  [[nodiscard]] virtual std::vector<Series::Column> columns() const = 0;
  /// Fills `values` (one per column) and returns the kernel weight that carried them: 0 is dry,
  /// and no value but the air's, where a scene names it.
  [[nodiscard]] virtual double sample(const Solver& solver, std::span<double> values) const = 0;
  /// A sampler that looks for an event ends at its first sample and stores no dry ones.
  [[nodiscard]] virtual bool is_event() const { return false; }
  /// Others are asked on several threads at once.
  [[nodiscard]] virtual bool uses_all_threads() const { return false; }
};

[[nodiscard]] std::unique_ptr<Sampler> make_sampler(const Sensor& sensor, const Scene& scene);

/// All sensors of a scene with their samplers: those of one kind and interval together. The samples
/// and the schedule's state live in the tables, which go into the checkpoint; a SensorArray itself
/// has nothing to save.
class SensorArray {
 public:
  explicit SensorArray(const Scene& scene);

  /// The tables before the first sample.
  [[nodiscard]] const std::vector<SampleTable>& empty_tables() const { return empty_; }

  /// Appends to each table that is due at the solver's time. `tables` must have the names of
  /// `empty_tables`.
  void sample(const Solver& solver, std::vector<SampleTable>& tables) const;

 private:
  /// The samplers of one table.
  struct Group {
    SensorKind kind;
    double interval;  ///< s
    std::vector<std::unique_ptr<Sampler>> samplers;
  };
  Group& group_for(const Sensor& sensor, const Sampler& sampler);

  /// A row of a table that is being filled: what its sensors measure now.
  struct Row {
    const Group* group;
    SampleTable* table;
    std::size_t values_from;
    std::size_t weight_from;
  };
  static Row begin_row(const Group& group, SampleTable& table);
  static void fill(const Row& row, const Solver& solver, std::size_t begin, std::size_t end);
  /// Ends the row; without it where a sensor of an event saw none.
  static void end_row(const Row& row, double time);

  std::vector<Group> groups_;
  std::vector<SampleTable> empty_;
};

}  // namespace sluice
