#pragma once

#include <filesystem>
#include <string>

#include "cli/service_client.hpp"

namespace sluice {

/// What a report needs of a service's job, in a folder of its own as long as this lives: scene,
/// its series where there is one and, once an attempt has ended, its outcome.
class FetchedJob {
 public:
  /// Throws CommandEnd(not_found) when there is no such job.
  FetchedJob(ServiceClient& service, const std::string& id);
  ~FetchedJob();
  FetchedJob(const FetchedJob&) = delete;
  FetchedJob& operator=(const FetchedJob&) = delete;

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

}  // namespace sluice
