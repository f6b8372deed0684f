#include "engine/store/hdf5/archive.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/store/disk/errors.hpp"

namespace sluice {

void ReadArchive::require_shape(const std::string& path, const Extents& shape) const {
  const Extents found = reader_.info(path).shape;
  if (found != shape) {
    throw StorageError(StorageFault::corrupt,
                       fmt::format("data set {} has the shape ({}) where ({}) is expected", path,
                                   fmt::join(found, ", "), fmt::join(shape, ", ")));
  }
}

void ReadArchive::require_unit(const std::string& path, const std::string& found,
                               const std::string& wanted) {
  if (found != wanted) {
    throw StorageError(
        StorageFault::corrupt,
        fmt::format("data set {} has the unit '{}' where '{}' is expected", path, found, wanted));
  }
}

void ReadArchive::require_plausible_count(const std::string& path, const std::string& name,
                                          std::uint64_t value) const {
  if (value > largest_count_) {
    throw StorageError(
        StorageFault::corrupt,
        fmt::format("attribute '{}' of {} is {}, more than the file can hold", name, path, value));
  }
}

void ReadArchive::require_all_met() const {
  std::vector<std::string> paths{"/"};
  for (const Hdf5Object& object : reader_.objects()) {
    if (object.kind == Hdf5Object::Kind::other || !met_.contains(object.path)) {
      throw StorageError(StorageFault::corrupt,
                         fmt::format("{} is unknown to this version of the layout", object.path));
    }
    paths.push_back(object.path);
  }
  for (const std::string& path : paths) {
    for (const std::string& name : reader_.attribute_names(path)) {
      const auto known = met_.find(path);
      if (known == met_.end() || !known->second.contains(name)) {
        throw StorageError(
            StorageFault::corrupt,
            fmt::format("attribute '{}' of {} is unknown to this version of the layout", name,
                        path));
      }
    }
  }
}

}  // namespace sluice
