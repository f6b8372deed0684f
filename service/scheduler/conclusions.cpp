#include "service/scheduler/conclusions.hpp"

#include <fmt/format.h>

#include <utility>

#include "service/jobs/service_log.hpp"

namespace sluice {
namespace {

bool is_final(const JobStoreError& error) {
  return error.fault() == JobStoreError::Fault::conflict ||
         error.fault() == JobStoreError::Fault::not_found;
}

}  // namespace

void Conclusions::conclude(const Job& job, AttemptVerdict verdict, double now) {
  back_offs_.note(job.id, verdict.action == JobAction::requeue ? verdict.next : NextTry::at_once,
                  verdict.change.crashes.value_or(job.crashes), now);
  Conclusion conclusion{job, std::move(verdict)};
  if (!is_settled(conclusion)) waiting_.push_back(std::move(conclusion));
}

void Conclusions::retry() {
  std::erase_if(waiting_, [this](const Conclusion& waiting) { return is_settled(waiting); });
}

bool Conclusions::is_settled(const Conclusion& conclusion) {
  try {
    const AttemptVerdict& verdict = conclusion.verdict;
    store_.apply(conclusion.job.id, verdict.action, conclusion.job.token, verdict.change);
    return true;
  } catch (const JobStoreError& error) {
    log_scheduler(fmt::format("job {}: how its attempt ended is not kept{}: {}", conclusion.job.id,
                              is_final(error) ? "" : " yet", error.what()));
    return is_final(error);
  }
}

}  // namespace sluice
