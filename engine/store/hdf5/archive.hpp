#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/store/disk/sha256.hpp"
#include "engine/store/hdf5/hdf5_reader.hpp"
#include "engine/store/hdf5/hdf5_writer.hpp"

namespace sluice {

// The three ways to walk a layout (engine/store/files/layout.hpp): write a file, read one, digest
// it. They share one interface, so that one walk serves all and reader and writer cannot drift
// apart:
//
//   attribute(path, name, value)                   a number or a text of the object at `path`
//   attribute_or(path, name, value, usual)         the same, left out where it is `usual`
//   group(path)                                    a folder in the file
//   data_set(path, values, shape, unit, description)
//   count(path, name, vector)                      the length of `vector`; a reader makes it so
//   long
//
// `kReads` says whether the walk fills what it is given.

/// What a data set is, for a person who opens the file.
struct Label {
  std::string unit;  ///< SI; "1" for numbers without one
  std::string description;
};

/// Puts everything it meets into an HDF5 image.
class WriteArchive {
 public:
  static constexpr bool kReads = false;
  explicit WriteArchive(std::uint64_t expected_bytes) : writer_(expected_bytes) {}

  template <class T>
  void attribute(const std::string& path, const std::string& name, const T& value) {
    writer_.set_attribute(path, name, value);
  }
  template <class T>
  void attribute_or(const std::string& path, const std::string& name, const T& value,
                    const T& usual) {
    if (value != usual) attribute(path, name, value);
  }
  void group(const std::string& path) { writer_.create_group(path); }
  template <class T>
  void data_set(const std::string& path, const std::vector<T>& values, const Extents& shape,
                const Label& label) {
    writer_.write(path, std::span<const T>(values), shape);
    writer_.set_attribute(path, "unit", label.unit);
    writer_.set_attribute(path, "description", label.description);
  }
  template <class Vector>
  void count(const std::string& path, const std::string& name, const Vector& vector) {
    writer_.set_attribute(path, name, static_cast<std::uint64_t>(vector.size()));
  }
  [[nodiscard]] Bytes image() { return writer_.image(); }

 private:
  Hdf5Writer writer_;
};

/// Fills everything it meets from an HDF5 image, which must outlive it, and knows in the end what
/// it did not meet. Throws StorageError: corrupt.
class ReadArchive {
 public:
  static constexpr bool kReads = true;
  explicit ReadArchive(ByteSpan image) : reader_(image), largest_count_(image.size()) {}
  explicit ReadArchive(Bytes&& image) = delete;

  template <class T>
  void attribute(const std::string& path, const std::string& name, T& value) {
    reader_.attribute(path, name, value);
    met_[path].insert(name);
  }
  template <class T>
  void attribute_or(const std::string& path, const std::string& name, T& value, const T& usual) {
    value = usual;
    if (reader_.has_attribute(path, name)) attribute(path, name, value);
  }
  void group(const std::string& path) { met_[path]; }
  template <class T>
  void data_set(const std::string& path, std::vector<T>& values, const Extents& shape,
                const Label& label) {
    require_shape(path, shape);
    reader_.read(path, values);
    std::string unit;
    std::string description;
    attribute(path, "unit", unit);
    attribute(path, "description", description);
    require_unit(path, unit, label.unit);
  }
  template <class Vector>
  void count(const std::string& path, const std::string& name, Vector& vector) {
    std::uint64_t value = 0;
    attribute(path, name, value);
    require_plausible_count(path, name, value);
    vector.resize(static_cast<std::size_t>(value));
  }
  /// Throws when the file holds an object or attribute that the walk did not ask for.
  void require_all_met() const;

 private:
  void require_shape(const std::string& path, const Extents& shape) const;
  static void require_unit(const std::string& path, const std::string& found,
                           const std::string& wanted);
  void require_plausible_count(const std::string& path, const std::string& name,
                               std::uint64_t value) const;

  Hdf5Reader reader_;
  std::uint64_t largest_count_;  ///< nothing of which there are more could lie in the file
  std::map<std::string, std::set<std::string>> met_;
};

/// SHA-256 over names, lengths and bytes of everything it meets, in order; groups and labels are
/// not content.
class DigestArchive {
 public:
  static constexpr bool kReads = false;

  template <class T>
  void attribute(const std::string& path, const std::string& name, const T& value) {
    add_text(path);
    add_text(name);
    add(value);
  }
  template <class T>
  void attribute_or(const std::string& path, const std::string& name, const T& value,
                    const T& usual) {
    if (value != usual) attribute(path, name, value);
  }
  void group(const std::string&) {}
  template <class T>
  void data_set(const std::string& path, const std::vector<T>& values, const Extents&,
                const Label&) {
    add_text(path);
    add(static_cast<std::uint64_t>(values.size()));
    digest_.update(std::as_bytes(std::span(values)));
  }
  template <class Vector>
  void count(const std::string& path, const std::string& name, const Vector& vector) {
    attribute(path, name, static_cast<std::uint64_t>(vector.size()));
  }
  [[nodiscard]] std::string finish() { return digest_.finish(); }

 private:
  void add_text(std::string_view text) {
    add(static_cast<std::uint64_t>(text.size()));
    digest_.update(std::as_bytes(std::span(text)));
  }
  void add(double value) { digest_.update(std::as_bytes(std::span(&value, 1))); }
  void add(std::uint64_t value) { digest_.update(std::as_bytes(std::span(&value, 1))); }
  void add(const std::string& value) { add_text(value); }
  void add(const std::vector<std::string>& values) {
    add(static_cast<std::uint64_t>(values.size()));
    for (const std::string& value : values) {
      add_text(value);
    }
  }

  Sha256 digest_;
};

}  // namespace sluice
