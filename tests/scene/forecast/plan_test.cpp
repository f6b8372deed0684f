#include "engine/scene/forecast/plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "engine/scene/filling/initial.hpp"
#include "engine/scene/forecast/estimate.hpp"
#include "engine/scene/format/numerics_json.hpp"
#include "engine/sph/method/particles.hpp"
#include "tests/scene/support.hpp"

namespace sluice {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using testing::base_scene;
using ::testing::Contains;
using ::testing::IsSupersetOf;
using ::testing::Not;
using testing::parsed;

std::vector<std::string> names(const std::vector<PlanItem>& items) {
  std::vector<std::string> result;
  for (const PlanItem& item : items) result.push_back(item.name);
  return result;
}

std::string reason(const std::vector<PlanItem>& items, const std::string& name) {
  for (const PlanItem& item : items) {
    if (item.name == name) return item.reason;
  }
  return "not there";
}

TEST(Plan, LeavesOutWhatAnEmptySceneDoesNotName) {
  const Plan p =
      plan(parsed(testing::free_scene({{"shape", "circle"}, {"center", {0, 0}}, {"radius", 1}})));
  EXPECT_THAT(names(p.passes_left_out),
              IsSupersetOf({"laminar_viscosity", "wall_pressure", "wall_artificial_viscosity",
                            "wall_shear", "gravity", "reinitialisation", "sample"}));
  EXPECT_THAT(names(p.passes), IsSupersetOf({"sort", "continuity", "momentum", "update",
                                             "density_diffusion", "artificial_viscosity"}));
  EXPECT_THAT(names(p.files_left_out), IsSupersetOf({"series", "frames"}));
}

TEST(Plan, GivesTheKeyOrTheSchemeAsTheReason) {
  json text = base_scene();
  text["numerics"] =
      json::parse(R"({"scheme": "recommended", "artificial_viscosity": {"alpha": 0.1},
      "density_diffusion": null, "wall_artificial_viscosity": {}})");
  const Plan p = plan(parsed(text));
  EXPECT_EQ(reason(p.passes, "wall_pressure"), "key tank");
  EXPECT_EQ(reason(p.passes, "gravity"), "key gravity");
  EXPECT_EQ(reason(p.passes, "wall_artificial_viscosity"),
            "key numerics.wall_artificial_viscosity");
  EXPECT_EQ(reason(p.passes, "particle_shifting"), "scheme recommended");
  EXPECT_EQ(reason(p.passes_left_out, "density_diffusion"), "null at numerics.density_diffusion");
  EXPECT_EQ(reason(p.passes_left_out, "reinitialisation"), "scheme recommended");
  EXPECT_EQ(reason(p.passes_left_out, "wall_shear"),
            "scheme recommended, but excluded by another key");
}

TEST(Plan, SaysWhatTheWordOfTheSchemeStandsFor) {
  json text = base_scene();
  text["numerics"] = json::parse(R"({"artificial_viscosity": {"alpha": 0.1}, "courant": 0.5,
                                     "scheme": "recommended"})");
  std::map<std::string, std::string> said;
  for (const PlanItem& item : plan(parsed(text)).numerics) {
    said[item.name] = item.description + " [" + item.reason + "]";
  }
  EXPECT_EQ(said["artificial_viscosity.alpha"], "0.1 [key numerics.artificial_viscosity.alpha]");
  EXPECT_EQ(said["artificial_viscosity.beta"], "0.5 [scheme recommended]");
  EXPECT_EQ(said["courant"], "0.5 [key numerics.courant]");
  EXPECT_EQ(said["kernel"], "wendland_c2 [scheme recommended]");
  EXPECT_EQ(said["wall_artificial_viscosity"], "none [scheme recommended]");
  const json values = numerics_json(parsed(text).method).flatten();
  EXPECT_EQ(said.size(), values.size()) << "every number and word of the method, once";
}

