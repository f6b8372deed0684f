#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "engine/scene/checks/parse.hpp"
#include "engine/scene/filling/initial.hpp"
#include "engine/scene/forecast/estimate.hpp"
#include "engine/scene/forecast/plan.hpp"
#include "engine/scene/format/canonical.hpp"
#include "tests/fuzz/require.hpp"

// Any text as a scene: it is taken or refused with places and messages, and what is taken means the
// same when it is written and read again.

namespace sluice::fuzz {
namespace {

/// More would only be slow.
constexpr std::uint64_t kMostParticles = 5000;

void require_named(const Problem& problem) {
  require(problem.pointer.empty() || problem.pointer.front() == '/', "a place is a JSON pointer");
  require(!problem.message.empty(), "a problem has a message");
  (void)nlohmann::json(problem.pointer + problem.message).dump();  // throws where it is not UTF-8
}

void require_same_when_read_again(const Scene& scene) {
  const std::string text = canonical_text(scene);
  const ParseResult again = parse_scene(text);
  require(again.scene.has_value(), "the canonical text is a scene");
  require(canonical_text(*again.scene) == text, "the canonical text is of itself");
}

void require_finite_particles(const Scene& scene) {
  try {
    const Particles particles = create_particles(scene).state.particles;
    for (const double x : particles.position[0]) {
      require(std::isfinite(x), "a particle is somewhere");
    }
  } catch (const SceneError& error) {
    require_named(error.problem());
  }
}

void try_scene(std::string_view text) {
  const ParseResult result = parse_scene(text);
  require(result.scene.has_value() == result.problems.empty(), "a scene or problems");
  for (const Problem& problem : result.problems) require_named(problem);
  if (!result.scene) return;
  require_same_when_read_again(*result.scene);
  (void)plan_json(plan(*result.scene));
  const Estimate cost = estimate(*result.scene);
  require(cost.time_step > 0.0 && std::isfinite(cost.time_step), "time goes on");
  const std::uint64_t particles = cost.fluid_particles + cost.wall_particles;
  require(particles <= static_cast<std::uint64_t>(kMaxParticles), "the particles are bounded");
  if (particles <= kMostParticles) require_finite_particles(*result.scene);
}

}  // namespace
}  // namespace sluice::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sluice::fuzz::try_scene({reinterpret_cast<const char*>(data), size});
  return 0;
}
