#include "engine/store/files/layout.hpp"

#include <fmt/format.h>

#include <array>
#include <type_traits>

#include "engine/store/disk/errors.hpp"
#include "engine/store/files/file_values.hpp"

namespace sluice {
namespace {

constexpr const char* kCauses =
    "0 overtopped, 1 leaked; excluded: 2 not finite, 3 too fast, 4 too dense, 5 too thin";

[[noreturn]] void throw_corrupt(const std::string& message) {
  throw StorageError(StorageFault::corrupt, message);
}

/// An attribute that is converted on its way.
template <class Archive, class Value>
void converted(Archive& archive, const std::string& name, Value& value) {
  auto stored = to_file(value);
  archive.attribute("/", name, stored);
  if constexpr (Archive::kReads) {
    from_file(stored, value);
  }
}

template <class Archive, class Subject>
void identity(Archive& archive, Subject& checkpoint) {
  archive.attribute("/", "scene_hash", checkpoint.scene_hash);
  archive.attribute("/", "build", checkpoint.build);
  archive.attribute("/", "simd_target", checkpoint.simd_target);
  converted(archive, "bit_exact", checkpoint.bit_exact);
  converted(archive, "integrator", checkpoint.integrator);
}

/// How many dimensions the particles of a file have: files of the plane do not say it.
template <class Archive>
void dimensions_in(Archive& archive, std::uint64_t& dimensions) {
  archive.attribute_or("/", "dimensions", dimensions, std::uint64_t{kPlaneDim});
  if (dimensions != 2 && dimensions != 3) {
    throw_corrupt(fmt::format("the particles have {} dimensions; 2 or 3 are expected", dimensions));
  }
}

/// The fields that particles of this integrator carry.
template <class Archive, class Subject>
void particle_fields(Archive& archive, Integrator integrator, Subject& particles) {
  archive.group("/particles");
  std::uint64_t dimensions = particles.position.size();
  dimensions_in(archive, dimensions);
  if constexpr (Archive::kReads) particles = no_particles(static_cast<int>(dimensions));
  archive.count("/particles", "count", particles.position.front());
  const Extents shape{particles.size()};
  for (const Field& field : fields_in(particles.position.size())) {
    if (carries(integrator, field)) {
      archive.data_set("/particles/" + std::string(field.name), field.values.of(particles), shape,
                       {std::string(field.unit), std::string(field.description)});
    }
  }
}

/// What `member` names of each removed particle as a data set.
template <class Archive, class List, class Member>
void removed_column(Archive& archive, const std::string& name, List& list, const Member& member,
                    const Label& label) {
  std::vector<decltype(to_file(member(list.front())))> column;
  column.reserve(list.size());
  for (auto& removed : list) column.push_back(to_file(member(removed)));
  archive.data_set("/retired/" + name, column, Extents{list.size()}, label);
  if constexpr (Archive::kReads) {
    for (std::size_t i = 0; i < list.size(); ++i) from_file(column[i], member(list[i]));
  }
}

/// Whether a field was kept from the first version on.
bool is_place(const RemovedField& field) { return field.unit == "m"; }

template <class Archive, class Subject>
void removed_particles(Archive& archive, Subject& list, std::size_t dimensions,
                       RemovedLayout layout) {
  archive.group("/retired");
  archive.count("/retired", "count", list);
  if constexpr (Archive::kReads) {
    for (RemovedParticle& removed : list) {
      removed.position = removed.velocity = filled_vec<kAnyDim>(0.0, static_cast<int>(dimensions));
    }
  }
  const auto column = [&](const char* name, auto RemovedParticle::*member, const Label& label) {
    removed_column(
        archive, name, list, [&](auto& removed) -> auto& { return removed.*member; }, label);
  };
  column("id", &RemovedParticle::id, {"1", "number given at the start"});
  column("cause", &RemovedParticle::cause, {"1", kCauses});
  column("step", &RemovedParticle::step, {"1", "step at which it left the sums"});
  column("time", &RemovedParticle::time, {"s", "time at which it left the sums"});
  for (const RemovedField& field : removed_fields_in(dimensions)) {
    if (layout == RemovedLayout::places && !is_place(field)) continue;
    removed_column(archive, std::string(field.name),
                   list, [&](auto& removed) -> auto& { return field.value.of(removed); },
                   {std::string(field.unit), std::string(field.description)});
  }
}

/// Names and units of the columns; the caller's list is as long as the file's afterwards.
template <class Archive, class Subject>
void columns(Archive& archive, const std::string& path, Subject& list) {
  std::vector<std::string> names;
  std::vector<std::string> units;
  for (const Series::Column& column : list) {
    names.push_back(column.name);
    units.push_back(column.unit);
  }
  archive.attribute(path, "columns", names);
  archive.attribute(path, "units", units);
  if constexpr (Archive::kReads) {
    if (names.size() != units.size()) {
      throw_corrupt(
          fmt::format("{} has {} columns and {} units", path, names.size(), units.size()));
    }
    list.resize(names.size());
    for (std::size_t i = 0; i < list.size(); ++i) {
      list[i] = {names[i], units[i]};
    }
  }
}

std::string joined_units(const std::vector<Series::Column>& list) {
  std::string text;
  for (const Series::Column& column : list) {
    text += (text.empty() ? "" : ", ") + column.unit;
  }
  return text;
}

template <class Archive, class Subject>
void sample_table(Archive& archive, const std::string& path, Subject& table) {
  archive.group(path);
  archive.attribute(path, "kind", table.kind);
  archive.attribute(path, "names", table.names);
  columns(archive, path, table.columns);
  archive.attribute(path, "next_index", table.next_index);
  archive.count(path, "count", table.time);
  const std::uint64_t samples = table.size();
  const std::uint64_t sensors = table.sensors();
  archive.data_set(path + "/place", table.places, {sensors},
                   {"1", "places of the sensors in the scene's list, from 0 on"});
  archive.data_set(path + "/time", table.time, {samples}, {"s", "time of the sample"});
  archive.data_set(path + "/duration", table.duration, {samples},
                   {"s", "time since the sample before"});
  archive.data_set(path + "/values", table.values, {samples, sensors, table.columns.size()},
                   {joined_units(table.columns), "by sample, sensor and column; NaN: dry"});
  archive.data_set(path + "/weight", table.weight, {samples, sensors},
                   {"1", "kernel weight that carried the value; 0: dry"});
}

/// Numbered groups and not named ones: a name may hold what a path cannot.
std::string table_path(std::size_t index) { return fmt::format("/series/{:04}", index); }

template <class Archive, class Subject>
void sample_tables(Archive& archive, Subject& tables) {
  archive.group("/series");
  archive.count("/series", "count", tables);
  for (std::size_t i = 0; i < tables.size(); ++i) {
    sample_table(archive, table_path(i), tables[i]);
  }
}

/// As the first versions kept them: a table for each sensor.
void samples_by_sensor(ReadArchive& archive, std::vector<SampleTable>& tables) {
  archive.group("/series");
  archive.count("/series", "count", tables);
  for (std::size_t i = 0; i < tables.size(); ++i) {
    SampleTable& table = tables[i];
    const std::string path = table_path(i);
    archive.group(path);
    table.names.resize(1);
    table.places = {i};
    archive.attribute(path, "name", table.names.front());
    archive.attribute(path, "kind", table.kind);
    columns(archive, path, table.columns);
    archive.attribute(path, "next_index", table.next_index);
    archive.count(path, "count", table.time);
    const std::uint64_t samples = table.size();
    archive.data_set(path + "/time", table.time, {samples}, {"s", {}});
    archive.data_set(path + "/duration", table.duration, {samples}, {"s", {}});
    archive.data_set(path + "/values", table.values, {samples, table.columns.size()},
                     {joined_units(table.columns), {}});
    archive.data_set(path + "/weight", table.weight, {samples}, {"1", {}});
  }
}

template <class Archive, class Subject>
void samples(Archive& archive, Subject& tables, SampleLayout layout) {
  if constexpr (Archive::kReads) {
    if (layout == SampleLayout::by_sensor) return samples_by_sensor(archive, tables);
  }
  sample_tables(archive, tables);
}

template <class Archive, class Subject>
void guard_baselines(Archive& archive, Subject& guards) {
  archive.group("/guards");
  for (const GuardNumber& number : kGuardNumbers) {
    archive.attribute("/guards", std::string(number.name), guards.*number.member);
  }
}

template <class Archive, class Subject>
void physics(Archive& archive, Subject& checkpoint, const CheckpointLayout& layout = {}) {
  archive.attribute("/", "step", checkpoint.solver.step);
  archive.attribute("/", "time", checkpoint.solver.time);
  archive.attribute("/", "time_step", checkpoint.solver.time_step);
  archive.attribute("/", "next_frame", checkpoint.next_snapshot);
  particle_fields(archive, checkpoint.integrator, checkpoint.solver.particles);
  removed_particles(archive, checkpoint.solver.removed, checkpoint.solver.particles.position.size(),
                    layout.removed);
  samples(archive, checkpoint.samples, layout.samples);
  guard_baselines(archive, checkpoint.guards);
}

template <class Archive, class Subject>
void snapshot_layout(Archive& archive, Subject& frame, std::uint64_t version) {
  archive.attribute("/", "step", frame.step);
  archive.attribute("/", "time", frame.time);
  std::uint64_t dimensions = frame.position.size();
  dimensions_in(archive, dimensions);
  if constexpr (Archive::kReads) frame = empty_snapshot(frame.step, frame.time, dimensions);
  if (version > 1) {
    for (std::size_t axis = 0; axis < frame.position.size(); ++axis) {
      archive.attribute("/", "origin_" + std::string(axis_name(static_cast<Eigen::Index>(axis))),
                        frame.origin[static_cast<Eigen::Index>(axis)]);
    }
  }
  archive.group("/particles");
  archive.count("/particles", "count", frame.position.front());
  const Extents shape{frame.size()};
  for (const SnapshotField& field : snapshot_fields_in(frame.position.size())) {
    archive.data_set("/particles/" + std::string(field.name), field.values.of(frame), shape,
                     {std::string(field.unit), std::string(field.description)});
  }
  archive.data_set("/particles/id", frame.id, shape, {"1", "number given at the start"});
}

}  // namespace

void walk_format(WriteArchive& archive, const Format& format) {
  archive.attribute("/", "format", std::string(format.name));
  archive.attribute("/", "version", format.version);
}

std::uint64_t walk_format(ReadArchive& archive, const Format& format) {
  std::string name;
  std::uint64_t version = 0;
  archive.attribute("/", "format", name);
  archive.attribute("/", "version", version);
  if (name != format.name) {
    throw StorageError(StorageFault::not_ours,
                       fmt::format("the format is '{}' where '{}' is expected", name, format.name));
  }
  if (version < format.oldest || version > format.version) {
    throw StorageError(StorageFault::unsupported_version,
                       fmt::format("version {} of the format {}, this program knows {} to {}; use "
                                   "the program that wrote it",
                                   version, name, format.oldest, format.version));
  }
  return version;
}

void walk_identity(WriteArchive& archive, const Checkpoint& checkpoint) {
  identity(archive, checkpoint);
}
void walk_identity(ReadArchive& archive, Checkpoint& checkpoint) { identity(archive, checkpoint); }

void walk_physics(WriteArchive& archive, const Checkpoint& checkpoint) {
  physics(archive, checkpoint);
}
void walk_physics(ReadArchive& archive, Checkpoint& checkpoint, const CheckpointLayout& layout) {
  physics(archive, checkpoint, layout);
}
void walk_physics(DigestArchive& archive, const Checkpoint& checkpoint) {
  physics(archive, checkpoint);
}

void walk_samples(WriteArchive& archive, const std::vector<SampleTable>& tables) {
  sample_tables(archive, tables);
}
void walk_samples(ReadArchive& archive, std::vector<SampleTable>& tables, SampleLayout layout) {
  samples(archive, tables, layout);
}
void walk_samples(DigestArchive& archive, const std::vector<SampleTable>& tables) {
  sample_tables(archive, tables);
}

void walk_snapshot(WriteArchive& archive, const Snapshot& frame) {
  snapshot_layout(archive, frame, kSnapshotFormat.version);
}
void walk_snapshot(ReadArchive& archive, Snapshot& frame, std::uint64_t version) {
  snapshot_layout(archive, frame, version);
}

}  // namespace sluice
