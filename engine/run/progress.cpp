#include "engine/run/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sluice {

void RateMeter::add(double now, double model_time, std::uint64_t step,
                    std::uint64_t particle_steps) {
  points_.push_back({now, model_time, step, particle_steps});
  while (points_.size() > 2 && points_[1].now <= now - window_) points_.pop_front();
}

std::optional<Rate> RateMeter::rate() const {
  if (points_.size() < 2) return {};
  const Point& first = points_.front();
  const Point& last = points_.back();
  const double span = last.now - first.now;
  if (!(span > 0.0)) return {};
  return Rate{(last.model_time - first.model_time) / span,
              static_cast<double>(last.step - first.step) / span,
              static_cast<double>(last.particle_steps - first.particle_steps) / span};
}

double Progress::fraction() const {
  if (!(end_time > 0.0)) return 1.0;
  return std::clamp(time / end_time, 0.0, 1.0);
}

std::optional<double> Progress::remaining() const {
  if (time >= end_time) return 0.0;
  if (!rate || !(rate->model_time > 0.0)) return {};
  const double seconds = (end_time - time) / rate->model_time;
  return std::isfinite(seconds) ? std::optional(seconds) : std::nullopt;
}

std::string duration_text(const std::optional<double>& seconds) {
  // Beyond a thousand years a number says less than the word.
  if (!seconds || !(*seconds >= 0.0) || *seconds > 3e10) return "unknown";
  const auto whole = static_cast<long long>(std::llround(*seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  if (whole < 86400) return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
  return fmt::format("{} d {} h", whole / 86400, whole % 86400 / 3600);
}

std::string progress_text(const Progress& progress) {
  const std::string speed = progress.rate
                                ? fmt::format("{:.3g} s/s, {:.1f} M/s", progress.rate->model_time,
                                              progress.rate->particle_steps * 1e-6)
                                : "speed unknown";
  return fmt::format("{:5.1f} % t {:.4f}/{:.4g} s, {}, ETA {}, dt {:.2g} s ({})",
                     100.0 * progress.fraction(), progress.time, progress.end_time, speed,
                     duration_text(progress.remaining()), progress.time_step,
                     to_string(progress.step_limit));
}

std::string progress_bar(const Progress& progress, std::size_t width) {
  const std::string text = " " + progress_text(progress);
  if (text.size() + 12 > width) return text.substr(0, width);
  const std::size_t cells = std::min<std::size_t>(30, width - text.size() - 2);
  const auto filled = static_cast<std::size_t>(progress.fraction() * static_cast<double>(cells));
  return fmt::format("[{:#<{}}{:.<{}}]{}", "", filled, "", cells - filled, text);
}

}  // namespace sluice
