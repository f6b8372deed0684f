#include "engine/store/hdf5/hdf5_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string_view>

#include "engine/store/hdf5/hdf5_calls.hpp"
#include "engine/store/hdf5/hdf5_memory.hpp"

namespace sluice {

class Hdf5Reader::Impl {
 public:
  explicit Impl(ByteSpan image) : image_size_(image.size()), memory_(image) {
    silence_hdf5();
    const Hdf5Handle access =
        check_.own(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "set up", "a file in memory");
    check_.require(H5Pset_fapl_core(access.get(), kImageRoom, false) >= 0, "set up", "memory");
    H5FD_file_image_callbacks_t callbacks = memory_.callbacks();
    check_.require(H5Pset_file_image_callbacks(access.get(), &callbacks) >= 0, "set up", "memory");
    auto* bytes = const_cast<std::byte*>(image.data());
    check_.require(H5Pset_file_image(access.get(), bytes, image.size()) >= 0, "take", "the image");
    file_ = check_.own(H5Fopen(unique_file_name().c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose,
                       "open", "the image");
  }

  [[nodiscard]] std::vector<Hdf5Object> objects() const {
    std::vector<Hdf5Object> found;
    check_.require(H5Lvisit(file(), H5_INDEX_NAME, H5_ITER_INC, note_link, &found) >= 0, "list",
                   "the file");
    for (Hdf5Object& object : found) {
      object.kind = kind_of(object.path);
    }
    return found;
  }

  [[nodiscard]] std::vector<std::string> attribute_names(const std::string& path) const {
    const Hdf5Handle object = check_.open_object(file(), path);
    std::vector<std::string> names;
    hsize_t from = 0;
    check_.require(
        H5Aiterate2(object.get(), H5_INDEX_NAME, H5_ITER_INC, &from, note_attribute, &names) >= 0,
        "list the attributes of", path);
    return names;
  }

  [[nodiscard]] ElementType attribute_type(const std::string& path, const std::string& name) const {
    const Hdf5Handle attribute = open_attribute(path, name);
    return element_type(type_of(attribute, path).get());
  }

  [[nodiscard]] DataSetInfo info(const std::string& path) const {
    const Hdf5Handle set = open_set(path);
    const Hdf5Handle type = check_.own(H5Dget_type(set.get()), H5Tclose, "read the type of", path);
    const Hdf5Handle space =
        check_.own(H5Dget_space(set.get()), H5Sclose, "read the shape of", path);
    return {element_type(type.get()), shape_of(space.get())};
  }

  template <class T>
  void read(const std::string& path, std::vector<T>& values) const {
    const DataSetInfo found = info(path);
    require_type(found.type, kElementType<T>, "data set " + path);
    require_plausible(found.shape, sizeof(T), path);
    values.resize(static_cast<std::size_t>(element_count(found.shape)));
    if (!values.empty()) {
      const Hdf5Handle set = open_set(path);
      check_.require(
          H5Dread(set.get(), file_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0,
          "read data set", path);
    }
  }

  template <class T>
  void scalar(const std::string& path, const std::string& name, T& value) const {
    const Hdf5Handle attribute = open_attribute(path, name);
    require_attribute(attribute, kElementType<T>, 0, path, name);
    check_.require(H5Aread(attribute.get(), file_type<T>(), &value) >= 0, "read " + name + " of",
                   path);
  }

  void text(const std::string& path, const std::string& name, std::string& value) const {
    const Hdf5Handle attribute = open_attribute(path, name);
    require_attribute(attribute, ElementType::text, 0, path, name);
    value = read_texts(attribute, 1, path).front();
  }

  void texts(const std::string& path, const std::string& name,
             std::vector<std::string>& values) const {
    const Hdf5Handle attribute = open_attribute(path, name);
    const Extents shape = require_attribute(attribute, ElementType::text, 1, path, name);
    require_plausible(shape, sizeof(char*), path);
    values = read_texts(attribute, static_cast<std::size_t>(shape[0]), path);
  }

 private:
  [[nodiscard]] hid_t file() const { return file_.get(); }

  static herr_t note_link(hid_t, const char* name, const H5L_info_t*, void* found) {
    static_cast<std::vector<Hdf5Object>*>(found)->push_back(
        {fmt::format("/{}", name), Hdf5Object::Kind::other});
    return 0;
  }

  static herr_t note_attribute(hid_t, const char* name, const H5A_info_t*, void* names) {
    static_cast<std::vector<std::string>*>(names)->emplace_back(name);
    return 0;
  }

  /// Links that are not hard ones lead out of what we write.
  [[nodiscard]] Hdf5Object::Kind kind_of(const std::string& path) const {
    H5L_info_t link{};
    H5O_info_t object{};
    if (H5Lget_info(file(), path.c_str(), &link, H5P_DEFAULT) < 0 || link.type != H5L_TYPE_HARD ||
        H5Oget_info_by_name(file(), path.c_str(), &object, H5P_DEFAULT) < 0) {
      return Hdf5Object::Kind::other;
    }
    switch (object.type) {
      case H5O_TYPE_GROUP:
        return Hdf5Object::Kind::group;
      case H5O_TYPE_DATASET:
        return Hdf5Object::Kind::data_set;
      default:
        return Hdf5Object::Kind::other;
    }
  }

  [[nodiscard]] Hdf5Handle open_set(const std::string& path) const {
    if (H5Lexists(file(), path.c_str(), H5P_DEFAULT) <= 0) {
      throw StorageError(StorageFault::corrupt, "data set " + path + " is missing");
    }
    return check_.own(H5Dopen2(file(), path.c_str(), H5P_DEFAULT), H5Dclose, "open data set", path);
  }

  [[nodiscard]] Hdf5Handle open_attribute(const std::string& path, const std::string& name) const {
    const Hdf5Handle object = check_.open_object(file(), path);
    if (H5Aexists(object.get(), name.c_str()) <= 0) {
      throw StorageError(StorageFault::corrupt,
                         fmt::format("attribute '{}' of {} is missing", name, path));
    }
    return check_.own(H5Aopen(object.get(), name.c_str(), H5P_DEFAULT), H5Aclose,
                      "open attribute " + name + " of", path);
  }

  [[nodiscard]] Hdf5Handle type_of(const Hdf5Handle& attribute, const std::string& path) const {
    return check_.own(H5Aget_type(attribute.get()), H5Tclose, "read an attribute's type of", path);
  }

  Extents require_attribute(const Hdf5Handle& attribute, ElementType type, std::size_t rank,
                            const std::string& path, const std::string& name) const {
    require_type(element_type(type_of(attribute, path).get()), type,
                 fmt::format("attribute '{}' of {}", name, path));
    const Hdf5Handle space =
        check_.own(H5Aget_space(attribute.get()), H5Sclose, "read an attribute's shape of", path);
    if (H5Sget_simple_extent_type(space.get()) == H5S_NULL ||
        shape_of(space.get()).size() != rank) {
      throw StorageError(StorageFault::corrupt,
                         fmt::format("attribute '{}' of {} has the wrong shape", name, path));
    }
    return shape_of(space.get());
  }

  static void require_type(ElementType found, ElementType wanted, const std::string& what) {
    if (found != wanted) {
      throw StorageError(StorageFault::corrupt,
                         fmt::format("{} holds {} where {} is expected", what, to_string(found),
                                     to_string(wanted)));
    }
  }

  /// Nothing is compressed, so that no set is larger than the file it lies in.
  void require_plausible(const Extents& shape, std::size_t element_size,
                         const std::string& path) const {
    std::uint64_t room = image_size_ / element_size;
    for (const std::uint64_t length : shape) {
      if (length > room) {
        throw StorageError(StorageFault::corrupt,
                           fmt::format("{} claims to be larger than its file", path));
      }
      room /= std::max<std::uint64_t>(length, 1);
    }
  }

  [[nodiscard]] std::vector<std::string> read_texts(const Hdf5Handle& attribute, std::size_t count,
                                                    const std::string& path) const {
    const Hdf5Handle type = check_.text_type();
    const Hdf5Handle space =
        check_.own(H5Aget_space(attribute.get()), H5Sclose, "read an attribute's shape of", path);
    std::vector<char*> raw(count + 1, nullptr);
    check_.require(H5Aread(attribute.get(), type.get(), raw.data()) >= 0, "read a text of", path);
    std::vector<std::string> values;
    for (std::size_t i = 0; i < count; ++i) {
      values.emplace_back(raw[i] != nullptr ? raw[i] : "");
    }
    H5Dvlen_reclaim(type.get(), space.get(), H5P_DEFAULT, raw.data());
    return values;
  }

  Hdf5Checker check_{StorageFault::corrupt};
  std::uint64_t image_size_;
  BorrowedImage memory_;
  Hdf5Handle file_;
};

Hdf5Reader::Hdf5Reader(ByteSpan image) : impl_(std::make_unique<Impl>(image)) {}
Hdf5Reader::~Hdf5Reader() = default;
Hdf5Reader::Hdf5Reader(Hdf5Reader&&) noexcept = default;
Hdf5Reader& Hdf5Reader::operator=(Hdf5Reader&&) noexcept = default;

std::vector<Hdf5Object> Hdf5Reader::objects() const { return impl_->objects(); }
std::vector<std::string> Hdf5Reader::attribute_names(const std::string& path) const {
  return impl_->attribute_names(path);
}
bool Hdf5Reader::has_attribute(const std::string& path, const std::string& name) const {
  const std::vector<std::string> names = attribute_names(path);
  return std::find(names.begin(), names.end(), name) != names.end();
}

ElementType Hdf5Reader::attribute_type(const std::string& path, const std::string& name) const {
  return impl_->attribute_type(path, name);
}
DataSetInfo Hdf5Reader::info(const std::string& path) const { return impl_->info(path); }
void Hdf5Reader::read(const std::string& path, std::vector<double>& values) const {
  impl_->read(path, values);
}
void Hdf5Reader::read(const std::string& path, std::vector<float>& values) const {
  impl_->read(path, values);
}
void Hdf5Reader::read(const std::string& path, std::vector<std::uint64_t>& values) const {
  impl_->read(path, values);
}
void Hdf5Reader::attribute(const std::string& path, const std::string& name, double& value) const {
  impl_->scalar(path, name, value);
}
void Hdf5Reader::attribute(const std::string& path, const std::string& name,
                           std::uint64_t& value) const {
  impl_->scalar(path, name, value);
}
void Hdf5Reader::attribute(const std::string& path, const std::string& name,
                           std::string& value) const {
  impl_->text(path, name, value);
}
void Hdf5Reader::attribute(const std::string& path, const std::string& name,
                           std::vector<std::string>& values) const {
  impl_->texts(path, name, values);
}

}  // namespace sluice
