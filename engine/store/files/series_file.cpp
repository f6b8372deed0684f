#include "engine/store/files/series_file.hpp"

#include "engine/store/disk/errors.hpp"
#include "engine/store/files/layout.hpp"
#include "engine/store/files/rules.hpp"

namespace sluice {
namespace {

Bytes encode(const std::vector<SampleTable>& tables) {
  require_sound(tables, StorageFault::invalid_content);
  WriteArchive archive(file_bytes(tables));
  walk_format(archive, kSeriesFormat);
  walk_samples(archive, tables);
  return archive.image();
}

std::vector<SampleTable> decode(ByteSpan image) {
  ReadArchive archive(image);
  std::vector<SampleTable> tables;
  const std::uint64_t version = walk_format(archive, kSeriesFormat);
  walk_samples(archive, tables, series_layout(version));
  archive.require_all_met();
  require_sound(tables, StorageFault::corrupt);
  return tables;
}

}  // namespace

void write_series(const std::filesystem::path& path, const std::vector<SampleTable>& tables,
                  Durability durability, FileSystem& system) {
  const Bytes image = naming(path, [&] { return encode(tables); });
  publish(path, image, durability, system);
}

std::vector<Series> read_series(const std::filesystem::path& path) {
  const Bytes image = read_verified(path);
  return split(naming(path, [&] { return decode(image); }));
}

}  // namespace sluice
