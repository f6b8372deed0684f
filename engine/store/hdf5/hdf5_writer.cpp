#include "engine/store/hdf5/hdf5_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "engine/store/hdf5/hdf5_calls.hpp"
#include "engine/store/hdf5/hdf5_memory.hpp"
#include "engine/store/hdf5/utf8.hpp"

namespace sluice {
namespace {

/// 512 KiB of doubles: fits HDF5's chunk cache of 1 MiB, so that a chunk is written once.
constexpr std::uint64_t kLargestChunk = 65536;

void require_text(std::string_view text, const std::string& path, const std::string& name) {
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t length = rest.front() == '\0' ? 0 : utf8_sequence(rest);
    if (length == 0) {
      throw StorageError(StorageFault::invalid_content,
                         fmt::format("attribute '{}' of {}: byte {} is NUL or no UTF-8", name, path,
                                     text.size() - rest.size()));
    }
    rest.remove_prefix(length);
  }
}

}  // namespace

class Hdf5Writer::Impl {
 public:
  explicit Impl(std::uint64_t expected_bytes) {
    silence_hdf5();
    const Hdf5Handle access =
        check_.own(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "set up", "a file in memory");
    const auto growth = static_cast<std::size_t>(expected_bytes + expected_bytes / 64 + kImageRoom);
    check_.require(H5Pset_fapl_core(access.get(), growth, false) >= 0, "set up", "memory");
    check_.require(H5Pset_libver_bounds(access.get(), H5F_LIBVER_LATEST, H5F_LIBVER_LATEST) >= 0,
                   "set", "the version of the layout");
    H5FD_file_image_callbacks_t callbacks = memory_.callbacks();
    check_.require(H5Pset_file_image_callbacks(access.get(), &callbacks) >= 0, "set up", "memory");
    const Hdf5Handle creation = properties(H5P_FILE_CREATE);
    file_ = check_.own(
        H5Fcreate(unique_file_name().c_str(), H5F_ACC_TRUNC, creation.get(), access.get()),
        H5Fclose, "make", "a file in memory");
  }

