// STL and OBJ files: whole, and as no program should write them.

#include "engine/scene/format/mesh_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <random>
#include <string>

#include "engine/scene/geometry/mesh_faults.hpp"
#include "tests/scene/meshes.hpp"

namespace sluice {
namespace {

using testing::as_ascii_stl;
using testing::as_binary_stl;
using testing::as_obj;
using ::testing::HasSubstr;

constexpr std::size_t kMany = 1000;

Triangles small_box() { return testing::box_mesh(Vec3(-0.25, 0, 1), Vec3(1, 2, 0.5)); }

std::string error_of(const std::string& name, const std::string& bytes) {
  try {
    (void)read_mesh_file(name, bytes, kMany);
  } catch (const MeshFileError& error) {
    return error.what();
  }
  return "";
}

TEST(MeshFile, TheSameBodyIsReadFromEachKind) {
  for (const auto& [name, bytes] : {std::pair("box.stl", as_binary_stl(small_box())),
                                    std::pair("BOX.STL", as_ascii_stl(small_box())),
                                    std::pair("box.obj", as_obj(small_box()))}) {
    const Triangles read = read_mesh_file(name, bytes, kMany);
    EXPECT_EQ(read.points.size(), 8u) << name << ": corners at one place are one";
    EXPECT_EQ(read.corners.size(), 12u) << name;
    EXPECT_EQ(mesh_fault(read), std::nullopt) << name;
    const TriangleMesh mesh(read);
    EXPECT_EQ(mesh.volume(), 1.0) << name;
    EXPECT_EQ(mesh.bounds().min, Vec3(-0.25, 0, 1)) << name;
    EXPECT_EQ(mesh.bounds().max, Vec3(0.75, 2, 1.5)) << name;
  }
}

TEST(MeshFile, ABinaryFileMayBeginWithTheWordOfAsciiOnes) {
  std::string bytes = as_binary_stl(small_box());
  bytes.replace(0, 5, "solid");
  EXPECT_EQ(read_mesh_file("box.stl", bytes, kMany).corners.size(), 12u);
}

TEST(MeshFile, ObjFacesMayHaveMoreCornersAndCountFromTheEnd) {
  const std::string text =
      "mtllib none.mtl\r\nv 0 0 0 1\r\nv 1 0 0\nv 0 1 0\nv +0 -0 1e0 # the tip\n"
      "g base\nusemtl none\nf 1 3 2\nf 1 2 4\nf -3/1/1 -2/2/2 -1\nf 3 1 4\n"
      "v 5 5 5\nv 6 5 5\nv 6 5 6\nv 5 5 6\nf 5 6 7 8\n";
  const Triangles read = read_mesh_file("tip.obj", text, kMany);
  EXPECT_EQ(read.corners.size(), 6u);
  EXPECT_EQ(read.points[read.corners[2][0]], Vec3(1, 0, 0));
}

TEST(MeshFile, TrianglesWithTwoCornersAtOnePlaceAreLeftOut) {
  Triangles with_more = small_box();
  with_more.corners.push_back({0, 1, 1});
  EXPECT_EQ(read_mesh_file("a.stl", as_binary_stl(with_more), kMany).corners.size(), 12u);
  const Triangles none{{Vec3(0, 0, 0), Vec3(1, 0, 0)}, {{0, 1, 1}}};
  EXPECT_THAT(error_of("a.stl", as_binary_stl(none)), HasSubstr("no triangle with an area"));
}

TEST(MeshFile, CutOffFilesSayWhereAndHow) {
  const std::string binary = as_binary_stl(small_box());
  EXPECT_THAT(error_of("a.stl", binary.substr(0, 300)),
              HasSubstr("has 300 bytes, but as a binary STL of 12 triangles (bytes 80 to 83) it "
                        "must have 684"));
  EXPECT_THAT(error_of("a.stl", binary.substr(0, 30)), HasSubstr("has 30 bytes"));
  EXPECT_THAT(error_of("a.stl", ""), HasSubstr("has 0 bytes"));
  const std::string ascii = as_ascii_stl(small_box());
  EXPECT_THAT(error_of("a.stl", ascii.substr(0, ascii.find("endloop"))),
              HasSubstr("no more, where endloop must be: it was cut off"));
  EXPECT_THAT(error_of("a.obj", ""), HasSubstr("no triangle"));
}

TEST(MeshFile, HugeCountsAreRefusedBeforeAnythingIsMade) {
  std::string binary = as_binary_stl(small_box());
  binary.replace(80, 4, "\xff\xff\xff\xff");
  EXPECT_THAT(error_of("a.stl", binary), HasSubstr("4294967295 triangles"));
  Triangles many = small_box();
  while (many.corners.size() <= kMany) many.corners.push_back({0, 1, 2});
  for (const auto& [name, bytes] :
       {std::pair("a.stl", as_binary_stl(many)), std::pair("a.stl", as_ascii_stl(many)),
        std::pair("a.obj", as_obj(many))}) {
    EXPECT_THAT(error_of(name, bytes), HasSubstr("has 1001 triangles; at most 1000"));
  }
}

TEST(MeshFile, WhatIsNoPlaceIsRefusedWithItsPlaceInTheFile) {
  for (const float wrong :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e20F}) {
    std::string binary = as_binary_stl(small_box());
    std::memcpy(binary.data() + 84 + 12, &wrong, sizeof wrong);
    EXPECT_THAT(error_of("a.stl", binary), HasSubstr("a corner at byte 96 that is no place"));
  }
  for (const std::string wrong : {"nan", "inf", "1e999", "0x10", "ten", "1.5.2", ""}) {
    EXPECT_THAT(error_of("a.obj", "v 0 0 0\nv 1 2 " + wrong + "\n"), HasSubstr("in line 2"));
  }
  EXPECT_THAT(error_of("a.obj", "v 0 0 1e15\n"), HasSubstr("a coordinate above"));
}

TEST(MeshFile, FacesOfCornersThatAreNotThereAreRefused) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const std::string face :
       {"f 1 2 4", "f 0 1 2", "f -4 1 2", "f 1 2 x", "f 1 2 3x", "f 99999999999999999999 1 2"}) {
    EXPECT_THAT(error_of("a.obj", points + face), HasSubstr("in line 4")) << face;
  }
  EXPECT_THAT(error_of("a.obj", points + "f 1 2"), HasSubstr("less than three corners"));
}