TEST(Plan, RunsWhatASceneNames) {
  json text = base_scene();
  text["numerics"] = json::parse(R"({"scheme": "paper", "wall_artificial_viscosity": {}})");
  text["sensors"] = json::parse(R"([{"name": "e", "kind": "energy", "interval": 0.1}])");
  text["gate"] = {{"x", 1.0}, {"speed", 3.46}};
  const Plan p = plan(parsed(text));
  EXPECT_THAT(names(p.passes_left_out),
              IsSupersetOf({"packing", "laminar_viscosity", "wall_shear", "particle_shifting"}))
      << "which may not stand beside wall_artificial_viscosity, or this integrator";
  EXPECT_THAT(names(p.passes),
              IsSupersetOf({"density_diffusion", "artificial_viscosity", "wall_pressure", "gravity",
                            "reinitialisation", "sample"}));
  EXPECT_EQ(reason(p.passes, "wall_artificial_viscosity"),
            "key numerics.wall_artificial_viscosity");
  EXPECT_EQ(reason(p.passes, "gate"), "key gate");
  text["numerics"].erase("wall_artificial_viscosity");
  text["numerics"]["laminar_viscosity"] = json::object();
  EXPECT_EQ(reason(plan(parsed(text)).passes, "laminar_viscosity"),
            "key numerics.laminar_viscosity");
  text["numerics"].erase("laminar_viscosity");
  text["numerics"]["wall_shear"] = json::object();
  text["numerics"]["integrator"] = "kick_drift_kick";
  text["numerics"]["particle_shifting"] = json::object();
  EXPECT_EQ(reason(plan(parsed(text)).passes, "wall_shear"), "key numerics.wall_shear");
  EXPECT_EQ(reason(plan(parsed(text)).passes, "particle_shifting"),
            "key numerics.particle_shifting");
}

TEST(Plan, LeavesOutWhatHoldsAtWallsWhereThereIsNoWall) {
  json text = testing::free_scene({{"shape", "circle"}, {"center", {0, 0}}, {"radius", 1}});
  for (const char* term : {"wall_artificial_viscosity", "wall_shear"}) {
    text["numerics"] = {{"scheme", "paper"}, {term, json::object()}};
    const Plan p = plan(parsed(text));
    EXPECT_THAT(names(p.passes), Not(Contains(term)));
    EXPECT_THAT(names(p.passes_left_out), Contains(term));
  }
}

TEST(Plan, NamesEachFieldOnceAsItsIntegratorCarriesIt) {
  for (const auto& [word, integrator] :
       {std::pair{"modified_leap_frog", Integrator::modified_leap_frog},
        std::pair{"kick_drift_kick", Integrator::kick_drift_kick}}) {
    json text = base_scene();
    text["numerics"] = {{"scheme", "recommended"}, {"integrator", word}};
    const Plan p = plan(parsed(text));
    EXPECT_EQ(p.fields.size() + p.fields_left_out.size(), fields_in(2).size());
    for (const Field& field : fields_in(2)) {
      const auto& list = carries(integrator, field) ? p.fields : p.fields_left_out;
      EXPECT_THAT(names(list), Contains(std::string(field.name))) << word;
    }
  }
}

TEST(Plan, SaysWhereTheLatticeDoesNotFit) {
  json text = base_scene();
  text["tank"]["width"] = 1.02;
  text["fluid"][0]["size"] = {1.02, 0.5};
  EXPECT_EQ(reason(plan(parsed(text)).passes, "packing"),
            "the lattice does not fit the tank's right wall at (0.975, 0.025) m");
}

TEST(Plan, IsJsonWithAReasonForEachItem) {
  const json text = json::parse(plan_json(plan(parsed(base_scene()))));
  for (const char* key : {"numerics", "passes", "passes_left_out", "fields", "fields_left_out",
                          "files", "files_left_out"}) {
    ASSERT_TRUE(text.contains(key)) << key;
    for (const json& item : text[key]) EXPECT_FALSE(item.at("reason").get<std::string>().empty());
  }
}

TEST(Estimate, CountsWhatIsMade) {
  for (const char* name : {"dambreak", "dambreak-paper", "dambreak-paper-coarse", "still-water"}) {
    const auto path = testing::source_dir() / "schemas/examples" / (std::string(name) + ".json");
    const Scene scene = parsed(json::parse(testing::read_text(path)));
    const InitialParticles made = create_particles(scene);
    const Estimate e = estimate(scene);
    EXPECT_EQ(e.fluid_particles, made.state.particles.size()) << name;
    EXPECT_EQ(e.wall_particles, made.walls.size()) << name;
  }
}

TEST(Estimate, ComesCloseForCurvedShapesAndObstacles) {
  json text = base_scene();
  text["resolution"]["spacing"] = 0.005;
  text["fluid"] = json::parse(R"([{"shape": "circle", "center": [0.5, 0.5], "radius": 0.4}])");
  text["obstacles"] = json::parse(R"([{"shape": "circle", "center": [1.5, 0.5], "radius": 0.4}])");
  const Scene scene = parsed(text);
  const InitialParticles made = create_particles(scene);
  const Estimate e = estimate(scene);
  const auto fluid = static_cast<double>(made.state.particles.size());
  EXPECT_NEAR(static_cast<double>(e.fluid_particles), fluid, 0.02 * fluid);
  const auto walls = static_cast<double>(made.walls.size());
  EXPECT_NEAR(static_cast<double>(e.wall_particles), walls, 0.3 * walls);
}

