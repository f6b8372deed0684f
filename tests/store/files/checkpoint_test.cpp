#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <string>
#include <thread>

#include "engine/store/disk/publish.hpp"
#include "engine/store/files/checkpoint_io.hpp"
#include "engine/store/files/digest.hpp"
#include "engine/store/files/inspect.hpp"
#include "engine/store/files/layout.hpp"
#include "engine/store/files/series_file.hpp"
#include "engine/store/files/snapshot_io.hpp"
#include "engine/store/hdf5/hdf5_reader.hpp"
#include "engine/store/hdf5/hdf5_writer.hpp"
#include "tests/store/expect_fault.hpp"
#include "tests/store/fixtures.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(CheckpointFile, ComesBackToTheLastBitForBothIntegrators) {
  const TemporaryFolder folder;
  for (const Integrator integrator :
       {Integrator::modified_leap_frog, Integrator::kick_drift_kick}) {
    for (const std::size_t count : {0UL, 1UL, 50UL, 65536UL, 65537UL}) {
      const Checkpoint written = make_checkpoint(123, count, integrator);
      const fs::path path = write_checkpoint(folder.path(), written);
      EXPECT_EQ(path, folder / "checkpoint-000000000123.h5");
      EXPECT_TRUE(same_bits(read_checkpoint(path), written)) << count;
    }
  }
}

TEST(CheckpointFile, OfThreeDimensionsComesBackToTheLastBit) {
  for (const Integrator integrator :
       {Integrator::modified_leap_frog, Integrator::kick_drift_kick}) {
    for (const std::size_t count : {0UL, 1UL, 50UL}) {
      const Checkpoint written = make_checkpoint(123, count, integrator, 3);
      const Checkpoint read = decode_checkpoint(encode_checkpoint(written));
      EXPECT_EQ(read.solver.particles.position.size(), 3U);
      EXPECT_TRUE(same_bits(read, written)) << count;
    }
  }
  EXPECT_NE(physics_digest(make_checkpoint(1, 0, Integrator::kick_drift_kick, 3)),
            physics_digest(make_checkpoint(1, 0, Integrator::kick_drift_kick, 2)));
}

TEST(FrameFile, OfThreeDimensionsComesBackAsItWas) {
  const TemporaryFolder folder;
  for (const std::size_t count : {0UL, 7UL}) {
    const Snapshot frame = make_test_snapshot(count, 3);
    write_snapshot(folder / "f.h5", frame);
    EXPECT_EQ(read_snapshot(folder / "f.h5"), frame) << count;
  }
}

TEST(CheckpointFile, ComesBackWithNothingRemovedAndNoSamples) {
  Checkpoint written = make_checkpoint(0);
  written.solver.removed.clear();
  written.samples.clear();
  written.bit_exact = true;
  EXPECT_TRUE(same_bits(decode_checkpoint(encode_checkpoint(written)), written));
}

TEST(CheckpointFile, HasTheSameBytesForTheSameContentAtAnyTime) {
  const Bytes image = encode_checkpoint(make_checkpoint(5));
  // HDF5's time stamps, if there were any, count seconds.
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  EXPECT_EQ(encode_checkpoint(make_checkpoint(5)), image);
  EXPECT_NE(encode_checkpoint(make_checkpoint(6)), image);
}

TEST(CheckpointFile, IsNamedByItsStepSoThatNamesSortBySteps) {
  EXPECT_EQ(checkpoint_name(0), "checkpoint-000000000000.h5");
  EXPECT_EQ(checkpoint_name(999999999999), "checkpoint-999999999999.h5");
  EXPECT_LT(checkpoint_name(9), checkpoint_name(10));
  for (const std::uint64_t step : {0UL, 1UL, 999999999999UL, 1000000000000UL}) {
    EXPECT_EQ(step_of_checkpoint_name(checkpoint_name(step)), step);
  }
  for (const char* name : {"checkpoint-.h5", "checkpoint-12.h5", "checkpoint-0000000000012.h5",
                           "checkpoint-00000000001x.h5", "checkpoint-000000000012.h5.bad",
                           "checkpoint.h5", "checkpoint-", ".h5", "",
                           "checkpoint-99999999999999999999999.h5", "checkpoint--00000000001.h5"}) {
    EXPECT_EQ(step_of_checkpoint_name(name), std::nullopt) << name;
  }
}

