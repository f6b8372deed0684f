#include "engine/execute/seccomp_filter.hpp"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/sched.h>
#include <linux/seccomp.h>
#include <sys/syscall.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace sluice {
namespace {

#if defined(__x86_64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kArchitecture = 0;
#endif

constexpr std::uint32_t kRefuse = SECCOMP_RET_ERRNO | EPERM;
/// Of the second ABI of x86-64, whose calls have other numbers.
constexpr std::uint32_t kX32Bit = 0x40000000;

constexpr std::array kRefused{
    SYS_socket,
    SYS_socketpair,
    SYS_connect,
    SYS_bind,
    SYS_listen,
    SYS_accept,
    SYS_accept4,
    SYS_execve,
    SYS_ptrace,
    SYS_process_vm_readv,
    SYS_process_vm_writev,
    SYS_kill,
    SYS_tkill,
    SYS_rt_sigqueueinfo,
    SYS_pidfd_send_signal,
    SYS_pidfd_getfd,
    SYS_mount,
    SYS_umount2,
    SYS_pivot_root,
    SYS_chroot,
    SYS_unshare,
    SYS_setns,
    SYS_bpf,
    SYS_perf_event_open,
    SYS_userfaultfd,
    SYS_io_uring_setup,
    SYS_io_uring_enter,
    SYS_io_uring_register,
    SYS_add_key,
    SYS_request_key,
    SYS_keyctl,
    SYS_open_by_handle_at,
    SYS_init_module,
    SYS_finit_module,
    SYS_delete_module,
    SYS_kexec_load,
    SYS_reboot,
    SYS_swapon,
    SYS_swapoff,
    SYS_settimeofday,
    SYS_clock_settime,
    SYS_setrlimit,
    SYS_acct,
    SYS_personality,
    SYS_fsopen,
    SYS_open_tree,
    SYS_move_mount,
    SYS_mount_setattr,
};

constexpr std::uint32_t kNewNamespace = CLONE_NEWNS | CLONE_NEWUTS | CLONE_NEWIPC | CLONE_NEWUSER |
                                        CLONE_NEWPID | CLONE_NEWNET | CLONE_NEWCGROUP;

// Both architectures are little-endian.
constexpr std::size_t argument_low(std::size_t index) {
  return offsetof(seccomp_data, args) + 8 * index;
}
constexpr std::size_t argument_high(std::size_t index) { return argument_low(index) + 4; }

/// Skip counts of a comparison: `yes` instructions when it holds, else `no`.
struct Skip {
  std::uint8_t yes = 0;
  std::uint8_t no = 0;
};

class Program {
 public:
  void load(std::size_t offset) {
    add(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset));
  }
  void answer(std::uint32_t value) { add(BPF_RET | BPF_K, value); }
  void if_equal(std::uint32_t value, Skip skip) { add(BPF_JMP | BPF_JEQ | BPF_K, value, skip); }
  void if_any_bit(std::uint32_t bits, Skip skip) { add(BPF_JMP | BPF_JSET | BPF_K, bits, skip); }
  void if_at_least(std::uint32_t value, Skip skip) { add(BPF_JMP | BPF_JGE | BPF_K, value, skip); }
  [[nodiscard]] std::size_t size() const { return code_.size(); }
  [[nodiscard]] std::vector<sock_filter> take() { return std::move(code_); }

 private:
  void add(int code, std::uint32_t value, Skip skip = {}) {
    code_.push_back({static_cast<std::uint16_t>(code), skip.yes, skip.no, value});
  }
  std::vector<sock_filter> code_;
};

constexpr std::uint32_t number(long call) { return static_cast<std::uint32_t>(call); }

/// Calls of another ABI have other numbers: none of them may pass unread.
void refuse_other_abis(Program& program) {
  program.load(offsetof(seccomp_data, arch));
  program.if_equal(kArchitecture, {1, 0});
  program.answer(SECCOMP_RET_KILL_PROCESS);
  program.load(offsetof(seccomp_data, nr));
  program.if_at_least(kX32Bit, {0, 1});
  program.answer(kRefuse);
}

// Each of the following ends in an answer for its call, so that the loaded number stays loaded for
// all others.

void refuse(Program& program, long call, std::uint32_t answer = kRefuse) {
  program.if_equal(number(call), {0, 1});
  program.answer(answer);
}

/// The exec of `descriptor` itself.
void allow_exec_of(Program& program, int descriptor) {
  program.if_equal(number(SYS_execveat), {0, 6});
  program.load(argument_low(0));
  program.if_equal(static_cast<std::uint32_t>(descriptor), {0, 3});
  program.load(argument_low(4));
  program.if_equal(AT_EMPTY_PATH, {0, 1});
  program.answer(SECCOMP_RET_ALLOW);
  program.answer(kRefuse);
}

/// Limits may be read: the pointer to new ones must be null.
void allow_reading_limits(Program& program) {
  program.if_equal(number(SYS_prlimit64), {0, 6});
  program.load(argument_low(2));
  program.if_equal(0, {0, 3});
  program.load(argument_high(2));
  program.if_equal(0, {0, 1});
  program.answer(SECCOMP_RET_ALLOW);
  program.answer(kRefuse);
}

/// abort() sends a signal to a thread of its own. Gives the instruction that names the process.
std::size_t allow_signals_to_itself(Program& program) {
  program.if_equal(number(SYS_tgkill), {0, 4});
  program.load(argument_low(0));
  const std::size_t own_id = program.size();
  program.if_equal(0, {0, 1});
  program.answer(SECCOMP_RET_ALLOW);
  program.answer(kRefuse);
  return own_id;
}

void allow_threads(Program& program) {
  program.if_equal(number(SYS_clone), {0, 4});
  program.load(argument_low(0));
  program.if_any_bit(kNewNamespace, {1, 0});
  program.answer(SECCOMP_RET_ALLOW);
  program.answer(kRefuse);
  // Its arguments lie in memory, where no filter can look; the C library falls back on clone.
  refuse(program, SYS_clone3, SECCOMP_RET_ERRNO | ENOSYS);
}

}  // namespace

SeccompFilter confined_filter(int descriptor) {
  if constexpr (kArchitecture == 0) return {};
  SeccompFilter filter;
  Program program;
  refuse_other_abis(program);
  for (const long call : kRefused) refuse(program, call);
  allow_exec_of(program, descriptor);
  allow_reading_limits(program);
  filter.own_id.push_back(allow_signals_to_itself(program));
  allow_threads(program);
  program.answer(SECCOMP_RET_ALLOW);
  filter.program = program.take();
  return filter;
}

}  // namespace sluice
