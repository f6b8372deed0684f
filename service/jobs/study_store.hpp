#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "engine/store/disk/file_system.hpp"

namespace sluice {

/// A submitted study without its document. Its runs are jobs: the label of each is the study's id,
/// its name the run's.
struct StudyRecord {
  enum class Stage {
    making,  ///< its jobs are being made; what a crash left undone, the next start does
    made,
  };
  std::string id;  ///< "s" and 20 characters of [0-9a-v], sorting by creation
  std::string name;
  std::size_t runs = 0;
  int priority = 0;             ///< of its jobs
  std::int64_t created_ms = 0;  ///< Unix time, ms
  std::string key;              ///< Idempotency-Key, may be empty
  std::string body_hash;        ///< of the request that came with the key
  Stage stage = Stage::making;
};

/// What is left of a run whose job was deleted.
struct KeptRun {
  std::string state;   ///< of the job
  std::string reason;  ///< why it is not complete
  std::string report;  ///< report.json; empty when there was none
};

/// The studies of a data folder, DATA/studies/<id>: study.json as it was sent, submission.json, and
/// kept/RUN.json of runs whose job was deleted. Files are the truth, rows of jobs may be rebuilt;
/// what a call returned from survives a power cut. Every call may come from any thread. Throws
/// StorageError: disk_full, unwritable, io, corrupt.
class StudyStore {
 public:
  /// Reads what is there; what a submission cut short left is removed, and so is a folder without
  /// submission.json, which a removal cut short left. A study that cannot be read is a line in the
  /// log, and is passed over.
  explicit StudyStore(const std::filesystem::path& data, FileSystem& system = FileSystem::real());

  void add(const StudyRecord& record, std::string_view document);
  void set_made(const std::string& id);
  void remove(const std::string& id);

  [[nodiscard]] std::optional<StudyRecord> find(const std::string& id) const;
  [[nodiscard]] std::optional<StudyRecord> find_by_key(const std::string& key) const;
  /// Newest first; those before `after`, or from the newest when it is empty.
  [[nodiscard]] std::vector<StudyRecord> list(const std::string& after, std::size_t limit) const;
  /// Those whose jobs are not all made, oldest first.
  [[nodiscard]] std::vector<StudyRecord> unfinished() const;
  /// study.json, of at most the size of a body. corrupt: it is missing or no file.
  [[nodiscard]] std::string document(const std::string& id) const;
  [[nodiscard]] std::optional<KeptRun> kept_run(const std::string& id,
                                                const std::string& run) const;

 private:
  [[nodiscard]] std::filesystem::path folder(const std::string& id) const { return root_ / id; }
  void read_all();
  void read_folder(const std::filesystem::path& path);
  void write(const StudyRecord& record) const;

  std::filesystem::path root_;
  FileSystem* system_;
  mutable std::mutex mutex_;  ///< guards records_
  std::map<std::string, StudyRecord> records_;
};

/// Keeps what a run came to in the folder of its study, before its job is deleted. Does nothing
/// when there is no such study.
void keep_run(const std::filesystem::path& data, const std::string& study, const std::string& run,
              const KeptRun& kept);

}  // namespace sluice
