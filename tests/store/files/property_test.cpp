#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "engine/store/files/checkpoint_io.hpp"
#include "engine/store/files/series_file.hpp"
#include "engine/store/hdf5/hdf5_reader.hpp"
#include "engine/store/hdf5/hdf5_writer.hpp"
#include "tests/store/fixtures.hpp"

namespace sluice::test {
namespace {

/// Any bit pattern.
rc::Gen<double> any_double() {
  return rc::gen::map(rc::gen::arbitrary<std::uint64_t>(),
                      [](std::uint64_t bits) { return std::bit_cast<double>(bits); });
}

rc::Gen<double> finite_double() {
  return rc::gen::suchThat(any_double(), [](double value) { return std::isfinite(value); });
}

/// Any text that HDF5 can hold: no NUL, and ASCII is enough of UTF-8 here.
rc::Gen<std::string> text() {
  return rc::gen::container<std::string>(rc::gen::inRange<char>(1, 127));
}

std::vector<double> finite_doubles(std::size_t count) {
  return *rc::gen::container<std::vector<double>>(count, finite_double());
}

/// Of sensors from place `first` on.
SampleTable any_table(std::uint64_t first) {
  SampleTable table;
  table.kind = *text();
  for (std::size_t i = *rc::gen::inRange<std::size_t>(0, 4); i > 0; --i) {
    table.columns.push_back({*text(), *text()});
  }
  const std::size_t sensors = *rc::gen::inRange<std::size_t>(1, 4);
  for (std::size_t i = 0; i < sensors; ++i) {
    table.names.push_back(*text());
    table.places.push_back(first + i);
  }
  const std::size_t count = *rc::gen::inRange<std::size_t>(0, 20);
  for (std::size_t i = 0; i < count; ++i) {
    table.time.push_back(0.5 * static_cast<double>(i));
  }
  table.duration = finite_doubles(count);
  table.values = finite_doubles(count * table.width());
  table.weight = finite_doubles(count * sensors);
  table.next_index = *rc::gen::arbitrary<std::uint64_t>();
  if (!table.values.empty()) {
    table.values[0] = std::numeric_limits<double>::quiet_NaN();
    table.weight[0] = 0.0;
  }
  return table;
}

RC_GTEST_PROP(Hdf5File, AnyBitPatternComesBack, ()) {
  const auto values = *rc::gen::container<std::vector<double>>(any_double());
  const auto whole = *rc::gen::arbitrary<std::vector<std::uint64_t>>();
  const auto label = *text();
  Hdf5Writer writer;
  writer.write("/values", std::span<const double>(values), {values.size()});
  writer.write("/whole", std::span<const std::uint64_t>(whole), {whole.size()});
  writer.set_attribute("/values", "label", label);
  const Bytes image = writer.image();
  const Hdf5Reader reader(image);
  std::vector<double> values_back;
  std::vector<std::uint64_t> whole_back;
  std::string label_back;
  reader.read("/values", values_back);
  reader.read("/whole", whole_back);
  reader.attribute("/values", "label", label_back);
  RC_ASSERT(same_bits(values_back, values));
  RC_ASSERT(whole_back == whole);
  RC_ASSERT(label_back == label);
}

RC_GTEST_PROP(CheckpointFile, AnySoundContentComesBack, ()) {
  const auto integrator =
      *rc::gen::element(Integrator::modified_leap_frog, Integrator::kick_drift_kick);
  const auto count = *rc::gen::inRange<std::size_t>(0, 40);
  Checkpoint checkpoint = make_checkpoint(*rc::gen::arbitrary<std::uint64_t>(), count, integrator);
  checkpoint.build = *text();
  checkpoint.bit_exact = *rc::gen::arbitrary<bool>();
  checkpoint.solver.time = *finite_double();
  for (const Field& field : fields_in(2)) {
    if (carries(integrator, field)) {
      field.values.of(checkpoint.solver.particles) = finite_doubles(count);
    }
  }
  checkpoint.solver.removed.resize(*rc::gen::inRange<std::size_t>(0, 5), {1.0});
  checkpoint.samples.clear();
  std::uint64_t sensors = 0;
  for (std::size_t i = *rc::gen::inRange<std::size_t>(0, 4); i > 0; --i) {
    checkpoint.samples.push_back(any_table(sensors));
    sensors += checkpoint.samples.back().sensors();
  }
  RC_ASSERT(same_bits(decode_checkpoint(encode_checkpoint(checkpoint)), checkpoint));
}

}  // namespace
}  // namespace sluice::test
