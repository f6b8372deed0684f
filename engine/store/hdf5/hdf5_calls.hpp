#pragma once

// What the reader and the writer need of HDF5's own interface. For this room alone.

#include <hdf5.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "engine/store/disk/errors.hpp"
#include "engine/store/hdf5/hdf5_types.hpp"

#ifndef H5_HAVE_THREADSAFE
#error "needs an HDF5 library that was built thread-safe, as Debian's is"
#endif

namespace sluice {

/// An HDF5 identifier with the function that gives it back.
class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Hdf5Handle() = default;
  Hdf5Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Hdf5Handle() {
    if (id_ >= 0) {
      close_(id_);
    }
  }
  [[nodiscard]] hid_t get() const { return id_; }
  [[nodiscard]] hid_t release() { return std::exchange(id_, H5I_INVALID_HID); }

 private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

/// HDF5 prints its errors unless it is told not to, once for each thread.
void silence_hdf5();

/// Throws unless an HDF5 call went well; each class of callers has its own fault.
class Hdf5Checker {
 public:
  explicit Hdf5Checker(StorageFault fault) : fault_(fault) {}

  void require(bool good, std::string_view action, std::string_view path) const {
    if (!good) fail(action, path);
  }
  [[nodiscard]] Hdf5Handle own(hid_t id, Hdf5Handle::Close close, std::string_view action,
                               std::string_view path) const {
    require(id >= 0, action, path);
    return {id, close};
  }
  [[nodiscard]] Hdf5Handle open_object(hid_t file, const std::string& path) const {
    return own(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose, "open", path);
  }
  /// That of texts of variable length in UTF-8.
  [[nodiscard]] Hdf5Handle text_type() const;

 private:
  [[noreturn]] void fail(std::string_view action, std::string_view path) const;

  StorageFault fault_;
};

/// How numbers of type T lie in a file.
template <class T>
[[nodiscard]] hid_t file_type();
template <>
[[nodiscard]] inline hid_t file_type<double>() {
  return H5T_IEEE_F64LE;
}
template <>
[[nodiscard]] inline hid_t file_type<float>() {
  return H5T_IEEE_F32LE;
}
template <>
[[nodiscard]] inline hid_t file_type<std::uint64_t>() {
  return H5T_STD_U64LE;
}
template <>
[[nodiscard]] inline hid_t file_type<std::int64_t>() {
  return H5T_STD_I64LE;
}
template <>
[[nodiscard]] inline hid_t file_type<std::uint8_t>() {
  return H5T_STD_U8LE;
}

[[nodiscard]] ElementType element_type(hid_t type);

template <class T>
inline constexpr ElementType kElementType = ElementType::other;
template <>
inline constexpr ElementType kElementType<double> = ElementType::float64;
template <>
inline constexpr ElementType kElementType<float> = ElementType::float32;
template <>
inline constexpr ElementType kElementType<std::uint64_t> = ElementType::uint64;

[[nodiscard]] Extents shape_of(hid_t space);

}  // namespace sluice
