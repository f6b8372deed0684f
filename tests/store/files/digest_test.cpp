#include "engine/store/files/digest.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <functional>
#include <set>
#include <utility>

#include "engine/store/files/checkpoint_io.hpp"
#include "tests/store/fixtures.hpp"

namespace sluice::test {
namespace {

/// Runs over every number that decides how a run goes on and flips one of its bits in turn.
class BitFlipper {
 public:
  explicit BitFlipper(std::function<void()> seen) : seen_(std::move(seen)) {}

  void operator()(std::uint64_t& number) const {
    for (const unsigned bit : {0U, 31U, 51U, 52U, 63U}) {
      const std::uint64_t before = number;
      number ^= std::uint64_t{1} << bit;
      seen_();
      number = before;
    }
  }
  void operator()(double& number) const {
    const double before = number;
    for (unsigned bit = 0; bit < 64; ++bit) {
      number =
          std::bit_cast<double>(std::bit_cast<std::uint64_t>(before) ^ (std::uint64_t{1} << bit));
      seen_();
    }
    number = before;
  }
  void operator()(std::vector<double>& numbers) const {
    for (double& number : numbers) {
      (*this)(number);
    }
  }

 private:
  std::function<void()> seen_;
};

TEST(PhysicsDigest, ChangesWithEveryBitOfEveryNumber) {
  Checkpoint checkpoint = make_checkpoint(20, 3);
  std::set<std::string> digests{physics_digest(checkpoint)};
  std::size_t changes = 1;
  const BitFlipper flip([&] {
    digests.insert(physics_digest(checkpoint));
    ++changes;
  });
  flip(checkpoint.solver.step);
  flip(checkpoint.solver.time);
  flip(checkpoint.solver.time_step);
  flip(checkpoint.next_snapshot);
  for (const Field& field : fields_in(2)) {
    flip(field.values.of(checkpoint.solver.particles));
  }
  for (RemovedParticle& removed : checkpoint.solver.removed) {
    flip(removed.id);
    flip(removed.step);
    flip(removed.time);
    for (const RemovedField& field : removed_fields_in(2)) flip(field.value.of(removed));
  }
  for (SampleTable& table : checkpoint.samples) {
    flip(table.time);
    flip(table.duration);
    flip(table.values);
    flip(table.weight);
    flip(table.next_index);
    for (std::uint64_t& place : table.places) flip(place);
  }
  for (const GuardNumber& number : kGuardNumbers) flip(checkpoint.guards.*number.member);
  EXPECT_EQ(digests.size(), changes);
  EXPECT_GT(changes, 3000U);
}

TEST(PhysicsDigest, ChangesWithTheOrderOfParticlesCausesAndTexts) {
  const std::string before = physics_digest(make_checkpoint(20, 3));
  Checkpoint swapped = make_checkpoint(20, 3);
  std::swap(swapped.solver.particles.position[0][0], swapped.solver.particles.position[0][1]);
  EXPECT_NE(physics_digest(swapped), before);
  Checkpoint cause = make_checkpoint(20, 3);
  cause.solver.removed[0].cause = RemovalCause::leaked;
  EXPECT_NE(physics_digest(cause), before);
  Checkpoint name = make_checkpoint(20, 3);
  name.samples[0].names[0] = "P2";
  EXPECT_NE(physics_digest(name), before);
  Checkpoint unit = make_checkpoint(20, 3);
  unit.samples[0].columns[0].unit = "bar";
  EXPECT_NE(physics_digest(unit), before);
  Checkpoint moved = make_checkpoint(20, 3);
  std::swap(moved.samples[0], moved.samples[1]);
  EXPECT_NE(physics_digest(moved), before);
}

TEST(PhysicsDigest, DoesNotDependOnWhoComputedIt) {
  Checkpoint other = make_checkpoint(20, 3);
  other.build = "9.9.9";
  other.simd_target = "SSE4";
  other.bit_exact = true;
  other.scene_hash.clear();
  EXPECT_EQ(physics_digest(other), physics_digest(make_checkpoint(20, 3)));
  EXPECT_EQ(physics_digest(other).size(), 64U);
}

TEST(PhysicsDigest, IsTheSameAfterWritingAndReading) {
  const Checkpoint checkpoint = make_checkpoint(20);
  const Checkpoint back = decode_checkpoint(encode_checkpoint(checkpoint));
  EXPECT_EQ(physics_digest(back), physics_digest(checkpoint));
  const std::vector<Series> before = split(checkpoint.samples);
  const std::vector<Series> after = split(back.samples);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_EQ(series_digest(after[i]), series_digest(before[i]));
  }
}

TEST(SeriesDigest, DiffersBetweenSeries) {
  const std::vector<Series> list = split(make_samples());
  EXPECT_NE(series_digest(list[0]), series_digest(list[1]));
  EXPECT_EQ(series_digest(list[0]), series_digest(split(make_samples())[0]));
}

TEST(SceneHash, IsThePublishedXxh3) {
  // XXH3-128 with seed 0 of the empty input, from the sanity tests of xxHash 0.8.
  EXPECT_EQ(scene_hash(""), "99aa06d3014798d86001c324468d497f");
  EXPECT_NE(scene_hash("a"), scene_hash("b"));
}

}  // namespace
}  // namespace sluice::test
