#include "tests/store/fixtures.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace sluice::test {
namespace {

namespace fs = std::filesystem;
using Limits = std::numeric_limits<double>;

bool same(const RemovedParticle& a, const RemovedParticle& b) {
  return same_bits(a.id, b.id) && a.cause == b.cause && a.step == b.step &&
         same_bits(a.time, b.time) &&
         same_bits(Values(a.position.begin(), a.position.end()),
                   Values(b.position.begin(), b.position.end())) &&
         same_bits(Values(a.velocity.begin(), a.velocity.end()),
                   Values(b.velocity.begin(), b.velocity.end())) &&
         same_bits(a.density_excess, b.density_excess);
}

template <class List, class Same>
bool same_lists(const List& a, const List& b, const Same& same_elements) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_elements);
}

/// Finite doubles of every kind, then plain ones that differ by field and index.
std::vector<double> awkward_values(std::size_t count, double first) {
  std::vector<double> values{-0.0, Limits::denorm_min(), -Limits::max(), Limits::min() / 3, 0.1};
  for (std::size_t i = values.size(); i < count; ++i) {
    values.push_back(first + static_cast<double>(i) / 7.0);
  }
  values.resize(count);
  return values;
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::string name = (fs::temp_directory_path() / "sluice-test-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw std::runtime_error("cannot make a temporary folder");
  }
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::vector<SampleTable> make_samples() {
  const double dry = Limits::quiet_NaN();
  return {
      {"pressure",
       {{"value", "Pa"}},
       {"P1", "P2"},
       {0, 2},
       {0.0, 0.1, 0.3},
       {0.0, 0.1, 0.2},
       {dry, 7.0, -0.0, 8.0, 1e-310, 9.0},
       {0.0, 1.0, 0.5, 0.75, 1.0, 0.25},
       7},
      {"energy",
       {{"kinetic", "J/m"}, {"potential", "J/m"}, {"internal", "J/m"}},
       {"energy"},
       {1},
       {0.0, 0.2},
       {0.0, 0.2},
       {0.0, 1.0, 2.0, 0.5, 0.25, 0.125},
       {1.0, 1.0},
       2},
      {"arrival", {{"value", "s"}}, {"späte Ankunft / 1"}, {3}, {}, {}, {}, {}, 0},
  };
}

Checkpoint make_checkpoint(std::uint64_t step, std::size_t count, Integrator integrator,
                           int dimensions) {
  Checkpoint checkpoint;
  checkpoint.solver.particles = no_particles(dimensions);
  checkpoint.scene_hash = "00112233445566778899aabbccddeeff";
  checkpoint.build = "0.1.0";
  checkpoint.simd_target = "AVX2";
  checkpoint.bit_exact = false;
  checkpoint.integrator = integrator;
  checkpoint.solver.step = step;
  checkpoint.solver.time = 1e-4 * static_cast<double>(step);
  checkpoint.solver.time_step = 1e-4;
  const auto fields = fields_in(static_cast<std::size_t>(dimensions));
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (carries(integrator, fields[i])) {
      fields[i].values.of(checkpoint.solver.particles) =
          awkward_values(count, 100.0 * static_cast<double>(i));
    }
  }
  checkpoint.solver.removed = {
      {3.0, RemovalCause::overtopped, 11, 0.011, Vec2(1.5, 0.61), Vec2(0.5, -1.5), 2.5},
      {5.0, RemovalCause::leaked, 12, 0.012, Vec2(-0.1, -0.0), Vec2(-0.0, 3.5), -4.5},
      {6.0, RemovalCause::too_thin, 13, 0.013, Vec2(0.1, 0.2), Vec2(5.5, 6.5), -301.0}};
  if (dimensions == 3) {
    for (RemovedParticle& removed : checkpoint.solver.removed) {
      removed.position = Vec3(removed.position[0], removed.position[1], 0.3);
      removed.velocity = Vec3(removed.velocity[0], removed.velocity[1], -0.7);
    }
  }
  checkpoint.samples = make_samples();
  checkpoint.guards = {10.0, 20.0, 30.0, 40.0, 50.0, -60.0, 70.0, 80.0, 90.0};
  checkpoint.next_snapshot = 4;
  return checkpoint;
}

Snapshot make_test_snapshot(std::size_t count, int dimensions) {
  Snapshot frame = empty_snapshot(17, 0.25, static_cast<std::size_t>(dimensions));
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = static_cast<float>(i) / 3.0F;
    append(frame.position, std::array{value, -value, 2.0F * value});
    // A denormal in single precision.
    append(frame.velocity, std::array{value * 1e-42F, -0.0F, value});
    frame.pressure.push_back(value * 1e30F);
    frame.id.push_back(count - i);
  }
  return frame;
}

int in_child(const std::function<int()>& action) {
  const pid_t child = ::fork();
  if (child == 0) {
    int result = 99;  // An exception must not go on into the parent's tests
    try {
      result = action();
    } catch (...) {
    }
    ::_exit(result);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return same_lists(a, b, [](double x, double y) { return same_bits(x, y); });
}

bool same_bits(const Series& a, const Series& b) { return same_bits(table_of(a), table_of(b)); }

bool same_bits(const SampleTable& a, const SampleTable& b) {
  const auto same_columns = [](const Series::Column& x, const Series::Column& y) {
    return x.name == y.name && x.unit == y.unit;
  };
  return a.names == b.names && a.places == b.places && a.kind == b.kind &&
         same_lists(a.columns, b.columns, same_columns) && same_bits(a.time, b.time) &&
         same_bits(a.duration, b.duration) && same_bits(a.values, b.values) &&
         same_bits(a.weight, b.weight) && a.next_index == b.next_index;
}

bool same_bits(const std::vector<Series>& a, const std::vector<Series>& b) {
  return same_lists(a, b, [](const Series& x, const Series& y) { return same_bits(x, y); });
}

bool same_bits(const Checkpoint& a, const Checkpoint& b) {
  const auto same_tables = [](const SampleTable& x, const SampleTable& y) {
    return same_bits(x, y);
  };
  const std::size_t dimensions = a.solver.particles.position.size();
  if (b.solver.particles.position.size() != dimensions) return false;
  const auto list = fields_in(dimensions);
  const bool fields = std::all_of(list.begin(), list.end(), [&](const Field& field) {
    return same_bits(field.values.of(a.solver.particles), field.values.of(b.solver.particles));
  });
  return fields && a.scene_hash == b.scene_hash && a.build == b.build &&
         a.simd_target == b.simd_target && a.bit_exact == b.bit_exact &&
         a.integrator == b.integrator && a.solver.step == b.solver.step &&
         same_bits(a.solver.time, b.solver.time) &&
         same_bits(a.solver.time_step, b.solver.time_step) &&
         same_lists(a.solver.removed, b.solver.removed, same) &&
         same_lists(a.samples, b.samples, same_tables) && a.guards == b.guards &&
         a.next_snapshot == b.next_snapshot;
}

Bytes read_bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

void write_bytes(const fs::path& path, ByteSpan bytes) {
  fs::remove(path);  // Some file systems wait for the disk when a file is cut and written again
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace sluice::test
