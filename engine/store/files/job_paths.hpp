#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>
#include <utility>
#include <vector>

namespace sluice {

/// What a checkpoint's name ends with that was put aside as unusable.
inline constexpr const char* kBadSuffix = ".bad";

/// Paths in a folder whose names `wanted` accepts, sorted by name; none where there is no folder.
[[nodiscard]] std::vector<std::filesystem::path> sorted_paths(
    const std::filesystem::path& folder, const std::function<bool(std::string_view)>& wanted);

/// The names of all files of a job. Needs no lock and touches no disk.
class JobPaths {
 public:
  explicit JobPaths(std::filesystem::path root) : root_(std::move(root)) {}

  [[nodiscard]] const std::filesystem::path& root() const { return root_; }
  [[nodiscard]] std::filesystem::path scene() const { return root_ / "scene.json"; }
  /// A file that the scene names. Its ending, .stl or .obj, is that of no other file of a job.
  [[nodiscard]] std::filesystem::path part(std::string_view name) const { return root_ / name; }
  [[nodiscard]] std::filesystem::path lock() const { return root_ / "lock"; }
  [[nodiscard]] std::filesystem::path log() const { return root_ / "log.jsonl"; }
  [[nodiscard]] std::filesystem::path series() const { return root_ / "series.h5"; }
  [[nodiscard]] std::filesystem::path outcome() const { return root_ / "outcome.json"; }
  [[nodiscard]] std::filesystem::path report() const { return root_ / "report.json"; }
  static constexpr std::uint64_t kLargestReport = 1 << 20;  ///< bytes; no report.json has more
  [[nodiscard]] std::filesystem::path report_markdown() const { return root_ / "report.md"; }
  [[nodiscard]] std::filesystem::path report_html() const { return root_ / "report.html"; }
  [[nodiscard]] std::filesystem::path frames() const { return root_ / "frames"; }
  [[nodiscard]] std::filesystem::path frame(std::uint64_t index) const;
  [[nodiscard]] std::filesystem::path checkpoint(std::uint64_t step) const;

  /// Files that a scene may name, by name.
  [[nodiscard]] std::vector<std::filesystem::path> parts() const;
  /// Checkpoint files by name, newest first; none of them has been read. `.bad` ones are left out.
  [[nodiscard]] std::vector<std::filesystem::path> checkpoints() const;
  /// Checkpoints that were put aside as unusable.
  [[nodiscard]] std::vector<std::filesystem::path> bad_checkpoints() const;
  /// Snapshot files, oldest first.
  [[nodiscard]] std::vector<std::filesystem::path> snapshot_files() const;

 private:
  std::filesystem::path root_;
};

}  // namespace sluice
