#pragma once

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/client/watch.hpp"
#include "engine/run/reporter.hpp"
#include "engine/run/stopwatch.hpp"

namespace sluice {

/// Shows what changed about a job since it was last shown.
class WatchView {
 public:
  /// `form` is not automatic.
  WatchView(WatchForm form, double interval, std::FILE* out);

  void show(const nlohmann::ordered_json& job, const std::string& body);
  /// A line about the watching itself, on stderr.
  void say(const std::string& line);
  /// Lines that end it.
  void close_with(const std::string& text);
  /// Whether the reader has gone away.
  [[nodiscard]] bool is_unheard() const { return std::ferror(out_) != 0; }

 private:
  void show_body(const std::string& body);
  void show_status(const nlohmann::ordered_json& job);
  void put_line(const std::string& line);

  WatchForm form_;
  double interval_;
  std::FILE* out_;
  StatusLine status_;
  std::string state_;    ///< as last shown
  std::string written_;  ///< the last body, so that none is said twice
  Stopwatch since_;      ///< the last line of progress
  bool due_ = true;      ///< a line of progress is due whatever the time
};

}  // namespace sluice
