#include "engine/study/study.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

namespace sluice {
namespace {

using nlohmann::json;

json puddle() {
  return json::parse(R"({
    "name": "puddle", "tank": {"width": 0.2, "height": 0.2},
    "fluid": [{"shape": "rectangle", "corner": [0, 0], "size": [0.1, 0.1]}],
    "gravity": [0, -9.81], "resolution": {"spacing": 0.01},
    "numerics": {"scheme": "recommended", "artificial_viscosity": {"alpha": 0.1}}, "end_time": 0.1})");
}

json small_study() { return {{"name", "small"}, {"scene", puddle()}}; }

StudyPlan plan_of(const json& study) { return plan_study(study.dump(), {}); }

void expect_refused(const json& study, const std::string& pointer, const std::string& words) {
  const StudyPlan plan = plan_of(study);
  EXPECT_TRUE(plan.runs.empty());
  ASSERT_FALSE(plan.problems.empty()) << pointer;
  EXPECT_EQ(plan.problems.front().pointer, pointer);
  EXPECT_NE(plan.problems.front().message.find(words), std::string::npos)
      << plan.problems.front().message;
}

TEST(Study, OfABaseAloneIsOneRunOfIt) {
  const StudyPlan plan = plan_of(small_study());
  ASSERT_EQ(plan.runs.size(), 1u);
  EXPECT_EQ(plan.runs[0].name, "small");
  EXPECT_DOUBLE_EQ(plan.runs[0].scene.method.spacing, 0.01);
}

TEST(Study, RunsEveryCaseWithEveryPointOfTheGrid) {
  json study = small_study();
  study["cases"] = {{{"name", "a"}}, {{"name", "b"}, {"set", {{"/numerics/courant", 0.3}}}}};
  study["vary"] = {
      {{"key", "/resolution/spacing"}, {"values", {0.01, 0.02}}},
      {{"key", "/numerics/kernel"}, {"values", {"wendland_c2", "truncated_gaussian"}}}};
  const StudyPlan plan = plan_of(study);
  ASSERT_EQ(plan.runs.size(), 8u);
  EXPECT_EQ(plan.runs[0].name, "a-spacing-0.01-kernel-wendland_c2");
  std::set<std::string> names;
  for (const StudyRun& run : plan.runs) names.insert(run.name);
  EXPECT_EQ(names.size(), 8u);
  const StudyRun& last = plan.runs.back();
  EXPECT_EQ(last.of_case, "b");
  EXPECT_DOUBLE_EQ(last.scene.method.courant, 0.3);
  EXPECT_DOUBLE_EQ(last.scene.method.spacing, 0.02);
  EXPECT_EQ(last.scene.method.kernel, KernelKind::truncated_gaussian);
}

TEST(Study, ACaseMayHaveABaseOfItsOwn) {
  json study = small_study();
  json other = puddle();
  other["numerics"]["courant"] = 0.125;
  study["cases"] = {{{"name", "a"}},
                    {{"name", "b"}, {"scene", other}, {"set", {{"/end_time", 0.2}}}}};
  const StudyPlan plan = plan_of(study);
  ASSERT_EQ(plan.runs.size(), 2u);
  EXPECT_NE(plan.runs[0].scene.method.courant, 0.125);
  EXPECT_DOUBLE_EQ(plan.runs[0].scene.end_time, 0.1);
  EXPECT_DOUBLE_EQ(plan.runs[1].scene.method.courant, 0.125);
  EXPECT_DOUBLE_EQ(plan.runs[1].scene.end_time, 0.2);
  study["cases"][1]["scene"] = "other.json";
  expect_refused(study, "/cases/1/scene", "must be the scene itself");
}

TEST(Study, LeavesAKeyOutForNull) {
  json study = small_study();
  study["cases"] = {{{"name", "bare"}, {"set", {{"/numerics/artificial_viscosity", nullptr}}}}};
  ASSERT_EQ(plan_of(study).runs.size(), 1u);
  EXPECT_FALSE(plan_of(study).runs[0].scene.method.viscosity);
  EXPECT_TRUE(plan_of(small_study()).runs[0].scene.method.viscosity);
}

TEST(Study, GivesEachMemberItsOwnSeed) {
  json study = small_study();
  study["members"] = {{"count", 3}, {"perturbation", 0.01}};
  const StudyPlan plan = plan_of(study);
  ASSERT_EQ(plan.runs.size(), 3u);
  std::set<int> seeds;
  for (const StudyRun& run : plan.runs) {
    ASSERT_TRUE(run.scene.perturbation);
    EXPECT_DOUBLE_EQ(run.scene.perturbation->amplitude, 0.01);
    seeds.insert(run.scene.perturbation->seed);
    EXPECT_EQ(run.setup, "small");
  }
  EXPECT_EQ(seeds.size(), 3u);
}

TEST(Study, ReadsFormerNamesOfItsOwnKeysAndOfTheScenes) {
  json study = small_study();
  study["repeats"] = {{"count", 2}, {"jitter", 0.02}};
  study["cases"] = {{{"name", "rough"}, {"set", {{"/numerics/wall_drag/coefficient", 0.03}}}}};
  study["vary"] = {{{"key", "/numerics/wall_drag"}, {"values", {{{"coefficient", 0.02}}}}}};
  const StudyPlan plan = plan_of(study);
  ASSERT_EQ(plan.runs.size(), 2u);
  EXPECT_DOUBLE_EQ(plan.runs[1].scene.perturbation.value().amplitude, 0.02);
  EXPECT_DOUBLE_EQ(plan.runs[1].scene.method.wall_shear.value().coefficient, 0.02);
  EXPECT_TRUE(plan.runs[1].setup.starts_with("rough-wall_drag-")) << plan.runs[1].setup;

  study["repeats"]["jitter"] = 7;
  expect_refused(study, "/repeats/jitter", "");
}

TEST(Study, RefusesAMisspelledKeyOfTheSceneBeforeAnythingRuns) {
  json study = small_study();
  study["vary"] = {{{"key", "/numerics/corant"}, {"values", {0.1}}}};
  expect_refused(study, "", "run small-corant-0.1: /numerics/corant");
}

TEST(Study, RefusesPointersThatLeadNowhere) {
  for (const char* key : {"no slash", "/fluid/x/size", "/name/below", "/fluid/7/0", "//"}) {
    json study = small_study();
    study["vary"] = {{{"key", key}, {"values", {1, 2}}}};
    const StudyPlan plan = plan_of(study);
    EXPECT_TRUE(plan.runs.empty()) << key;
    EXPECT_FALSE(plan.problems.empty()) << key;
  }
}

TEST(Study, RefusesWhatItCannotRun) {
  json study = small_study();
  study["scene"] = "puddle.json";
  expect_refused(study, "/scene", "must be the scene itself");
  study = small_study();
  study["vary"] = {{{"key", "/end_time"}, {"values", json::array()}}};
  expect_refused(study, "/vary/0/values", "is empty");
  study = small_study();
  study["cases"] = {{{"name", "a"}}, {{"name", "a"}}};
  expect_refused(study, "", "two runs of the name a");
  study = small_study();
  study["scene"]["spacing"] = 1;
  expect_refused(study, "", "/spacing");
  study = small_study();
  study["case"] = json::array();
  expect_refused(study, "/case", "cases");
}

TEST(Study, RefusesAGridWithoutEndBeforeMakingIt) {
  json study = small_study();
  json values = json::array();
  for (int i = 1; i <= 60; ++i) values.push_back(0.001 * i);
  for (const char* key : {"/numerics/courant", "/end_time", "/resolution/smoothing_ratio"}) {
    study["vary"].push_back({{"key", key}, {"values", values}});
  }
  expect_refused(study, "", "makes 216000 runs, more than 1000");
}

TEST(Study, RefusesMoreRunsThanItsReaderAllows) {
  json study = small_study();
  study["members"] = {{"count", 3}};
  EXPECT_EQ(plan_study(study.dump(), {}, 3).runs.size(), 3u);
  EXPECT_TRUE(plan_study(study.dump(), {}, 2).runs.empty());
}

TEST(Study, SurvivesAnyText) {
  for (const char* text : {"", "{", "[]", "3", "null", R"({"name": 3, "scene": null})",
                           R"({"name": "a", "scene": {}, "cases": [{"name": "b", "set": []}]})",
                           R"({"name": "a", "scene": [], "vary": {}})"}) {
    const StudyPlan plan = plan_study(text, {});
    EXPECT_TRUE(plan.runs.empty()) << text;
    EXPECT_FALSE(plan.problems.empty()) << text;
  }
}

TEST(Study, LeavesATermOutForNullThatTheSchemeHas) {
  json study = small_study();
  study["vary"] = {
      {{"key", "/numerics/particle_shifting"}, {"values", {nullptr, json{{"coefficient", 1}}}}}};
  const StudyPlan plan = plan_of(study);
  ASSERT_EQ(plan.runs.size(), 2u);
  EXPECT_FALSE(plan.runs[0].scene.method.shifting);
  EXPECT_EQ(plan.runs[1].scene.method.shifting->coefficient, 1.0);
}

TEST(Study, RefusesARunWhoseSolidsAreThinnerThanItsSpacingHolds) {
  json study = small_study();
  study["scene"]["obstacles"] = {
      {{"shape", "rectangle"}, {"corner", {0.15, 0}}, {"size", {0.02, 0.1}}}};
  study["vary"] = {{{"key", "/resolution/spacing"}, {"values", {0.01, 0.0125}}}};
  expect_refused(study, "", "run small-spacing-0.0125: /obstacles/0");
}

TEST(Study, KeepsTheWarningsOfEachRun) {
  json study = small_study();
  study["scene"]["sensors"] = {
      {{"name", "outside"}, {"kind", "pressure"}, {"position", {-0.03, 0.05}}, {"interval", 0.01}}};
  study["members"] = {{"count", 2}};
  const StudyPlan plan = plan_of(study);
  ASSERT_EQ(plan.runs.size(), 2U);
  ASSERT_EQ(plan.runs[1].warnings.size(), 1U);
  EXPECT_EQ(plan.runs[1].warnings.front().pointer, "/sensors/0/position");
  EXPECT_TRUE(plan_of(small_study()).runs.front().warnings.empty());
}

// Before there were schemes this base meant kick_drift_kick without any term.
TEST(Study, TakenBeforeThereWereSchemesKeepsItsMeaning) {
  json study = small_study();
  study["scene"]["numerics"] = {{"integrator", "kick_drift_kick"}};
  expect_refused(study, "", "names no scheme");
  const StudyPlan plan = plan_study(study.dump(), {}, kMaxStudyRuns, SceneOrigin::study);
  ASSERT_EQ(plan.runs.size(), 1u);
  EXPECT_FALSE(plan.runs[0].scene.method.shifting);
  EXPECT_FALSE(parse_job_scene(plan.runs[0].scene_text).scene->method.shifting);
}

TEST(Study, GivesFoldersASceneThatNamesItsScheme) {
  json study = small_study();
  study["scene"].erase("numerics");
  const StudyPlan plan = plan_of(study);
  ASSERT_EQ(plan.runs.size(), 1u);
  EXPECT_TRUE(parse_job_scene(plan.runs[0].scene_text).scene->method.shifting);
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Study, ExamplesAreAccepted) {
  const std::filesystem::path folder =
      std::filesystem::path(SLUICE_SOURCE_DIR) / "schemas" / "examples";
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (!entry.path().filename().string().starts_with("study-")) continue;
    const StudyPlan plan = plan_study(
        text_of(entry.path()), [&](const std::string& name) { return text_of(folder / name); });
    for (const Problem& problem : plan.problems) ADD_FAILURE() << entry << problem.message;
    EXPECT_FALSE(plan.runs.empty()) << entry;
    EXPECT_EQ(plan.study.name, entry.path().stem());
    ++count;
  }
  EXPECT_GE(count, 2);
}

// To publish a change to the format, run this test once with SLUICE_PUBLISH_SCHEMA=1 in the
// environment and commit what it wrote.
TEST(Study, PublishedSchemaIsWhatTheReaderReadsBy) {
  const auto path = std::filesystem::path(SLUICE_SOURCE_DIR) / "schemas" / "study.schema.json";
  if (std::getenv("SLUICE_PUBLISH_SCHEMA") != nullptr) {
    std::ofstream(path, std::ios::binary) << study_schema_text();
  }
  EXPECT_TRUE(text_of(path) == study_schema_text()) << path << " must be published again";
}

}  // namespace
}  // namespace sluice
