#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/store/files/series.hpp"

namespace sluice {

/// A filtered column: one entry per sample of the series.
struct Filtered {
  std::vector<double> value;   ///< NaN where no sample that counts lies within the window
  std::vector<double> weight;  ///< sum of W_mn Dt_n, dimensionless: about 1 where all samples
                               ///< count, less at the ends, 0 without a value
};

/// The window of the time filter ends at this many tau: R < 3, as eq. 6 has it.
inline constexpr double kFilterReach = 3.0;

/// Gaussian low-pass filter in time, eq. 12 with eq. 6 for d = 1 and `tau` (s) for h, each sample
/// weighted by the time Dt_n it stands for:
///   v_m = sum_n v_n W_mn Dt_n / sum_n W_mn Dt_n,  W_mn = exp(-((t_m - t_n)/tau)^2) / (sqrt(pi)
///   tau)
/// A dry sample (NaN) of a pressure counts as 0 Pa, which the air around the sensor has: an average
/// over the wet samples alone would begin three tau before the fluid arrives. Of other kinds dry
/// samples are skipped. The first sample has none before it and stands for as long as the
/// second. O(samples * window). Throws std::invalid_argument when tau is not a positive number or
/// the series has no such column.
[[nodiscard]] Filtered gaussian_filter(const Series& series, double tau, std::size_t column = 0);

/// The same for series that were sampled together, one result each: the kernel is summed over once
/// for all. Throws std::invalid_argument as well when their times or durations differ.
[[nodiscard]] std::vector<Filtered> gaussian_filter(std::span<const Series* const> together,
                                                    double tau, std::size_t column = 0);

/// Filtered values after this time (s) will still change when the run goes on: the filter looks
/// 3 tau ahead. Minus infinity for an empty series.
[[nodiscard]] double provisional_after(const Series& series, double tau);

}  // namespace sluice