TEST(MeshFile, OtherTextsAreRefusedWithTheirLine) {
  EXPECT_THAT(error_of("a.stl", "solid x\n facet normal 0 0 0\n inner loop\n"),
              HasSubstr("\"inner\", where outer must be in line 3"));
  EXPECT_THAT(error_of("a.stl", "solid x\n<html>\n"), HasSubstr("no facet"));
  EXPECT_THAT(error_of("a.stl", std::string(2000, '\xff')), HasSubstr("another kind of file"));
}

RC_GTEST_PROP(MeshFile, BytesThatWereChangedAreReadOrRefused, (unsigned seed)) {
  std::mt19937 dice(seed);
  const auto any = [&](std::size_t below) {
    return std::uniform_int_distribution<std::size_t>(0, below - 1)(dice);
  };
  for (auto [name, bytes] :
       {std::pair("a.stl", as_binary_stl(small_box())),
        std::pair("a.stl", as_ascii_stl(small_box())), std::pair("a.obj", as_obj(small_box()))}) {
    for (int k = 0; k < 3; ++k) bytes[any(bytes.size())] = static_cast<char>(any(256));
    if (any(2) == 0) bytes.resize(any(bytes.size()));
    try {
      (void)mesh_fault(read_mesh_file(name, bytes, kMany));
    } catch (const MeshFileError& error) {
      RC_ASSERT(std::string(error.what()).size() < 400);
    }
  }
}

}  // namespace
}  // namespace sluice
