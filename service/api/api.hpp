#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string_view>

#include "service/http/message.hpp"
#include "service/jobs/job_store.hpp"
#include "service/scheduler/scheduler.hpp"

namespace sluice {

struct ApiContext;

/// All routes (schemas/openapi.json). Knows no sockets; every error is problem+json (RFC 9457) and
/// none leaves as an exception. May be called from any thread.
class Api {
 public:
  /// `program`: `sluice`, which makes reports.
  Api(JobStore& store, Scheduler& scheduler, std::filesystem::path data,
      std::filesystem::path program = "/proc/self/exe");
  ~Api();
  Api(const Api&) = delete;
  Api& operator=(const Api&) = delete;

  [[nodiscard]] Response handle(const Request& request);
  /// While draining, changing requests are answered 503 and /readyz says so; waiting requests
  /// return and event streams end within a second.
  void set_draining();
  /// Counts an answered request for /metrics, with what the HTTP layer refused itself.
  void count_request(std::string_view method, int status, std::chrono::duration<double> took);

 private:
  std::unique_ptr<ApiContext> context_;
};

}  // namespace sluice
