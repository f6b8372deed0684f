#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/store/files/job_folder.hpp"
#include "engine/store/files/scene_parts.hpp"
#include "service/http/message.hpp"
#include "service/jobs/job_file.hpp"
#include "service/jobs/job_store.hpp"

namespace sluice {

/// curl --data sends a form's type; a body without a type is taken as what it is. Throws
/// ApiError(unsupported_media_type); `what` is what the body should be, such as "a scene".
void require_json(const Request& request, std::string_view what);

/// A scene as it was submitted, with the files that it names.
struct SubmittedScene {
  std::string text;
  std::vector<NamedPart> files;
  SceneParts parts = no_parts;  ///< gives those files
};

/// The body as a scene; or, of a form, the field `scene` as one and every other part as a file by
/// its name. Throws ApiError: unsupported_media_type, bad_request.
[[nodiscard]] SubmittedScene read_submission(const Request& request);

/// Throws ApiError(bad_request) for a file that the scene does not name: it may be misspelt there.
void require_named(const SubmittedScene& submitted, const std::vector<NamedPart>& named);

/// The Idempotency-Key; empty when there is none. Throws ApiError(invalid_parameter).
[[nodiscard]] std::string read_key(const Request& request);

/// Tells requests with one key apart: SHA-256 of the body and of all else that makes a difference.
[[nodiscard]] std::string request_hash(const Request& request, std::string_view rest);
/// The same of a scene with its files, however the form was written.
[[nodiscard]] std::string request_hash(const SubmittedScene& scene, std::string_view rest);

/// 202 with what was made and where it is. `repeated`: by an earlier request with the same key.
[[nodiscard]] Response accepted_response(std::string location,
                                         const nlohmann::ordered_json& document, bool repeated);

/// A job's folder that goes away again unless the job gets its row.
class NewFolder {
 public:
  NewFolder(const JobPaths& paths, std::string_view scene, const JobFile& file,
            const std::vector<NamedPart>& parts = {});
  NewFolder(NewFolder&& other) noexcept;
  NewFolder& operator=(NewFolder&&) = delete;
  ~NewFolder();
  void keep() { kept_ = true; }

 private:
  std::filesystem::path root_;
  bool kept_ = false;
};

inline void keep(NewFolder& folder) { folder.keep(); }
inline void keep(std::vector<NewFolder>& folders) {
  for (NewFolder& folder : folders) folder.keep();
}

/// Makes the rows of a folder, or of several. Where nobody can tell whether they were made, the
/// folders stay: the next start gives them rows.
template <class Folders, class Action>
auto keeping_if_uncertain(Folders& folders, const Action& make_rows) {
  try {
    return make_rows();
  } catch (const JobStoreError& error) {
    if (error.fault() == JobStoreError::Fault::uncertain) keep(folders);
    throw;
  }
}

}  // namespace sluice
