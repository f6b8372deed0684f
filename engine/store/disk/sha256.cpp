#include "engine/store/disk/sha256.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <new>
#include <stdexcept>

namespace sluice {
namespace {

void require(int status) {
  if (status != 1) throw std::runtime_error("OpenSSL cannot make a SHA-256 digest");
}

/// A library context of our own reads no configuration: what a machine's openssl.cnf turns off must
/// not end a run at its last step. Never freed, for digests may be made until the process ends.
const EVP_MD* algorithm() {
  static const EVP_MD* const sha256 = EVP_MD_fetch(OSSL_LIB_CTX_new(), "SHA256", nullptr);
  return sha256;
}

}  // namespace

void Sha256::Free::operator()(evp_md_ctx_st* context) const { EVP_MD_CTX_free(context); }

Sha256::Sha256() : context_(EVP_MD_CTX_new()) {
  if (!context_) throw std::bad_alloc();
  require(algorithm() != nullptr ? EVP_DigestInit_ex(context_.get(), algorithm(), nullptr) : 0);
}

void Sha256::update(ByteSpan bytes) {
  require(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()));
}

std::string Sha256::finish() {
  std::array<unsigned char, 32> digest{};
  require(EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr));
  std::string text;
  for (const unsigned char byte : digest) text += fmt::format("{:02x}", byte);
  return text;
}

}  // namespace sluice
