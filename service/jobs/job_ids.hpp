#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace sluice {

/// Makes job ids: "j", 10 characters of Unix time in ms, 10 random ones, all of [0-9a-v], most
/// significant first. Each sorts after all that this source made or was told of, even when the
/// clock stands still or is set back. Not for several threads at once.
class JobIds {
 public:
  /// The next id at the time `now_ms`.
  [[nodiscard]] std::string next(std::int64_t now_ms);
  /// Later ids sort after this one. Anything that is no id is passed over.
  void follow(std::string_view id);

 private:
  std::uint64_t time_ = 0;  ///< 50 bits
  std::uint64_t tail_ = 0;  ///< 50 bits
};

/// Whether a text has the form of an id: safe as the name of a folder.
[[nodiscard]] bool is_job_id(std::string_view text);
/// Whether a text has the form of a study's id: that of a job's, with an "s" in front.
[[nodiscard]] bool is_study_id(std::string_view text);
/// The study's id that a fresh job's id makes.
[[nodiscard]] std::string study_id_of(std::string_view job_id);
/// When the id was made, Unix time in ms; empty for what is no id.
[[nodiscard]] std::optional<std::int64_t> time_of_job_id(std::string_view id);

/// 128 random bits as 32 hexadecimal digits.
[[nodiscard]] std::string random_token();

/// Unix time, ms.
[[nodiscard]] std::int64_t unix_time_ms();

}  // namespace sluice