TEST(CheckpointFile, OfAnotherSceneOrIntegratorIsRefused) {
  const Bytes image = encode_checkpoint(make_checkpoint(5));
  EXPECT_NO_THROW((void)decode_checkpoint(
      image, {make_checkpoint(5).scene_hash, Integrator::modified_leap_frog}));
  expect_fault(StorageFault::wrong_scene, [&] { (void)decode_checkpoint(image, {"other", {}}); });
  expect_fault(StorageFault::wrong_scene, [&] {
    (void)decode_checkpoint(image, {{}, Integrator::kick_drift_kick});
  });
}

TEST(CheckpointFile, OfAnotherFormatIsRefused) {
  const TemporaryFolder folder;
  write_series(folder / "series.h5", make_samples());
  write_snapshot(folder / "frame.h5", make_test_snapshot(3));
  publish(folder / "checkpoint.h5", encode_checkpoint(make_checkpoint(1)), Durability::power_cut);
  expect_fault(StorageFault::not_ours, [&] { (void)read_checkpoint(folder / "series.h5"); });
  expect_fault(StorageFault::not_ours, [&] { (void)read_series(folder / "frame.h5"); });
  expect_fault(StorageFault::not_ours, [&] { (void)read_snapshot(folder / "checkpoint.h5"); });
}

TEST(CheckpointFile, IsNotWrittenFromContentThatBreaksTheRules) {
  const TemporaryFolder folder;
  const std::vector<std::function<void(Checkpoint&)>> faults{
      [](Checkpoint& c) { c.solver.particles.velocity[0][3] = kNan; },
      [](Checkpoint& c) { c.solver.particles.id[0] = HUGE_VAL; },
      [](Checkpoint& c) { c.solver.particles.velocity[1].pop_back(); },
      [](Checkpoint& c) { c.solver.particles.position[0].push_back(0.0); },
      [](Checkpoint& c) {
        c.solver.particles.acceleration[0].resize(50);
      },  // not carried by this integrator
      [](Checkpoint& c) { c.solver.time = kNan; },
      [](Checkpoint& c) { c.solver.time_step = -HUGE_VAL; },
      [](Checkpoint& c) { c.solver.removed[1].position[0] = kNan; },
      [](Checkpoint& c) { c.guards.energy_scale = kNan; },
      [](Checkpoint& c) { c.samples[0].weight[0] = 0.5; },  // NaN with a weight
      [](Checkpoint& c) { c.samples[0].values[1] = HUGE_VAL; },
      [](Checkpoint& c) { c.samples[0].time[2] = c.samples[0].time[1]; },
      [](Checkpoint& c) { c.samples[0].duration.pop_back(); },
      [](Checkpoint& c) { c.samples[1].values.pop_back(); },
      [](Checkpoint& c) { c.samples[1].weight[1] = kNan; },
      [](Checkpoint& c) { c.samples[0].places[1] = 1; },  // the energy's
      [](Checkpoint& c) { c.samples[0].places[1] = 4; },  // of four sensors
      [](Checkpoint& c) { c.samples[0].places.pop_back(); },
      [](Checkpoint& c) { c.build = std::string("a\0b", 3); },
      [](Checkpoint& c) { c.samples[0].names[1] = "\xC3"; },  // half a UTF-8 character
  };
  for (std::size_t i = 0; i < faults.size(); ++i) {
    Checkpoint checkpoint = make_checkpoint(7);
    faults[i](checkpoint);
    const std::string message = expect_fault(
        StorageFault::invalid_content, [&] { (void)write_checkpoint(folder.path(), checkpoint); });
    EXPECT_NE(message.find("checkpoint-000000000007.h5: "), std::string::npos) << i << message;
  }
  EXPECT_TRUE(names_in(folder.path()).empty());
}

// --- files with one thing changed: copied object by object, as a foreign program might write them

struct Change {
  std::string leave_out = {};  ///< path, or path@attribute
  std::function<void(Hdf5Writer&)> add = [](Hdf5Writer&) {};
  std::function<void(const std::string& path, std::vector<double>&, Extents&)> alter =
      [](const std::string&, std::vector<double>&, Extents&) {};
};

void copy_attribute(const Hdf5Reader& from, Hdf5Writer& to, const std::string& path,
                    const std::string& name) {
  const auto copy = [&](auto value) {
    from.attribute(path, name, value);
    to.set_attribute(path, name, value);
  };
  switch (from.attribute_type(path, name)) {
    case ElementType::float64:
      return copy(0.0);
    case ElementType::uint64:
      return copy(std::uint64_t{0});
    default:
      break;
  }
  if (name == "columns" || name == "units" || name == "names") {
    return copy(std::vector<std::string>());
  }
  copy(std::string());
}

