#include "engine/run/build_id.hpp"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <cstring>
#include <span>

#include "sluice/version.hpp"

namespace sluice {
namespace {

std::string hexadecimal(std::span<const unsigned char> bytes) {
  std::string text;
  for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

std::size_t padded(std::size_t size) { return (size + 3) / 4 * 4; }

/// The descriptor of the NT_GNU_BUILD_ID note within a PT_NOTE segment, or nothing.
std::span<const unsigned char> find_build_id(std::span<const unsigned char> notes) {
  while (notes.size() > sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) header{};
    std::memcpy(&header, notes.data(), sizeof header);
    const std::size_t name = sizeof header;
    const std::size_t descriptor = name + padded(header.n_namesz);
    const std::size_t end = descriptor + padded(header.n_descsz);
    if (end > notes.size()) return {};
    const bool is_gnu =
        header.n_namesz == 4 && std::memcmp(notes.data() + name, ELF_NOTE_GNU, 4) == 0;
    if (is_gnu && header.n_type == NT_GNU_BUILD_ID) {
      return notes.subspan(descriptor, header.n_descsz);
    }
    notes = notes.subspan(end);
  }
  return {};
}

/// Called for each loaded object; the first one is the program itself.
int read_program_id(dl_phdr_info* info, std::size_t, void* result) {
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = info->dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    const auto* start = reinterpret_cast<const unsigned char*>(info->dlpi_addr + segment.p_vaddr);
    const auto id = find_build_id({start, segment.p_memsz});
    if (!id.empty()) *static_cast<std::string*>(result) = hexadecimal(id.first(id.size() / 2));
  }
  return 1;
}

std::string make_build_id() {
  std::string id;
  dl_iterate_phdr(read_program_id, &id);
  return id.empty() ? kVersion : fmt::format("{}+{}", kVersion, id);
}

}  // namespace

const std::string& build_id() {
  static const std::string id = make_build_id();
  return id;
}

}  // namespace sluice
