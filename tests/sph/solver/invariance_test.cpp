// What the equations do not know must not matter: place, frame of reference, units.

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <vector>

#include "tests/sph/test_fluids.hpp"

namespace sluice {
namespace {

struct Scene {
  TestMethod method;
  Fluid fluid;
  std::vector<Vec2> walls;
};

Scene tank(Integrator integrator, Precision precision) {
  Dice dice(31);
  Scene scene;
  scene.method = full_method();
  scene.method.integrator = integrator;
  scene.method.precision = precision;
  scene.method.reinitialisation = Reinitialisation{5};
  scene.fluid = random_block(dice, {-0.7, -0.7}, 14, 10, 0.1, 0.1, 0.5, 5.0);
  scene.walls = walls_around({-0.7, -0.7}, 14, 10, 0.1);
  return scene;
}

Fluid after(const Scene& scene, int steps) {
  SolverN<2> solver = solver_for(scene.method, start_from(scene.fluid), scene.walls, {});
  run_steps(solver, steps);
  return fluid_of(solver.state());
}

Scene moved(Scene scene, const Vec2& by) {
  for (Vec2& x : scene.fluid.x) x += by;
  for (Vec2& x : scene.walls) x += by;
  scene.method.domain.box.min += by;
  scene.method.domain.box.max += by;
  return scene;
}

void expect_same_motion(const Fluid& seen, const Fluid& expected, const Vec2& by, double tolerance,
                        const std::string& what) {
  Fluid back = seen;
  for (Vec2& x : back.x) x -= by;
  // In units of h, c and the largest excess.
  expect_near(back.x, expected.x, tolerance * 0.12, what + ": position");
  expect_near(back.v, expected.v, tolerance * 20.0, what + ": velocity");
  expect_near(back.excess, expected.excess, tolerance * 20.0, what + ": density");
}

TEST(Translation, ChangesResultsOnlyInRounding) {
  for (const Integrator integrator : kIntegrators) {
    for (const Precision precision : kPrecisions) {
      const Scene scene = tank(integrator, precision);
      const Fluid expected = after(scene, 12);
      const double tolerance = precision == Precision::mixed ? 1e-5 : 1e-11;
      for (const Vec2& by : {Vec2(0.037, -0.061), Vec2(-3.3, 8.9)}) {
        expect_same_motion(after(moved(scene, by), 12), expected, by, tolerance,
                           name_of(integrator) + ", " + name_of(precision));
      }
    }
  }
}

TEST(Translation, ByTenThousandTimesTheSceneIsStillRounding) {
  for (const Integrator integrator : kIntegrators) {
    const Vec2 by(1e4, -2e4);
    // Positions: 2e4 m to 4e-12 m. Mixed precision sees places relative to the scene.
    const Scene exact = tank(integrator, Precision::double_precision);
    expect_same_motion(after(moved(exact, by), 12), after(exact, 12), by, 1e-8,
                       name_of(integrator) + ", double");
    const Scene mixed = tank(integrator, Precision::mixed);
    expect_same_motion(after(moved(mixed, by), 12), after(mixed, 12), by, 1e-5,
                       name_of(integrator) + ", mixed");
  }
}

TEST(GalileanShift, ChangesNothingButTheFrame) {
  for (const Integrator integrator : kIntegrators) {
    for (const Precision precision : kPrecisions) {
      Scene scene = tank(integrator, precision);
      scene.walls.clear();
      scene.method.gravity.setZero();
      const Vec2 shift(3.0, 0.0);
      // Steps depend on the largest speed: a lone particle has it, the same in both frames.
      scene.fluid.add({0.0, 1.8}, {-1.5, 9.0}, 0.0);
      scene.method.domain.box = {{-3.0, -3.0}, {3.0, 3.0}};
      Scene shifted = scene;
      for (Vec2& v : shifted.fluid.v) v += shift;

      SolverN<2> one = solver_for(scene.method, start_from(scene.fluid), {}, {});
      SolverN<2> other = solver_for(shifted.method, start_from(shifted.fluid), {}, {});
      run_steps(one, 12);
      run_steps(other, 12);
      EXPECT_NEAR(other.time() / one.time(), 1.0, 1e-6);
      Fluid back = fluid_of(other.state());
      for (Vec2& v : back.v) v -= shift;
      const double tolerance = precision == Precision::mixed ? 1e-5 : 1e-11;
      expect_same_motion(back, fluid_of(one.state()), other.time() * shift, tolerance,
                         name_of(integrator) + ", " + name_of(precision));
    }
  }
}

TEST(Units, LengthGravityAndDensityScaleOutOfEverythingOverTwelveDecades) {
  struct Factors {
    double length, gravity, density;
  };
  for (const Integrator integrator : kIntegrators) {
    const Scene scene = tank(integrator, Precision::double_precision);
    const Fluid expected = after(scene, 40);
    std::vector<Factors> all{{0.3, 7.0, 1.7}, {1e6, 1e-6, 1e6}, {1e-6, 1e6, 1e-6}};
    for (const double factor : {1e-6, 1e-4, 1e-2, 1e2, 1e4, 1e6}) {
      all.insert(all.end(), {{factor, 1.0, 1.0}, {1.0, factor, 1.0}, {1.0, 1.0, factor}});
    }
    for (const Factors& k : all) {
      Scene other = scene;
      const double speed = std::sqrt(k.length * k.gravity);
      other.method.spacing *= k.length;
      other.method.smoothing_length *= k.length;
      other.method.domain.box.min *= k.length;
      other.method.domain.box.max *= k.length;
      other.method.gravity *= k.gravity;
      other.method.reference_density *= k.density;
      other.method.sound_speed *= speed;
      for (Vec2& x : other.fluid.x) x *= k.length;
      for (Vec2& x : other.walls) x *= k.length;
      for (Vec2& v : other.fluid.v) v *= speed;
      for (double& excess : other.fluid.excess) excess *= k.density;

      Fluid seen = after(other, 40);
      for (Vec2& x : seen.x) x /= k.length;
      for (Vec2& v : seen.v) v /= speed;
      for (double& excess : seen.excess) excess /= k.density;
      std::ostringstream what;
      what << name_of(integrator) << ", length x " << k.length << ", gravity x " << k.gravity
           << ", density x " << k.density;
      expect_same_motion(seen, expected, Vec2::Zero(), 1e-9, what.str());
    }
  }
}

TEST(Mirror, ASceneAndItsMirrorImageGoTheSameWay) {
  for (const Integrator integrator : kIntegrators) {
    const Scene scene = tank(integrator, Precision::double_precision);
    Scene image = scene;
    for (Vec2& x : image.fluid.x) x.x() *= -1.0;
    for (Vec2& v : image.fluid.v) v.x() *= -1.0;
    for (Vec2& x : image.walls) x.x() *= -1.0;
    image.method.gravity.x() *= -1.0;
    Fluid seen = after(image, 12);
    for (Vec2& x : seen.x) x.x() *= -1.0;
    for (Vec2& v : seen.v) v.x() *= -1.0;
    expect_same_motion(seen, after(scene, 12), Vec2::Zero(), 1e-11, name_of(integrator));
  }
}

TEST(Precisions, MixedFollowsDoubleToItsRounding) {
  for (const Integrator integrator : kIntegrators) {
    const Scene mixed = tank(integrator, Precision::mixed);
    const Scene exact = tank(integrator, Precision::double_precision);
    expect_same_motion(after(mixed, 12), after(exact, 12), Vec2::Zero(), 1e-5, name_of(integrator));
  }
}

}  // namespace
}  // namespace sluice
