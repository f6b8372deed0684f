#include "service/jobs/migrate.hpp"

#include <fmt/format.h>

#include <iterator>
#include <string>

#include "service/jobs/job_store.hpp"
#include "sluice/migration_texts.hpp"

namespace sluice {
namespace {

using Fault = JobStoreError::Fault;

/// Marks the file as one of ours: "SLUC".
constexpr std::int64_t kApplicationId = 0x534c5543;

void require_ours(SqliteDb& db, std::int64_t version) {
  const bool empty = db.number("SELECT count(*) FROM sqlite_schema") == 0;
  if (empty && version == 0) return;
  if (db.number("PRAGMA application_id") != kApplicationId) {
    throw JobStoreError(Fault::damaged, fmt::format("{}: this is a data base of another program; "
                                                    "move it out of the data folder",
                                                    db.path().string()));
  }
  if (version > newest_database_version()) {
    throw JobStoreError(
        Fault::newer_version,
        fmt::format("{}: version {}, written by a newer program; this one knows versions up to {}: "
                    "install the newer one again",
                    db.path().string(), version, newest_database_version()));
  }
}

void require_whole(SqliteDb& db) {
  const std::string found = db.text("PRAGMA integrity_check(1)");
  const bool orphans = db.text("PRAGMA foreign_key_check") != "";
  if (found == "ok" && !orphans) return;
  throw JobStoreError(
      Fault::damaged,
      fmt::format("{}: damaged ({}); make it anew from the job folders with --rebuild",
                  db.path().string(), orphans ? "rows without their job" : found));
}

void migrate(SqliteDb& db, std::int64_t from) {
  for (std::int64_t version = from + 1; version <= newest_database_version(); ++version) {
    SqliteTransaction transaction(db);
    db.execute(std::string(kMigrationTexts[static_cast<std::size_t>(version - 1)].second));
    db.execute(fmt::format("PRAGMA application_id = {}", kApplicationId));
    db.execute(fmt::format("PRAGMA user_version = {}", version));
    transaction.commit();
  }
}

}  // namespace

std::int64_t newest_database_version() {
  return static_cast<std::int64_t>(std::size(kMigrationTexts));
}

void prepare_database(SqliteDb& db, LastStop last_stop) {
  const std::int64_t version = db.number("PRAGMA user_version");
  require_ours(db, version);
  // In simulated power cuts WAL lost every commit and DELETE with FULL the last. PERSIST ends a
  // commit by overwriting the journal's head, synced, where TRUNCATE changes the file's size and so
  // waits for the file system's own journal: a commit takes a third of the time.
  db.execute(
      "PRAGMA journal_mode = PERSIST; PRAGMA journal_size_limit = 1048576; "
      "PRAGMA synchronous = EXTRA");
  if (last_stop == LastStop::unclean) require_whole(db);
  migrate(db, version);
}

}  // namespace sluice
