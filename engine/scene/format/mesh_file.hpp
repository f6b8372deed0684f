#pragma once

#include <cstddef>
#include <stdexcept>
#include <string_view>

#include "engine/scene/geometry/triangle_mesh.hpp"

namespace sluice {

/// What is wrong with a mesh file, and where: a line, or a byte.
class MeshFileError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The triangles of an STL file, ascii or binary, or of an OBJ file, as the name's ending says, in
/// the file's units. Corners at the same place become one; triangles with two corners at one place
/// are left out. Of OBJ the lines v and f count; a face of more corners is a fan of triangles.
/// Throws MeshFileError for what is no such file or has more than `most` triangles. Allocates in
/// proportion to the bytes that are there, whatever they say.
[[nodiscard]] Triangles read_mesh_file(std::string_view name, std::string_view bytes,
                                       std::size_t most);

}  // namespace sluice
