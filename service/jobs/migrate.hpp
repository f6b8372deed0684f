#pragma once

#include "service/jobs/data_lock.hpp"
#include "service/jobs/sqlite_db.hpp"

namespace sluice {

/// Brings DATA/jobs.sqlite to this program's version, one transaction per step, and sets how it is
/// written. After an unclean stop the file is checked first. Throws JobStoreError: newer_version
/// and damaged leave the file as it is; disk_full, io.
void prepare_database(SqliteDb& db, LastStop last_stop);

/// The version of the tables that this program works with.
[[nodiscard]] std::int64_t newest_database_version();

}  // namespace sluice
