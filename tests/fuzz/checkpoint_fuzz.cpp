#include <fuzzer/FuzzedDataProvider.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/store/files/checkpoint_io.hpp"
#include "engine/store/files/inspect.hpp"
#include "engine/store/hdf5/hdf5_reader.hpp"
#include "engine/store/hdf5/hdf5_writer.hpp"
#include "tests/fuzz/require.hpp"
#include "tests/store/fixtures.hpp"

// The reader of checkpoints. An input that begins with an odd byte is a whole file. Any other is a
// list of changes to a good one, made through HDF5 and with a right checksum, because that is the
// only kind of altered image that the reader hands to HDF5.

namespace sluice::fuzz {
namespace {

/// Copies an HDF5 image and changes on the way what the input says; 0, and an input that has come
/// to its end, changes nothing.
class Alteration {
 public:
  Alteration(ByteSpan image, FuzzedDataProvider& input)
      : reader_(image), writer_(image.size()), input_(input) {}

  Bytes image() {
    attributes("/", "/");
    for (const Hdf5Object& object : reader_.objects()) copy(object);
    if (input_.ConsumeBool()) writer_.create_group("/stranger");
    return writer_.image();
  }

 private:
  void copy(const Hdf5Object& object) {
    if (object.kind == Hdf5Object::Kind::group) {
      if (input_.ConsumeIntegral<std::uint8_t>() == 1) return;
      writer_.create_group(object.path);
    } else if (!data_set(object.path)) {
      return;
    }
    attributes(object.path, object.path);
  }

  /// False when it is left out.
  bool data_set(const std::string& path) {
    const DataSetInfo info = reader_.info(path);
    switch (info.type) {
      case ElementType::float64:
        return numbers<double>(path, info.shape);
      case ElementType::float32:
        return numbers<float>(path, info.shape);
      default:
        return numbers<std::uint64_t>(path, info.shape);
    }
  }

  template <class T>
  bool numbers(const std::string& path, Extents shape) {
    std::vector<T> values;
    reader_.read(path, values);
    switch (input_.ConsumeIntegralInRange<int>(0, 7)) {
      case 1:
        return false;
      case 2:
        resize(values, shape, shape[0] / 2);
        break;
      case 3:
        resize(values, shape, shape[0] + 1);
        break;
      case 4:
        resize(values, shape, 0);
        break;
      case 5:
        shape.push_back(1);
        break;
      case 6:
        writer_.write(path, std::vector<float>(values.size(), 1.0F), shape);
        return true;
      case 7:
        change_one(values);
        break;
      default:
        break;
    }
    writer_.write(path, std::span<const T>(values), shape);
    return true;
  }

  template <class T>
  void resize(std::vector<T>& values, Extents& shape, std::uint64_t rows) {
    shape[0] = rows;
    values.resize(element_count(shape));
  }
  template <class T>
  void change_one(std::vector<T>& values) {
    if (values.empty()) return;
    const auto place = input_.ConsumeIntegralInRange<std::size_t>(0, values.size() - 1);
    const auto bits = input_.ConsumeIntegral<std::uint64_t>();
    static_assert(sizeof(T) <= sizeof(bits));
    std::memcpy(&values[place], &bits, sizeof(T));
  }

  void attributes(const std::string& from, const std::string& to) {
    for (const std::string& name : reader_.attribute_names(from)) attribute(from, to, name);
    if (input_.ConsumeIntegral<std::uint8_t>() == 1) writer_.set_attribute(to, "stranger", 1.0);
  }

  void attribute(const std::string& from, const std::string& to, const std::string& name) {
    switch (input_.ConsumeIntegralInRange<int>(0, 5)) {
      case 1:
        return;
      case 2:
        writer_.set_attribute(to, name, input_.ConsumeIntegral<std::uint64_t>());
        return;
      case 3:
        writer_.set_attribute(to, name, number());
        return;
      case 4:
        writer_.set_attribute(to, name, input_.ConsumeRandomLengthString(100));
        return;
      case 5:
        writer_.set_attribute(to, name, std::vector<std::string>(3, "x"));
        return;
      default:
        keep_attribute(from, to, name);
    }
  }
  double number() {
    const auto bits = input_.ConsumeIntegral<std::uint64_t>();
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
  }

  void keep_attribute(const std::string& from, const std::string& to, const std::string& name) {
    switch (reader_.attribute_type(from, name)) {
      case ElementType::float64:
        return keep<double>(from, to, name);
      case ElementType::uint64:
        return keep<std::uint64_t>(from, to, name);
      default:
        break;
    }
    try {
      keep<std::string>(from, to, name);
    } catch (const StorageError&) {
      keep<std::vector<std::string>>(from, to, name);
    }
  }
  template <class T>
  void keep(const std::string& from, const std::string& to, const std::string& name) {
    T value{};
    reader_.attribute(from, name, value);
    writer_.set_attribute(to, name, value);
  }

  Hdf5Reader reader_;
  Hdf5Writer writer_;
  FuzzedDataProvider& input_;
};

/// Refused, or a checkpoint that is the same when it is written and read again.
void try_image(ByteSpan image) {
  Checkpoint checkpoint;
  try {
    checkpoint = decode_checkpoint(image);
  } catch (const StorageError&) {
    return;
  }
  const Checkpoint again = decode_checkpoint(encode_checkpoint(checkpoint));
  require(test::same_bits(again, checkpoint), "what was read is what is written");
}

void try_altered(FuzzedDataProvider& input) {
  static const Bytes good = encode_checkpoint(test::make_checkpoint(100, 10));
  Bytes image;
  try {
    image = Alteration(good, input).image();
  } catch (const StorageError&) {
    return;  // nothing that HDF5 or its writer would write
  }
  try_image(image);
}

/// A file in memory, with a path.
std::filesystem::path put_in_file(ByteSpan bytes) {
  static const int file = ::memfd_create("fuzz", 0);
  require(::ftruncate(file, 0) == 0, "the file is emptied");
  require(::pwrite(file, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()),
          "the file is written");
  return "/proc/self/fd/" + std::to_string(file);
}

void try_file(ByteSpan bytes) {
  const std::filesystem::path path = put_in_file(bytes);
  require(!inspect_file(path).text.empty(), "every file is explained");
  try {
    (void)read_checkpoint(path);
  } catch (const StorageError&) {
  }
}

}  // namespace
}  // namespace sluice::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 0 && data[0] % 2 == 1) {
    sluice::fuzz::try_file(std::as_bytes(std::span(data + 1, size - 1)));
    return 0;
  }
  FuzzedDataProvider input(data, size);
  (void)input.ConsumeIntegral<std::uint8_t>();
  sluice::fuzz::try_altered(input);
  return 0;
}