void copy_data_set(const Hdf5Reader& from, Hdf5Writer& to, const std::string& path,
                   const Change& change) {
  Extents shape = from.info(path).shape;
  if (from.info(path).type == ElementType::uint64) {
    std::vector<std::uint64_t> values;
    from.read(path, values);
    return to.write(path, values, shape);
  }
  std::vector<double> values;
  from.read(path, values);
  change.alter(path, values, shape);
  to.write(path, values, shape);
}

Bytes changed(ByteSpan image, const Change& change) {
  const Hdf5Reader from(image);
  Hdf5Writer to;
  std::vector<std::string> paths{"/"};
  for (const Hdf5Object& object : from.objects()) {
    const bool below = object.path.starts_with(change.leave_out + "/");
    if (object.path == change.leave_out || (!change.leave_out.empty() && below)) {
      continue;
    }
    paths.push_back(object.path);
    if (object.kind == Hdf5Object::Kind::group) {
      to.create_group(object.path);
    } else {
      copy_data_set(from, to, object.path, change);
    }
  }
  for (const std::string& path : paths) {
    for (const std::string& name : from.attribute_names(path)) {
      if (path + "@" + name != change.leave_out) {
        copy_attribute(from, to, path, name);
      }
    }
  }
  change.add(to);
  return to.image();
}

TEST(CheckpointLayout, IsReadWhenCopiedObjectByObject) {
  const Checkpoint written = make_checkpoint(5);
  const Bytes copy = changed(encode_checkpoint(written), {});
  EXPECT_TRUE(same_bits(decode_checkpoint(copy), written));
}

TEST(CheckpointLayout, RefusesAFileInWhichAnyOneThingIsMissing) {
  const Bytes image = encode_checkpoint(make_checkpoint(5));
  const Hdf5Reader reader(image);
  std::vector<std::string> things;
  std::vector<std::string> paths{"/"};
  for (const Hdf5Object& object : reader.objects()) {
    things.push_back(object.path);
    paths.push_back(object.path);
  }
  for (const std::string& path : paths) {
    for (const std::string& name : reader.attribute_names(path)) {
      things.push_back(path + "@" + name);
    }
  }
  ASSERT_GT(things.size(), 80U);
  for (const std::string& thing : things) {
    const Bytes other = changed(image, {.leave_out = thing});
    const std::string message =
        expect_fault(StorageFault::corrupt, [&] { (void)decode_checkpoint(other); });
    EXPECT_FALSE(message.empty()) << thing;
  }
}

TEST(CheckpointLayout, RefusesAFileWithAnythingUnknown) {
  const Bytes image = encode_checkpoint(make_checkpoint(5));
  const std::vector<double> values(50, 0.0);
  const std::vector<std::function<void(Hdf5Writer&)>> additions{
      [](Hdf5Writer& w) { w.create_group("/extra"); },
      [](Hdf5Writer& w) { w.create_group("/series/0003"); },
      [&](Hdf5Writer& w) { w.write("/particles/colour", std::span(values), {50}); },
      [&](Hdf5Writer& w) { w.write("/particles/ax", std::span(values), {50}); },
      [](Hdf5Writer& w) { w.set_attribute("/", "remark", std::string("hello")); },
      [](Hdf5Writer& w) { w.set_attribute("/guards", "mood", 1.0); },
      [](Hdf5Writer& w) { w.set_attribute("/particles/x", "offset", 0.5); },
  };
  for (const auto& add : additions) {
    const Bytes other = changed(image, {.add = add});
    const std::string message =
        expect_fault(StorageFault::corrupt, [&] { (void)decode_checkpoint(other); });
    EXPECT_NE(message.find("unknown"), std::string::npos) << message;
  }
}

