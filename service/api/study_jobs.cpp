#include "service/api/study_jobs.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "engine/scene/filling/initial.hpp"
#include "engine/store/disk/errors.hpp"
#include "service/api/submission.hpp"
#include "service/http/problem.hpp"
#include "service/jobs/admission.hpp"
#include "service/jobs/job_ids.hpp"
#include "service/jobs/service_log.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

/// Regions that overlap show only when they are filled. What goes beyond is left to the workers.
constexpr std::uint64_t kMostTried = 200'000;

[[noreturn]] void refuse_study(const std::vector<Problem>& problems) {
  refuse(ProblemType::invalid_study, "the whole study", problems);
}

void check_limits(const StudyPlan& plan, const ServiceLimits& limits) {
  Json errors = Json::array();
  const int threads = plan.study.threads;
  if (threads > thread_limit(limits)) {
    errors.push_back(
        {{"limit", "threads"},
         {"value", threads},
         {"allowed", thread_limit(limits)},
         {"pointer", "/threads"},
         {"detail", fmt::format("is {}, this service has {}", threads, thread_limit(limits))}});
  }
  for (const StudyRun& run : plan.runs) {
    for (Json& error : broken_limits(estimate(run.scene), limits)) {
      error["detail"] = fmt::format("run {}", run.name);
      errors.push_back(std::move(error));
    }
  }
  if (errors.empty()) return;
  const Json first = errors.front();
  const std::string who = first.contains("pointer") ? "each run" : first["detail"];
  throw ApiError(ProblemType::over_limit,
                 fmt::format("{} needs {} = {}, this service allows {}", who,
                             first["limit"].get<std::string>(), first["value"].dump(),
                             first["allowed"].dump()),
                 {{"errors", std::move(errors)}});
}

void check_overlap(const StudyPlan& plan) {
  std::uint64_t particles = 0;
  for (const StudyRun& run : plan.runs) {
    const Estimate size = estimate(run.scene);
    particles += size.fluid_particles + size.wall_particles;
    if (particles > kMostTried) return;
    if (const auto problem = problem_when_filled(run.scene)) {
      refuse_study(
          {{"", fmt::format("run {}: {}: {}", run.name, problem->pointer, problem->message)}});
    }
  }
}

Job job_of(const StudyRecord& study, const StudyRun& run, int threads, std::string id) {
  Job job;
  job.id = std::move(id);
  job.label = study.id;
  job.priority = study.priority;
  job.threads = threads;
  job.created_ms = unix_time_ms();
  describe_scene(job, run.scene, estimate(run.scene));  // whose name is the run's
  return job;
}

/// A study is one document: no file comes with it.
SceneParts parts_of_studies() {
  return [](const std::string&) {
    return ScenePart{{},
                     {},
                     "a study on a service has no files; run it with sluice study, which "
                     "reads them beside it"};
  };
}

}  // namespace

StudyPlan admit_study(std::string_view text, const ServiceLimits& limits) {
  StudyPlan plan =
      plan_study(text, {}, limits.runs_per_study, SceneOrigin::user, parts_of_studies());
  if (!plan.problems.empty()) refuse_study(plan.problems);
  check_limits(plan, limits);
  check_overlap(plan);
  return plan;
}

StudyPlan plan_of_study(const StudyStore& studies, const StudyRecord& study) {
  StudyPlan plan = plan_study(studies.document(study.id), {}, kMaxStudyRuns, SceneOrigin::study,
                              parts_of_studies());
  if (plan.problems.empty()) return plan;
  const Problem& problem = plan.problems.front();
  throw StorageError(
      StorageFault::corrupt,
      fmt::format("study {}: its study.json is damaged: {}{}{}", study.id, problem.pointer,
                  problem.pointer.empty() ? "" : ": ", problem.message));
}

std::map<std::string, Job> jobs_of_study(const JobStore& store, const StudyRecord& study) {
  JobFilter filter;
  filter.label = study.id;
  filter.limit = study.runs + 1;
  std::map<std::string, Job> jobs;
  for (Job& job : store.list(filter)) {
    std::string name = job.name;
    jobs.emplace(std::move(name), std::move(job));
  }
  return jobs;
}

void make_study_jobs(ApiContext& context, const StudyRecord& study, const StudyPlan& plan) {
  const auto present = jobs_of_study(context.store, study);
  std::vector<Job> jobs;
  std::vector<NewFolder> folders;
  for (const StudyRun& run : plan.runs) {
    if (present.contains(run.name)) continue;
    jobs.push_back(job_of(study, run, plan.study.threads, context.store.new_id()));
    const Job& job = jobs.back();
    folders.emplace_back(context.paths(job.id), run.scene_text,
                         JobFile{job.label, job.priority, job.threads, job.created_ms, "", "", {}});
  }
  keeping_if_uncertain(folders, [&] {
    return context.store.submit_all(jobs, context.scheduler.limits().queued_jobs);
  });
  keep(folders);
  try {
    context.studies.set_made(study.id);
  } catch (const StorageError& error) {
    // The jobs are there; the next start notes it.
    log_line({{"event", "study_unfinished"}, {"study", study.id}, {"message", error.what()}});
  }
  context.scheduler.poke();
}

void finish_studies(ApiContext& context) {
  for (const StudyRecord& study : context.studies.unfinished()) {
    try {
      make_study_jobs(context, study, plan_of_study(context.studies, study));
    } catch (const std::exception& error) {
      // The study stays as it is, and the next start tries again.
      log_line({{"event", "study_unfinished"}, {"study", study.id}, {"message", error.what()}});
    }
  }
}

}  // namespace sluice
