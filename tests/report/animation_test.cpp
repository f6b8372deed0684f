#include "engine/report/animation.hpp"

#include <gtest/gtest.h>

#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "engine/draw/png.hpp"
#include "engine/report/figures.hpp"
#include "engine/report/snapshots.hpp"
#include "engine/scene/checks/parse.hpp"
#include "engine/scene/format/canonical.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

std::uint32_t big_endian_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k)
    value = value << 8U | static_cast<unsigned char>(bytes[at + k]);
  return value;
}

/// The types of a PNG's chunks, in order.
std::vector<std::string> chunk_types(const std::string& png) {
  std::vector<std::string> types;
  for (std::size_t at = 8; at + 12 <= png.size(); at += 12 + big_endian_at(png, at)) {
    types.push_back(png.substr(at + 4, 4));
  }
  return types;
}

/// Tank 1 m by 0.5 m with a gate, a block on its floor and snapshots every 0.1 s.
Scene test_scene(const std::string& more = "") {
  const std::string text =
      R"({"name": "pictures", "tank": {"width": 1, "height": 0.5},
          "gate": {"x": 0.3, "height": 0.4, "speed": 1},
          "fluid": [{"shape": "rectangle", "corner": [0, 0], "size": [0.3, 0.2]}],
          "obstacles": [{"shape": "rectangle", "corner": [0.6, 0], "size": [0.2, 0.2]}],
          "gravity": [0, -9.81], "resolution": {"spacing": 0.02},
          "output": {"frames": {"interval": 0.1})" +
      more + R"(}, "end_time": 1})";
  const ParseResult parsed = parse_scene(text, StabilityCheck::skip);
  if (!parsed.scene) throw std::runtime_error(parsed.problems.front().message);
  return *parsed.scene;
}

class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "sluice-looks-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
    fs::create_directories(path_ / "frames");
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { fs::remove_all(path_); }
  void add(std::uint64_t index, float x) const {
    Snapshot frame;
    frame.time = 0.1 * static_cast<double>(index);
    append(frame.position, std::array{x, 0.1F});
    append(frame.velocity, std::array{3.0F, 4.0F});
    frame.pressure = {1000.0F};
    frame.id = {0};
    write_snapshot(path_ / "frames" / snapshot_name(index), frame, Durability::process_crash);
  }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

Report report_of(Scene scene) { return make_report(scene, {}, nullptr); }

TEST(Animation, IsOnePngWithAPictureForEachSnapshotAndLeavesOutWhatCannotBeRead) {
  const Folder folder;
  for (const std::uint64_t index : {0U, 1U, 2U, 3U}) folder.add(index, 0.1F);
  std::ofstream(folder.path() / "frames" / snapshot_name(4)) << "no frame";
  const std::string png = animation_png(folder.path(), report_of(test_scene()), Quantity::pressure);
  const std::vector<std::string> types = chunk_types(png);
  EXPECT_EQ(types.front(), "IHDR");
  EXPECT_EQ(types.at(1), "acTL");
  EXPECT_EQ(types.back(), "IEND");
  EXPECT_EQ(std::count(types.begin(), types.end(), "fcTL"), 4);
  EXPECT_EQ(std::count(types.begin(), types.end(), "PLTE"), 1);
  EXPECT_EQ(big_endian_at(png, png.find("acTL") + 4), 4U);
}

TEST(Animation, ShowsASceneOfSpaceAsABodyOrAsASection) {
  const Folder folder;
  const ParseResult parsed = parse_scene(
      R"({"name": "body", "dimensions": 3, "tank": {"width": 1, "height": 0.5, "depth": 0.5},
          "fluid": [{"shape": "box", "corner": [0, 0, 0], "size": [0.3, 0.2, 0.5]}],
          "gravity": [0, -9.81, 0], "resolution": {"spacing": 0.05},
          "output": {"frames": {"interval": 0.1}}, "end_time": 1})",
      StabilityCheck::skip);
  ASSERT_TRUE(parsed.scene);
  const Report report = report_of(*parsed.scene);
  Snapshot frame = empty_snapshot(0, 0.0, 3);
  append(frame.position, std::array{0.1F, 0.1F, 0.25F});
  append(frame.velocity, std::array{0.0F, 0.0F, 0.0F});
  frame.pressure = {1000.0F};
  frame.id = {0};
  write_snapshot(folder.path() / "frames" / snapshot_name(0), frame, Durability::process_crash);
  const std::string body = animation_png(folder.path(), report, Quantity::pressure, Look::rendered);
  const std::string section =
      animation_png(folder.path(), report, Quantity::pressure, Look::section);
  // A section is as wide to its height as the tank with its walls; the body is seen from above too.
  const auto shape = [](const std::string& png) {
    return static_cast<double>(big_endian_at(png, 16)) / big_endian_at(png, 20);
  };
  EXPECT_GT(shape(section), shape(body));
  const std::string page = report_html(report, {}, {frame});
  EXPECT_NE(page.find("as a section at z = 0.25 m"), std::string::npos);
  EXPECT_NE(page.find("colours-view-0"), std::string::npos);
  EXPECT_NE(page.find("colours-section-0"), std::string::npos);
  EXPECT_EQ(report_html(report_of(test_scene()), {}, {}).find("as a body"), std::string::npos);
}

