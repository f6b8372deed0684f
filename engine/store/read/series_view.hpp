#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "engine/store/files/series.hpp"
#include "engine/store/read/dimensionless.hpp"

namespace sluice {

/// How a series is asked for. Times in s of model time.
struct SeriesQuery {
  std::optional<double> from;
  std::optional<double> to;
  std::optional<double> tau;  ///< of the Gaussian time filter, eq. 12; none: raw samples
  std::size_t max_points = std::numeric_limits<std::size_t>::max();
  /// Products of the filter that one view may take: some 1e8 a second of one core.
  double max_products = std::numeric_limits<double>::infinity();
  std::optional<Divisors> divisors;  ///< dimensionless; none: SI
};

/// A series as it is shown.
struct SeriesView {
  Series series;
  std::size_t samples = 0;                  ///< in the time asked for, before decimation
  std::optional<double> provisional_after;  ///< in the view's unit of time
};

enum class SeriesState { growing, final };

/// Filters, cuts, decimates and scales, in this order. Values of a `growing` series after
/// `provisional_after` may still change: the filter looks 3 tau ahead. Throws std::invalid_argument
/// when tau is not positive, std::length_error when the filter would take more than `max_products`.
[[nodiscard]] SeriesView make_view(const Series& raw, const SeriesQuery& query, SeriesState state);

/// At most `max_points` (10 or more) samples of a series, in order: the first, the last, and in
/// each of equal parts the least and the greatest value of every column and its first dry sample.
/// One part has up to 3 per column, however few may be kept.
[[nodiscard]] Series decimate(const Series& series, std::size_t max_points);

/// "time_s,value,weight" and one line per sample; an empty cell where there is no value.
[[nodiscard]] std::string csv_text(const SeriesView& view, const SeriesQuery& query);
/// The same as one JSON object; null where there is no value.
[[nodiscard]] std::string json_text(const SeriesView& view, const SeriesQuery& query);

}  // namespace sluice
