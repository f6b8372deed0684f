#include "engine/store/hdf5/hdf5_file.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <exception>
#include <functional>
#include <numeric>
#include <string_view>
#include <utility>

#include "engine/store/disk/errors.hpp"

#ifndef H5_HAVE_THREADSAFE
#error "needs an HDF5 library that was built thread-safe, as Debian's is"
#endif

namespace sluice {
namespace {

/// 512 KiB of doubles: fits HDF5's chunk cache of 1 MiB, so that a chunk is written once.
constexpr std::uint64_t kLargestChunk = 65536;
/// Beside the expected size of an image, bytes, so that it is made in one piece.
constexpr std::uint64_t kRoom = std::uint64_t{1} << 20;

/// An HDF5 identifier with the function that gives it back.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() {
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
void silence() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

herr_t keep_first_reason(unsigned index, const H5E_error2_t* error, void* reason) {
  if (index == 0 && error->desc != nullptr) {
    *static_cast<std::string*>(reason) = error->desc;
  }
  return 0;
}

/// The innermost reason of the failure that this thread met last.
std::string last_reason() {
  std::string reason = "no reason given";
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first_reason, &reason);
  return reason;
}

/// Throws unless an HDF5 call went well; each class of callers has its own fault.
class Checker {
 public:
  explicit Checker(StorageFault fault) : fault_(fault) {}

  void require(bool good, std::string_view action, std::string_view path) const {
    if (!good) {
      throw StorageError(fault_, fmt::format("HDF5 cannot {} {}: {}", action, path, last_reason()));
    }
  }
  [[nodiscard]] Handle own(hid_t id, Handle::Close close, std::string_view action,
                           std::string_view path) const {
    require(id >= 0, action, path);
    return {id, close};
  }
  [[nodiscard]] Handle open_object(hid_t file, const std::string& path) const {
    return own(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose, "open", path);
  }
  [[nodiscard]] Handle text_type() const {
    Handle type = own(H5Tcopy(H5T_C_S1), H5Tclose, "make a type for", "texts");
    require(H5Tset_size(type.get(), H5T_VARIABLE) >= 0, "size the type for", "texts");
    require(H5Tset_cset(type.get(), H5T_CSET_UTF8) >= 0, "set UTF-8 for", "texts");
    return type;
  }

 private:
  StorageFault fault_;
};

template <class T>
hid_t file_type();
template <>
hid_t file_type<double>() {
  return H5T_IEEE_F64LE;
}
template <>
hid_t file_type<float>() {
  return H5T_IEEE_F32LE;
}
template <>
hid_t file_type<std::uint64_t>() {
  return H5T_STD_U64LE;
}
template <>
hid_t file_type<std::int64_t>() {
  return H5T_STD_I64LE;
}
template <>
hid_t file_type<std::uint8_t>() {
  return H5T_STD_U8LE;
}

ElementType element_type(hid_t type) {
  if (H5Tequal(type, H5T_IEEE_F64LE) > 0) {
    return ElementType::float64;
  }
  if (H5Tequal(type, H5T_IEEE_F32LE) > 0) {
    return ElementType::float32;
  }
  if (H5Tequal(type, H5T_STD_U64LE) > 0) {
    return ElementType::uint64;
  }
  return H5Tis_variable_str(type) > 0 ? ElementType::text : ElementType::other;
}

template <class T>
constexpr ElementType kElementType = ElementType::other;
template <>
constexpr ElementType kElementType<double> = ElementType::float64;
template <>
constexpr ElementType kElementType<float> = ElementType::float32;
template <>
constexpr ElementType kElementType<std::uint64_t> = ElementType::uint64;

Extents shape_of(hid_t space) {
  const int rank = H5Sget_simple_extent_ndims(space);
  std::vector<hsize_t> lengths(static_cast<std::size_t>(std::max(rank, 0)));
  H5Sget_simple_extent_dims(space, lengths.data(), nullptr);
  return {lengths.begin(), lengths.end()};
}

/// Length of the UTF-8 sequence that begins `text`, by RFC 3629; 0 when it is none.
std::size_t utf8_sequence(std::string_view text) {
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = at(0);
  if (lead < 0x80) {
    return 1;
  }
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < length) {
    return 0;
  }
  for (std::size_t i = 1; i < length; ++i) {
    if ((at(i) & 0xC0U) != 0x80U) {
      return 0;
    }
  }
  const bool overlong = (lead == 0xE0 && at(1) < 0xA0) || (lead == 0xF0 && at(1) < 0x90);
  const bool out_of_range = (lead == 0xED && at(1) > 0x9F) || (lead == 0xF4 && at(1) > 0x8F);
  return overlong || out_of_range ? 0 : length;
}

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

