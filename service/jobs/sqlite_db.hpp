#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

// The handles of SQLite; its header stays in sqlite_db.cpp.
struct sqlite3;
struct sqlite3_stmt;

namespace sluice {

class JobStoreError;

/// A SQLite file. For one thread at a time. Everything here throws JobStoreError: disk_full,
/// damaged, io, with the path in the message.
class SqliteDb {
 public:
  /// Opens or creates the file. It waits up to 5 s for another program that reads it, such as a
  /// backup. Nothing is read or changed before the first statement.
  explicit SqliteDb(std::filesystem::path path);
  SqliteDb(const SqliteDb&) = delete;
  SqliteDb& operator=(const SqliteDb&) = delete;
  ~SqliteDb();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Runs statements whose rows nobody wants, separated by semicolons.
  void execute(const std::string& sql);
  /// The first column of the only row.
  [[nodiscard]] std::int64_t number(std::string_view sql);
  [[nodiscard]] std::string text(std::string_view sql);
  /// Rows that the last INSERT, UPDATE or DELETE changed.
  [[nodiscard]] std::int64_t changes() const;
  /// Number of the last row inserted.
  [[nodiscard]] std::int64_t last_row() const;
  [[nodiscard]] bool in_transaction() const;
  /// A number in the file's head that every committed transaction makes greater; nothing where it
  /// cannot be read.
  [[nodiscard]] std::optional<std::uint32_t> change_count();
  /// Whether any call so far met damage.
  [[nodiscard]] bool found_damage() const { return found_damage_; }

 private:
  friend class SqliteStatement;
  /// Throws for the result of a call that did not succeed.
  [[noreturn]] void fail(int result);

  std::filesystem::path path_;
  sqlite3* handle_ = nullptr;
  bool found_damage_ = false;
};

/// A prepared statement with its parameters ?1, ?2, ... and the row that it stands on.
class SqliteStatement {
 public:
  template <class... Values>
  SqliteStatement(SqliteDb& db, std::string_view sql, const Values&... values)
      : SqliteStatement(db, sql) {
    (bind(values), ...);
  }
  SqliteStatement(SqliteDb& db, std::string_view sql);
  SqliteStatement(const SqliteStatement&) = delete;
  SqliteStatement& operator=(const SqliteStatement&) = delete;
  ~SqliteStatement();

  // Each gives the next parameter.
  void bind(std::string_view text);
  void bind(double value);
  void bind(std::integral auto value) { bind_integer(static_cast<std::int64_t>(value)); }

  /// Goes to the next row; false after the last.
  [[nodiscard]] bool step();
  /// Runs it to its end.
  void run();

  // Of the row; columns count from 0.
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] double real(int column) const;

 private:
  void bind_integer(std::int64_t value);

  SqliteDb& db_;
  sqlite3_stmt* handle_ = nullptr;
  int next_parameter_ = 1;
};

/// A write transaction, undone at the end of its life unless it was committed.
class SqliteTransaction {
 public:
  explicit SqliteTransaction(SqliteDb& db);
  SqliteTransaction(const SqliteTransaction&) = delete;
  SqliteTransaction& operator=(const SqliteTransaction&) = delete;
  ~SqliteTransaction();
  /// When it returns, all that was written survives a power cut. When it throws, nothing was
  /// written: where the disk fails after the point from which SQLite counts a transaction as
  /// committed, COMMIT reports an error and is done all the same, so the file is asked. Where that
  /// cannot be read either, it throws `uncertain`.
  void commit();

 private:
  [[nodiscard]] bool took_effect(const JobStoreError& error);
  void make_it_last();

  SqliteDb& db_;
  std::optional<std::uint32_t> before_;
};

}  // namespace sluice
