// What numerics.scheme stands for, what single keys beside it change, and what becomes of scenes
// that were written before there were schemes.

#include "engine/scene/model/scheme.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/scene/format/canonical.hpp"
#include "engine/scene/format/numerics_json.hpp"
#include "tests/scene/support.hpp"

namespace sluice {
namespace {

using nlohmann::json;
using testing::base_scene;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_at;
using testing::parse;
using testing::parsed;
using testing::pointers;

json with_numerics(const std::string& numerics) {
  json scene = base_scene();
  scene["numerics"] = json::parse(numerics);
  return scene;
}

Method method_with(const std::string& numerics) { return parsed(with_numerics(numerics)).method; }

std::filesystem::path earlier() { return testing::source_dir() / "tests/scene/earlier"; }

// The nine keys that README told to copy.
constexpr const char* kNineKeys = R"({
    "kernel": "wendland_c2", "integrator": "kick_drift_kick", "courant": 1.0, "precision": "mixed",
    "density_diffusion": {"kind": "fourtakas", "delta": 0.1},
    "artificial_viscosity": {"alpha": 0.02, "epsilon": 0.01, "beta": 0.5},
    "wall_shear": {"coefficient": 0.01}, "wall_pressure": "clamped",
    "particle_shifting": {"coefficient": 2}})";

TEST(Scheme, RecommendedIsTheDefaultAndStandsForNineKeys) {
  const json nine = numerics_json(method_with(kNineKeys));
  EXPECT_EQ(numerics_json(parsed(base_scene()).method), nine);
  EXPECT_EQ(numerics_json(method_with(R"({"scheme": "recommended"})")), nine);
  EXPECT_EQ(parsed(base_scene()).method.smoothing_length, 1.5 * 0.05);
}

TEST(Scheme, PaperStandsForWhatThePaperPrints) {
  const Method m = method_with(R"({"scheme": "paper"})");
  EXPECT_EQ(m.kernel, KernelKind::truncated_gaussian);
  EXPECT_EQ(m.integrator, Integrator::modified_leap_frog);
  EXPECT_EQ(m.courant, 0.25);
  ASSERT_TRUE(m.diffusion && m.viscosity && m.reinitialisation);
  EXPECT_EQ(m.diffusion->kind, DiffusionKind::molteni_colagrossi);
  EXPECT_EQ(m.viscosity->beta, 0.0);
  EXPECT_EQ(m.reinitialisation->interval, 20);
  EXPECT_EQ(m.wall_pressure, WallPressure::extrapolated);
  EXPECT_FALSE(m.wall_shear || m.shifting || m.wall_artificial_viscosity || m.laminar_viscosity);
  EXPECT_EQ(m.smoothing_length, 0.05);
}

TEST(Scheme, SingleKeysOverrideItAndNullLeavesATermOut) {
  const Method m = method_with(R"({"scheme": "recommended", "courant": 0.5,
      "artificial_viscosity": {"alpha": 0.1}, "particle_shifting": null,
      "reinitialisation": {}})");
  EXPECT_EQ(m.courant, 0.5);
  EXPECT_EQ(m.viscosity->alpha, 0.1);
  EXPECT_EQ(m.viscosity->beta, 0.5) << "of the scheme";
  EXPECT_FALSE(m.shifting);
  EXPECT_EQ(m.reinitialisation->interval, 20);
  EXPECT_EQ(m.kernel, KernelKind::wendland_c2);
}

TEST(Scheme, ANamedKeySwitchesOffWhatItExcludes) {
  const Method slow =
      method_with(R"({"scheme": "recommended", "integrator": "modified_leap_frog"})");
  EXPECT_FALSE(slow.shifting);
  EXPECT_EQ(slow.courant, 0.25);
  for (const char* term : {"wall_artificial_viscosity", "laminar_viscosity"}) {
    json scene = base_scene();
    scene["numerics"] = {{"scheme", "recommended"}, {term, json::object()}};
    EXPECT_FALSE(parsed(scene).method.wall_shear) << term;
  }
  EXPECT_EQ(method_with(R"({"scheme": "recommended", "kernel": "truncated_gaussian"})").support(),
            method_with(R"({"scheme": "recommended"})").support());
}

TEST(Scheme, WhatIsNamedAndExcludedIsAProblemThatSaysWhatToWrite) {
  const auto shifting = parse(with_numerics(R"({"scheme": "paper", "particle_shifting": {}})"));
  EXPECT_THAT(message_at(shifting, "/numerics/particle_shifting"),
              HasSubstr(R"("integrator": "kick_drift_kick")"));
  const auto both = parse(with_numerics(
      R"({"scheme": "recommended", "wall_artificial_viscosity": {}, "wall_shear": {}})"));
  EXPECT_THAT(pointers(both), ElementsAre("/numerics/wall_artificial_viscosity"));
}

