#pragma once

#include <string>
#include <string_view>

#include "cli/client/service_client.hpp"

namespace sluice {

/// A study that a service runs, or is to run.
struct ServiceStudy {
  ServiceOptions service;
  bool of_service = false;
  bool json = false;
  bool watch = false;
  std::string key;
};

/// Adds --server, --token-file, --watch and --idempotency-key.
void add_service_study_options(CLI::App& verb, ServiceStudy& options);

/// Submits a study's document, whose base scene stands in it, and prints its id and the commands
/// that come next; with `watch`, shows it until all its jobs have ended.
void submit_study(const ServiceStudy& options, std::string_view document,
                  const std::string& subject);

/// Prints the result so far of the study that `word` names (job_names.hpp).
void show_study(const ServiceStudy& options, const std::string& word);

/// "/v1/studies/<id>" and what follows it.
[[nodiscard]] std::string study_target(const std::string& id, std::string_view rest = "");

/// 128 random bits as an Idempotency-Key: no two submissions share it.
[[nodiscard]] std::string new_key();

}  // namespace sluice
