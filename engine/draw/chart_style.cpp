#include "engine/draw/chart.hpp"

namespace sluice {
namespace {

constexpr std::string_view kStyle = R"(
.chart { --ink: #1b1f24; --faint: #d0d7de; --frame: #57606a; --sim: #0059b3; --exp: #1b1f24;
  --one: #0059b3; --two: #b35900; --three: #1a7f37; --four: #8250df; --band: #1b1f24; --halo: #ffffff; }
@media (prefers-color-scheme: dark) {
.chart { --ink: #e6edf3; --faint: #30363d; --frame: #8b949e; --sim: #58a6ff; --exp: #e6edf3;
  --one: #58a6ff; --two: #f0883e; --three: #56d364; --four: #d2a8ff; --band: #e6edf3; --halo: #0d1117; } }
.chart text { font: 13px system-ui, "DejaVu Sans", sans-serif; fill: var(--ink); }
.chart .title { font-weight: 600; }
.chart .grid { stroke: var(--faint); stroke-width: 1; }
.chart .frame { stroke: var(--frame); stroke-width: 1; fill: none; }
.chart .canvas { fill: #f6f8fa; }
.chart .band { fill: var(--band); fill-opacity: 0.16; }
.chart .line { fill: none; stroke-width: 1.4; stroke-linejoin: round; }
.chart .mark { stroke-width: 1.3; fill: none; }
.chart .word { font-size: 11px; paint-order: stroke; stroke: var(--halo); stroke-width: 3px; }
.chart .simulation { stroke: var(--sim); }
.chart .experiment { stroke: var(--exp); }
.chart .experiment.line { stroke-dasharray: 6 3; stroke-width: 1.6; }
.chart .first { stroke: var(--one); }
.chart .second { stroke: var(--two); }
.chart .third { stroke: var(--three); }
.chart .fourth { stroke: var(--four); }
)";

}  // namespace

std::string_view chart_style() { return kStyle; }

}  // namespace sluice
