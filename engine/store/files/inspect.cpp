#include "engine/store/files/inspect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "engine/store/disk/apart.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/trailer.hpp"
#include "engine/store/files/checkpoint_io.hpp"
#include "engine/store/files/layout.hpp"
#include "engine/store/files/series_file.hpp"
#include "engine/store/files/snapshot_io.hpp"
#include "engine/store/hdf5/hdf5_reader.hpp"

namespace sluice {

NLOHMANN_JSON_SERIALIZE_ENUM(Verdict, {{Verdict::whole, "whole"},
                                       {Verdict::damaged, "damaged"},
                                       {Verdict::unsupported, "unsupported"},
                                       {Verdict::unreadable, "unreadable"}})

namespace {

using Json = nlohmann::ordered_json;

Json attribute_value(const Hdf5Reader& reader, const std::string& path, const std::string& name) {
  const auto get = [&](auto value) {
    reader.attribute(path, name, value);
    return Json(std::move(value));
  };
  switch (reader.attribute_type(path, name)) {
    case ElementType::float64:
      return get(0.0);
    case ElementType::uint64:
      return get(std::uint64_t{0});
    case ElementType::text:
      break;
    default:
      return "(of another type)";
  }
  try {
    return get(std::string());
  } catch (const StorageError&) {
    return get(std::vector<std::string>());
  }
}

Json attributes(const Hdf5Reader& reader, const std::string& path) {
  Json found = Json::object();
  for (const std::string& name : reader.attribute_names(path)) {
    found[name] = attribute_value(reader, path, name);
  }
  return found;
}

/// Least and greatest number, and how many are none.
template <class T>
void add_range(const Hdf5Reader& reader, const std::string& path, Json& facts) {
  std::vector<T> values;
  reader.read(path, values);
  std::size_t not_finite = 0;
  T least = std::numeric_limits<T>::max();
  T greatest = std::numeric_limits<T>::lowest();
  for (const T value : values) {
    if (!std::isfinite(static_cast<double>(value))) {
      ++not_finite;
      continue;
    }
    least = std::min(least, value);
    greatest = std::max(greatest, value);
  }
  if (not_finite < values.size()) {
    facts["min"] = least;
    facts["max"] = greatest;
  }
  if (not_finite > 0) {
    facts["not_finite"] = not_finite;
  }
}

Json data_set(const Hdf5Reader& reader, const std::string& path) {
  const DataSetInfo info = reader.info(path);
  Json facts = attributes(reader, path);
  facts["path"] = path;
  facts["type"] = to_string(info.type);
  facts["shape"] = info.shape;
  switch (info.type) {
    case ElementType::float64:
      add_range<double>(reader, path, facts);
      break;
    case ElementType::float32:
      add_range<float>(reader, path, facts);
      break;
    case ElementType::uint64:
      add_range<std::uint64_t>(reader, path, facts);
      break;
    default:
      break;
  }
  return facts;
}

/// One entry of `series`: the attributes of a table of samples and the span of its times.
Json series_facts(const Hdf5Reader& reader, const std::string& path) {
  Json facts = attributes(reader, path);
  std::vector<double> time;
  reader.read(path + "/time", time);
  if (!time.empty()) {
    facts["from"] = time.front();
    facts["to"] = time.back();
  }
  return facts;
}

bool is_series_group(const Hdf5Object& object) {
  return object.kind == Hdf5Object::Kind::group && object.path.starts_with("/series/");
}

void add_contents(const Hdf5Reader& reader, Json& facts) {
  facts["attributes"] = attributes(reader, "/");
  for (const Hdf5Object& object : reader.objects()) {
    if (object.kind == Hdf5Object::Kind::data_set) {
      facts["data_sets"].push_back(data_set(reader, object.path));
    } else if (is_series_group(object)) {
      facts["series"].push_back(series_facts(reader, object.path));
    } else if (object.kind == Hdf5Object::Kind::group) {
      facts["groups"][object.path] = attributes(reader, object.path);
    }
  }
}

/// Reads the file as what it says it is, with all checks of a reader.
void require_sound_contents(const std::filesystem::path& path, const Json& facts) {
  const std::string format = facts["attributes"].value("format", std::string());
  if (format == kCheckpointFormat.name) {
    (void)read_checkpoint(path);
  } else if (format == kSeriesFormat.name) {
    (void)read_series(path);
  } else if (format == kSnapshotFormat.name) {
    (void)read_snapshot(path);
  } else {
    throw StorageError(StorageFault::not_ours, "none of our formats");
  }
}

Verdict verdict_of(StorageFault fault) {
  switch (fault) {
    case StorageFault::corrupt:
      return Verdict::damaged;
    case StorageFault::unsupported_version:
    case StorageFault::not_ours:
      return Verdict::unsupported;
    default:
      return Verdict::unreadable;
  }
}

constexpr auto kReplace = Json::error_handler_t::replace;  // names and paths need not be UTF-8

void add_problem(const StorageError& error, Json& facts) {
  facts["problem"] = error.what();
  facts["verdict"] = verdict_of(error.fault());
}

/// Adds what the image holds until something is wrong; that is then the last fact. All of it is
/// done in a child, which a file that was made to hurt may kill.
void add_contents_apart(const std::filesystem::path& path, const Bytes& image, Json& facts) {
  const auto look = [&] {
    try {
      naming(path, [&] { add_contents(Hdf5Reader(image), facts); });
      naming(path, [&] { require_sound_contents(path, facts); });
    } catch (const StorageError& error) {
      add_problem(error, facts);
    }
    return facts.dump(-1, ' ', false, kReplace);
  };
  try {
    facts = Json::parse(work_apart(ApartLimits::for_bytes(image.size()), look));
  } catch (const ApartFailure& failure) {
    throw StorageError(StorageFault::corrupt, damage_message(path, failure));
  }
}

Json collect(const std::filesystem::path& path) {
  Json facts = {{"file", path.string()},      {"attributes", Json::object()},
                {"groups", Json::object()},   {"series", Json::array()},
                {"data_sets", Json::array()}, {"verdict", Verdict::whole}};
  try {
    const InputFile file(path, Links::refuse);
    facts["bytes"] = file.size();
    const Trailer trailer = naming(path, [&] { return read_trailer(file); });
    facts["trailer"] = {{"version", trailer.version},
                        {"image_bytes", trailer.length},
                        {"xxh3_128", to_hex(trailer.hash)}};
    add_contents_apart(path, read_verified(path), facts);
  } catch (const StorageError& error) {
    add_problem(error, facts);
  }
  return facts;
}

// --- the text, made from the facts alone

std::string plain(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

void add_attributes(std::string& text, const Json& values) {
  for (const auto& [name, value] : values.items()) {
    text += fmt::format("  {:<15} {}\n", name, plain(value));
  }
}

std::string range_text(const Json& set) {
  std::string text =
      set.contains("min") ? fmt::format("{} ... {}", set["min"].dump(), set["max"].dump()) : "-";
  if (set.contains("not_finite")) {
    text += fmt::format(" ({} not a number)", set["not_finite"].dump());
  }
  return text;
}

void add_data_sets(std::string& text, const Json& sets) {
  if (!sets.empty()) {
    text += "data sets\n";
  }
  for (const Json& set : sets) {
    text += fmt::format("  {:<32} {:<8} {:<12} {:<8} {}\n", plain(set["path"]), plain(set["type"]),
                        set["shape"].dump(), set.value("unit", std::string("?")), range_text(set));
  }
}

void add_series(std::string& text, const Json& list) {
  if (!list.empty()) {
    text += "series\n";
  }
  for (const Json& series : list) {
    const std::string span =
        series.contains("from")
            ? fmt::format("{} s ... {} s", series["from"].dump(), series["to"].dump())
            : "empty";
    // The first versions had a group for each sensor.
    const Json one = Json::array({series.value("name", Json("?"))});
    for (const Json& name : series.value("names", one)) {
      text += fmt::format("  {:<20} {:<16} {} samples, {}\n", plain(name),
                          plain(series.value("kind", Json("?"))),
                          series.value("count", Json(0)).dump(), span);
    }
  }
}

std::string describe(const Json& facts) {
  std::string text = fmt::format("{}\n", plain(facts["file"]));
  if (facts.contains("bytes")) {
    text += fmt::format("  {:<15} {}\n", "bytes", facts["bytes"].dump());
  }
  add_attributes(text, facts["attributes"]);
  for (const auto& [path, values] : facts["groups"].items()) {
    text += fmt::format("{}\n", path);
    add_attributes(text, values);
  }
  add_series(text, facts["series"]);
  add_data_sets(text, facts["data_sets"]);
  if (facts.contains("trailer")) {
    text += "trailer\n";
    add_attributes(text, facts["trailer"]);
  }
  text += fmt::format("verdict: {}\n", plain(facts["verdict"]));
  if (facts.contains("problem")) {
    text += fmt::format("  {}\n", plain(facts["problem"]));
  }
  return text;
}

}  // namespace

Inspection inspect_file(const std::filesystem::path& path) {
  const Json facts = collect(path);
  return {facts["verdict"].get<Verdict>(), describe(facts), facts.dump(2, ' ', false, kReplace)};
}

std::string inspect(const std::filesystem::path& path) { return inspect_file(path).text; }

}  // namespace sluice
