#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "engine/sph/solver/solver.hpp"

namespace sluice {

/// Speed over the recent past.
struct Rate {
  double model_time = 0.0;      ///< model seconds per second
  double steps = 0.0;           ///< per second
  double particle_steps = 0.0;  ///< fluid-particle steps per second
};

/// Measures a rate over a window of the last `window` seconds. Takes the time as an argument; knows
/// no clock.
class RateMeter {
 public:
  explicit RateMeter(double window = 10.0) : window_(window) {}
  void add(double now, double model_time, std::uint64_t step, std::uint64_t particle_steps);
  /// Nothing until two points lie apart in time.
  [[nodiscard]] std::optional<Rate> rate() const;

 private:
  struct Point {
    double now;
    double model_time;
    std::uint64_t step;
    std::uint64_t particle_steps;
  };
  double window_;
  std::deque<Point> points_;
};

/// Where a run stands.
struct Progress {
  std::uint64_t step = 0;
  double time = 0.0;        ///< model time, s
  double start_time = 0.0;  ///< model time at which this attempt began, s
  double end_time = 0.0;    ///< s
  double time_step = 0.0;   ///< s
  StepLimit step_limit = StepLimit::sound;
  std::size_t particles = 0;
  std::size_t overtopped = 0;
  std::size_t leaked = 0;
  std::size_t excluded = 0;
  double max_speed = 0.0;                ///< m/s
  double elapsed = 0.0;                  ///< wall time of this attempt, s
  std::optional<double> checkpoint_age;  ///< s since the last checkpoint was safe
  std::optional<Rate> rate;

  /// Share of the model time that is done, 0 to 1.
  [[nodiscard]] double fraction() const;
  /// Seconds to go at the recent rate; nothing when it is unknown: never infinite.
  [[nodiscard]] std::optional<double> remaining() const;
};

/// "45 s", "12 min 05 s", "3 h 20 min", "6 d 4 h"; "unknown" without a value.
[[nodiscard]] std::string duration_text(const std::optional<double>& seconds);

/// " 12.3 % t 0.1722/1.4 s, 0.21 s/s, 14.2 M/s, ETA 5 s, dt 2.1e-05 s (sound)".
[[nodiscard]] std::string progress_text(const Progress& progress);

/// The same after a bar: one line of at most `width` characters for a terminal.
[[nodiscard]] std::string progress_bar(const Progress& progress, std::size_t width);

}  // namespace sluice
