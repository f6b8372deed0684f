#pragma once

#include <filesystem>
#include <string>

namespace sluice {

enum class Verdict { whole, damaged, unsupported, unreadable };

/// What a file is, told in two forms.
struct Inspection {
  Verdict verdict = Verdict::whole;
  std::string text;  ///< for people, ends with a newline
  std::string json;  ///< one object with the same facts
};

/// Explains any file that we publish: format, version, step, time, scene, build, each data set with
/// unit, shape and range, series with samples and span, trailer and verdict. Never throws for the
/// state of the file: what is wrong and what to do is the explanation then. A file whose checksum
/// is wrong is not handed to HDF5, which may crash on damaged images.
[[nodiscard]] Inspection inspect_file(const std::filesystem::path& path);

/// The text of it.
[[nodiscard]] std::string inspect(const std::filesystem::path& path);

}  // namespace sluice
