#include <gtest/gtest.h>

#include <set>
#include <span>

#include "engine/store/disk/publish.hpp"
#include "engine/store/files/snapshot_io.hpp"
#include "engine/store/hdf5/hdf5_writer.hpp"
#include "tests/store/fixtures.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;

/// A row of particles a centimetre apart, from `start` on.
SolverState row_from(double start, std::size_t count) {
  SolverState state = make_checkpoint(1).solver;
  Particles& particles = state.particles;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    particles.position[0][i] = start + 0.01 * static_cast<double>(i % count);
    particles.position[1][i] = 0.005;
  }
  return state;
}

TEST(FrameFile, FarFromZeroKeepsParticlesApartToAThousandthOfTheirDistance) {
  for (const double start : {0.0, 1e5, -3e8}) {
    const TemporaryFolder folder;
    const SolverState state = row_from(start, 50);
    write_snapshot(folder / "f.h5", make_snapshot(state, Method{}));
    const Snapshot frame = read_snapshot(folder / "f.h5");
    std::set<double> places;
    for (std::size_t i = 0; i < frame.size(); ++i) {
      EXPECT_NEAR(frame.position_of(i).x(), state.particles.position[0][i],
                  1e-5 + 1e-15 * std::abs(start));
      EXPECT_NEAR(frame.position_of(i).y(), 0.005, 1e-9);
      places.insert(frame.position_of(i).x());
    }
    EXPECT_EQ(places.size(), 50U);
  }
}

TEST(FrameFile, NearZeroHasItsOriginThere) {
  EXPECT_EQ(make_snapshot(row_from(0.0, 50), Method{}).origin.x(), 0.0);
  EXPECT_EQ(make_snapshot(row_from(-0.2, 50), Method{}).origin.x(), 0.0);
}

TEST(FrameFile, OfTheFirstVersionIsReadWithPositionsFromZero) {
  const TemporaryFolder folder;
  Hdf5Writer writer;
  writer.set_attribute("/", "format", std::string("sluice-frame"));
  writer.set_attribute("/", "version", std::uint64_t{1});
  writer.set_attribute("/", "step", std::uint64_t{7});
  writer.set_attribute("/", "time", 0.5);
  writer.create_group("/particles");
  writer.set_attribute("/particles", "count", std::uint64_t{2});
  const std::vector<float> values{0.25F, 0.5F};
  const auto label = [&](const std::string& path, const char* unit) {
    writer.set_attribute(path, "unit", std::string(unit));
    writer.set_attribute(path, "description", std::string("as it was"));
  };
  for (const auto& [name, unit] :
       {std::pair{"x", "m"}, {"y", "m"}, {"vx", "m/s"}, {"vy", "m/s"}, {"pressure", "Pa"}}) {
    const std::string path = std::string("/particles/") + name;
    writer.write(path, std::span<const float>(values), {2});
    label(path, unit);
  }
  const std::vector<std::uint64_t> ids{0, 1};
  writer.write("/particles/id", std::span<const std::uint64_t>(ids), {2});
  label("/particles/id", "1");
  publish(folder / "f.h5", writer.image(), Durability::process_crash);
  const Snapshot frame = read_snapshot(folder / "f.h5");
  EXPECT_EQ(frame.step, 7U);
  EXPECT_EQ(frame.position_of(1).x(), 0.5);
}

}  // namespace
}  // namespace sluice::test
