#include "engine/execute/sandbox.hpp"

#include <fcntl.h>
#include <link.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <set>
#include <system_error>

#include "engine/execute/executor.hpp"
#include "engine/execute/seccomp_filter.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

// Debian 12's headers end with the first versions of Landlock; the numbers are the kernel's ABI.
constexpr std::uint64_t kRefer = 1U << 13;     // version 2
constexpr std::uint64_t kTruncate = 1U << 14;  // version 3
constexpr std::uint64_t kIoctl = 1U << 15;     // version 5

struct RulesetAttributes {
  std::uint64_t file_system = 0;
  std::uint64_t network = 0;  // version 4: bind and connect
  std::uint64_t scope = 0;    // version 6: abstract sockets and signals
};

constexpr std::uint64_t kReadFile = LANDLOCK_ACCESS_FS_READ_FILE;
constexpr std::uint64_t kRead = kReadFile | LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t kExecute = kReadFile | LANDLOCK_ACCESS_FS_EXECUTE;
constexpr std::uint64_t kWork = kRead | LANDLOCK_ACCESS_FS_WRITE_FILE |
                                LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_MAKE_DIR |
                                LANDLOCK_ACCESS_FS_REMOVE_FILE | LANDLOCK_ACCESS_FS_REMOVE_DIR |
                                kTruncate;

// The sanitizers trace their own process and reserve more addresses than there is memory.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

/// The highest number that a descriptor of this process may have, as far as any is of use.
constexpr int kMostDescriptor = 1000;

int highest_descriptor() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return kMostDescriptor;
  return static_cast<int>(std::clamp<rlim_t>(limit.rlim_cur, 1, kMostDescriptor + 1)) - 1;
}

/// Version of Landlock that the kernel speaks; 0 without it.
int landlock_version() {
  const long version =
      ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  return version > 0 ? static_cast<int>(version) : 0;
}

bool has_seccomp() {
  const std::uint32_t action = SECCOMP_RET_KILL_PROCESS;
  return ::syscall(SYS_seccomp, SECCOMP_GET_ACTION_AVAIL, 0, &action) == 0;
}

RulesetAttributes attributes_for(int version) {
  RulesetAttributes attributes;
  attributes.file_system = kRefer - 1;  // all of version 1
  if (version >= 2) attributes.file_system |= kRefer;
  if (version >= 3) attributes.file_system |= kTruncate;
  if (version >= 4) attributes.network = 3;
  if (version >= 5) attributes.file_system |= kIoctl;
  if (version >= 6) attributes.scope = 3;
  return attributes;
}

std::size_t size_for(int version) {
  if (version >= 6) return sizeof(RulesetAttributes);
  return (version >= 4 ? 2 : 1) * sizeof(std::uint64_t);
}

void allow(int ruleset, int target, std::uint64_t access) {
  const landlock_path_beneath_attr rule{access, target};
  if (::syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &rule, 0) != 0) {
    throw ProcessStartError(errno, std::generic_category(), "Landlock refuses a rule");
  }
}

/// Nothing is allowed for a path that is not there.
void allow(int ruleset, const fs::path& path, std::uint64_t access, std::uint64_t handled) {
  const FileDescriptor target(::open(path.c_str(), O_PATH | O_CLOEXEC));
  struct stat status {};
  if (target.get() < 0 || ::fstat(target.get(), &status) != 0) return;
  // What only folders have must not be asked for with a file.
  const std::uint64_t fitting = S_ISDIR(status.st_mode) ? access : access & kExecute;
  allow(ruleset, target.get(), fitting & handled);
}

/// What this program was loaded from; a process that is confined is the same program.
struct LoadedFiles {
  std::set<fs::path> object_folders;
  fs::path interpreter;
};

int note_loaded_file(dl_phdr_info* info, std::size_t, void* data) {
  auto* files = static_cast<LoadedFiles*>(data);
  const fs::path path(info->dlpi_name);
  if (path.is_absolute()) files->object_folders.insert(path.parent_path());
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    if (info->dlpi_phdr[i].p_type != PT_INTERP) continue;
    // The loader gives addresses as numbers.
    files->interpreter =
        reinterpret_cast<const char*>(info->dlpi_addr + info->dlpi_phdr[i].p_vaddr);
  }
  return 0;
}

void allow_program(int ruleset, int program, std::uint64_t handled) {
  LoadedFiles files;
  ::dl_iterate_phdr(note_loaded_file, &files);
  allow(ruleset, program, kExecute);
  allow(ruleset, files.interpreter, kExecute, handled);
  for (const fs::path& folder : files.object_folders) allow(ruleset, folder, kRead, handled);
  for (const char* path :
       {"/lib", "/lib64", "/usr/lib", "/usr/lib64", "/usr/local/lib", "/etc/ld.so.cache",
        "/etc/localtime", "/usr/share/zoneinfo", "/sys/devices/system/cpu"}) {
    allow(ruleset, fs::path(path), kRead, handled);
  }
}

FileDescriptor make_rules(const fs::path& folder, int program) {
  const int version = landlock_version();
  if (version == 0) return FileDescriptor(-1);
  const RulesetAttributes attributes = attributes_for(version);
  FileDescriptor ruleset(
      static_cast<int>(::syscall(SYS_landlock_create_ruleset, &attributes, size_for(version), 0)));
  if (ruleset.get() < 0) {
    throw ProcessStartError(errno, std::generic_category(), "Landlock refuses its rules");
  }
  const FileDescriptor work(::open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  if (work.get() < 0) {
    throw ProcessStartError(errno, std::generic_category(), "cannot open the job's folder");
  }
  allow(ruleset.get(), work.get(), kWork & attributes.file_system);
  allow_program(ruleset.get(), program, attributes.file_system);
  return ruleset;
}

}  // namespace

Sandbox::Sandbox(const fs::path& folder, int program)
    : program_descriptor_(highest_descriptor()), rules_(make_rules(folder, program)) {
  if (kSanitized || !has_seccomp()) return;
  SeccompFilter filter = confined_filter(program_descriptor_);
  filter_ = std::move(filter.program);
  own_id_ = std::move(filter.own_id);
}

int Sandbox::enter() {
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return errno;
  if (rules_.get() >= 0 && ::syscall(SYS_landlock_restrict_self, rules_.get(), 0) != 0) {
    return errno;
  }
  if (filter_.empty()) return 0;
  for (const std::size_t index : own_id_) {
    filter_[index].k = static_cast<std::uint32_t>(::getpid());
  }
  const sock_fprog program{static_cast<unsigned short>(filter_.size()), filter_.data()};
  return ::syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0, &program) == 0 ? 0 : errno;
}

std::string Sandbox::missing() {
  const bool landlock = landlock_version() > 0;
  const bool seccomp = has_seccomp() && !confined_filter(kMostDescriptor).program.empty();
  if (landlock && seccomp) return {};
  if (landlock) return "seccomp";
  return seccomp ? "Landlock" : "Landlock and seccomp";
}

}  // namespace sluice
