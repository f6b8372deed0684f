// What is predicted before a run, and what is refused for it.

#include "engine/scene/forecast/stability.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/scene/checks/parse.hpp"

namespace sluice {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

/// The paper's kernel and walls, and no term but those named.
Json with_nothing_else(Json numerics) {
  numerics["scheme"] = "paper";
  for (const char* term : {"density_diffusion", "artificial_viscosity", "reinitialisation"}) {
    if (!numerics.contains(term)) numerics[term] = nullptr;
  }
  return numerics;
}

Json still_tank(const Json& numerics) {
  return Json{{"name", "tank"},
              {"tank", {{"width", 1.0}, {"height", 1.0}}},
              {"fluid", {{{"shape", "rectangle"}, {"corner", {0, 0}}, {"size", {1.0, 0.5}}}}},
              {"gravity", {0.0, -9.81}},
              {"resolution", {{"spacing", 0.05}}},
              {"numerics", with_nothing_else(numerics)},
              {"end_time", 10.0}};
}

Json damped(const char* integrator, double courant) {
  return Json{{"integrator", integrator},
              {"courant", courant},
              {"density_diffusion", {{"delta", 0.1}}},
              {"artificial_viscosity", {{"alpha", 0.02}}}};
}

StabilityPrediction prediction_of(const Json& scene) {
  const ParseResult result = parse_scene(scene.dump(), StabilityCheck::skip);
  EXPECT_TRUE(result.scene.has_value());
  return predict_stability(*result.scene);
}

TEST(StabilityPrediction, RefusesACourantNumberBeyondTheLimitAndNamesTheLimit) {
  for (const char* integrator : {"modified_leap_frog", "kick_drift_kick"}) {
    // delta = 1 lowers the limit of kick-drift-kick below the largest Courant number of a scene.
    Json numerics = damped(integrator, 1.0);
    numerics["density_diffusion"]["delta"] = 1.0;
    const StabilityPrediction p = prediction_of(still_tank(numerics));
    EXPECT_EQ(p.outlook, Outlook::unstable);
    EXPECT_LT(p.margin, 0.0);

    const ParseResult refused = parse_scene(still_tank(numerics).dump());
    ASSERT_EQ(refused.problems.size(), 1U);
    EXPECT_EQ(refused.problems[0].pointer, "/numerics/courant");
    EXPECT_THAT(refused.problems[0].message, HasSubstr("is 1; must be at most"));

    numerics["courant"] = 0.98 * p.courant_limit;
    EXPECT_TRUE(parse_scene(still_tank(numerics).dump()).scene.has_value()) << integrator;
  }
}

TEST(StabilityPrediction, SaysWhatToDoWhereNoStepIsStable) {
  const Json undamped{{"integrator", "modified_leap_frog"}, {"courant", 0.5}};
  const ParseResult refused = parse_scene(still_tank(undamped).dump());
  ASSERT_EQ(refused.problems.size(), 1U);
  EXPECT_THAT(refused.problems[0].message, HasSubstr("artificial_viscosity"));
}

TEST(StabilityPrediction, OnlyTellsOfGrowthThatARunIsTooShortFor) {
  Json scene = still_tank(Json{{"integrator", "modified_leap_frog"}, {"courant", 0.25}});
  scene["end_time"] = 0.1;
  const StabilityPrediction p = prediction_of(scene);
  EXPECT_EQ(p.outlook, Outlook::growing);
  EXPECT_EQ(p.courant_limit, 0.0);
  EXPECT_GT(p.growth_decades, 0.0);
  EXPECT_TRUE(parse_scene(scene.dump()).scene.has_value());
}

TEST(StabilityPrediction, MarginIsWhatTheCourantNumberMayStillGrowBy) {
  const StabilityPrediction p = prediction_of(still_tank(damped("kick_drift_kick", 1.0)));
  EXPECT_EQ(p.outlook, Outlook::stable);
  EXPECT_DOUBLE_EQ(p.courant * (1.0 + p.margin), p.courant_limit);
  EXPECT_EQ(p.growth_decades, 0.0);
}

TEST(StabilityPrediction, SaysAboveWhichCourantNumberAnImpactMayFail) {
  const double limit = prediction_of(still_tank(damped("kick_drift_kick", 1.0))).courant_limit;
  const double flow_limit = 0.66 * limit;  // truncated Gaussian, kick_drift_kick
  const StabilityPrediction calm =
      prediction_of(still_tank(damped("kick_drift_kick", 0.99 * flow_limit)));
  EXPECT_DOUBLE_EQ(calm.flow_limit, 0.66 * calm.courant_limit);
  EXPECT_THAT(stability_text(calm), Not(HasSubstr("impact")));
  const StabilityPrediction bold =
      prediction_of(still_tank(damped("kick_drift_kick", 1.01 * flow_limit)));
  EXPECT_EQ(bold.outlook, Outlook::stable);
  EXPECT_THAT(stability_text(bold),
              HasSubstr("where an impact throws them about it may fail above"));
}

TEST(StabilityPrediction, ForceLimitIsAQuarterOfTheRootInUnitsOfTheSoundStep) {
  // c = 10 sqrt(2 g H), H = 0.5 m, h = 0.05 m: 0.25 sqrt(h/g) c/h = 2.5 sqrt(2 H/h).
  const StabilityPrediction p = prediction_of(still_tank(damped("kick_drift_kick", 1.0)));
  EXPECT_NEAR(p.force_limit, 2.5 * std::sqrt(2 * 0.5 / 0.05), 1e-9);
}

TEST(StabilityPrediction, JsonHoldsEveryMemberAndNullForLimitsThatDoNotExist) {
  Json scene = still_tank(Json{{"integrator", "kick_drift_kick"}});
  scene["gravity"] = {0.0, 0.0};
  scene["material"] = {{"sound_speed", 20.0}};
  const Json p = Json::parse(stability_json(prediction_of(scene)));
  EXPECT_EQ(p["outlook"], "stable");
  EXPECT_TRUE(p["viscosity_limit"].is_null());
  EXPECT_TRUE(p["diffusion_limit"].is_null());
  EXPECT_TRUE(p["force_limit"].is_null());
  EXPECT_EQ(p["courant_limit"], p["sound_limit"]);
}

}  // namespace
}  // namespace sluice
