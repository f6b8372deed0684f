// The files that scenes name: beside them, in a job's folder, or as they were sent.

#include "engine/store/files/scene_parts.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "engine/scene/model/problems.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/files/job_folder.hpp"
#include "tests/store/fixtures.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;

void write_file(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}
std::string read_file(const fs::path& path) { return read_text(path, kMaxMeshBytes); }

TEST(SceneParts, AreReadBesideTheSceneWithTheirSha256) {
  const TemporaryFolder folder;
  write_file(folder / "a.stl", "abc");
  const ScenePart part = parts_in(folder.path(), Links::refuse)("a.stl");
  EXPECT_EQ(part.bytes, "abc");
  EXPECT_EQ(part.why_none, "");
  // FIPS 180-2, appendix B.1.
  EXPECT_EQ(part.sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(SceneParts, AreReadOnceSoThatNobodySeesTwoOfThem) {
  const TemporaryFolder folder;
  write_file(folder / "a.stl", "abc");
  const SceneParts parts = parts_in(folder.path(), Links::refuse);
  (void)parts("a.stl");
  write_file(folder / "a.stl", "changed");
  EXPECT_EQ(parts("a.stl").bytes, "abc");
}

TEST(SceneParts, WhatCannotBeReadSaysWhy) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "folder.stl");
  write_file(folder / "there.stl", "abc");
  fs::create_symlink(folder / "there.stl", folder / "link.stl");
  write_file(folder / "large.stl", std::string(kMaxMeshBytes + 1, 'x'));
  const SceneParts parts = parts_in(folder.path(), Links::refuse);
  for (const char* name : {"none.stl", "folder.stl", "link.stl", "large.stl"}) {
    EXPECT_NE(parts(name).why_none, "") << name;
    EXPECT_EQ(parts(name).bytes, "") << name;
  }
  EXPECT_EQ(parts_in(folder.path(), Links::follow)("link.stl").bytes, "abc");
}

TEST(SceneParts, ThatWereSentAreFoundByTheirNames) {
  const SceneParts parts = parts_from({{"a.stl", "abc"}, {"b.stl", ""}}, "; send it");
  EXPECT_EQ(parts("a.stl").bytes, "abc");
  EXPECT_EQ(parts("b.stl").why_none, "");
  EXPECT_EQ(parts("c.stl").why_none, "no file of that name came with the scene; send it");
}

TEST(SceneParts, OfASceneComeOnceEachByName) {
  Scene scene;
  Mesh mesh;
  mesh.file = "b.stl";
  scene.obstacles = {mesh, mesh, Cuboid<3>{}};
  mesh.file = "a.stl";
  scene.fluid.push_back({});
  scene.fluid.back().shape = mesh;
  const auto named = parts_of(scene, parts_from({{"a.stl", "abc"}, {"b.stl", "d"}}, ""));
  ASSERT_EQ(named.size(), 2u);
  EXPECT_EQ(named[0].name, "a.stl");
  EXPECT_EQ(named[0].bytes, "abc");
  EXPECT_EQ(named[1].bytes, "d");
}

TEST(SceneParts, AreInTheFolderOfANewJobBeforeItsScene) {
  const TemporaryFolder folder;
  const std::vector<NamedPart> parts{{"a.stl", "abc"}};
  {
    const JobFolder job = JobFolder::create(folder / "job", "{}", parts);
    EXPECT_EQ(read_file(folder / "job" / "a.stl"), "abc");
    EXPECT_EQ(job.paths().parts(), std::vector<fs::path>{folder / "job" / "a.stl"});
  }
  // As if the making had been cut short before the scene.
  fs::remove(folder / "job" / "scene.json");
  fs::remove(folder / "job" / "frames");
  write_file(folder / "job" / "a.stl", "other");
  EXPECT_THROW((void)JobFolder::create(folder / "job", "{}"), StorageError)
      << "a file of somebody else";
  const JobFolder again = JobFolder::create(folder / "job", "{}", parts);
  EXPECT_EQ(read_file(folder / "job" / "a.stl"), "abc");
}

}  // namespace
}  // namespace sluice::test
