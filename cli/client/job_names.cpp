#include "cli/client/job_names.hpp"

#include <fmt/format.h>

#include <vector>

#include "cli/json_text.hpp"
#include "cli/verbs.hpp"
#include "service/jobs/job_ids.hpp"

namespace sluice {
namespace {

constexpr std::size_t kIdLength = 21;
constexpr std::size_t kCandidates = 5;  // that a message names
constexpr std::string_view kLast = "last";

/// Jobs or studies, as the service lists them, newest first.
struct Listing {
  char letter;
  const char* target;
  const char* key;
  const char* one;
};
constexpr Listing kJobs{'j', "/v1/jobs", "jobs", "job"};
constexpr Listing kStudies{'s', "/v1/studies", "studies", "study"};

bool begins_an_id(const Listing& listing, const std::string& word) {
  return word.size() < kIdLength && word.starts_with(listing.letter) &&
         is_job_id("j" + word.substr(1) + std::string(kIdLength - word.size(), '0'));
}

/// The newest ids before `cursor`, at most one more than a message names.
std::vector<std::string> ids_before(ServiceClient& service, const Listing& listing,
                                    const std::string& cursor, const Patience& patience) {
  HttpRequest request;
  request.target = fmt::format("{}?limit={}{}", listing.target, kCandidates + 1,
                               cursor.empty() ? "" : "&cursor=" + cursor);
  const auto page = service.object_of(service.ask_patiently(request, patience));
  std::vector<std::string> ids;
  for (const auto& each : member(page, listing.key)) ids.push_back(text_at(each, "id"));
  return ids;
}

[[noreturn]] void end_unknown(const Listing& listing, const std::string& what) {
  throw CommandEnd(ClientExit::not_found,
                   fmt::format("there is no {}{}: see sluice list", listing.one, what));
}

std::string newest(ServiceClient& service, const Listing& listing, const Patience& patience) {
  const auto ids = ids_before(service, listing, "", patience);
  if (ids.empty()) end_unknown(listing, " yet");
  return ids.front();
}

std::string beginning_with(ServiceClient& service, const Listing& listing, const std::string& word,
                           const Patience& patience) {
  // Ids that begin so come right before the last one that could.
  const std::string highest = word + std::string(kIdLength - word.size(), 'v');
  auto ids = ids_before(service, listing, highest, patience);
  std::erase_if(ids, [&](const std::string& id) { return !id.starts_with(word); });
  if (ids.empty()) end_unknown(listing, fmt::format(" whose id begins with {}", word));
  if (ids.size() == 1) return ids.front();
  const bool more = ids.size() > kCandidates;
  if (more) ids.pop_back();
  throw CommandEnd(ExitCode::usage,
                   fmt::format("{} begins the ids of several: {}{}; write more of one", word,
                               fmt::join(ids, ", "), more ? ", ..." : ""));
}

std::string named(ServiceClient& service, const Listing& listing, const std::string& word,
                  const Patience& patience) {
  if (word == kLast) return newest(service, listing, patience);
  if (begins_an_id(listing, word)) return beginning_with(service, listing, word, patience);
  return word;
}

Patience no_patience() {
  return {0.0, [](const std::string&) {},
          "start one with sluice serve --data DIR, or name its address with --server"};
}

}  // namespace

std::string job_named(ServiceClient& service, const std::string& word) {
  return job_named(service, word, no_patience());
}

std::string job_named(ServiceClient& service, const std::string& word, const Patience& patience) {
  return named(service, kJobs, word, patience);
}

std::string study_named(ServiceClient& service, const std::string& word) {
  return named(service, kStudies, word, no_patience());
}

std::string job_or_study_named(ServiceClient& service, const std::string& word) {
  return named(service, word.starts_with(kStudies.letter) ? kStudies : kJobs, word, no_patience());
}

}  // namespace sluice
