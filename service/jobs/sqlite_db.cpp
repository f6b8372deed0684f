#include "service/jobs/sqlite_db.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <array>
#include <cerrno>
#include <utility>

#include "service/jobs/job_store.hpp"

namespace sluice {
namespace {

using Fault = JobStoreError::Fault;

constexpr int kBusyMilliseconds = 5000;

/// SQLite knows only ENOSPC as a full disk.
bool says_full(int system_error) {
  return system_error == ENOSPC || system_error == EDQUOT || system_error == EFBIG;
}

struct Meaning {
  Fault fault;
  std::string_view advice;
};

Meaning meaning_of(int result, int system_error) {
  const int kind = result & 0xff;
  if (kind == SQLITE_FULL || (kind == SQLITE_IOERR && says_full(system_error))) {
    return {Fault::disk_full, "make room on its disk"};
  }
  switch (kind) {
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return {Fault::damaged, "stop the service and make the file anew with --rebuild"};
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return {Fault::io, "another program has it open: end that one and try again"};
    case SQLITE_CANTOPEN:
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return {Fault::io, "make the data folder and its files writable for the service's user"};
    case SQLITE_CONSTRAINT:
      return {Fault::conflict, "this breaks a rule of its tables; nothing was written"};
    default:
      return {Fault::io, "see the system's log for trouble with its disk"};
  }
}

/// Absolute, so that it is never taken for a URI or a name like ":memory:". SQLITE_OPEN_NOFOLLOW
/// refuses links in all of a path, but only the file itself must be none: systemd keeps the folders
/// of services behind a link, and so may anybody whose data are on another disk.
std::string name_for_sqlite(const std::filesystem::path& path) {
  const std::filesystem::path whole = std::filesystem::absolute(path).lexically_normal();
  std::error_code missing;
  const std::filesystem::path folder = std::filesystem::canonical(whole.parent_path(), missing);
  return (missing ? whole : folder / whole.filename()).string();
}

}  // namespace

SqliteDb::SqliteDb(std::filesystem::path path) : path_(std::move(path)) {
  // One thread at a time is the caller's promise, so SQLite needs no locks of its own.
  const int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX |
                    SQLITE_OPEN_NOFOLLOW | SQLITE_OPEN_EXRESCODE;
  const std::string name = name_for_sqlite(path_);
  const int result = ::sqlite3_open_v2(name.c_str(), &handle_, flags, nullptr);
  if (result != SQLITE_OK) {
    try {
      fail(result);
    } catch (...) {
      ::sqlite3_close(handle_);
      throw;
    }
  }
  ::sqlite3_busy_timeout(handle_, kBusyMilliseconds);
  ::sqlite3_db_config(handle_, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  ::sqlite3_db_config(handle_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  ::sqlite3_db_config(handle_, SQLITE_DBCONFIG_ENABLE_FKEY, 1, nullptr);
}

SqliteDb::~SqliteDb() { ::sqlite3_close(handle_); }

void SqliteDb::fail(int result) {
  const int system_error = handle_ == nullptr ? 0 : ::sqlite3_system_errno(handle_);
  const Meaning meaning = meaning_of(result, system_error);
  found_damage_ = found_damage_ || meaning.fault == Fault::damaged;
  const char* text = handle_ == nullptr ? ::sqlite3_errstr(result) : ::sqlite3_errmsg(handle_);
  throw JobStoreError(meaning.fault,
                      fmt::format("{}: {}; {}", path_.string(), text, meaning.advice));
}

void SqliteDb::execute(const std::string& sql) {
  const int result = ::sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr);
  if (result != SQLITE_OK) fail(result);
}

std::int64_t SqliteDb::number(std::string_view sql) {
  SqliteStatement statement(*this, sql);
  return statement.step() ? statement.integer(0) : 0;
}

std::string SqliteDb::text(std::string_view sql) {
  SqliteStatement statement(*this, sql);
  return statement.step() ? statement.text(0) : std::string();
}

std::int64_t SqliteDb::changes() const { return ::sqlite3_changes64(handle_); }
std::int64_t SqliteDb::last_row() const { return ::sqlite3_last_insert_rowid(handle_); }
std::optional<std::uint32_t> SqliteDb::change_count() {
  constexpr int kOffset = 24;  // of the file format
  sqlite3_file* file = nullptr;
  if (::sqlite3_file_control(handle_, "main", SQLITE_FCNTL_FILE_POINTER, &file) != SQLITE_OK) {
    return std::nullopt;
  }
  if (file == nullptr || file->pMethods == nullptr) return std::nullopt;
  std::array<unsigned char, 4> bytes{};
  const int result = file->pMethods->xRead(file, bytes.data(), bytes.size(), kOffset);
  if (result != SQLITE_OK && result != SQLITE_IOERR_SHORT_READ) return std::nullopt;
  std::uint32_t count = 0;
  for (const unsigned char byte : bytes) count = count << 8U | byte;
  return count;
}

bool SqliteDb::in_transaction() const { return ::sqlite3_get_autocommit(handle_) == 0; }

SqliteStatement::SqliteStatement(SqliteDb& db, std::string_view sql) : db_(db) {
  const int result = ::sqlite3_prepare_v2(db_.handle_, sql.data(), static_cast<int>(sql.size()),
                                          &handle_, nullptr);
  if (result != SQLITE_OK) db_.fail(result);
}

SqliteStatement::~SqliteStatement() { ::sqlite3_finalize(handle_); }

void SqliteStatement::bind(std::string_view text) {
  // Null would be bound for a view that points nowhere.
  const char* start = text.data() == nullptr ? "" : text.data();
  const int result = ::sqlite3_bind_text64(handle_, next_parameter_++, start, text.size(),
                                           SQLITE_TRANSIENT, SQLITE_UTF8);
  if (result != SQLITE_OK) db_.fail(result);
}

void SqliteStatement::bind(double value) {
  const int result = ::sqlite3_bind_double(handle_, next_parameter_++, value);
  if (result != SQLITE_OK) db_.fail(result);
}

void SqliteStatement::bind_integer(std::int64_t value) {
  const int result = ::sqlite3_bind_int64(handle_, next_parameter_++, value);
  if (result != SQLITE_OK) db_.fail(result);
}

bool SqliteStatement::step() {
  const int result = ::sqlite3_step(handle_);
  if (result == SQLITE_ROW) return true;
  if (result != SQLITE_DONE) db_.fail(result);
  return false;
}

void SqliteStatement::run() {
  while (step()) {
  }
}

std::string SqliteStatement::text(int column) const {
  const auto* start = ::sqlite3_column_text(handle_, column);
  const auto size = static_cast<std::size_t>(::sqlite3_column_bytes(handle_, column));
  return start == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(start), size);
}

std::int64_t SqliteStatement::integer(int column) const {
  return ::sqlite3_column_int64(handle_, column);
}

double SqliteStatement::real(int column) const { return ::sqlite3_column_double(handle_, column); }

SqliteTransaction::SqliteTransaction(SqliteDb& db) : db_(db) {
  db_.execute("BEGIN IMMEDIATE");
  before_ = db_.change_count();
}

SqliteTransaction::~SqliteTransaction() {
  if (!db_.in_transaction()) return;
  try {
    db_.execute("ROLLBACK");
  } catch (const JobStoreError&) {
    // SQLite rolls back from the journal at the next use; the reason is on its way already.
  }
}

void SqliteTransaction::commit() {
  try {
    return db_.execute("COMMIT");
  } catch (const JobStoreError& error) {
    if (db_.in_transaction() || !took_effect(error)) throw;
  }
  make_it_last();
}

bool SqliteTransaction::took_effect(const JobStoreError& error) {
  constexpr int kMostReads = 3;
  for (int n = 0; before_ && n < kMostReads; ++n) {
    try {
      // Whatever must be rolled back is, before anything can be read.
      static_cast<void>(db_.number("SELECT count(*) FROM sqlite_schema"));
    } catch (const JobStoreError&) {
      continue;
    }
    if (const auto after = db_.change_count()) return *after != *before_;
  }
  throw JobStoreError(Fault::uncertain,
                      fmt::format("{}; whether the change was made cannot be read now: look again "
                                  "when the disk is well",
                                  error.what()));
}

/// A commit more brings what the last one left in the system's memory to the disk. Should that fail
/// too, the change is made all the same; only a power cut could take it back.
void SqliteTransaction::make_it_last() {
  try {
    db_.execute(fmt::format("PRAGMA user_version = {}", db_.number("PRAGMA user_version")));
  } catch (const JobStoreError&) {
  }
}

}  // namespace sluice
