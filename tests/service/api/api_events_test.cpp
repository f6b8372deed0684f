#include <vector>

#include "tests/service/api/api_support.hpp"

namespace sluice::test {
namespace {

/// All that a stream sends until it ends; the job must have ended or be about to.
std::string read_all(const Response& response) {
  std::string text;
  if (!response.stream) return text;
  for (bool more = true; more;) {
    std::string chunk;
    more = response.stream(chunk);
    text += chunk;
  }
  return text;
}

std::vector<std::string> names_in(const std::string& text) {
  std::vector<std::string> names;
  const std::string mark = "\nevent: ";
  for (std::size_t at = text.find(mark); at != text.npos; at = text.find(mark, at + 1)) {
    const std::size_t start = at + mark.size();
    names.push_back(text.substr(start, text.find('\n', start) - start));
  }
  return names;
}

TEST(ApiEvents, ReplaysTheHistoryOfAnEndedJobAndEnds) {
  Service service;
  const std::string id = service.submit_in(JobState::cancelled);
  const Response response = service.get("/v1/jobs/" + id + "/events");
  EXPECT_EQ(response.content_type, "text/event-stream");
  EXPECT_EQ(names_in(read_all(response)), (std::vector<std::string>{"submitted", "cancelled"}));
}

TEST(ApiEvents, GoesOnAfterTheEventThatTheClientSawLast) {
  Service service;
  const std::string id = service.submit_in(JobState::cancelled);
  const auto events = service.store.events(id, 0, 10);
  ASSERT_EQ(events.size(), 2U);
  const std::string target = "/v1/jobs/" + id + "/events";
  const auto after = [&](std::int64_t number) {
    return service.ask("GET", target, "", {{"last-event-id", std::to_string(number)}});
  };
  EXPECT_EQ(names_in(read_all(after(events[0].number))), std::vector<std::string>{"cancelled"});
  EXPECT_EQ(after(events[1].number).status, 204) << "tells an EventSource to stay away";
  expect_problem(service.ask("GET", target, "", {{"last-event-id", "-1"}}), 400,
                 "invalid-parameter");
  expect_problem(service.ask("GET", target, "", {{"last-event-id", "x"}}), 400,
                 "invalid-parameter");
}

TEST(ApiEvents, SendsProgressWithoutANumber) {
  Service service;
  const std::string id = service.submit_in(JobState::running);
  const Response response = service.get("/v1/jobs/" + id + "/events");
  std::string chunk;
  ASSERT_TRUE(response.stream(chunk));
  const Job job = service.store.find(id).value();
  service.store.record_progress(id, job.token, R"({"event":"progress","step":42})");
  chunk.clear();
  ASSERT_TRUE(response.stream(chunk));
  EXPECT_EQ(chunk, "event: progress\ndata: {\"step\":42}\n\n");
}

TEST(ApiEvents, ProgressNeverFollowsTheEnd) {
  Service service;
  const std::string id = service.submit_in(JobState::running);
  const Response response = service.get("/v1/jobs/" + id + "/events");
  std::string chunk;
  ASSERT_TRUE(response.stream(chunk));
  const Job job = service.store.find(id).value();
  service.store.record_progress(id, job.token, R"({"event":"progress","step":42})");
  (void)service.store.apply(id, JobAction::complete, job.token, {});
  EXPECT_EQ(names_in("\n" + read_all(response)),
            (std::vector<std::string>{"progress", "completed"}));
}

TEST(ApiEvents, RefusesMoreStreamsThanThereArePlacesAndFreesThem) {
  Service service;
  const std::string target = "/v1/jobs/" + service.submit() + "/events";
  std::vector<Response> open;
  for (int n = 0; n < 16; ++n) open.push_back(service.get(target));
  for (const Response& response : open) EXPECT_EQ(response.status, 200);
  expect_problem(service.get(target), 503, "too-many-streams");
  open.pop_back();
  EXPECT_EQ(service.get(target).status, 200);
}

TEST(ApiEvents, EndWhenTheServiceStops) {
  Service service;
  const std::string target = "/v1/jobs/" + service.submit() + "/events";
  const Response response = service.get(target);
  service.api.set_draining();
  EXPECT_EQ(read_all(response), "");
  expect_problem(service.get(target), 503, "draining");
}

}  // namespace
}  // namespace sluice::test
