#include "engine/scene/filling/intervals.hpp"

#include <algorithm>

namespace sluice {

Intervals merged(Intervals line) {
  std::sort(line.begin(), line.end());
  Intervals result;
  for (const auto& [begin, end] : line) {
    if (!result.empty() && begin <= result.back().second) {
      result.back().second = std::max(result.back().second, end);
    } else if (begin < end) {
      result.emplace_back(begin, end);
    }
  }
  return result;
}

Intervals without(const Intervals& line, const Intervals& taken) {
  Intervals result;
  for (auto [begin, end] : line) {
    for (const auto& [low, high] : taken) {
      if (high <= begin || low >= end) continue;
      if (low > begin) result.emplace_back(begin, low);
      begin = high;
      if (begin >= end) break;
    }
    if (begin < end) result.emplace_back(begin, end);
  }
  return result;
}

double length(const Intervals& line) {
  double sum = 0.0;
  for (const auto& [begin, end] : line) sum += end - begin;
  return sum;
}

std::vector<double> middles(const std::vector<Intervals>& lines, std::size_t count) {
  std::vector<std::pair<double, int>> events;
  double total = 0.0;
  for (const Intervals& line : lines) {
    total += length(line);
    for (const auto& [begin, end] : line) {
      events.emplace_back(begin, 1);
      events.emplace_back(end, -1);
    }
  }
  std::sort(events.begin(), events.end());
  std::vector<double> result;
  double below = 0.0;
  int width = 0;
  for (std::size_t i = 0; i + 1 < events.size(); ++i) {
    width += events[i].second;
    const double rise = events[i + 1].first - events[i].first;
    const double share = total / static_cast<double>(count);
    while (result.size() < count) {
      const double wanted = (static_cast<double>(result.size()) + 0.5) * share;
      if (width == 0 || wanted > below + width * rise) break;
      result.push_back(events[i].first + (wanted - below) / width);
    }
    below += width * rise;
  }
  // The last one may have missed its share by rounding.
  while (result.size() < count) result.push_back(events.back().first);
  return result;
}

}  // namespace sluice
