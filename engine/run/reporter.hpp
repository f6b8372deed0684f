#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "engine/run/guards.hpp"
#include "engine/run/progress.hpp"

namespace sluice {

struct RunEvent;

/// Who hears how a run goes. Reporting never fails a run: a reader who went away is ignored.
class Reporter {
 public:
  virtual ~Reporter() = default;
  /// About once a second.
  virtual void progress(const Progress& progress) = 0;
  virtual void event(const RunEvent& event) = 0;
};

/// One JSON object per line: {"event": name, ...}. The service reads these.
class JsonReporter final : public Reporter {
 public:
  explicit JsonReporter(std::FILE* out) : out_(out) {}
  void progress(const Progress& progress) override;
  void event(const RunEvent& event) override;

 private:
  std::FILE* out_;
};

/// The last line of a terminal, which is written over again and again.
class StatusLine {
 public:
  explicit StatusLine(std::FILE* out) : out_(out) {}
  /// Characters that fit.
  [[nodiscard]] std::size_t width() const;
  /// Cut to what fits. Must hold no control characters.
  void draw(std::string text);
  /// Makes room for a line that stays.
  void clear();

 private:
  std::FILE* out_;
  std::size_t drawn_ = 0;
};

/// A bar that redraws itself and a line for each event that a person wants to see.
class BarReporter final : public Reporter {
 public:
  explicit BarReporter(std::FILE* out) : out_(out), bar_(out) {}
  void progress(const Progress& progress) override;
  void event(const RunEvent& event) override;

 private:
  std::FILE* out_;
  StatusLine bar_;
};

class SilentReporter final : public Reporter {
 public:
  void progress(const Progress&) override {}
  void event(const RunEvent&) override {}
};

/// Passes everything on and appends all but progress to a log file with the time of day. The log is
/// the one file of a job that grows in place; a line that cannot be written is lost.
class LoggingReporter final : public Reporter {
 public:
  LoggingReporter(Reporter& next, std::filesystem::path log);
  void progress(const Progress& progress) override { next_->progress(progress); }
  void event(const RunEvent& event) override;

 private:
  Reporter* next_;
  std::filesystem::path log_;
};

[[nodiscard]] nlohmann::ordered_json to_json(const Progress& progress);
[[nodiscard]] nlohmann::ordered_json to_json(const Diagnosis& diagnosis);

}  // namespace sluice