TEST(CheckpointLayout, RefusesOtherVersionsTypesUnitsShapesAndValues) {
  const Bytes image = encode_checkpoint(make_checkpoint(5));
  const auto replaced = [&](const std::string& attribute, const auto& value) {
    const std::size_t at = attribute.find('@');
    return changed(image, {.leave_out = attribute, .add = [&](Hdf5Writer& w) {
                             w.set_attribute(attribute.substr(0, at), attribute.substr(at + 1),
                                             value);
                           }});
  };
  const std::uint64_t two = 2;
  const std::uint64_t later = kCheckpointFormat.version + 1;
  const std::uint64_t huge = UINT64_MAX;
  const auto refuse = [](StorageFault fault, const Bytes& other) {
    expect_fault(fault, [&] { (void)decode_checkpoint(other); });
  };
  refuse(StorageFault::unsupported_version, replaced("/@version", later));
  refuse(StorageFault::not_ours, replaced("/@format", std::string("photographs")));
  refuse(StorageFault::corrupt, replaced("/@step", 5.0));
  refuse(StorageFault::corrupt, replaced("/@bit_exact", two));
  refuse(StorageFault::corrupt, replaced("/@integrator", std::string("euler")));
  refuse(StorageFault::corrupt, replaced("/@time", kNan));
  refuse(StorageFault::corrupt, replaced("/particles@count", two));
  refuse(StorageFault::corrupt, replaced("/particles@count", huge));
  refuse(StorageFault::corrupt, replaced("/series@count", two));
  refuse(StorageFault::corrupt, replaced("/series@count", huge));
  refuse(StorageFault::corrupt, replaced("/retired@count", huge));
  refuse(StorageFault::corrupt, replaced("/particles/vx@unit", std::string("km/h")));
  refuse(StorageFault::corrupt, replaced("/series/0000@units", std::vector<std::string>{}));
  for (const char* set :
       {"/particles/vy", "/series/0000/time", "/series/0000/weight", "/series/0001/values"}) {
    const auto shorten = [&](const std::string& path, std::vector<double>& values, Extents& shape) {
      if (path == set) {
        shape = {values.size() - 1};
        values.pop_back();
      }
    };
    const auto spoil = [&](const std::string& path, std::vector<double>& values, Extents&) {
      if (path == set) {
        values.back() = kNan;
      }
    };
    refuse(StorageFault::corrupt, changed(image, {.leave_out = {}, .alter = shorten}));
    refuse(StorageFault::corrupt, changed(image, {.leave_out = {}, .alter = spoil}));
  }
}

/// The same samples as the first versions kept them: a group for each sensor.
void add_by_sensor(Hdf5Writer& writer, const std::vector<Series>& list) {
  writer.create_group("/series");
  writer.set_attribute("/series", "count", std::uint64_t{list.size()});
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Series& series = list[i];
    const std::string path = "/series/000" + std::to_string(i);
    std::vector<std::string> names;
    std::vector<std::string> units;
    std::string joined;
    for (const Series::Column& column : series.columns) {
      names.push_back(column.name);
      units.push_back(column.unit);
      joined += (joined.empty() ? "" : ", ") + column.unit;
    }
    writer.create_group(path);
    writer.set_attribute(path, "name", series.name);
    writer.set_attribute(path, "kind", series.kind);
    writer.set_attribute(path, "columns", names);
    writer.set_attribute(path, "units", units);
    writer.set_attribute(path, "next_index", series.next_index);
    writer.set_attribute(path, "count", std::uint64_t{series.size()});
    const auto add = [&](const std::string& name, const std::vector<double>& values,
                         const Extents& shape, const std::string& unit) {
      writer.write(path + "/" + name, std::span(values), shape);
      writer.set_attribute(path + "/" + name, "unit", unit);
      writer.set_attribute(path + "/" + name, "description", std::string("as it was"));
    };
    add("time", series.time, {series.size()}, "s");
    add("duration", series.duration, {series.size()}, "s");
    add("values", series.values, {series.size(), names.size()}, joined);
    add("weight", series.weight, {series.size()}, "1");
  }
}

Bytes as_version(ByteSpan image, std::uint64_t version) {
  return changed(image, {.leave_out = "/@version",
                         .add = [&](Hdf5Writer& w) { w.set_attribute("/", "version", version); }});
}

/// Before version 5 nothing was kept of what left but its place.
Bytes with_places_alone(ByteSpan image) {
  Bytes old = changed(image, {.leave_out = "/retired/vx"});
  for (const char* path : {"/retired/vy", "/retired/density_excess"}) {
    old = changed(old, {.leave_out = path});
  }
  return old;
}

TEST(CheckpointLayout, WithoutTheVelocitiesOfWhatLeftIsStillRead) {
  Checkpoint written = make_checkpoint(5);
  const Bytes old = as_version(with_places_alone(encode_checkpoint(written)), 4);
  for (RemovedParticle& removed : written.solver.removed) {
    removed.velocity.setZero();
    removed.density_excess = 0.0;
  }
  EXPECT_TRUE(same_bits(decode_checkpoint(old), written));
  expect_fault(StorageFault::corrupt, [&] { (void)decode_checkpoint(as_version(old, 5)); });
}

