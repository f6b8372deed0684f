#include "cli/client/fetched_job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <system_error>
#include <vector>

#include "cli/json_text.hpp"
#include "cli/verbs.hpp"
#include "engine/scene/format/text_rules.hpp"
#include "engine/store/disk/apart.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/files/job_folder.hpp"
#include "engine/store/files/snapshot_io.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

fs::path new_folder() {
  std::string name = (fs::temp_directory_path() / "sluice-report-XXXXXX").string();
  if (::mkdtemp(name.data()) != nullptr) return name;
  throw CommandEnd(ExitCode::storage_failure,
                   fmt::format("cannot make a folder {}: {}; TMPDIR can name another place", name,
                               std::strerror(errno)));
}

void write_file(const fs::path& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (file) return;
  throw CommandEnd(
      ExitCode::storage_failure,
      fmt::format("cannot write {}: TMPDIR can name a place with more room", path.string()));
}

/// Whether the name is one that JobPaths finds again, and leads nowhere else.
bool is_snapshot_name(const std::string& name) {
  return name.starts_with("frame-") && name.ends_with(".h5") && name.find('/') == name.npos;
}

std::vector<std::string> file_names(ServiceClient& service, const std::string& id) {
  const auto list = service.object_of(service.get(job_target(id, "/files")));
  std::vector<std::string> names;
  for (const auto& file : member(list, "files")) names.push_back(text_at(file, "name"));
  return names;
}

/// How a run ended that left no outcome.json, as far as the service knows.
std::string known_outcome(ServiceClient& service, const std::string& id) {
  const auto job = service.object_of(service.get(job_target(id)));
  const auto outcome = member(job, "outcome");
  if (outcome.is_object()) return outcome.dump();
  if (text_at(job, "state") != "failed") return "null";
  return nlohmann::json{{"state", "failed"}, {"reason", text_at(job, "reason")}}.dump();
}

void fetch(ServiceClient& service, const std::string& id, const fs::path& folder) {
  const std::vector<std::string> there = file_names(service, id);
  const JobPaths paths(folder);
  for (const fs::path& path : {paths.scene(), paths.series(), paths.outcome()}) {
    const std::string name = path.filename().string();
    if (std::ranges::find(there, name) != there.end()) {
      write_file(path, service.get(job_target(id, "/files/" + name)).body);
    } else if (path == paths.outcome()) {
      write_file(path, known_outcome(service, id));
    }
  }
  for (const std::string& name : there) {
    if (!are_allowed(name, Characters::mesh)) continue;
    write_file(paths.part(name), service.get(job_target(id, "/files/" + name)).body);
  }
  fs::create_directory(paths.frames());
  for (const std::string& name : there) {
    if (is_snapshot_name(name)) write_file(paths.frames() / name, "");
  }
}

bool is_harmless_snapshot(const fs::path& path) {
  try {
    require_harmless(path, [&] { static_cast<void>(read_snapshot(path)); });
    return true;
  } catch (const StorageError&) {
    return false;
  }
}

}  // namespace

FetchedJob::FetchedJob(ServiceClient& service, const std::string& id)
    : id_(id), folder_(new_folder()) {
  try {
    fetch(service, id, folder_);
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    throw;
  }
}

void FetchedJob::fetch_snapshots(ServiceClient& service, const std::vector<fs::path>& frames) {
  for (const fs::path& path : frames) {
    const std::string name = path.filename().string();
    write_file(path, service.get(job_target(id_, "/files/" + percent_encoded(name))).body);
    if (!is_harmless_snapshot(path)) write_file(path, "");
  }
}

std::string FetchedJob::in_users_words(std::string message) const {
  const std::string name = folder_.string();
  for (std::size_t at = 0; (at = message.find(name, at)) != message.npos; at += id_.size()) {
    message.replace(at, name.size(), id_);
  }
  return message;
}

FetchedJob::~FetchedJob() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

}  // namespace sluice
