#include "engine/store/hdf5/hdf5_types.hpp"

#include <functional>
#include <numeric>

namespace sluice {

std::uint64_t element_count(const Extents& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::uint64_t{1}, std::multiplies<>());
}

const char* to_string(ElementType type) {
  switch (type) {
    case ElementType::float64:
      return "float64";
    case ElementType::float32:
      return "float32";
    case ElementType::uint64:
      return "uint64";
    case ElementType::text:
      return "text";
    case ElementType::other:
      break;
  }
  return "other";
}

}  // namespace sluice