  void create_group(const std::string& path) {
    const Hdf5Handle creation = properties(H5P_GROUP_CREATE);
    const Hdf5Handle group =
        check_.own(H5Gcreate2(file(), path.c_str(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
                   H5Gclose, "make group", path);
  }

  template <class T>
  void write(const std::string& path, std::span<const T> values, const Extents& shape) {
    if (element_count(shape) != values.size()) {
      throw StorageError(StorageFault::invalid_content,
                         fmt::format("{}: {} values where its shape holds {}", path, values.size(),
                                     element_count(shape)));
    }
    const Hdf5Handle space = simple_space(shape, path);
    const Hdf5Handle creation = data_set_properties(shape, path);
    const Hdf5Handle set = check_.own(H5Dcreate2(file(), path.c_str(), file_type<T>(), space.get(),
                                                 H5P_DEFAULT, creation.get(), H5P_DEFAULT),
                                      H5Dclose, "make data set", path);
    if (!values.empty()) {
      check_.require(
          H5Dwrite(set.get(), file_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0,
          "write data set", path);
    }
  }

  void set_attribute(const std::string& path, const std::string& name, hid_t type, hid_t space,
                     const void* value) {
    const Hdf5Handle object = check_.open_object(file(), path);
    const Hdf5Handle attribute =
        check_.own(H5Acreate2(object.get(), name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                   H5Aclose, "make attribute " + name + " of", path);
    check_.require(H5Awrite(attribute.get(), type, value) >= 0, "write attribute " + name + " of",
                   path);
  }

  template <class T>
  void set_scalar(const std::string& path, const std::string& name, T value) {
    set_attribute(path, name, file_type<T>(), scalar_space().get(), &value);
  }

  void set_text(const std::string& path, const std::string& name, const std::string& value) {
    require_text(value, path, name);
    const char* text = value.c_str();
    set_attribute(path, name, check_.text_type().get(), scalar_space().get(), &text);
  }

  void set_texts(const std::string& path, const std::string& name,
                 const std::vector<std::string>& values) {
    std::vector<const char*> texts;
    for (const std::string& value : values) {
      require_text(value, path, name);
      texts.push_back(value.c_str());
    }
    texts.push_back(nullptr);  // so that there is an address even for none
    const Hdf5Handle space = simple_space({values.size()}, path);
    set_attribute(path, name, check_.text_type().get(), space.get(), texts.data());
  }

  template <class T>
  void set_array(const std::string& path, const std::string& name, std::span<const T> values) {
    const Hdf5Handle space = simple_space({values.size()}, path);
    set_attribute(path, name, file_type<T>(), space.get(), values.data());
  }

  void set_ascii(const std::string& path, const std::string& name, const std::string& value) {
    const Hdf5Handle type = check_.own(H5Tcopy(H5T_C_S1), H5Tclose, "make a type for", "texts");
    check_.require(H5Tset_size(type.get(), value.size()) >= 0, "size the type for", "texts");
    check_.require(H5Tset_strpad(type.get(), H5T_STR_NULLPAD) >= 0, "pad", "texts");
    set_attribute(path, name, type.get(), scalar_space().get(), value.data());
  }

  Bytes image() {
    check_.require(H5Fflush(file(), H5F_SCOPE_LOCAL) >= 0, "complete", "the file in memory");
    const ssize_t size = H5Fget_file_image(file(), nullptr, 0);
    check_.require(size > 0, "size", "the file in memory");
    check_.require(H5Fclose(file_.release()) >= 0, "close", "the file in memory");
    return memory_.take(static_cast<std::size_t>(size));
  }

 private:
  [[nodiscard]] hid_t file() const { return file_.get(); }

  /// Without time stamps, which would make equal content differ.
  [[nodiscard]] Hdf5Handle properties(hid_t kind) const {
    Hdf5Handle list = check_.own(H5Pcreate(kind), H5Pclose, "set up", "an object");
    check_.require(H5Pset_obj_track_times(list.get(), false) >= 0, "leave out", "time stamps");
    return list;
  }

  [[nodiscard]] Hdf5Handle simple_space(const Extents& shape, const std::string& path) const {
    const std::vector<hsize_t> lengths(shape.begin(), shape.end());
    return check_.own(H5Screate_simple(static_cast<int>(lengths.size()), lengths.data(), nullptr),
                      H5Sclose, "shape", path);
  }

  [[nodiscard]] Hdf5Handle scalar_space() const {
    return check_.own(H5Screate(H5S_SCALAR), H5Sclose, "shape", "a scalar");
  }

  /// Chunks of equal length along the first direction; an empty set has no chunks.
  [[nodiscard]] Hdf5Handle data_set_properties(const Extents& shape,
                                               const std::string& path) const {
    Hdf5Handle list = properties(H5P_DATASET_CREATE);
    const std::uint64_t count = element_count(shape);
    if (count == 0) {
      return list;
    }
    std::vector<hsize_t> chunk(shape.begin(), shape.end());
    const std::uint64_t chunk_count = (count + kLargestChunk - 1) / kLargestChunk;
    chunk[0] = (chunk[0] + chunk_count - 1) / chunk_count;
    check_.require(H5Pset_chunk(list.get(), static_cast<int>(chunk.size()), chunk.data()) >= 0,
                   "chunk", path);
    check_.require(H5Pset_fletcher32(list.get()) >= 0, "checksum", path);
    return list;
  }

  Hdf5Checker check_{StorageFault::io};
  FileMemory memory_;
  Hdf5Handle file_;
};

Hdf5Writer::Hdf5Writer(std::uint64_t expected_bytes)
    : impl_(std::make_unique<Impl>(expected_bytes)) {}
Hdf5Writer::~Hdf5Writer() = default;
Hdf5Writer::Hdf5Writer(Hdf5Writer&&) noexcept = default;
Hdf5Writer& Hdf5Writer::operator=(Hdf5Writer&&) noexcept = default;

void Hdf5Writer::create_group(const std::string& path) { impl_->create_group(path); }
void Hdf5Writer::write(const std::string& path, std::span<const double> values,
                       const Extents& shape) {
  impl_->write(path, values, shape);
}
void Hdf5Writer::write(const std::string& path, std::span<const float> values,
                       const Extents& shape) {
  impl_->write(path, values, shape);
}
void Hdf5Writer::write(const std::string& path, std::span<const std::uint64_t> values,
                       const Extents& shape) {
  impl_->write(path, values, shape);
}
void Hdf5Writer::write(const std::string& path, std::span<const std::int64_t> values,
                       const Extents& shape) {
  impl_->write(path, values, shape);
}
void Hdf5Writer::write(const std::string& path, std::span<const std::uint8_t> values,
                       const Extents& shape) {
  impl_->write(path, values, shape);
}
void Hdf5Writer::set_attribute(const std::string& path, const std::string& name,
                               std::span<const std::int64_t> values) {
  impl_->set_array(path, name, values);
}
void Hdf5Writer::set_ascii(const std::string& path, const std::string& name,
                           const std::string& value) {
  impl_->set_ascii(path, name, value);
}
void Hdf5Writer::set_attribute(const std::string& path, const std::string& name, double value) {
  impl_->set_scalar(path, name, value);
}
void Hdf5Writer::set_attribute(const std::string& path, const std::string& name,
                               std::uint64_t value) {
  impl_->set_scalar(path, name, value);
}
void Hdf5Writer::set_attribute(const std::string& path, const std::string& name,
                               const std::string& value) {
  impl_->set_text(path, name, value);
}
void Hdf5Writer::set_attribute(const std::string& path, const std::string& name,
                               const std::vector<std::string>& values) {
  impl_->set_texts(path, name, values);
}
Bytes Hdf5Writer::image() { return impl_->image(); }

}  // namespace sluice
