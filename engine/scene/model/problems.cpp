#include "engine/scene/model/problems.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>

#include "engine/scene/model/spec.hpp"

namespace sluice {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// Optimal string alignment over at most 64 characters, letter case ignored.
std::size_t edits(std::string_view a, std::string_view b) {
  constexpr std::size_t kLongest = 64;
  a = a.substr(0, kLongest);
  b = b.substr(0, kLongest);
  using Row = std::array<std::size_t, kLongest + 1>;
  Row two_up{}, up{}, row{};
  std::iota(up.begin(), up.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = up[j - 1] + (lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1);
      row[j] = std::min({up[j] + 1, row[j - 1] + 1, replaced});
      const bool swapped = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
                           lower(a[i - 2]) == lower(b[j - 1]);
      if (swapped) row[j] = std::min(row[j], two_up[j - 2] + 1);
    }
    two_up = up;
    up = row;
  }
  return up[b.size()];
}

}  // namespace

void Problems::add(std::string pointer, std::string message) {
  if (problems_.size() < kMaxProblems) {
    problems_.push_back({std::move(pointer), std::move(message)});
  } else {
    ++unnamed_;
  }
}

bool Problems::clean(std::initializer_list<std::string_view> pointers) const {
  if (unnamed_ > 0) return false;
  const auto below = [](std::string_view pointer, std::string_view parent) {
    return pointer.starts_with(parent) &&
           (pointer.size() == parent.size() || pointer[parent.size()] == '/');
  };
  return std::none_of(problems_.begin(), problems_.end(), [&](const Problem& problem) {
    return std::any_of(pointers.begin(), pointers.end(),
                       [&](std::string_view parent) { return below(problem.pointer, parent); });
  });
}

std::vector<Problem> Problems::take() {
  if (unnamed_ > 0) {
    problems_.push_back(
        {"", fmt::format("{} more problems are not listed; correct these first", unnamed_)});
    unnamed_ = 0;
  }
  return std::move(problems_);
}

std::string at(std::string_view pointer, std::string_view key) {
  std::string result{pointer};
  result += '/';
  for (const char c : key) {
    if (c == '~') {
      result += "~0";
    } else if (c == '/') {
      result += "~1";
    } else {
      result += c;
    }
  }
  return result;
}

std::string at(std::string_view pointer, std::size_t index) {
  return fmt::format("{}/{}", pointer, index);
}

std::string_view nearest(std::string_view word, std::span<const std::string_view> in) {
  std::string_view best;
  std::size_t fewest = std::max<std::size_t>(2, word.size() / 2) + 1;
  for (const std::string_view each : in) {
    const std::size_t count = edits(word, each);
    if (count < fewest && count < each.size()) {
      fewest = count;
      best = each;
    }
  }
  return best;
}

std::string hint(std::string_view word, std::span<const std::string_view> in) {
  const std::string_view meant = nearest(word, in);
  const std::string question = meant.empty() ? "" : fmt::format("did you mean \"{}\"? ", meant);
  return fmt::format("{}allowed here: {}", question, fmt::join(in, ", "));
}

std::string shortest(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::string to_text(const Range& range, std::string_view unit) {
  const std::string suffix = unit == "1" ? std::string{} : fmt::format(" {}", unit);
  const std::string high = shortest(range.high);
  return range.low_end == Range::Low::included
             ? fmt::format("from {} to {}{}", shortest(range.low), high, suffix)
             : fmt::format("above {} and at most {}{}", shortest(range.low), high, suffix);
}

}  // namespace sluice
