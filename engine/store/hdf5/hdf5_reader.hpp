#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/store/disk/file_system.hpp"
#include "engine/store/hdf5/hdf5_types.hpp"

namespace sluice {

/// Reads an HDF5 file from its image in memory. HDF5 1.10 may crash on an altered image: give it
/// only what `read_verified` has passed. Throws StorageError: corrupt, with the name of what is
/// missing or of another type. The image must outlive it. For one thread at a time.
class Hdf5Reader {
 public:
  explicit Hdf5Reader(ByteSpan image);
  explicit Hdf5Reader(Bytes&& image) = delete;
  ~Hdf5Reader();
  Hdf5Reader(Hdf5Reader&&) noexcept;
  Hdf5Reader& operator=(Hdf5Reader&&) noexcept;

  /// Everything in the file but the root group, in order of names.
  [[nodiscard]] std::vector<Hdf5Object> objects() const;
  /// Names of the attributes of the object at `path`, in order of names.
  [[nodiscard]] std::vector<std::string> attribute_names(const std::string& path) const;
  [[nodiscard]] bool has_attribute(const std::string& path, const std::string& name) const;
  [[nodiscard]] ElementType attribute_type(const std::string& path, const std::string& name) const;
  [[nodiscard]] DataSetInfo info(const std::string& path) const;

  /// All elements, row by row. The stored type must be that of `values`.
  void read(const std::string& path, std::vector<double>& values) const;
  void read(const std::string& path, std::vector<float>& values) const;
  void read(const std::string& path, std::vector<std::uint64_t>& values) const;
  void attribute(const std::string& path, const std::string& name, double& value) const;
  void attribute(const std::string& path, const std::string& name, std::uint64_t& value) const;
  void attribute(const std::string& path, const std::string& name, std::string& value) const;
  void attribute(const std::string& path, const std::string& name,
                 std::vector<std::string>& values) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sluice