TEST(CheckpointLayout, WithAGroupForEachSensorIsStillRead) {
  const Checkpoint written = make_checkpoint(5);
  const std::vector<Series> series = split(written.samples);
  const Bytes old =
      changed(as_version(with_places_alone(encode_checkpoint(written)), 3),
              {.leave_out = "/series", .add = [&](Hdf5Writer& w) { add_by_sensor(w, series); }});
  const Checkpoint read = decode_checkpoint(old);
  EXPECT_EQ(read.samples.size(), series.size());
  EXPECT_TRUE(same_bits(split(read.samples), series));
  expect_fault(StorageFault::corrupt, [&] { (void)decode_checkpoint(as_version(old, 4)); });
  expect_fault(StorageFault::unsupported_version,
               [&] { (void)decode_checkpoint(as_version(old, 2)); });

  const TemporaryFolder folder;
  Hdf5Writer file;
  file.set_attribute("/", "format", std::string("sluice-series"));
  file.set_attribute("/", "version", std::uint64_t{1});
  add_by_sensor(file, series);
  publish(folder / "series.h5", file.image(), Durability::process_crash);
  EXPECT_TRUE(same_bits(read_series(folder / "series.h5"), series));
  EXPECT_NE(inspect(folder / "series.h5").find("P2 "), std::string::npos);
}

TEST(CheckpointLayout, IsDescribedWithEveryNameInItsDocument) {
  const fs::path document = fs::path(SLUICE_SOURCE_DIR) / "schemas" / "checkpoint.md";
  std::ifstream file(document);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  ASSERT_FALSE(text.empty()) << document;
  const auto require_described = [&](const Bytes& image) {
    const Hdf5Reader reader(image);
    std::vector<std::string> paths{"/"};
    for (const Hdf5Object& object : reader.objects()) {
      paths.push_back(object.path);
      std::string name = fs::path(object.path).filename().string();
      name = name.starts_with("0") ? "0000" : name;
      EXPECT_NE(text.find("`" + name + "`"), std::string::npos) << object.path;
    }
    for (const std::string& path : paths) {
      for (const std::string& name : reader.attribute_names(path)) {
        EXPECT_NE(text.find("`" + name + "`"), std::string::npos) << path << "@" << name;
      }
    }
  };
  const TemporaryFolder folder;
  write_snapshot(folder / "frame.h5", make_test_snapshot(3));
  require_described(read_verified(folder / "frame.h5"));
  require_described(encode_checkpoint(make_checkpoint(1)));
  require_described(encode_checkpoint(make_checkpoint(1, 50, Integrator::kick_drift_kick)));
}

TEST(SeriesFile, ComesBackToTheLastBit) {
  const TemporaryFolder folder;
  write_series(folder / "series.h5", make_samples());
  EXPECT_TRUE(same_bits(read_series(folder / "series.h5"), split(make_samples())));
  write_series(folder / "series.h5", {}, Durability::power_cut);
  EXPECT_TRUE(read_series(folder / "series.h5").empty());
}

TEST(SeriesFile, ThatIsReplacedStaysWholeForWhoHasItOpen) {
  const TemporaryFolder folder;
  write_series(folder / "series.h5", make_samples());
  const InputFile open(folder / "series.h5");
  const Bytes before = read_bytes(folder / "series.h5");
  write_series(folder / "series.h5", {});
  Bytes after(static_cast<std::size_t>(open.size()));
  open.read(0, after);
  EXPECT_EQ(after, before);
}

TEST(FrameFile, ComesBackToTheLastBit) {
  const TemporaryFolder folder;
  for (const std::size_t count : {0UL, 1UL, 100000UL}) {
    const Snapshot frame = make_test_snapshot(count);
    write_snapshot(folder / snapshot_name(12), frame);
    EXPECT_EQ(read_snapshot(folder / "frame-000012.h5"), frame);
    EXPECT_EQ(std::signbit(read_snapshot(folder / "frame-000012.h5").velocity[1].empty()
                               ? -0.0F
                               : read_snapshot(folder / "frame-000012.h5").velocity[1][0]),
              true);
  }
}

TEST(FrameFile, WithFieldsOfDifferentLengthIsNotWritten) {
  const TemporaryFolder folder;
  Snapshot frame = make_test_snapshot(5);
  frame.pressure.pop_back();
  expect_fault(StorageFault::invalid_content, [&] { write_snapshot(folder / "f.h5", frame); });
  EXPECT_TRUE(names_in(folder.path()).empty());
}

TEST(FrameFile, HoldsThePressureOfTheEquationOfState) {
  const SolverState state = make_checkpoint(3).solver;
  Method method;
  method.sound_speed = 20.0;
  const Snapshot frame = make_snapshot(state, method);
  // eq. 3: p = c^2 (rho - rho_0)
  EXPECT_EQ(frame.pressure[10], static_cast<float>(400.0 * state.particles.density_excess[10]));
  EXPECT_EQ(frame.step, 3U);
  EXPECT_EQ(frame.size(), state.particles.size());
}

}  // namespace
}  // namespace sluice::test
