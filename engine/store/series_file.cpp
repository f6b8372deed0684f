#include "engine/store/series_file.hpp"

#include "engine/store/errors.hpp"
#include "engine/store/layout.hpp"
#include "engine/store/rules.hpp"

namespace sluice {
namespace {

Bytes encode(const std::vector<Series>& series) {
  require_sound(series, StorageFault::invalid_content);
  WriteArchive archive(0);
  walk_format(archive, kSeriesFormat);
  walk_series_list(archive, series);
  return archive.image();
}

std::vector<Series> decode(ByteSpan image) {
  ReadArchive archive(image);
  std::vector<Series> series;
  walk_format(archive, kSeriesFormat);
  walk_series_list(archive, series);
  archive.require_all_met();
  require_sound(series, StorageFault::corrupt);
  return series;
}

}  // namespace

void write_series(const std::filesystem::path& path, const std::vector<Series>& series,
                  Durability durability, FileSystem& system) {
  const Bytes image = naming(path, [&] { return encode(series); });
  publish(path, image, durability, system);
}

std::vector<Series> read_series(const std::filesystem::path& path) {
  const Bytes image = read_verified(path);
  return naming(path, [&] { return decode(image); });
}

}  // namespace sluice
