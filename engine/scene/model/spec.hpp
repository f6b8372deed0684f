#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "engine/sph/terms/parameter.hpp"

namespace sluice {

/// Whether a key must be there. An optional one has the default of its struct, or `otherwise` says
/// what its absence means.
enum class Need { required, optional };

/// "from 0 to 2", "above 0 and at most 1e+06 m".
[[nodiscard]] std::string to_text(const Range& range, std::string_view unit);

// What the parser, its messages and the schema say of a key. Members left out of an initialiser
// keep their defaults.
struct NumberSpec {
  std::string_view about = {};
  std::string_view unit = "1";  ///< SI; "1": dimensionless
  Range range = {};
  Need need = Need::optional;
  std::string_view otherwise = {};
};
struct KeySpec {
  std::string_view about = {};
  Need need = Need::optional;
  std::string_view otherwise = {};
};
struct ListSpec {
  std::string_view about = {};
  std::size_t min = 0;
  std::size_t max = 0;
  Need need = Need::optional;
};

enum class Characters {
  name,      ///< letters, digits, _ . -
  sentence,  ///< anything but control characters
  mesh,      ///< the bare name of an STL or OBJ file
  sha256,    ///< 64 hexadecimal digits
};
struct TextSpec {
  std::string_view about = {};
  Characters characters = Characters::name;
  std::size_t min = 0;  ///< in code points, as JSON Schema counts
  std::size_t max = 0;
  Need need = Need::optional;
};

}  // namespace sluice
