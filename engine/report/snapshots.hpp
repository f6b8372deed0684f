#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "engine/draw/picture.hpp"
#include "engine/report/report.hpp"

namespace sluice {

/// Times of a report's pictures, s: those that the scene names; else, beside the built-in
/// experiment and if the run has them, those of its paper's pictures (T = 2.0, 5.9, 7.8); else
/// first, last and two between of what there is, and the highest pressure that a sensor saw.
/// `last`: time of the last snapshot.
[[nodiscard]] std::vector<double> picture_times(const Report& report, double last);

/// The snapshots of a job nearest to those times, each once, oldest first.
[[nodiscard]] std::vector<std::filesystem::path> picture_files(const std::filesystem::path& folder,
                                                               const Report& report);

/// All snapshots of a job, or `most` of them evenly, the first and the last among them.
[[nodiscard]] std::vector<std::filesystem::path> spread_files(const std::filesystem::path& folder,
                                                              std::size_t most);

/// Nothing where the file cannot be read: a report without one of its pictures is worth having.
[[nodiscard]] std::optional<Snapshot> try_snapshot(const std::filesystem::path& path);

/// The box around all particles that are somewhere; nothing when none is.
[[nodiscard]] std::optional<Box> particle_box(std::span<const Snapshot> frames);

/// What of a scene is worth showing, m: the inside of the tank, or the box around particles and the
/// solids near them.
[[nodiscard]] Box picture_room(const Scene& scene, const std::optional<Box>& particles);

/// The same as x and y, with the tank's walls.
[[nodiscard]] Box2 picture_view(const Scene& scene, const std::optional<Box>& particles);

/// Where pictures cut a scene of space: in the middle of the tank or of the first fluid, as z, m.
[[nodiscard]] double picture_section(const Scene& scene);

/// A common end for the colours of these frames: what all but one value in two hundred stay below.
[[nodiscard]] double colour_end(const std::vector<Snapshot>& frames, Quantity quantity);

}  // namespace sluice
