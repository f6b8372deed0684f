#include "cli/client/watch_view.hpp"

#include <fmt/format.h>

#include "cli/client/job_text.hpp"
#include "cli/json_text.hpp"

namespace sluice {

using Json = nlohmann::ordered_json;

WatchView::WatchView(WatchForm form, double interval, std::FILE* out)
    : form_(form), interval_(interval), out_(out), status_(out) {}

void WatchView::show(const Json& job, const std::string& body) {
  if (form_ == WatchForm::json) return show_body(body);
  const bool at_rest = is_at_rest(job);
  const std::string state = at_rest ? rest_text(job) : state_text(job);
  if (state != state_) {
    state_ = state;
    due_ = true;
    put_line(state);
  }
  if (!at_rest) show_status(job);
}

void WatchView::show_body(const std::string& body) {
  if (body == written_) return;
  written_ = body;
  std::fwrite(body.data(), 1, body.size(), out_);
  if (!body.ends_with('\n')) std::fputc('\n', out_);
  std::fflush(out_);
}

void WatchView::show_status(const Json& job) {
  const auto progress = progress_of(job);
  const std::string waiting = text_at(job, "waiting");
  // A job that waits for its next attempt has the progress of the last one, too.
  const bool moves = waiting.empty() && progress;
  if (waiting.empty() && !progress) return;
  if (form_ == WatchForm::bar) {
    return status_.draw(moves ? progress_bar(*progress, status_.width()) : waiting);
  }
  if (!due_ && since_.seconds() < interval_) return;
  const std::string line = "  " + (moves ? progress_text(*progress) : waiting);
  since_ = Stopwatch();
  due_ = false;
  put_line(line);
}

void WatchView::put_line(const std::string& line) {
  if (form_ == WatchForm::bar) status_.clear();
  std::fputs((line + "\n").c_str(), out_);
  std::fflush(out_);
}

void WatchView::say(const std::string& line) {
  if (form_ == WatchForm::bar) status_.clear();
  std::fputs(fmt::format("sluice: {}\n", line).c_str(), stderr);
}

void WatchView::close_with(const std::string& text) {
  if (form_ == WatchForm::json) return;
  std::fputs(text.c_str(), out_);
  std::fflush(out_);
}

}  // namespace sluice
