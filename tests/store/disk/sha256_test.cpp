#include "engine/store/disk/sha256.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <string>

namespace sluice {
namespace {

std::string digest_of(const std::string& text, std::size_t part) {
  Sha256 digest;
  for (std::size_t at = 0; at < text.size(); at += part) {
    digest.update(std::as_bytes(std::span(text)).subspan(at, std::min(part, text.size() - at)));
  }
  return digest.finish();
}

struct Vector {
  std::string text;
  std::string digest;
};

// NIST, "Examples with intermediate values" for FIPS 180-4, and the empty message of the SHAVS.
const Vector kVectors[] = {
    {"", "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"},
    {"abc", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"},
    {"abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq",
     "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1"},
    {"abcdefghbcdefghicdefghijdefghijkefghijklfghijklmghijklmnhijklmnoijklmnopjklmnopqklmnopqrlmnop"
     "qr"
     "smnopqrstnopqrstu",
     "cf5b16a778af8380036ce59e7b0492370b249b11e8f07a51afac45037afee9d1"},
    {std::string(1000000, 'a'), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0"},
};

TEST(Sha256, GivesThePublishedDigests) {
  for (const Vector& vector : kVectors) {
    EXPECT_EQ(digest_of(vector.text, 1000), vector.digest) << vector.text.size() << " bytes";
  }
}

TEST(Sha256, DoesNotDependOnHowTheMessageIsCut) {
  const std::string text(300, 'x');
  for (std::size_t part = 1; part <= text.size(); ++part) {
    EXPECT_EQ(digest_of(text, part), digest_of(text, text.size())) << part;
  }
}

}  // namespace
}  // namespace sluice
