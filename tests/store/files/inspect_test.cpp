#include "engine/store/files/inspect.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/store/disk/publish.hpp"
#include "engine/store/files/checkpoint_io.hpp"
#include "engine/store/files/series_file.hpp"
#include "engine/store/hdf5/hdf5_writer.hpp"
#include "tests/store/fixtures.hpp"

namespace sluice::test {
namespace {

using nlohmann::json;

bool mentions(const Inspection& inspection, const std::string& text) {
  return inspection.text.find(text) != std::string::npos;
}

TEST(Inspect, TellsWhatACheckpointHolds) {
  const TemporaryFolder folder;
  Checkpoint checkpoint = make_checkpoint(20);
  checkpoint.solver.particles.position[0].assign(50, 0.5);
  checkpoint.solver.particles.position[0][3] = -2.0;
  const Inspection inspection = inspect_file(write_checkpoint(folder.path(), checkpoint));
  EXPECT_EQ(inspection.verdict, Verdict::whole);
  for (const char* text : {"sluice-checkpoint", "scene_hash", "AVX2", "/particles/vx_half", "m/s",
                           "-2.0 ... 0.5", "P1", "3 samples, 0.0 s ... 0.3 s", "verdict: whole"}) {
    EXPECT_TRUE(mentions(inspection, text)) << text << "\n" << inspection.text;
  }
  const json facts = json::parse(inspection.json);
  EXPECT_EQ(facts["verdict"], "whole");
  EXPECT_EQ(facts["attributes"]["step"], 20);
  EXPECT_EQ(facts["trailer"]["version"], 1);
  EXPECT_EQ(facts["series"].size(), 3U);
  EXPECT_EQ(facts["groups"]["/guards"]["energy_scale"], 20.0);
}

TEST(Inspect, TellsWhatSeriesAndFramesHold) {
  const TemporaryFolder folder;
  write_series(folder / "series.h5", make_samples());
  write_snapshot(folder / "frame.h5", make_test_snapshot(5));
  EXPECT_TRUE(mentions(inspect_file(folder / "series.h5"), "sluice-series"));
  EXPECT_TRUE(mentions(inspect_file(folder / "series.h5"), "(1 not a number)"));
  EXPECT_TRUE(mentions(inspect_file(folder / "frame.h5"), "/particles/pressure"));
  EXPECT_EQ(inspect_file(folder / "frame.h5").verdict, Verdict::whole);
  EXPECT_EQ(inspect(folder / "frame.h5"), inspect_file(folder / "frame.h5").text);
}

TEST(Inspect, ExplainsWhatIsNoFileOfOurs) {
  const TemporaryFolder folder;
  std::ofstream(folder / "empty").flush();
  std::ofstream(folder / "text") << std::string(1000, 'x');
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(inspect_file(folder / "empty").verdict, Verdict::damaged);
  EXPECT_EQ(inspect_file(folder / "text").verdict, Verdict::damaged);
  EXPECT_TRUE(mentions(inspect_file(folder / "text"), "not written by this program"));
  EXPECT_EQ(inspect_file(folder / "pipe").verdict, Verdict::damaged);
  EXPECT_EQ(inspect_file(folder.path()).verdict, Verdict::damaged);
  EXPECT_EQ(inspect_file(folder / "missing").verdict, Verdict::unreadable);
  EXPECT_EQ(json::parse(inspect_file(folder / "missing").json)["verdict"], "unreadable");
}

TEST(Inspect, TellsOfAWholeFileOfUnknownContent) {
  const TemporaryFolder folder;
  Hdf5Writer writer;
  writer.set_attribute("/", "format", std::string("photographs"));
  publish(folder / "photos.h5", writer.image(), Durability::power_cut);
  const Inspection inspection = inspect_file(folder / "photos.h5");
  EXPECT_EQ(inspection.verdict, Verdict::unsupported);
  EXPECT_TRUE(mentions(inspection, "photographs"));
  publish(folder / "noise.h5", Bytes(3000), Durability::power_cut);
  EXPECT_EQ(inspect_file(folder / "noise.h5").verdict, Verdict::damaged);
}

}  // namespace
}  // namespace sluice::test
