#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "service/http/message.hpp"

namespace sluice {

/// Every kind of error that the service answers with. A kind is a stable `type` URI of RFC 9457,
/// /problems/<slug>, which can be fetched for its description.
enum class ProblemType {
  bad_request,
  invalid_parameter,
  unauthorized,
  forbidden_host,
  forbidden_origin,
  not_found,
  no_such_job,
  no_such_study,
  no_such_sensor,
  no_such_file,
  method_not_allowed,
  not_acceptable,
  request_timeout,
  wrong_state,
  no_samples_yet,
  not_dimensionless,
  body_too_large,
  uri_too_long,
  unsupported_media_type,
  range_not_satisfiable,
  invalid_scene,
  invalid_study,
  over_limit,
  key_reused,
  headers_too_large,
  internal,
  damaged_files,
  not_implemented,
  draining,
  queue_full,
  too_many_streams,
  overloaded,
  not_ready,
  disk_full,
};

/// One line of the table of problems.
struct ProblemEntry {
  ProblemType type;
  int status;
  std::string_view slug;
  std::string_view title;
  std::string_view advice;  ///< what the caller can do
};

[[nodiscard]] std::span<const ProblemEntry> all_problems();
[[nodiscard]] const ProblemEntry& problem_entry(ProblemType type);

using ProblemFields = nlohmann::ordered_json;

/// application/problem+json: type, title, status, detail and the members of `fields`, which is an
/// object. Bytes that are no UTF-8 are replaced.
[[nodiscard]] Response problem_response(ProblemType type, std::string_view detail,
                                        const ProblemFields& fields = ProblemFields::object());

/// A handler's way out: becomes the problem's response.
class ApiError : public std::runtime_error {
 public:
  ApiError(ProblemType type, const std::string& detail,
           ProblemFields fields = ProblemFields::object())
      : std::runtime_error(detail), type_(type), fields_(std::move(fields)) {}
  [[nodiscard]] ProblemType type() const { return type_; }
  [[nodiscard]] const ProblemFields& fields() const { return fields_; }

 private:
  ProblemType type_;
  ProblemFields fields_;
};

/// A message without the place of the data folder, which is nobody's business but the
/// administrator's.
[[nodiscard]] std::string without_place(std::string text, const std::filesystem::path& data);

/// A text of this media type as a response.
[[nodiscard]] Response text_response(std::string body, std::string_view type);
/// A JSON value as a response.
[[nodiscard]] Response json_response(int status, const nlohmann::ordered_json& value);

}  // namespace sluice
