#pragma once

#include "engine/scene/checks/parse.hpp"
#include "engine/scene/format/written_scene.hpp"
#include "engine/scene/model/problems.hpp"

namespace sluice {

/// What relates keys to one another: shapes to the tank, the domain and the spacing; the sound
/// speed to gravity; sensors to the domain; the amount of work to the limits; the Courant number to
/// what linear analysis calls stable; obstacles to what holds fluid back. Each check leaves out
/// what has problems already. Allocates nothing in proportion to what the scene asks for. What may
/// not be meant, but can be run, goes to `warnings`: only of a user's scene without problems.
struct CheckedAs {
  StabilityCheck stability = StabilityCheck::refuse;
  SceneOrigin origin = SceneOrigin::user;
};
void check(const WrittenScene& written, const CheckedAs& as, Problems& problems,
           Problems& warnings);

}  // namespace sluice
