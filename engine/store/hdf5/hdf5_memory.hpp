#pragma once

// Files of HDF5 that lie in memory. For this room alone.

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <string>
#include <utility>

#include "engine/store/disk/file_system.hpp"

namespace sluice {

/// Beside the expected size of an image, bytes, so that it is made in one piece.
inline constexpr std::uint64_t kImageRoom = std::uint64_t{1} << 20;

/// A name that no other file in memory has: HDF5 takes two of one name for the same file.
[[nodiscard]] std::string unique_file_name();

/// What HDF5 asks of memory that is not its own, whatever it does with it.
struct ForeignMemory {
  using Operation = H5FD_file_image_op_t;

  static herr_t keep(void*, Operation, void*) { return 0; }
  static void* share(void* self) { return self; }
  static herr_t leave(void*) { return 0; }
};

/// The memory of a file in memory, kept beyond the file's closing. H5Fget_file_image of HDF5 1.10.8
/// would give the file as it is while open, with a flag cleared and so a checksum that is wrong.
class FileMemory : ForeignMemory {
 public:
  FileMemory() = default;
  FileMemory(const FileMemory&) = delete;
  FileMemory& operator=(const FileMemory&) = delete;
  ~FileMemory() = default;

  [[nodiscard]] H5FD_file_image_callbacks_t callbacks() {
    return {allocate, copy, resize, keep, share, leave, this};
  }
  /// The first `count` bytes; nothing is left.
  [[nodiscard]] Bytes take(std::size_t count) {
    bytes_.resize(count);
    return std::move(bytes_);
  }

 private:
  static void* allocate(std::size_t size, Operation, void* self) {
    return resize(nullptr, size, H5FD_FILE_IMAGE_OP_FILE_RESIZE, self);
  }
  static void* copy(void* to, const void* from, std::size_t size, Operation, void*) {
    return std::memcpy(to, from, size);
  }
  /// No exception may pass through HDF5.
  static void* resize(void*, std::size_t size, Operation, void* self) {
    Bytes& bytes = static_cast<FileMemory*>(self)->bytes_;
    try {
      bytes.resize(size);
    } catch (const std::exception&) {
      return nullptr;
    }
    return bytes.data();
  }

  Bytes bytes_;
};

/// An image that is read where it lies. HDF5 would make two copies of it, one when it is told of
/// the image and one when it opens it.
class BorrowedImage : ForeignMemory {
 public:
  explicit BorrowedImage(ByteSpan image) : image_(image) {}
  BorrowedImage(const BorrowedImage&) = delete;
  BorrowedImage& operator=(const BorrowedImage&) = delete;
  ~BorrowedImage() = default;

  [[nodiscard]] H5FD_file_image_callbacks_t callbacks() {
    return {lend, pass_on, refuse, keep, share, leave, this};
  }

 private:
  /// The file is opened for reading alone; HDF5's signatures lack the const.
  static void* lend(std::size_t size, Operation, void* self) {
    const ByteSpan image = static_cast<BorrowedImage*>(self)->image_;
    return size == image.size() ? const_cast<std::byte*>(image.data()) : nullptr;
  }
  static void* pass_on(void* to, const void* from, std::size_t, Operation, void*) {
    return to == from ? to : nullptr;
  }
  static void* refuse(void*, std::size_t, Operation, void*) { return nullptr; }

  ByteSpan image_;
};

}  // namespace sluice
