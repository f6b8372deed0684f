#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "engine/store/files/snapshot_io.hpp"

namespace sluice {

/// `frame-<index>.hdf` for a frame's `frame-<index>.h5`.
[[nodiscard]] std::string vtk_name(const std::filesystem::path& frame);

/// Publishes a frame as VTKHDF 1.0 of type UnstructuredGrid, which ParaView opens from 5.10 on:
/// each particle a vertex at its place in the plane z = 0, in double precision and absolute, with
/// the point data `pressure` (Pa), `velocity` (m/s) and `id`. No trailer. Throws what publish
/// throws.
void write_vtk(const std::filesystem::path& path, const Snapshot& frame);

/// The text of a ParaView file series: which file shows which time, s.
[[nodiscard]] std::string vtk_series_text(const std::vector<std::pair<std::string, double>>& files);

}  // namespace sluice