TEST(Estimate, CountsExactlyWhatWasMade) {
  json text = base_scene();
  text["obstacles"] = json::parse(R"([{"shape": "circle", "center": [0.5, 0.2], "radius": 0.15}])");
  const Scene scene = parsed(text);
  const InitialParticles made = create_particles(scene);
  ASSERT_LT(made.state.particles.size(), estimate(scene).fluid_particles) << "displaced";
  EXPECT_EQ(exact_estimate(scene).fluid_particles, made.state.particles.size());
  EXPECT_EQ(exact_estimate(scene).wall_particles, made.walls.size());
}

// Which precision is quicker is measured when first asked for: a matter of the machine.
TEST(Estimate, TakesTheTimeOfParticlesTimesSteps) {
  json text = base_scene();
  const Scene once = parsed(text);
  text["end_time"] = 2;
  const Scene twice = parsed(text);
  EXPECT_NEAR(
      expected_core_seconds(twice, estimate(twice)) / expected_core_seconds(once, estimate(once)),
      2.0, 0.01);
}

TEST(Estimate, AsksForTheDiskThatAFrameTakes) {
  json text = base_scene();
  const std::uint64_t bare = estimate(parsed(text)).disk_bytes;
  text["output"]["frames"]["interval"] = 0.5;
  // x, y, vx, vy and pressure in single precision, and an id of eight bytes.
  EXPECT_EQ(estimate(parsed(text)).disk_bytes - bare, 3U * 200 * (5 * 4 + 8));
}

TEST(Estimate, StepsAsEquation18Says) {
  json text = base_scene();
  text["material"]["sound_speed"] = 50;
  const Estimate e = estimate(parsed(text));
  const double speed = std::sqrt(2 * 9.81 * 0.5);
  EXPECT_DOUBLE_EQ(e.time_step, 1.5 * 0.05 / (50 + speed));
  EXPECT_EQ(e.steps, static_cast<std::uint64_t>(std::ceil(1 / e.time_step)));
}

TEST(Estimate, StepsAsTheForceConditionSaysWhereItIsShorter) {
  json text = base_scene();
  text["material"]["sound_speed"] = 5;
  text["numerics"] = {{"scheme", "paper"}, {"integrator", "kick_drift_kick"}, {"courant", 1.9}};
  EXPECT_DOUBLE_EQ(estimate(parsed(text)).time_step,
                   std::min(1.9 * 0.05 / (5 + std::sqrt(9.81)), 0.25 * std::sqrt(0.05 / 9.81)));
}

TEST(Estimate, CountsSamplesByIntervalAndStepsWhereThereIsNone) {
  json text = base_scene();
  text["sensors"] = json::parse(R"([{"name": "a", "kind": "energy", "interval": 0.25},
                                    {"name": "b", "kind": "energy", "interval": 0}])");
  const Estimate e = estimate(parsed(text));
  // t = 0, 0.25, 0.5, 0.75, 1, and every step.
  EXPECT_NEAR(static_cast<double>(e.samples), 5.0 + static_cast<double>(e.steps), 1.0);
}

TEST(Estimate, AsksForNoDiskOrMemoryOfWhatIsNotThere) {
  const json bare = base_scene();
  json full = bare;
  full["output"]["frames"]["interval"] = 0.1;
  full["sensors"] = json::parse(R"([{"name": "a", "kind": "energy", "interval": 0.01}])");
  const Estimate a = estimate(parsed(bare));
  const Estimate b = estimate(parsed(full));
  EXPECT_EQ(a.samples, 0U);
  EXPECT_EQ(a.frames, 0U);
  EXPECT_EQ(b.frames, 11U);
  EXPECT_LT(a.disk_bytes, b.disk_bytes);
  EXPECT_LT(a.memory_bytes, b.memory_bytes);
}

TEST(Estimate, IsJson) {
  const Estimate e = estimate(parsed(base_scene()));
  const json text = json::parse(estimate_json(e));
  EXPECT_EQ(text.at("fluid_particles"), 200);
  EXPECT_EQ(text.at("time_step"), e.time_step);
}

}  // namespace
}  // namespace sluice
