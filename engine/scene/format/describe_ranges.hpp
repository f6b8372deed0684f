#pragma once

#include <cstddef>

#include "engine/scene/model/spec.hpp"

namespace sluice {

// A scene spans at most a few decades around these; the bounds keep squares and products of all
// quantities far from the ends of double.
inline constexpr Range kLength = above(0, 1e6);
inline constexpr Range kCoordinate = from(-1e6, 1e6);
inline constexpr Range kTime = above(0, 1e6);
inline constexpr Range kSoundSpeed = from(1e-6, 1e7);
inline constexpr std::size_t kMaxShapes = 64;
inline constexpr std::size_t kMaxPolygonPoints = 256;
inline constexpr std::size_t kMaxHeights = 256;  // nodes of a grid along x or z
inline constexpr std::size_t kMaxSensors = 1024;
inline constexpr std::size_t kMaxReferenceCurves = 32;
inline constexpr std::size_t kMaxPictures = 24;
inline constexpr std::size_t kMaxReferencePoints = 2000;

}  // namespace sluice
