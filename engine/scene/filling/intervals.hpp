#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace sluice {

/// Intervals [begin, end] of a line, m. Where they are merged, they are apart and increase.
using Intervals = std::vector<std::pair<double, double>>;

/// The same places by intervals that are apart and increase.
[[nodiscard]] Intervals merged(Intervals line);

/// What of `line` no interval of `taken` covers; both merged.
[[nodiscard]] Intervals without(const Intervals& line, const Intervals& taken);

[[nodiscard]] double length(const Intervals& line);

/// Heights that part the summed length of some merged lines into `count` equal shares, the middle
/// of each.
[[nodiscard]] std::vector<double> middles(const std::vector<Intervals>& lines, std::size_t count);

}  // namespace sluice
