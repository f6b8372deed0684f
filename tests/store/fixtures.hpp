#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "engine/store/disk/file_system.hpp"
#include "engine/store/files/checkpoint.hpp"
#include "engine/store/files/snapshot_io.hpp"

namespace sluice::test {

/// A folder of its own, removed with all in it at the end of its life.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

/// A checkpoint with every part filled: `count` particles, values of every kind of double (-0.0,
/// denormals, extremes), series with and without samples and with dry ones, removed particles.
[[nodiscard]] Checkpoint make_checkpoint(std::uint64_t step, std::size_t count = 50,
                                         Integrator integrator = Integrator::modified_leap_frog,
                                         int dimensions = 2);
[[nodiscard]] std::vector<SampleTable> make_samples();
[[nodiscard]] Snapshot make_test_snapshot(std::size_t count, int dimensions = 2);

/// Runs `action`, which returns an exit status, in a child process. Its exit status, 99 when it
/// threw, or -1 when a signal ended it.
[[nodiscard]] int in_child(const std::function<int()>& action);

/// Equal to the last bit: NaN equals the same NaN, 0.0 differs from -0.0.
[[nodiscard]] bool same_bits(double a, double b);
[[nodiscard]] bool same_bits(const std::vector<double>& a, const std::vector<double>& b);
[[nodiscard]] bool same_bits(const Series& a, const Series& b);
[[nodiscard]] bool same_bits(const std::vector<Series>& a, const std::vector<Series>& b);
[[nodiscard]] bool same_bits(const SampleTable& a, const SampleTable& b);
[[nodiscard]] bool same_bits(const Checkpoint& a, const Checkpoint& b);

[[nodiscard]] Bytes read_bytes(const std::filesystem::path& path);
void write_bytes(const std::filesystem::path& path, ByteSpan bytes);
/// Names in a folder, sorted, hidden ones included.
[[nodiscard]] std::vector<std::string> names_in(const std::filesystem::path& folder);

}  // namespace sluice::test
