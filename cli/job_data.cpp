#include "cli/job_data.hpp"

#include <fmt/format.h>

#include <string_view>

#include "cli/checks.hpp"
#include "cli/verbs.hpp"
#include "engine/scene/model/problems.hpp"
#include "engine/store/files/job_folder.hpp"

namespace sluice {

void require_folder(const std::string& word) {
  std::string path = word;
  const std::string wrong = existing_folder()(path);
  if (wrong.empty()) return;
  throw CommandEnd(ExitCode::usage,
                   fmt::format("{}; for a job of a service, add --server URL", wrong));
}

JobReader job_or_end(const std::filesystem::path& folder) {
  if (JobFolder::holds_job(folder)) return JobReader(folder);
  throw CommandEnd(
      ExitCode::usage,
      fmt::format("{} holds no job: give the folder that sluice run made", folder.string()));
}

const Series& find_series(const std::vector<Series>& all, const std::string& name) {
  std::vector<std::string_view> names;
  for (const Series& series : all) {
    if (series.name == name) return series;
    names.push_back(series.name);
  }
  throw CommandEnd(ClientExit::not_found,
                   fmt::format("there is no sensor {}: {}", name, hint(name, names)));
}

}  // namespace sluice
