#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/sph/method/method.hpp"

namespace sluice {

/// What `numerics.scheme` may say: a choice of every key of `numerics`.
enum class Scheme {
  recommended,  ///< the one that came closest to experiments for its cost
  paper,        ///< that of the paper, as printed
};

/// The numerics of a scheme; what else a Method holds has its default. Without a scheme: no term,
/// and the words and the Courant number of a fresh Method, which is how scenes were read before
/// there were schemes.
[[nodiscard]] Method method_of(std::optional<Scheme> scheme);

/// Where the numerics of a scene come from.
struct NumericsSource {
  std::optional<Scheme> scheme;
  /// JSON pointers into `numerics` of what the scene itself says, such as /kernel and
  /// /wall_shear/coefficient; sorted.
  std::vector<std::string> named;

  /// Whether the scene says anything at or below this pointer.
  [[nodiscard]] bool names(std::string_view pointer) const;
};

/// Leaves out what the scheme brought and what the scene names beside it excludes: particle
/// shifting, and a step that is too long, beside modified_leap_frog; a term that holds the fluid at
/// walls beside another that does. What the scene names itself stays.
void leave_out_excluded(Method& method, const NumericsSource& source);

}  // namespace sluice
