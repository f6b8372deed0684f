#pragma once

#include <string>
#include <vector>

#include "engine/draw/chart.hpp"
#include "engine/report/frame_painter.hpp"
#include "engine/report/report.hpp"

namespace sluice {

/// A page with more plots is for no reader, and drawing a thousand takes longer than some runs.
inline constexpr std::size_t kMostCharts = 64;

/// The plots of a report, kMostCharts at most but for those with a reference. Against an experiment
/// those of the paper's figures 5 to 13: front, levels, pressures, each simulation over experiment.
/// Against curves of the scene one per curve. Then every other sensor by itself: its first column,
/// or all of them for energies.
[[nodiscard]] std::vector<Chart> report_charts(const Report& report,
                                               const std::vector<Series>& series);

/// A picture of each frame with a common scale of pressures, as SVGs that hold the pixels as PNG;
/// with axes in metres but for a rendered one.
[[nodiscard]] std::vector<std::string> picture_svgs(const Report& report,
                                                    const std::vector<Snapshot>& frames,
                                                    Look look = Look::section);

}  // namespace sluice
