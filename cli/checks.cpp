#include "cli/checks.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <system_error>

namespace sluice {
namespace {

namespace fs = std::filesystem;

std::string refusal(const std::string& found, const std::string& allowed) {
  return fmt::format("is \"{}\", but must be {}", found, allowed);
}

template <class Number>
std::optional<Number> whole_text_as(const std::string& text) {
  Number number{};
  // What the shell's users write, from_chars does not read.
  const std::size_t first = text.starts_with('+') ? 1 : 0;
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data() + first, end, number);
  if (result.ec != std::errc() || result.ptr != end) return {};
  return number;
}

CLI::Validator check(const std::string& allowed, const std::string& description,
                     const std::function<bool(const std::string&)>& holds) {
  return {[allowed, holds](std::string& text) {
            return holds(text) ? std::string() : refusal(text, allowed);
          },
          description, ""};
}

CLI::Validator number_check(const std::string& allowed, const std::string& description,
                            const std::function<bool(double)>& holds) {
  return check(allowed, description, [holds](const std::string& text) {
    const auto number = whole_text_as<double>(text);
    return number && std::isfinite(*number) && holds(*number);
  });
}

CLI::Validator path_check(bool file, bool folder, bool standard_input) {
  return {[=](std::string& text) -> std::string {
            if (standard_input && text == "-") return {};
            const std::string name = text.empty() ? "\"\"" : text;
            std::error_code unknown;
            const fs::file_type type = fs::status(text, unknown).type();
            if (type == fs::file_type::not_found) {
              return fmt::format("there is no {} {}",
                                 file && folder ? "file or folder" : (file ? "file" : "folder"),
                                 name);
            }
            // In a folder that cannot be entered it may well be there.
            if (unknown) return fmt::format("cannot look at {}: {}", name, unknown.message());
            const bool is_folder = type == fs::file_type::directory;
            if (is_folder && !folder) return name + " is a folder, no file";
            if (!is_folder && !file) return name + " is a file, no folder";
            if (::access(text.c_str(), R_OK) == 0) return {};
            return fmt::format("cannot read {}: {}", name, std::generic_category().message(errno));
          },
          "", ""};
}

}  // namespace

CLI::Validator any_number() {
  return number_check("a number", "", [](double) { return true; });
}

CLI::Validator number_above_zero() {
  return number_check("a number above 0", "> 0", [](double number) { return number > 0.0; });
}

CLI::Validator number_between(double low, double high) {
  return number_check(fmt::format("a number from {} to {}", low, high),
                      fmt::format("[{} - {}]", low, high),
                      [=](double number) { return number >= low && number <= high; });
}

CLI::Validator number_from_zero() {
  return number_check("0 or a number above it", ">= 0", [](double number) { return number >= 0; });
}

CLI::Validator whole_between(long long low, long long high) {
  return check(fmt::format("a whole number from {} to {}", low, high),
               fmt::format("[{} - {}]", low, high), [=](const std::string& text) {
                 const auto number = whole_text_as<long long>(text);
                 return number && *number >= low && *number <= high;
               });
}

CLI::Validator whole_from(long long low) {
  return check(fmt::format("a whole number, {} or more", low), fmt::format(">= {}", low),
               [=](const std::string& text) {
                 const auto number = whole_text_as<long long>(text);
                 return number && *number >= low;
               });
}

CLI::Validator size_in_bytes() {
  const CLI::AsSizeValue convert(false);
  return {[convert](std::string& text) {
            const std::string found = text;
            try {
              if (!text.starts_with('-') && convert(text).empty()) return std::string();
            } catch (const CLI::Error&) {
              // Told below, in words of ours.
            }
            return refusal(found, "a size in bytes, such as 500000000, 512MiB or 20GiB");
          },
          "SIZE", ""};
}

CLI::Validator one_of(std::vector<std::string> words) {
  const std::string listed = fmt::format("{}", fmt::join(words, ", "));
  const std::string description = fmt::format("{{{}}}", fmt::join(words, ","));
  return check("one of " + listed, description, [words = std::move(words)](const auto& text) {
    return std::ranges::find(words, text) != words.end();
  });
}

CLI::Validator file_or_stdin() { return path_check(true, false, true); }
CLI::Validator existing_file() { return path_check(true, false, false); }
CLI::Validator existing_folder() { return path_check(false, true, false); }
CLI::Validator existing_or_stdin() { return path_check(true, true, true); }

}  // namespace sluice
