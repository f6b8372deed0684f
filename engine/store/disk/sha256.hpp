#pragma once

#include <memory>
#include <string>

#include "engine/store/disk/file_system.hpp"

struct evp_md_ctx_st;  // OpenSSL's, so that its headers stay in sha256.cpp

namespace sluice {

/// SHA-256 (FIPS 180-4) of bytes given in any number of parts. Not meant for secrets.
class Sha256 {
 public:
  /// Throws std::runtime_error when OpenSSL cannot.
  Sha256();
  void update(ByteSpan bytes);
  /// 64 hexadecimal digits; the object is used up by it.
  [[nodiscard]] std::string finish();

 private:
  struct Free {
    void operator()(evp_md_ctx_st* context) const;
  };
  std::unique_ptr<evp_md_ctx_st, Free> context_;
};

}  // namespace sluice
