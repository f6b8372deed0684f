#include "engine/store/files/job_paths.hpp"

#include <algorithm>
#include <string>
#include <string_view>

#include "engine/scene/format/text_rules.hpp"
#include "engine/store/disk/file_system.hpp"
#include "engine/store/files/checkpoint_io.hpp"
#include "engine/store/files/snapshot_io.hpp"

namespace sluice {
namespace {

bool is_checkpoint_name(std::string_view name) { return step_of_checkpoint_name(name).has_value(); }

}  // namespace

std::vector<std::filesystem::path> sorted_paths(
    const std::filesystem::path& folder, const std::function<bool(std::string_view)>& wanted) {
  std::vector<std::filesystem::path> found;
  for (const std::filesystem::directory_entry& entry : entries_of(folder)) {
    if (wanted(entry.path().filename().string())) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::filesystem::path JobPaths::frame(std::uint64_t index) const {
  return frames() / snapshot_name(index);
}

std::filesystem::path JobPaths::checkpoint(std::uint64_t step) const {
  return root_ / checkpoint_name(step);
}

std::vector<std::filesystem::path> JobPaths::parts() const {
  return sorted_paths(root_,
                      [](std::string_view name) { return are_allowed(name, Characters::mesh); });
}

std::vector<std::filesystem::path> JobPaths::checkpoints() const {
  std::vector<std::filesystem::path> found = sorted_paths(root_, is_checkpoint_name);
  std::reverse(found.begin(), found.end());
  return found;
}

std::vector<std::filesystem::path> JobPaths::bad_checkpoints() const {
  return sorted_paths(root_, [](std::string_view name) {
    constexpr std::string_view suffix = kBadSuffix;
    return name.ends_with(suffix) &&
           is_checkpoint_name(name.substr(0, name.size() - suffix.size()));
  });
}

std::vector<std::filesystem::path> JobPaths::snapshot_files() const {
  return sorted_paths(frames(), [](std::string_view name) {
    return name.starts_with("frame-") && name.ends_with(".h5");
  });
}

}  // namespace sluice
