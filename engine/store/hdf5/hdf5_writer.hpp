#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/store/disk/file_system.hpp"
#include "engine/store/hdf5/hdf5_types.hpp"

namespace sluice {

/// Builds an HDF5 file in memory: numbers little endian, texts as UTF-8 of variable length, data
/// sets chunked and checksummed (fletcher32), no time stamps, so equal content gives equal bytes. A
/// group must be made before what lies in it. Throws StorageError: invalid_content for a text with
/// a NUL or that is no UTF-8, io for anything that HDF5 refuses. For one thread at a time.
class Hdf5Writer {
 public:
  /// `expected_bytes` sizes the image: one that is not much larger is made in one piece.
  explicit Hdf5Writer(std::uint64_t expected_bytes = 0);
  ~Hdf5Writer();
  Hdf5Writer(Hdf5Writer&&) noexcept;
  Hdf5Writer& operator=(Hdf5Writer&&) noexcept;

  void create_group(const std::string& path);
  void write(const std::string& path, std::span<const double> values, const Extents& shape);
  void write(const std::string& path, std::span<const float> values, const Extents& shape);
  void write(const std::string& path, std::span<const std::uint64_t> values, const Extents& shape);
  /// For readers of other formats that insist on signed numbers, bytes, or texts of fixed length.
  void write(const std::string& path, std::span<const std::int64_t> values, const Extents& shape);
  void write(const std::string& path, std::span<const std::uint8_t> values, const Extents& shape);
  void set_attribute(const std::string& path, const std::string& name,
                     std::span<const std::int64_t> values);
  void set_ascii(const std::string& path, const std::string& name, const std::string& value);
  void set_attribute(const std::string& path, const std::string& name, double value);
  void set_attribute(const std::string& path, const std::string& name, std::uint64_t value);
  void set_attribute(const std::string& path, const std::string& name, const std::string& value);
  void set_attribute(const std::string& path, const std::string& name,
                     const std::vector<std::string>& values);

  /// The whole file; nothing can be written after it.
  [[nodiscard]] Bytes image();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sluice
