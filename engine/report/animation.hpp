#pragma once

#include <filesystem>
#include <string>

#include "engine/report/frame_painter.hpp"
#include "engine/report/report.hpp"

namespace sluice {

/// No animation has more pictures, or more pixels in one: some twenty megabytes.
inline constexpr std::size_t kMostAnimated = 240;
inline constexpr int kAnimationWidth = 800;
inline constexpr int kAnimationHeight = 600;

/// All snapshots of a job, or kMostAnimated of them evenly, as an animated PNG of some twelve
/// seconds: solids grey, the gate red, each with its time and the scale of colours. Reads one
/// snapshot at a time. Empty where there is none that can be read.
[[nodiscard]] std::string animation_png(const std::filesystem::path& folder, const Report& report,
                                        Quantity quantity, Look look = Look::rendered);

}  // namespace sluice
