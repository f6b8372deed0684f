#include "engine/store/hdf5/hdf5_memory.hpp"

#include <fmt/format.h>

#include <atomic>

namespace sluice {

std::string unique_file_name() {
  static std::atomic<std::uint64_t> number = 0;
  return fmt::format("memory-{}", number.fetch_add(1));
}

}  // namespace sluice
