#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <string>

#include "engine/store/disk/publish.hpp"
#include "engine/store/files/checkpoint_io.hpp"
#include "engine/store/files/digest.hpp"
#include "engine/store/files/inspect.hpp"
#include "engine/store/files/job_folder.hpp"
#include "tests/store/expect_fault.hpp"
#include "tests/store/fixtures.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;

/// A job with an older and a newer checkpoint; the newer one is to be damaged.
class Damage : public testing::Test {
 protected:
  Damage() : job_(JobFolder::create(folder_ / "job", "{}")) {
    job_.write_checkpoint(make_checkpoint(100, 2000));
    newer_ = job_.write_checkpoint(make_checkpoint(200, 2000));
    good_ = read_bytes(newer_);
  }

  /// The altered newer one is found out and the older one taken, which is as it was.
  void expect_older_one_used(const Bytes& altered, const std::string& what) {
    write_bytes(newer_, altered);
    const std::optional<Restored> restored = job_.newest_checkpoint({});
    ASSERT_TRUE(restored) << what;
    EXPECT_EQ(restored->rejected.size(), 1U) << what;
    ASSERT_EQ(restored->checkpoint.solver.step, 100U) << what;
    ASSERT_EQ(physics_digest(restored->checkpoint), older_digest_) << what;
    fs::remove(newer_.string() + ".bad");
  }

  void flip_bits_before(std::size_t end) {
    std::mt19937_64 random(20240607);
    const char* const wanted = std::getenv("SLUICE_DAMAGED_BITS");
    const int bits = wanted != nullptr ? std::stoi(wanted) : 250;
    for (int i = 0; i < bits; ++i) {
      const std::size_t byte = random() % end;
      const auto bit = static_cast<unsigned>(random() % 8);
      Bytes altered = good_;
      altered[byte] ^= static_cast<std::byte>(1U << bit);
      expect_older_one_used(altered, fmt_what("bit", 8 * byte + bit));
    }
  }

  static std::string fmt_what(const std::string& what, std::size_t at) {
    return what + " " + std::to_string(at);
  }

  void cut_to(std::size_t length) {
    expect_older_one_used(Bytes(good_.begin(), good_.begin() + static_cast<std::ptrdiff_t>(length)),
                          fmt_what("cut to", length));
  }

  TemporaryFolder folder_;
  JobFolder job_;
  fs::path newer_;
  Bytes good_;
  std::string older_digest_ = physics_digest(make_checkpoint(100, 2000));
};

TEST_F(Damage, OfAnyBitIsDetectedAndTheOlderCheckpointUsed) { flip_bits_before(good_.size()); }

TEST_F(Damage, OfAnyBitInTheFirst8KiBIsDetectedAndTheOlderCheckpointUsed) {
  flip_bits_before(8192);
}

TEST_F(Damage, ByTruncationAtEvery4KiBIsDetectedAndTheOlderCheckpointUsed) {
  for (std::size_t length = 0; length < good_.size(); length += 4096) {
    cut_to(length);
  }
}

TEST_F(Damage, ByTruncationAtEachOfTheLast64BytesIsDetectedAndTheOlderCheckpointUsed) {
  for (std::size_t length = good_.size() - 64; length < good_.size(); ++length) {
    cut_to(length);
  }
}

TEST_F(Damage, ByBytesPutAfterTheEndIsDetectedAndTheOlderCheckpointUsed) {
  for (const std::size_t count : {1UL, 48UL, 5000UL}) {
    Bytes altered = good_;
    altered.resize(good_.size() + count);
    expect_older_one_used(altered, fmt_what("longer by", count));
  }
}

TEST_F(Damage, IsExplainedByInspect) {
  Bytes altered = good_;
  altered[5000] ^= std::byte{1};
  write_bytes(newer_, altered);
  const Inspection inspection = inspect_file(newer_);
  EXPECT_EQ(inspection.verdict, Verdict::damaged);
  EXPECT_NE(inspection.text.find("verdict: damaged"), std::string::npos) << inspection.text;
  EXPECT_NE(inspection.text.find("the checkpoint before it"), std::string::npos);
}

}  // namespace
}  // namespace sluice::test
