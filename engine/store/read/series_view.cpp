#include "engine/store/read/series_view.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "engine/store/read/filter.hpp"

namespace sluice {
namespace {

/// Samples [first, last) of a series.
Series slice(const Series& series, std::size_t first, std::size_t last) {
  const auto part = [](const std::vector<double>& from, std::size_t begin, std::size_t end) {
    return std::vector<double>(from.begin() + static_cast<std::ptrdiff_t>(begin),
                               from.begin() + static_cast<std::ptrdiff_t>(end));
  };
  const std::size_t width = series.columns.size();
  Series result;
  result.name = series.name;
  result.kind = series.kind;
  result.columns = series.columns;
  result.time = part(series.time, first, last);
  result.duration = part(series.duration, first, last);
  result.values = part(series.values, first * width, last * width);
  result.weight = part(series.weight, first, last);
  return result;
}

struct Span {
  std::size_t first = 0;
  std::size_t last = 0;
};

Span samples_between(const Series& series, double from, double to) {
  const auto begin = series.time.begin();
  const auto first = std::lower_bound(begin, series.time.end(), from);
  const auto last = std::upper_bound(first, series.time.end(), to);
  return {static_cast<std::size_t>(first - begin), static_cast<std::size_t>(last - begin)};
}

void require_cheap(const Series& series, double tau, double most) {
  if (std::isinf(most)) return;
  double pairs = 0.0;
  for (std::size_t m = 0, first = 0; m < series.size(); ++m) {
    while (series.time[m] - series.time[first] >= kFilterReach * tau) ++first;
    pairs += 2.0 * static_cast<double>(m - first + 1);
  }
  pairs *= static_cast<double>(series.columns.size());
  if (pairs <= most) return;
  throw std::length_error(fmt::format(
      "a filter of tau = {} s over {} samples takes {:.2g} products, above the limit of {:.2g}: "
      "choose a smaller tau, or a part of the time with from and to",
      tau, series.size(), pairs, most));
}

Series filtered(Series series, double tau) {
  const std::size_t width = series.columns.size();
  const Series raw = series;
  for (std::size_t column = 0; column < width; ++column) {
    const Filtered result = gaussian_filter(raw, tau, column);
    for (std::size_t n = 0; n < raw.size(); ++n) {
      series.values[n * width + column] = result.value[n];
    }
  }
  return series;
}

/// The samples from `from` to `to`, filtered with all that the filter reaches.
Series filtered_part(const Series& raw, double from, double to, double tau, double most) {
  if (!(tau > 0.0) || !std::isfinite(tau)) throw std::invalid_argument("tau must be positive");
  const double reach = kFilterReach * tau;
  Span wide = samples_between(raw, from - reach, to + reach);
  // The filter takes the first sample's duration from its neighbour, so it gets one out of reach.
  if (wide.first > 0) --wide.first;
  Series part = slice(raw, wide.first, wide.last);
  require_cheap(part, tau, most);
  part = filtered(std::move(part), tau);
  const Span asked = samples_between(part, from, to);
  return slice(part, asked.first, asked.last);
}

/// Adds where column `column` of samples [span) is least, greatest and first dry.
void keep_extremes(const Series& series, Span span, std::size_t column,
                   std::set<std::size_t>& kept) {
  const std::size_t width = series.columns.size();
  const auto value = [&](std::size_t n) { return series.values[n * width + column]; };
  std::size_t least = span.first;
  std::size_t greatest = span.first;
  for (std::size_t n = span.first; n < span.last; ++n) {
    if (std::isnan(value(n))) continue;
    if (std::isnan(value(least)) || value(n) < value(least)) least = n;
    if (std::isnan(value(greatest)) || value(n) > value(greatest)) greatest = n;
  }
  kept.insert(least);
  kept.insert(greatest);
  for (std::size_t n = span.first; n < span.last; ++n) {
    if (!std::isnan(value(n))) continue;
    kept.insert(n);
    return;
  }
}

/// The most that a double takes, as in -2.2250738585072014e-308, and what parts it from the next.
constexpr std::size_t kLongestNumber = 25;

/// Empty, but takes the numbers of a series without growing.
std::string room_for(const Series& series) {
  std::string out;
  out.reserve(512 + kLongestNumber * (series.columns.size() + 2) * series.size());
  return out;
}

void append_number(std::string& out, double value, std::string_view missing) {
  if (!std::isfinite(value)) {
    out.append(missing);
    return;
  }
  std::array<char, kLongestNumber> digits{};
  const auto* const end = fmt::format_to(digits.data(), FMT_COMPILE("{}"), value);
  out.append(digits.data(), static_cast<std::size_t>(end - digits.data()));
}

void append_array(std::string& out, const std::vector<double>& values, std::size_t first,
                  std::size_t stride) {
  out.push_back('[');
  for (std::size_t n = first; n < values.size(); n += stride) {
    if (n != first) out.push_back(',');
    append_number(out, values[n], "null");
  }
  out.push_back(']');
}

void append_optional(std::string& out, const std::optional<double>& value) {
  append_number(out, value.value_or(std::nan("")), "null");
}

}  // namespace

Series decimate(const Series& series, std::size_t max_points) {
  if (series.size() <= max_points) return series;
  const std::size_t width = series.columns.size();
  // Where a series begins and ends is part of what it shows.
  std::set<std::size_t> kept{0, series.size() - 1};
  const std::size_t parts = std::max<std::size_t>(1, (max_points - kept.size()) / (3 * width));
  for (std::size_t part = 0; part < parts; ++part) {
    const Span span{part * series.size() / parts, (part + 1) * series.size() / parts};
    for (std::size_t column = 0; column < width; ++column) {
      keep_extremes(series, span, column, kept);
    }
  }
  Series result = slice(series, 0, 0);
  for (const std::size_t n : kept) {
    result.time.push_back(series.time[n]);
    result.duration.push_back(series.duration[n]);
    result.weight.push_back(series.weight[n]);
    const auto row = series.values.begin() + static_cast<std::ptrdiff_t>(n * width);
    result.values.insert(result.values.end(), row, row + static_cast<std::ptrdiff_t>(width));
  }
  return result;
}

SeriesView make_view(const Series& raw, const SeriesQuery& query, SeriesState state) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double from = query.from.value_or(-infinity);
  const double to = query.to.value_or(infinity);
  SeriesView view;
  if (query.tau) {
    view.series = filtered_part(raw, from, to, *query.tau, query.max_products);
    if (state == SeriesState::growing && raw.size() > 0) {
      view.provisional_after = provisional_after(raw, *query.tau);
    }
  } else {
    const Span span = samples_between(raw, from, to);
    view.series = slice(raw, span.first, span.last);
  }
  view.samples = view.series.size();
  view.series = decimate(view.series, query.max_points);
  if (query.divisors) {
    view.series = dimensionless(std::move(view.series), *query.divisors);
    if (view.provisional_after) *view.provisional_after /= query.divisors->time;
  }
  return view;
}