TEST(Animation, OfAJobWithoutSnapshotsIsEmpty) {
  const Folder folder;
  EXPECT_TRUE(animation_png(folder.path(), report_of(test_scene()), Quantity::speed).empty());
}

TEST(PngAnimation, NumbersItsControlsAndPicturesInOneSequence) {
  PngAnimation animation(3, 40);
  for (int k = 0; k < 3; ++k) animation.add({2, 1, {kNothing, kSolid}});
  const std::string png = animation.take();
  std::uint32_t expected = 0;
  for (std::size_t at = 8; at + 12 <= png.size(); at += 12 + big_endian_at(png, at)) {
    const std::string type = png.substr(at + 4, 4);
    if (type != "fcTL" && type != "fdAT") continue;
    EXPECT_EQ(big_endian_at(png, at + 8), expected++);
  }
  EXPECT_EQ(expected, 5U);
  EXPECT_THROW(animation.add({1, 1, {kNothing}}), std::invalid_argument);
}

TEST(Picture, DrawsWallsAndObstaclesGreyAndTheGateAsFarAsItIsStillThere) {
  const Scene scene = test_scene();
  PictureView how;
  how.view = picture_view(scene, std::nullopt);
  how.diameter = 0.02;
  how.width = 400;
  Picture picture = draw_solids(scene, how);
  const auto at = [&](double x, double y) {
    const double scale = how.width / how.view.size().x();
    const auto column = static_cast<std::size_t>((x - how.view.min.x()) * scale);
    const auto row = static_cast<std::size_t>((how.view.max.y() - y) * scale);
    return picture.pixels.at(row * static_cast<std::size_t>(picture.width) + column);
  };
  EXPECT_NEAR(picture.height, 400 * how.view.size().y() / how.view.size().x(), 0.51);
  EXPECT_EQ(at(0.5, -0.01), kSolid);
  EXPECT_EQ(at(-0.01, 0.25), kSolid);
  EXPECT_EQ(at(1.01, 0.25), kSolid);
  EXPECT_EQ(at(0.7, 0.1), kSolid);
  EXPECT_EQ(at(0.7, 0.25), kNothing);
  EXPECT_EQ(at(0.5, 0.25), kNothing);
  draw_gate(picture, scene, how, 0.2);
  EXPECT_EQ(at(0.31, 0.3), kGate);
  EXPECT_EQ(at(0.31, 0.1), kNothing) << "the lower edge has passed";
  picture = draw_solids(scene, how);
  draw_gate(picture, scene, how, 0.5);
  EXPECT_EQ(at(0.31, 0.39), kNothing);
}

TEST(Picture, FarFromZeroCountsItsAxisFromWholeMetres) {
  Scene scene = test_scene();
  scene.tank.reset();
  scene.gate.reset();
  scene.obstacles.clear();
  Snapshot frame;
  frame.origin.x() = 1e5;
  frame.position[0] = {0.0F, 0.6F};
  frame.position[1] = {0.0F, 0.3F};
  frame.pressure = {0.0F, 0.0F};
  frame.velocity[0] = frame.velocity[1] = frame.pressure;
  frame.id = {0, 1};
  const std::string svg = picture_svgs(report_of(scene), {frame}).at(0);
  EXPECT_NE(svg.find(">x - 99999 m, m<"), std::string::npos);
  EXPECT_NE(svg.find(">y, m<"), std::string::npos);
  EXPECT_EQ(svg.find(">1e5<"), std::string::npos);
}

std::vector<std::string> names_of(const std::vector<fs::path>& paths) {
  std::vector<std::string> names;
  for (const fs::path& path : paths) names.push_back(path.filename().string());
  return names;
}

TEST(PictureTimes, AreThoseOfTheSceneByTheNearestSnapshot) {
  const Folder folder;
  for (std::uint64_t index = 0; index <= 10; ++index) folder.add(index, 0.1F);
  const Report report = report_of(test_scene(R"(, "pictures": [0.29, 0.31, 0.72, 99])"));
  EXPECT_EQ(names_of(picture_files(folder.path(), report)),
            (std::vector<std::string>{snapshot_name(3), snapshot_name(7), snapshot_name(10)}));
}

TEST(PictureTimes, OtherwiseSpreadFromFirstToLastAndHoldTheHighestPressure) {
  const Folder folder;
  for (std::uint64_t index = 0; index <= 9; ++index) folder.add(index, 0.1F);
  Report report = report_of(test_scene());
  SensorSummary sensor;
  sensor.kind = "pressure";
  sensor.highest = 5000.0;
  sensor.highest_at = 0.11;
  report.sensors = {sensor};
  EXPECT_EQ(names_of(picture_files(folder.path(), report)),
            (std::vector<std::string>{snapshot_name(0), snapshot_name(1), snapshot_name(3),
                                      snapshot_name(6), snapshot_name(9)}));
}

TEST(PictureTimes, WithinASceneChangeNothingThatARunIsBoundTo) {
  const Scene named = test_scene(R"(, "pictures": [0.5])");
  EXPECT_EQ(named.pictures, (std::vector<double>{0.5}));
  EXPECT_EQ(identity_text(named), identity_text(test_scene()));
  EXPECT_EQ(canonical_text(test_scene()).find("pictures\":["), std::string::npos);
}

}  // namespace
}  // namespace sluice
