#include "engine/store/files/digest.hpp"

#include <span>

#include "engine/store/disk/trailer.hpp"
#include "engine/store/files/layout.hpp"

namespace sluice {

std::string physics_digest(const Checkpoint& checkpoint) {
  DigestArchive archive;
  walk_physics(archive, checkpoint);
  return archive.finish();
}

std::string series_digest(const Series& series) {
  DigestArchive archive;
  walk_samples(archive, {table_of(series)});
  return archive.finish();
}

std::string scene_hash(std::string_view identity_text) {
  return to_hex(hash_bytes(std::as_bytes(std::span(identity_text))));
}

}  // namespace sluice
