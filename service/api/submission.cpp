#include "service/api/submission.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

#include "engine/store/disk/sha256.hpp"
#include "engine/store/files/new_folder.hpp"
#include "service/http/http_head.hpp"
#include "service/http/multipart.hpp"
#include "service/http/problem.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLongestKey = 128;
constexpr std::string_view kSceneField = "scene";
constexpr const char* kHowToSendFiles =
    "; send it along as a part of a form: curl -F scene=@SCENE.json -F mesh=@FILE";

/// What a client calls a part, in which any byte may stand.
std::string shown_name(const std::string& name) {
  constexpr std::size_t kShown = 64;
  std::string text = name.substr(0, kShown);
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c > '~'; }, '?');
  return fmt::format("\"{}\"", text);
}

[[noreturn]] void refuse_submission(const std::string& why) {
  throw ApiError(ProblemType::bad_request, fmt::format("the form is no submission: {}", why));
}

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

SubmittedScene read_submission(const Request& request) {
  if (!is_form(request)) {
    require_json(request, "a scene");
    return {request.body, {}, parts_from({}, kHowToSendFiles)};
  }
  SubmittedScene result;
  std::optional<std::string> text;
  for (const FormPart& part : read_form(request)) {
    if (part.name == kSceneField) {
      if (text) refuse_submission("it has two parts of the name scene");
      text = part.bytes;
      continue;
    }
    const bool known =
        std::ranges::find(result.files, part.filename, &NamedPart::name) != result.files.end();
    if (part.filename.empty()) {
      refuse_submission(
          fmt::format("the part {} is no file; the scene is the part called scene, and all "
                      "others are files with their names",
                      shown_name(part.name)));
    }
    if (known)
      refuse_submission(fmt::format("it has two files called {}", shown_name(part.filename)));
    result.files.push_back({part.filename, std::string(part.bytes)});
  }
  if (!text) refuse_submission("it has no part called scene");
  result.text = *std::move(text);
  result.parts = parts_from(result.files, kHowToSendFiles);
  return result;
}

void require_named(const SubmittedScene& submitted, const std::vector<NamedPart>& named) {
  for (const NamedPart& file : submitted.files) {
    if (std::ranges::find(named, file.name, &NamedPart::name) != named.end()) continue;
    refuse_submission(fmt::format("no mesh of the scene names the file {}", shown_name(file.name)));
  }
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

std::string request_hash(const SubmittedScene& scene, std::string_view rest) {
  Request whole;
  whole.body = scene.text;
  if (scene.files.empty()) return request_hash(whole, rest);
  std::vector<NamedPart> files = scene.files;
  std::ranges::sort(files, {}, &NamedPart::name);
  std::string names(rest);
  for (const NamedPart& file : files) {
    names += fmt::format("{} {}\n", file.name, scene.parts(file.name).sha256);
  }
  return request_hash(whole, names);
}

Response accepted_response(std::string location, const Json& document, bool repeated) {
  Response response = json_response(202, document);
  response.headers.emplace_back("Location", std::move(location));
  if (repeated) response.headers.emplace_back("Idempotency-Replayed", "true");
  return response;
}

NewFolder::NewFolder(const JobPaths& paths, std::string_view scene, const JobFile& file,
                     const std::vector<NamedPart>& parts)
    : root_(paths.root()) {
  const std::string name = job_file_path(root_).filename().string();
  const std::string text = job_file_text(file);
  std::vector<FirstFile> more{{name, text}};
  for (const NamedPart& part : parts) more.push_back({part.name, part.bytes});
  publish_job_folder(root_, scene, more);
}

NewFolder::NewFolder(NewFolder&& other) noexcept
    : root_(std::move(other.root_)), kept_(std::exchange(other.kept_, true)) {}

NewFolder::~NewFolder() {
  std::error_code ignored;
  if (!kept_) std::filesystem::remove_all(root_, ignored);
}

}  // namespace sluice