std::uint64_t element_count(const Extents& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::uint64_t{1}, std::multiplies<>());
}

const char* to_string(ElementType type) {
  switch (type) {
    case ElementType::float64:
      return "float64";
    case ElementType::float32:
      return "float32";
    case ElementType::uint64:
      return "uint64";
    case ElementType::text:
      return "text";
    case ElementType::other:
      break;
  }
  return "other";
}

namespace {

/// HDF5 takes two files in memory of one name for the same file.
std::string unique_name() {
  static std::atomic<std::uint64_t> number = 0;
  return fmt::format("memory-{}", number.fetch_add(1));
}

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

}  // namespace

class Hdf5Writer::Impl {
 public:
  explicit Impl(std::uint64_t expected_bytes) {
    silence();
    const Handle access =
        check_.own(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "set up", "a file in memory");
    const auto growth = static_cast<std::size_t>(expected_bytes + expected_bytes / 64 + kRoom);
    check_.require(H5Pset_fapl_core(access.get(), growth, false) >= 0, "set up", "memory");
    check_.require(H5Pset_libver_bounds(access.get(), H5F_LIBVER_LATEST, H5F_LIBVER_LATEST) >= 0,
                   "set", "the version of the layout");
    H5FD_file_image_callbacks_t callbacks = memory_.callbacks();
    check_.require(H5Pset_file_image_callbacks(access.get(), &callbacks) >= 0, "set up", "memory");
    const Handle creation = properties(H5P_FILE_CREATE);
    file_ =
        check_.own(H5Fcreate(unique_name().c_str(), H5F_ACC_TRUNC, creation.get(), access.get()),
                   H5Fclose, "make", "a file in memory");
  }

