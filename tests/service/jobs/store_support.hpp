#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "service/jobs/job_store.hpp"

namespace sluice::test {

/// A data folder of its own, removed with all in it at the end of its life.
class DataFolder {
 public:
  DataFolder();
  DataFolder(const DataFolder&) = delete;
  DataFolder& operator=(const DataFolder&) = delete;
  ~DataFolder();
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path database() const { return path_ / "jobs.sqlite"; }
  [[nodiscard]] std::filesystem::path job(const std::string& id) const {
    return path_ / "jobs" / id;
  }

 private:
  std::filesystem::path path_;
};

/// A job as the api submits it, with every member filled that a submission may fill.
[[nodiscard]] Job a_job(int priority = 0, int threads = 1);
/// Submits one without a key and returns it.
Job add_job(JobStore& store, int priority = 0, int threads = 1);
/// Adds one and brings it to that state; `pending` for running ones.
Job add_job_in(JobStore& store, JobState state, PendingStop pending = PendingStop::none);

/// All members equal.
[[nodiscard]] bool same(const Job& a, const Job& b);
/// The names of all events of a job, joined by a blank.
[[nodiscard]] std::string history(const JobStore& store, const std::string& id);

/// Runs `action`, expects a JobStoreError of that fault and returns its message.
template <class Action>
std::string expect_refusal(JobStoreError::Fault fault, const Action& action) {
  try {
    action();
  } catch (const JobStoreError& error) {
    EXPECT_EQ(static_cast<int>(error.fault()), static_cast<int>(fault)) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error where fault " << static_cast<int>(fault) << " is expected";
  return {};
}

}  // namespace sluice::test
