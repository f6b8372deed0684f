#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/client/service_client.hpp"

namespace sluice {

/// What a report needs of a service's job, in a folder of its own as long as this lives: scene,
/// its series where there is one and, once an attempt has ended, its outcome. Its snapshots are
/// many and large: they are empty files until they are asked for, so that their names tell which
/// ones a report shows.
class FetchedJob {
 public:
  /// Throws CommandEnd(not_found) when there is no such job.
  FetchedJob(ServiceClient& service, const std::string& id);
  ~FetchedJob();
  FetchedJob(const FetchedJob&) = delete;
  FetchedJob& operator=(const FetchedJob&) = delete;

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// Fetches these files of the folder. One that is no snapshot stays empty.
  void fetch_snapshots(ServiceClient& service, const std::vector<std::filesystem::path>& frames);

  /// A message with the job's id in place of the folder's name, which is nobody's business.
  [[nodiscard]] std::string in_users_words(std::string message) const;

 private:
  std::string id_;
  std::filesystem::path folder_;
};

}  // namespace sluice