  void create_group(const std::string& path) {
    const Handle creation = properties(H5P_GROUP_CREATE);
    const Handle group =
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
    const Handle space = simple_space(shape, path);
    const Handle creation = data_set_properties(shape, path);
    const Handle set = check_.own(H5Dcreate2(file(), path.c_str(), file_type<T>(), space.get(),
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
    const Handle object = check_.open_object(file(), path);
    const Handle attribute =
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
    const Handle space = simple_space({values.size()}, path);
    set_attribute(path, name, check_.text_type().get(), space.get(), texts.data());
  }

  template <class T>
  void set_array(const std::string& path, const std::string& name, std::span<const T> values) {
    const Handle space = simple_space({values.size()}, path);
    set_attribute(path, name, file_type<T>(), space.get(), values.data());
  }

  void set_ascii(const std::string& path, const std::string& name, const std::string& value) {
    const Handle type = check_.own(H5Tcopy(H5T_C_S1), H5Tclose, "make a type for", "texts");
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
  [[nodiscard]] Handle properties(hid_t kind) const {
    Handle list = check_.own(H5Pcreate(kind), H5Pclose, "set up", "an object");
    check_.require(H5Pset_obj_track_times(list.get(), false) >= 0, "leave out", "time stamps");
    return list;
  }

  [[nodiscard]] Handle simple_space(const Extents& shape, const std::string& path) const {
    const std::vector<hsize_t> lengths(shape.begin(), shape.end());
    return check_.own(H5Screate_simple(static_cast<int>(lengths.size()), lengths.data(), nullptr),
                      H5Sclose, "shape", path);
  }

  [[nodiscard]] Handle scalar_space() const {
    return check_.own(H5Screate(H5S_SCALAR), H5Sclose, "shape", "a scalar");
  }

  /// Chunks of equal length along the first direction; an empty set has no chunks.
  [[nodiscard]] Handle data_set_properties(const Extents& shape, const std::string& path) const {
    Handle list = properties(H5P_DATASET_CREATE);
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

  Checker check_{StorageFault::io};
  FileMemory memory_;
  Handle file_;
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

class Hdf5Reader::Impl {
 public:
  explicit Impl(ByteSpan image) : image_size_(image.size()), memory_(image) {
    silence();
    const Handle access =
        check_.own(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "set up", "a file in memory");
    check_.require(H5Pset_fapl_core(access.get(), kRoom, false) >= 0, "set up", "memory");
    H5FD_file_image_callbacks_t callbacks = memory_.callbacks();
    check_.require(H5Pset_file_image_callbacks(access.get(), &callbacks) >= 0, "set up", "memory");
    auto* bytes = const_cast<std::byte*>(image.data());
    check_.require(H5Pset_file_image(access.get(), bytes, image.size()) >= 0, "take", "the image");
    file_ = check_.own(H5Fopen(unique_name().c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose,
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
    const Handle object = check_.open_object(file(), path);
    std::vector<std::string> names;
    hsize_t from = 0;
    check_.require(
        H5Aiterate2(object.get(), H5_INDEX_NAME, H5_ITER_INC, &from, note_attribute, &names) >= 0,
        "list the attributes of", path);
    return names;
  }

  [[nodiscard]] ElementType attribute_type(const std::string& path, const std::string& name) const {
    const Handle attribute = open_attribute(path, name);
    return element_type(type_of(attribute, path).get());
  }

  [[nodiscard]] DataSetInfo info(const std::string& path) const {
    const Handle set = open_set(path);
    const Handle type = check_.own(H5Dget_type(set.get()), H5Tclose, "read the type of", path);
    const Handle space = check_.own(H5Dget_space(set.get()), H5Sclose, "read the shape of", path);
    return {element_type(type.get()), shape_of(space.get())};
  }

  template <class T>
  void read(const std::string& path, std::vector<T>& values) const {
    const DataSetInfo found = info(path);
    require_type(found.type, kElementType<T>, "data set " + path);
    require_plausible(found.shape, sizeof(T), path);
    values.resize(static_cast<std::size_t>(element_count(found.shape)));
    if (!values.empty()) {
      const Handle set = open_set(path);
      check_.require(
          H5Dread(set.get(), file_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0,
          "read data set", path);
    }
  }

  template <class T>
  void scalar(const std::string& path, const std::string& name, T& value) const {
    const Handle attribute = open_attribute(path, name);
    require_attribute(attribute, kElementType<T>, 0, path, name);
    check_.require(H5Aread(attribute.get(), file_type<T>(), &value) >= 0, "read " + name + " of",
                   path);
  }

  void text(const std::string& path, const std::string& name, std::string& value) const {
    const Handle attribute = open_attribute(path, name);
    require_attribute(attribute, ElementType::text, 0, path, name);
    value = read_texts(attribute, 1, path).front();
  }

  void texts(const std::string& path, const std::string& name,
             std::vector<std::string>& values) const {
    const Handle attribute = open_attribute(path, name);
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

  [[nodiscard]] Handle open_set(const std::string& path) const {
    if (H5Lexists(file(), path.c_str(), H5P_DEFAULT) <= 0) {
      throw StorageError(StorageFault::corrupt, "data set " + path + " is missing");
    }
    return check_.own(H5Dopen2(file(), path.c_str(), H5P_DEFAULT), H5Dclose, "open data set", path);
  }

  [[nodiscard]] Handle open_attribute(const std::string& path, const std::string& name) const {
    const Handle object = check_.open_object(file(), path);
    if (H5Aexists(object.get(), name.c_str()) <= 0) {
      throw StorageError(StorageFault::corrupt,
                         fmt::format("attribute '{}' of {} is missing", name, path));
    }
    return check_.own(H5Aopen(object.get(), name.c_str(), H5P_DEFAULT), H5Aclose,
                      "open attribute " + name + " of", path);
  }

  [[nodiscard]] Handle type_of(const Handle& attribute, const std::string& path) const {
    return check_.own(H5Aget_type(attribute.get()), H5Tclose, "read an attribute's type of", path);
  }

  Extents require_attribute(const Handle& attribute, ElementType type, std::size_t rank,
                            const std::string& path, const std::string& name) const {
    require_type(element_type(type_of(attribute, path).get()), type,
                 fmt::format("attribute '{}' of {}", name, path));
    const Handle space =
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

  [[nodiscard]] std::vector<std::string> read_texts(const Handle& attribute, std::size_t count,
                                                    const std::string& path) const {
    const Handle type = check_.text_type();
    const Handle space =
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

  Checker check_{StorageFault::corrupt};
  std::uint64_t image_size_;
  BorrowedImage memory_;
  Handle file_;
};

Hdf5Reader::Hdf5Reader(ByteSpan image) : impl_(std::make_unique<Impl>(image)) {}
Hdf5Reader::~Hdf5Reader() = default;
Hdf5Reader::Hdf5Reader(Hdf5Reader&&) noexcept = default;
Hdf5Reader& Hdf5Reader::operator=(Hdf5Reader&&) noexcept = default;

std::vector<Hdf5Object> Hdf5Reader::objects() const { return impl_->objects(); }
std::vector<std::string> Hdf5Reader::attribute_names(const std::string& path) const {
  return impl_->attribute_names(path);
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
