#include "engine/store/disk/trailer.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <new>
#include <string_view>

#include "engine/store/disk/errors.hpp"

namespace sluice {
namespace {

static_assert(std::endian::native == std::endian::little, "files are written little endian");

constexpr std::array<char, 8> kMagic{'S', 'L', 'U', 'I', 'C', 'E', '\r', '\n'};
constexpr std::size_t kBlock = std::size_t{1} << 20;

/// The trailer as it lies in the file.
struct Raw {
  std::array<char, 8> magic;
  std::uint64_t version;
  std::uint64_t length;
  std::uint64_t hash_low;
  std::uint64_t hash_high;
  std::uint64_t check;
};
static_assert(sizeof(Raw) == Trailer::kSize);

std::uint64_t check_of(const Raw& raw) { return XXH3_64bits(&raw, offsetof(Raw, check)); }

constexpr std::string_view kWhatToDo =
    "the file is damaged and must not be used; a run takes the checkpoint before it";

[[noreturn]] void throw_corrupt(const std::string& reason) {
  throw StorageError(StorageFault::corrupt, fmt::format("{}: {}", reason, kWhatToDo));
}

/// XXH3-128 of the first `length` bytes of a file.
Hash128 hash_file(const InputFile& file, std::uint64_t length) {
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(),
                                                                       &XXH3_freeState);
  if (!state) {
    throw std::bad_alloc();
  }
  XXH3_128bits_reset(state.get());
  Bytes block(static_cast<std::size_t>(std::min<std::uint64_t>(length, kBlock)));
  for (std::uint64_t at = 0; at < length; at += block.size()) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(length - at, block.size()));
    file.read(at, std::span(block).first(count));
    XXH3_128bits_update(state.get(), block.data(), count);
  }
  const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
  return {hash.high64, hash.low64};
}

void require_same(const Hash128& found, const Trailer& trailer) {
  if (found != trailer.hash) {
    throw_corrupt(
        fmt::format("the contents changed after they were written (XXH3-128 is {}, the "
                    "trailer says {})",
                    to_hex(found), to_hex(trailer.hash)));
  }
}

}  // namespace

Hash128 hash_bytes(ByteSpan bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return {hash.high64, hash.low64};
}

std::string to_hex(const Hash128& hash) {
  return fmt::format("{:016x}{:016x}", hash.high, hash.low);
}

std::array<std::byte, Trailer::kSize> Trailer::encode() const {
  Raw raw{kMagic, version, length, hash.low, hash.high, 0};
  raw.check = check_of(raw);
  return std::bit_cast<std::array<std::byte, kSize>>(raw);
}

Trailer make_trailer(ByteSpan image) {
  return {Trailer::kVersion, image.size(), hash_bytes(image)};
}

Trailer read_trailer(const InputFile& file) {
  if (file.size() < Trailer::kSize) {
    throw_corrupt(fmt::format("holds {} bytes, fewer than a trailer", file.size()));
  }
  std::array<std::byte, Trailer::kSize> bytes{};
  const std::uint64_t length = file.size() - Trailer::kSize;
  file.read(length, bytes);
  const Raw raw = std::bit_cast<Raw>(bytes);
  if (raw.magic != kMagic) {
    throw_corrupt("no trailer of ours at its end: cut short, or not written by this program");
  }
  if (raw.check != check_of(raw)) {
    throw_corrupt("its trailer was altered");
  }
  if (raw.version != Trailer::kVersion) {
    throw StorageError(StorageFault::unsupported_version,
                       fmt::format("trailer of version {}, this program knows version {}; use the "
                                   "program that wrote it or a newer one",
                                   raw.version, Trailer::kVersion));
  }
  if (raw.length != length) {
    throw_corrupt(fmt::format("its trailer stands after {} bytes and says {}", length, raw.length));
  }
  return {raw.version, raw.length, {raw.hash_high, raw.hash_low}};
}

Bytes read_verified(const std::filesystem::path& path) {
  const InputFile file(path, Links::refuse);
  return naming(path, [&] {
    const Trailer trailer = read_trailer(file);
    Bytes image(static_cast<std::size_t>(trailer.length));
    file.read(0, image);
    require_same(hash_bytes(image), trailer);
    return image;
  });
}

void verify(const std::filesystem::path& path) {
  const InputFile file(path, Links::refuse);
  naming(path, [&] {
    const Trailer trailer = read_trailer(file);
    require_same(hash_file(file, trailer.length), trailer);
  });
}

}  // namespace sluice
