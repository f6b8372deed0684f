#include "cli/adopt_scene.hpp"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "cli/scene_file.hpp"
#include "cli/verbs.hpp"
#include "engine/scene/checks/parse.hpp"
#include "engine/scene/format/canonical.hpp"

namespace sluice {
namespace {

constexpr std::size_t kShown = 3;

/// Every value of a document by its JSON pointer; numbers in one form, however they were written.
using Values = std::map<std::string, std::string>;

Values values_of(const std::string& text) {
  Values values;
  const nlohmann::json flat = nlohmann::json::parse(text).flatten();
  for (const auto& [pointer, value] : flat.items()) {
    const bool number = value.is_number();
    values[pointer] = number ? fmt::format("{}", value.get<double>()) : value.dump();
  }
  return values;
}

std::string value_at(const Values& values, const std::string& pointer) {
  const auto found = values.find(pointer);
  return found == values.end() ? "left out" : found->second;
}

/// The pointers at which two documents differ.
std::set<std::string> differing(const Values& there, const Values& here) {
  std::set<std::string> pointers;
  for (const Values* values : {&there, &here}) {
    for (const auto& [pointer, value] : *values) {
      if (value_at(there, pointer) != value_at(here, pointer)) pointers.insert(pointer);
    }
  }
  return pointers;
}

/// What another run may have of its own.
bool is_no_matter(const std::string& pointer) {
  return pointer == "/name" || pointer == "/description" || pointer == "/end_time" ||
         pointer.starts_with("/reference");
}

/// Where two scenes differ: "/resolution/spacing is 0.02 there and 0.03 here", the first few. Of
/// keys that were written, where there are such: what follows from them needs no telling.
std::string differences(const SceneFile& there, const SceneFile& here) {
  const Values whole_there = values_of(identity_text(there.scene));
  const Values whole_here = values_of(identity_text(here.scene));
  const std::set<std::string> all = differing(whole_there, whole_here);
  Values written_there = values_of(there.text);
  Values written_here = values_of(here.text);
  std::set<std::string> pointers = differing(written_there, written_here);
  std::erase_if(pointers, [&](const std::string& pointer) {
    const bool known = whole_there.contains(pointer) || whole_here.contains(pointer);
    return is_no_matter(pointer) || (known && !all.contains(pointer));
  });
  if (pointers.empty()) {
    pointers = all;
    written_there = whole_there;
    written_here = whole_here;
  }
  std::vector<std::string> shown;
  for (const std::string& pointer : pointers) {
    if (shown.size() == kShown) break;
    shown.push_back(fmt::format("{} is {} there and {} here", pointer,
                                value_at(written_there, pointer), value_at(written_here, pointer)));
  }
  const std::size_t more = pointers.size() - shown.size();
  return fmt::format("{}{}", fmt::join(shown, ", "),
                     more == 0 ? "" : fmt::format(", and {} more", more));
}

}  // namespace

void adopt_scene(JobFolder& folder, const std::string& text, const Scene& scene) {
  const std::filesystem::path path = folder.paths().scene();
  const std::string present_text = folder.scene_text();
  const Scene present = job_scene_or_end(present_text, path);
  if (identity_text(present) != identity_text(scene)) {
    throw CommandEnd(ExitCode::invalid_scene,
                     fmt::format("{} holds a run of another scene: {}; choose another folder with "
                                 "--folder, or remove that one",
                                 folder.name().string(),
                                 differences({present_text, present, {}}, {text, scene, {}})));
  }
  if (canonical_text(present) != canonical_text(scene)) folder.publish_text(path, text);
}

void prepare_folder(const std::filesystem::path& root, const std::string& text, const Scene& scene,
                    const std::vector<NamedPart>& parts) {
  if (!JobFolder::holds_job(root)) {
    static_cast<void>(JobFolder::create(root, text, parts));
    return;
  }
  JobFolder folder = JobFolder::open(root);
  adopt_scene(folder, text, scene);
}

}  // namespace sluice
