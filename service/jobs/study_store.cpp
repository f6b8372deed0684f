#include "service/jobs/study_store.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "engine/scene/checks/parse.hpp"
#include "engine/scene/format/json_text.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/publish.hpp"
#include "engine/store/files/new_folder.hpp"
#include "service/jobs/job_ids.hpp"
#include "service/jobs/service_log.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

fs::path studies_of(const fs::path& data) { return data / "studies"; }
fs::path submission_in(const fs::path& folder) { return folder / "submission.json"; }
fs::path document_in(const fs::path& folder) { return folder / "study.json"; }
fs::path kept_in(const fs::path& folder, const std::string& run) {
  return folder / "kept" / (run + ".json");
}

void make_folder(const fs::path& path, FileSystem& system) {
  std::error_code error;
  fs::create_directories(path, error);
  if (!error && system.sync_folder(path.parent_path()) == 0) return;
  throw system_error("cannot make the folder", path, error ? error.value() : errno);
}

std::string text_of(const json& object) {
  return object.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

json to_json(const StudyRecord& record) {
  return {{"name", record.name},
          {"runs", record.runs},
          {"priority", record.priority},
          {"created_ms", record.created_ms},
          {"key", record.key},
          {"body_hash", record.body_hash},
          {"made", record.stage == StudyRecord::Stage::made}};
}

StudyRecord from_json(const std::string& id, const json& object) {
  StudyRecord record;
  record.id = id;
  record.name = object.at("name").get<std::string>();
  record.runs = object.at("runs").get<std::size_t>();
  record.priority = object.at("priority").get<int>();
  record.created_ms = object.at("created_ms").get<std::int64_t>();
  record.key = object.at("key").get<std::string>();
  record.body_hash = object.at("body_hash").get<std::string>();
  record.stage =
      object.at("made").get<bool>() ? StudyRecord::Stage::made : StudyRecord::Stage::making;
  return record;
}

StudyRecord read_record(const fs::path& folder) {
  return from_json(
      folder.filename().string(),
      read_stored_json(read_text(submission_in(folder), kMaxStoredBytes, Links::refuse)));
}

bool is_missing(const fs::path& path) {
  std::error_code error;
  return fs::symlink_status(path, error).type() == fs::file_type::not_found;
}

/// A study that cannot be read must hide no other.
void pass_over(const fs::path& folder, const std::exception& error) {
  log_line({{"event", "study_passed_over"},
            {"study", folder.filename().string()},
            {"message", error.what()}});
}

}  // namespace

StudyStore::StudyStore(const fs::path& data, FileSystem& system)
    : root_(studies_of(data)), system_(&system) {
  make_folder(root_, system);
  remove_unfinished_folders(root_);
  read_all();
}

void StudyStore::read_all() {
  std::vector<fs::path> folders;
  for (const fs::directory_entry& entry : fs::directory_iterator(root_)) {
    if (is_study_id(entry.path().filename().string())) folders.push_back(entry.path());
  }
  for (const fs::path& path : folders) {
    try {
      read_folder(path);
    } catch (const std::exception& error) {
      pass_over(path, error);
    }
  }
}

void StudyStore::read_folder(const fs::path& path) {
  if (fs::symlink_status(path).type() != fs::file_type::directory) return;
  remove_leftovers(path);
  remove_leftovers(kept_in(path, "").parent_path());
  if (is_missing(submission_in(path))) {
    fs::remove_all(path);
    return;
  }
  StudyRecord record;
  try {
    record = read_record(path);
  } catch (const StorageError&) {
    // Once more: a passing error of the disk must not hide it until the next start.
    record = read_record(path);
  }
  records_.emplace(record.id, std::move(record));
}

void StudyStore::write(const StudyRecord& record) const {
  publish_text(submission_in(folder(record.id)), text_of(to_json(record)), *system_);
}

void StudyStore::add(const StudyRecord& record, std::string_view document) {
  const fs::path place = folder(record.id);
  const std::string study = document_in(place).filename().string();
  const std::string submission = submission_in(place).filename().string();
  const std::string text = text_of(to_json(record));
  publish_folder(place, std::array<FirstFile, 2>{{{study, document}, {submission, text}}}, {},
                 *system_);
  const std::scoped_lock lock(mutex_);
  records_[record.id] = record;
}

void StudyStore::set_made(const std::string& id) {
  auto record = find(id);
  if (!record) return;
  record->stage = StudyRecord::Stage::made;
  {
    const std::scoped_lock lock(mutex_);
    records_[id] = *record;
  }
  write(*record);
}

void StudyStore::remove(const std::string& id) {
  // Without this file the rest is a left-over, whatever happens next.
  std::error_code error;
  fs::remove(submission_in(folder(id)), error);
  if (error) {
    throw system_error("cannot remove", submission_in(folder(id)), error.value());
  }
  fs::remove_all(folder(id), error);
  if (error) fs::remove_all(folder(id), error);  // a passing one; after another the next start does
  const std::scoped_lock lock(mutex_);
  records_.erase(id);
}

std::optional<StudyRecord> StudyStore::find(const std::string& id) const {
  const std::scoped_lock lock(mutex_);
  const auto found = records_.find(id);
  return found == records_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<StudyRecord> StudyStore::find_by_key(const std::string& key) const {
  if (key.empty()) return std::nullopt;
  const std::scoped_lock lock(mutex_);
  for (const auto& [id, record] : records_) {
    if (record.key == key) return record;
  }
  return std::nullopt;
}

std::vector<StudyRecord> StudyStore::list(const std::string& after, std::size_t limit) const {
  const std::scoped_lock lock(mutex_);
  std::vector<StudyRecord> page;
  auto next = after.empty() ? records_.end() : records_.lower_bound(after);
  while (next != records_.begin() && page.size() < limit) page.push_back((--next)->second);
  return page;
}

std::vector<StudyRecord> StudyStore::unfinished() const {
  const std::scoped_lock lock(mutex_);
  std::vector<StudyRecord> all;
  for (const auto& [id, record] : records_) {
    if (record.stage == StudyRecord::Stage::making) all.push_back(record);
  }
  return all;
}

std::string StudyStore::document(const std::string& id) const {
  const fs::path path = document_in(folder(id));
  if (is_missing(path)) {
    throw StorageError(StorageFault::corrupt, fmt::format("{}: it is missing", path.string()));
  }
  return read_text(path, kMaxSceneBytes + 1, Links::refuse);
}

std::optional<KeptRun> StudyStore::kept_run(const std::string& id, const std::string& run) const {
  const fs::path path = kept_in(folder(id), run);
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return std::nullopt;
  try {
    const json object = read_stored_json(read_text(path, kMaxStoredBytes, Links::refuse));
    return KeptRun{object.at("state").get<std::string>(), object.at("reason").get<std::string>(),
                   object.at("report").get<std::string>()};
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

void keep_run(const fs::path& data, const std::string& study, const std::string& run,
              const KeptRun& kept) {
  const fs::path folder = studies_of(data) / study;
  std::error_code ignored;
  if (!is_study_id(study) || !fs::exists(submission_in(folder), ignored)) return;
  const fs::path path = kept_in(folder, run);
  make_folder(path.parent_path(), FileSystem::real());
  publish_text(path,
               text_of({{"state", kept.state}, {"reason", kept.reason}, {"report", kept.report}}));
}

}  // namespace sluice
