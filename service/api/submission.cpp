#include "service/api/submission.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "engine/store/disk/sha256.hpp"
#include "engine/store/files/new_folder.hpp"
#include "service/http/http_head.hpp"
#include "service/http/problem.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLongestKey = 128;

}  // namespace

void require_json(const Request& request, std::string_view what) {
  const std::string_view type = request.header("content-type");
  const std::string media = lower(type.substr(0, type.find_first_of("; \t")));
  for (const std::string_view known :
       {"", "application/json", "application/x-www-form-urlencoded", "text/plain"}) {
    if (media == known) return;
  }
  throw ApiError(ProblemType::unsupported_media_type,
                 fmt::format("{} is JSON: send Content-Type: application/json", what));
}

std::string read_key(const Request& request) {
  const std::string_view key = request.header("idempotency-key");
  if (key.empty() && !request.headers.contains("idempotency-key")) return {};
  const bool plain = key.find_first_not_of(
                         "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789"
                         "-_.:+/=\"") == std::string_view::npos;
  if (!key.empty() && key.size() <= kLongestKey && plain) return std::string(key);
  throw ApiError(
      ProblemType::invalid_parameter,
      fmt::format("Idempotency-Key must be 1 to {} of A-Z a-z 0-9 - _ . : + / = \"", kLongestKey),
      {{"errors", Json::array({{{"parameter", "Idempotency-Key"},
                                {"detail", "is too long or has other characters"}}})}});
}

std::string request_hash(const Request& request, std::string_view rest) {
  Sha256 hash;
  hash.update(std::as_bytes(std::span(rest)));
  hash.update(std::as_bytes(std::span(request.body)));
  return hash.finish();
}

Response accepted_response(std::string location, const Json& document, bool repeated) {
  Response response = json_response(202, document);
  response.headers.emplace_back("Location", std::move(location));
  if (repeated) response.headers.emplace_back("Idempotency-Replayed", "true");
  return response;
}

NewFolder::NewFolder(const JobPaths& paths, std::string_view scene, const JobFile& file)
    : root_(paths.root()) {
  publish_job_folder(root_, scene,
                     {{job_file_path(root_).filename().string(), job_file_text(file)}});
}

NewFolder::NewFolder(NewFolder&& other) noexcept
    : root_(std::move(other.root_)), kept_(std::exchange(other.kept_, true)) {}

NewFolder::~NewFolder() {
  std::error_code ignored;
  if (!kept_) std::filesystem::remove_all(root_, ignored);
}

}  // namespace sluice
