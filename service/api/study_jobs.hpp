#pragma once

#include <map>
#include <string>
#include <string_view>

#include "engine/study/study.hpp"
#include "service/api/api_context.hpp"

namespace sluice {

/// A study that this service takes, with every run's scene. Throws ApiError: invalid_study with
/// every problem as {pointer, detail}; over_limit with every limit that a run breaks. Runs that are
/// predicted to be unstable are taken: finding out is what a study is for.
[[nodiscard]] StudyPlan admit_study(std::string_view text, const ServiceLimits& limits);

/// The plan of a study that was taken. Throws StorageError(corrupt) when its study.json is damaged.
[[nodiscard]] StudyPlan plan_of_study(const StudyStore& studies, const StudyRecord& study);

/// The study's jobs by the names of their runs.
[[nodiscard]] std::map<std::string, Job> jobs_of_study(const JobStore& store,
                                                       const StudyRecord& study);

/// Makes the jobs that the study lacks: a folder for each, then all rows in one transaction, and
/// notes that it is made. Throws JobStoreError(full), StorageError.
void make_study_jobs(ApiContext& context, const StudyRecord& study, const StudyPlan& plan);

/// Does for every study what a crash left undone. One that cannot be made now is a line in the log,
/// and left for the next start.
void finish_studies(ApiContext& context);

}  // namespace sluice