std::string csv_text(const SeriesView& view, const SeriesQuery& query) {
  const Series& series = view.series;
  const std::size_t width = series.columns.size();
  std::string out = room_for(series);
  out.append(query.divisors ? "time" : "time_s");
  for (const Series::Column& column : series.columns) {
    fmt::format_to(std::back_inserter(out), ",{}", column.name);
  }
  out.append(",weight\n");
  for (std::size_t n = 0; n < series.size(); ++n) {
    append_number(out, series.time[n], "");
    for (std::size_t c = 0; c < width; ++c) {
      out.push_back(',');
      append_number(out, series.values[n * width + c], "");
    }
    out.push_back(',');
    append_number(out, series.weight[n], "");
    out.push_back('\n');
  }
  return out;
}

std::string json_text(const SeriesView& view, const SeriesQuery& query) {
  const Series& series = view.series;
  std::string out = room_for(series);
  const auto put = std::back_inserter(out);
  fmt::format_to(put, R"({{"name":"{}","kind":"{}","filter":"{}","tau":)", series.name, series.kind,
                 query.tau ? "gaussian" : "none");
  append_optional(out, query.tau);
  fmt::format_to(put, R"(,"dimensionless":{},"provisional_after":)", query.divisors.has_value());
  append_optional(out, view.provisional_after);
  fmt::format_to(put, R"(,"samples":{},"decimated":{},"time_unit":"{}","time":)", view.samples,
                 view.samples != series.size(), query.divisors ? "1" : "s");
  append_array(out, series.time, 0, 1);
  out.append(R"(,"columns":[)");
  for (std::size_t c = 0; c < series.columns.size(); ++c) {
    fmt::format_to(put, R"({}{{"name":"{}","unit":"{}","values":)", c == 0 ? "" : ",",
                   series.columns[c].name, series.columns[c].unit);
    append_array(out, series.values, c, series.columns.size());
    out.push_back('}');
  }
  out.append(R"(],"weight":)");
  append_array(out, series.weight, 0, 1);
  out.append("}\n");
  return out;
}

}  // namespace sluice
