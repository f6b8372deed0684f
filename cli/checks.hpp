#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

namespace sluice {

// What an option's value may be, as checks that say what was found and what is allowed. Numbers
// that are not finite are no numbers here.

[[nodiscard]] CLI::Validator any_number();
[[nodiscard]] CLI::Validator number_above_zero();
/// Both ends are allowed.
[[nodiscard]] CLI::Validator number_between(double low, double high);
[[nodiscard]] CLI::Validator number_from_zero();
/// A whole number; both ends are allowed.
[[nodiscard]] CLI::Validator whole_between(long long low, long long high);
[[nodiscard]] CLI::Validator whole_from(long long low);
/// A number of bytes with or without a unit, such as 20GiB; made a plain number.
[[nodiscard]] CLI::Validator size_in_bytes();

[[nodiscard]] CLI::Validator one_of(std::vector<std::string> words);
/// One of these words; made the number of its value, which CLI11 turns into the value.
template <class Value>
[[nodiscard]] CLI::Validator one_of(const std::map<std::string, Value>& values) {
  std::vector<std::string> words;
  std::vector<int> numbers;
  for (const auto& [word, value] : values) {
    words.push_back(word);
    numbers.push_back(static_cast<int>(value));
  }
  const auto check = one_of(words);
  return {[check, words, numbers](std::string& text) {
            std::string refusal = check(text);
            for (std::size_t k = 0; refusal.empty() && k < words.size(); ++k) {
              if (words[k] != text) continue;
              text = std::to_string(numbers[k]);
              break;
            }
            return refusal;
          },
          check.get_description(), ""};
}

/// A file that is there; "-" passes too.
[[nodiscard]] CLI::Validator file_or_stdin();
[[nodiscard]] CLI::Validator existing_file();
[[nodiscard]] CLI::Validator existing_folder();
/// A file or a folder; "-" passes too.
[[nodiscard]] CLI::Validator existing_or_stdin();

}  // namespace sluice
