#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "engine/store/file_system.hpp"

namespace sluice {

/// SHA-256 (FIPS 180-4) of bytes given in any number of parts. Not meant for secrets.
class Sha256 {
 public:
  void update(ByteSpan bytes);
  /// 64 hexadecimal digits; the object is used up by it.
  [[nodiscard]] std::string finish();

 private:
  void compress(const std::byte* block);

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::byte, 64> pending_{};
  std::size_t pending_count_ = 0;
  std::uint64_t byte_count_ = 0;
};

}  // namespace sluice