TEST(Scheme, SuitsScenesWithoutWallsAndGravity) {
  const ParseResult free =
      parse(testing::free_scene({{"shape", "circle"}, {"center", {0, 0}}, {"radius", 1}}));
  ASSERT_TRUE(free.scene) << testing::list(free.problems);
  EXPECT_TRUE(free.warnings.empty()) << testing::list(free.warnings);
}

TEST(Scheme, NullIsNoValueOfWhatIsNoTerm) {
  EXPECT_THAT(pointers(parse(with_numerics(R"({"courant": null})"))),
              ElementsAre("/numerics/courant"));
  EXPECT_THAT(pointers(parse(with_numerics(R"({"scheme": null})"))),
              ElementsAre("/numerics/scheme"));
  EXPECT_THAT(pointers(parse(with_numerics(R"({"scheme": "papers"})"))),
              ElementsAre("/numerics/scheme"));
  EXPECT_TRUE(takes_null("/numerics/wall_shear"));
  for (const char* key : {"/numerics/courant", "/numerics", "/output", "/numerics/wall_shear/x"}) {
    EXPECT_FALSE(takes_null(key)) << key;
  }
}

TEST(SceneWithoutScheme, MeansTheRecommendedWhereItCouldNotRunBefore) {
  // Without damping the leap-frog has no stable step: such scenes failed.
  for (const char* numerics : {"{}", R"({"courant": 0.5})", R"({"precision": "double"})",
                               R"({"kernel": "wendland_c2"})"}) {
    const ParseResult result = parse(with_numerics(numerics));
    ASSERT_TRUE(result.scene) << numerics << testing::list(result.problems);
    EXPECT_TRUE(result.scene->method.shifting) << numerics;
    EXPECT_TRUE(result.warnings.empty()) << testing::list(result.warnings);
  }
}

TEST(SceneWithoutScheme, IsRefusedWhereItRanAsSomethingElseAndToldWhatToWrite) {
  const ParseResult result = parse(with_numerics(R"({"integrator": "kick_drift_kick"})"));
  EXPECT_THAT(pointers(result), ElementsAre("/numerics"));
  EXPECT_THAT(message_at(result, "/numerics"), HasSubstr(R"("scheme": "recommended")"));
}

/// The part of a message between the last `or ` and ` to keep`: keys to write.
json spelled(const std::string& message) {
  const std::size_t end = message.find(" to keep");
  const std::size_t start = message.rfind(", or ", end) + 5;
  return json::parse("{" + message.substr(start, end - start) + "}");
}

TEST(SceneWithoutScheme, KeepsItsMeaningWithWhatTheRefusalTellsToWrite) {
  int refused = 0;
  for (const auto& path : testing::json_files(earlier())) {
    json text = json::parse(testing::read_text(path));
    const ParseResult before = parse_job_scene(text.dump());
    ASSERT_TRUE(before.scene) << path;
    const ParseResult now = parse(text);
    if (!now.scene) {
      ++refused;
      ASSERT_THAT(pointers(now), ElementsAre("/numerics")) << path;
      text["numerics"].update(spelled(message_at(now, "/numerics")));
    }
    EXPECT_EQ(identity_text(parsed(text)), identity_text(*before.scene)) << path;
  }
  EXPECT_EQ(refused, 4) << "all but dambreak, which names the nine keys";
}

TEST(SceneWithoutScheme, IdentitiesOfTheExamplesAreWhatTheyWere) {
  for (const auto& path : testing::json_files(earlier())) {
    const auto now = testing::source_dir() / "schemas/examples" / path.filename();
    const ParseResult before = parse_job_scene(testing::read_text(path));
    ASSERT_TRUE(before.scene) << path;
    EXPECT_EQ(identity_text(parsed(json::parse(testing::read_text(now)))),
              identity_text(*before.scene))
        << path;
  }
}

TEST(TextForFolder, NamesTheSchemeWhereAnEarlierFolderWouldMeanAnother) {
  const std::string bare = base_scene().dump();
  const std::string kept = text_for_folder(bare);
  EXPECT_EQ(json::parse(kept)["numerics"]["scheme"], "recommended");
  EXPECT_EQ(identity_text(*parse_job_scene(kept).scene), identity_text(parsed(base_scene())));
  EXPECT_FALSE(parse_job_scene(bare).scene->method.viscosity) << "as before there were schemes";
  for (const std::string& same :
       {kept, with_numerics(kNineKeys).dump(2), with_numerics(R"({"scheme": "paper"})").dump()}) {
    EXPECT_EQ(text_for_folder(same), same);
  }
}

TEST(TextForFolder, ReadsATakenStudysSceneAsItWasTaken) {
  const std::string text = with_numerics(R"({"integrator": "kick_drift_kick"})").dump();
  const auto read = [&](SceneOrigin origin) {
    return *parse_scene(text, StabilityCheck::skip, origin).scene;
  };
  EXPECT_EQ(identity_text(read(SceneOrigin::study)), identity_text(read(SceneOrigin::job)));
  EXPECT_EQ(text_for_folder(text), text);
}

}  // namespace
}  // namespace sluice
