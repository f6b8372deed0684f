#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "engine/scene/model/scene.hpp"
#include "engine/verify/case_runner.hpp"

namespace sluice {

/// Of every scene here that names no other, m/s^2.
inline constexpr double kGravity = 9.81;

// A scheme is the part of a scene that says how, not what: {numerics, resolution:
// {smoothing_ratio}}.

/// What the suite holds to its gates unless another is asked for: Wendland kernel with h = 1.5 dx,
/// kick-drift-kick at C = 1, Fourtakas diffusion, wall law, wall pressure not below zero, shifting.
[[nodiscard]] nlohmann::ordered_json recommended_scheme();
/// The paper's: Gaussian with h = dx, modified leap-frog at C = 0.25, eq. 7, eq. 10 every 20 steps.
[[nodiscard]] nlohmann::ordered_json paper_scheme();
/// That of a scene.
[[nodiscard]] nlohmann::ordered_json scheme_of(const nlohmann::ordered_json& scene);
/// The scene with the scheme; without its wall terms and its shifting where there is no tank.
[[nodiscard]] nlohmann::ordered_json with_scheme(nlohmann::ordered_json scene,
                                                 const nlohmann::ordered_json& scheme);

/// Water over the whole width of a tank, in units of its depth H.
struct StillWater {
  double depth = 1.0;         ///< H, m
  double width = 1.0;         ///< of the tank, in H
  double breadth = 0.0;       ///< of the tank along z, in H; none in the plane
  double per_depth = 20.0;    ///< particles in H
  double gravity = kGravity;  ///< m/s^2
  double density = 1000.0;    ///< kg/m^3
  double sound_ratio = 14.2;  ///< c / sqrt(g H)
  double time = 6.0;          ///< end, in sqrt(H/g)
};
/// Without a scheme, like all scenes here. With pressure sensors at H/4, H/2 and 3H/4 in the
/// middle, `energy` and `surface`.
[[nodiscard]] nlohmann::ordered_json still_water(std::string_view name, const StillWater& water);
/// Relative L2 of the pressures of still_water() against rho g times the depth, over rho g H, from
/// `from` of the end time on.
[[nodiscard]] double pressure_error(const CaseRun& run, const StillWater& water, double from);

/// A tank with an open top and the given fluid, of as many dimensions as its size; lengths in m,
/// gravity 9.81, sound speed `sound`.
[[nodiscard]] nlohmann::ordered_json tank_scene(std::string_view name, const Vec& size,
                                                nlohmann::ordered_json fluid, double spacing,
                                                double sound, double end_time);
/// A fluid by itself that starts without pressure: no tank, no gravity. Of the plane.
[[nodiscard]] nlohmann::ordered_json without_tank(std::string_view name,
                                                  nlohmann::ordered_json shape, double spacing,
                                                  double sound, double end_time);
/// A rectangle in the plane, a box in space.
[[nodiscard]] nlohmann::ordered_json cuboid(const Vec& corner, const Vec& size);
/// A circle in the plane, a sphere in space; without pressure at the start.
[[nodiscard]] nlohmann::ordered_json ball(const Vec& center, double radius);

/// A column of w x H, in space as broad as its tank, that falls into a tank of 4 w, but at least
/// 2 H: sizes in m, `per_length` particles in the shorter of w and H.
[[nodiscard]] nlohmann::ordered_json dam_break(std::string_view name, const Vec& column,
                                               double per_length, double end_in_root_h_over_g);

}  // namespace sluice
