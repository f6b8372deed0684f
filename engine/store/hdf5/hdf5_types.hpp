#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sluice {

/// Lengths of an array along each of its directions; the last runs fastest.
using Extents = std::vector<std::uint64_t>;
[[nodiscard]] std::uint64_t element_count(const Extents& shape);

enum class ElementType { float64, float32, uint64, text, other };
[[nodiscard]] const char* to_string(ElementType type);

/// Something with a path in an HDF5 file.
struct Hdf5Object {
  enum class Kind { group, data_set, other };
  std::string path;  ///< from the root, begins with "/"
  Kind kind = Kind::other;
};

struct DataSetInfo {
  ElementType type = ElementType::other;
  Extents shape;
};

}  // namespace sluice
