#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/store/disk/file_system.hpp"

namespace sluice {

/// Lengths of an array along each of its directions; the last runs fastest.
using Extents = std::vector<std::uint64_t>;
[[nodiscard]] std::uint64_t element_count(const Extents& shape);

enum class ElementType { float64, float32, uint64, text, other };
[[nodiscard]] const char* to_string(ElementType type);

/// Something with a path in an HDF5 file.
struct Hdf5Object {
  enum class Kind { group, data_set, other };
  std::string path;  ///< from the root, begins with "/"
  Kind kind = Kind::other;
};

struct DataSetInfo {
  ElementType type = ElementType::other;
  Extents shape;
};

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
