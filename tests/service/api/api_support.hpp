#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "engine/store/files/series.hpp"
#include "service/api/api.hpp"
#include "tests/service/scheduler/scheduler_support.hpp"
#include "tests/store/pressure_series.hpp"

namespace sluice::test {

/// "/path?a=b" with a method, a body and headers as a request.
[[nodiscard]] Request request(std::string_view method, std::string_view target,
                              std::string_view body = "",
                              std::map<std::string, std::string> headers = {});

/// The interface without sockets over a data folder of its own. Its scheduler starts nothing, so
/// that jobs stay as a test puts them.
class Service {
 public:
  explicit Service(const ServiceLimits& limits = limits_for_scripts());

  Response ask(std::string_view method, std::string_view target, std::string_view body = "",
               std::map<std::string, std::string> headers = {});
  Response get(std::string_view target) { return ask("GET", target); }
  Response post(std::string_view target, std::string_view body = "") {
    return ask("POST", target, body);
  }
  /// Submits a tiny scene and returns its id.
  std::string submit(std::string_view query = "");
  /// Submits one and brings it to this state.
  std::string submit_in(JobState state);
  /// Writes the samples of a job's sensor P1.
  void write_samples(const std::string& id, const Series& series);

  DataFolder data;
  JobStore store;
  Scheduler scheduler;
  Api api;
};

[[nodiscard]] nlohmann::json body_of(const Response& response);
/// The array under this key of the body.
[[nodiscard]] nlohmann::json list_in(const Response& response, std::string_view key);
[[nodiscard]] std::string header_of(const Response& response, std::string_view name);

/// Expects a problem of this type, with what RFC 9457 and the table of problems say.
void expect_problem(const Response& response, int status, std::string_view slug);

/// Expects row and folder of every job to be both there, and its scene to end where the row says.
void expect_agreement(Service& service);

}  // namespace sluice::test
