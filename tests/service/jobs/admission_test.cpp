#include "service/jobs/admission.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <optional>

namespace sluice::test {
namespace {

using nlohmann::json;

/// A drop of this radius, m, with particles 0.01 m apart.
std::string drop_of(double radius) {
  return json{
      {"name", "drop"},
      {"fluid",
       {{{"shape", "circle"}, {"center", {0, 0}}, {"radius", radius}, {"pressure", "zero"}}}},
      {"material", {{"sound_speed", 20}}},
      {"resolution", {{"spacing", 0.01}}},
      {"end_time", 0.1}}
      .dump();
}

TEST(Admission, HoldsTheExactNumberOfParticlesAgainstTheLimit) {
  int found = 0;
  for (double radius = 0.05; radius < 0.2; radius += 0.003) {
    const std::string text = drop_of(radius);
    const Scene scene = *parse_scene(text).scene;
    ServiceLimits limits;
    limits.particles_per_job = estimate(scene).fluid_particles;
    const std::uint64_t exact = exact_estimate(scene).fluid_particles;
    if (exact <= limits.particles_per_job) continue;
    ++found;
    EXPECT_THROW((void)admit_scene(text, limits), ApiError) << radius;
    limits.particles_per_job = exact;
    EXPECT_NO_THROW((void)admit_scene(text, limits)) << radius;
  }
  EXPECT_GT(found, 0);
}

TEST(Admission, HasNoLimitOfTheDiskWhereThatIsZero) {
  ServiceLimits limits;
  limits.disk_per_job = 1;
  EXPECT_THROW((void)admit_scene(drop_of(0.1), limits), ApiError);
  limits.disk_per_job = 0;
  EXPECT_NO_THROW((void)admit_scene(drop_of(0.1), limits));
}

}  // namespace
}  // namespace sluice::test
