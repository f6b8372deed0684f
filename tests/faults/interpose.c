/* Counts the calls that a program makes to its file system, and lets one of them fail, be cut short
 * or be the last. Loaded with LD_PRELOAD; without SLUICE_FAULTS, the path of a control file as
 * `struct Control` lays it out, it only passes calls on. The file is shared memory: whoever mapped it
 * arms a fault while the program runs, and reads afterwards which calls there were (faults.py).
 *
 * Counted are calls that name a path, and those for a descriptor of a regular file or a folder above
 * standard error. What the C library calls by itself (stdio's writes, readdir) passes uncounted, and so
 * does statvfs: what it tells is a hint, and the walk of the service uses it to keep jobs from running. */
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

/* Kinds of calls; the order is that of KINDS in faults.py. */
enum Kind {
  OPEN = 1, READ, WRITE, SYNC, CLOSE, RENAME, REMOVE, MKDIR, STAT, TRUNCATE, PIPE,
};

/* Instead of an errno. */
enum { KILL = -1, SHORT = -2 };

enum { MOST_CALLS = 1 << 20 };

struct Control {
  _Atomic uint32_t counting;   /* 0: nothing is counted, nothing fails */
  _Atomic uint32_t count;      /* calls so far */
  _Atomic uint32_t at;         /* the call that fails, from 1; 0: none */
  uint32_t burst;              /* so many calls from that one on fail, as far as the fault fits them */
  _Atomic int32_t fault;       /* errno, KILL or SHORT */
  _Atomic uint32_t fired;      /* 1 once it did */
  uint32_t quick;              /* 1: sleeps take a hundredth of their time, nothing is synced */
  char what[484];              /* the call that failed, for people */
  uint8_t kinds[MOST_CALLS];   /* of all calls */
};

static struct Control* control;

/* No wrapper may be called before the system's own functions are known: they are looked up when they
 * are first used. */
#define REAL(name)                                                     \
  static __typeof__(name)* real;                                       \
  if (!real) real = (__typeof__(name)*)dlsym(RTLD_NEXT, #name)

__attribute__((constructor)) static void start(void) {
  const char* path = getenv("SLUICE_FAULTS");
  if (!path) return;
  const int file = (int)syscall(SYS_openat, AT_FDCWD, path, O_RDWR | O_CLOEXEC);
  if (file < 0) abort();
  void* shared = mmap(NULL, sizeof(struct Control), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  syscall(SYS_close, file);
  if (shared == MAP_FAILED) abort();
  control = shared;
}

/* Whether a fault that was meant for another kind of call can happen to this one, too. */
static int fits(enum Kind kind) {
  switch (control->fault) {
    case EIO:
      return 1;
    case ENOSPC:
      return kind == WRITE || kind == SYNC || kind == RENAME || kind == MKDIR;
    case EMFILE:
      return kind == OPEN || kind == PIPE;
    case EINTR:
      return kind == OPEN || kind == READ || kind == WRITE || kind == SYNC;
    case SHORT:
      return kind == READ || kind == WRITE;
    default:
      return 0;
  }
}

/* The fault of this call; 0 for none. */
static int fault_of(enum Kind kind, const char* name, const char* path, int descriptor) {
  if (!control || !control->counting) return 0;
  const uint32_t number = ++control->count;
  if (number < MOST_CALLS) control->kinds[number] = (uint8_t)kind;
  if (control->at == 0 || number < control->at || number - control->at >= control->burst) return 0;
  if (number > control->at) return fits(kind) ? control->fault : 0;
  char link[32];
  char target[256] = "";
  if (!path) {
    snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    if (syscall(SYS_readlink, link, target, sizeof target - 1) > 0) path = target;
  }
  snprintf(control->what, sizeof control->what, "%s %s", name, path ? path : "");
  control->fired = 1;
  if (control->fault == KILL) {
    syscall(SYS_kill, getpid(), SIGKILL);
    for (;;) pause();
  }
  return control->fault;
}

static int of_descriptor(enum Kind kind, const char* name, int descriptor) {
  if (!control || !control->counting || descriptor <= STDERR_FILENO) return 0;
  const int saved = errno;
  struct stat status;
  const long known = syscall(SYS_fstat, descriptor, &status);
  errno = saved;
  if (known != 0 || !(S_ISREG(status.st_mode) || S_ISDIR(status.st_mode))) return 0;
  return fault_of(kind, name, NULL, descriptor);
}

#define FAIL_WITH(fault, failure) \
  do {                            \
    const int error = (fault);    \
    if (error > 0) {              \
      errno = error;              \
      return failure;             \
    }                             \
  } while (0)

#define MODE_OF(flags)                              \
  mode_t mode = 0;                                  \
  if ((flags) & (O_CREAT | __O_TMPFILE)) {          \
    va_list rest;                                   \
    va_start(rest, flags);                          \
    mode = va_arg(rest, mode_t);                    \
    va_end(rest);                                   \
  }

/* Each with its twin for large files, which is the same where off_t has 64 bits. */
#define OPEN_CALL(name)                                    \
  int name(const char* path, int flags, ...) {             \
    REAL(name);                                            \
    MODE_OF(flags)                                         \
    FAIL_WITH(fault_of(OPEN, #name, path, -1), -1);        \
    return real(path, flags, mode);                        \
  }
OPEN_CALL(open)
OPEN_CALL(open64)

#define OPENAT_CALL(name)                                  \
  int name(int folder, const char* path, int flags, ...) { \
    REAL(name);                                            \
    MODE_OF(flags)                                         \
    FAIL_WITH(fault_of(OPEN, #name, path, -1), -1);        \
    return real(folder, path, flags, mode);                \
  }
OPENAT_CALL(openat)
OPENAT_CALL(openat64)

/* What the headers of a program built with _FORTIFY_SOURCE make of open. */
int __open_2(const char* path, int flags) { return open(path, flags); }
int __open64_2(const char* path, int flags) { return open64(path, flags); }
int __openat_2(int folder, const char* path, int flags) { return openat(folder, path, flags); }
int __openat64_2(int folder, const char* path, int flags) { return openat64(folder, path, flags); }

#define FOPEN_CALL(name)                                   \
  FILE* name(const char* path, const char* mode) {         \
    REAL(name);                                            \
    FAIL_WITH(fault_of(OPEN, #name, path, -1), NULL);      \
    return real(path, mode);                               \
  }
FOPEN_CALL(fopen)
FOPEN_CALL(fopen64)

DIR* opendir(const char* path) {
  REAL(opendir);
  FAIL_WITH(fault_of(OPEN, "opendir", path, -1), NULL);
  return real(path);
}

static size_t shortened(int fault, size_t count) { return fault == SHORT && count > 1 ? count / 2 : count; }

ssize_t write(int file, const void* bytes, size_t count) {
  REAL(write);
  const int fault = of_descriptor(WRITE, "write", file);
  FAIL_WITH(fault, -1);
  return real(file, bytes, shortened(fault, count));
}

#define PWRITE_CALL(name)                                                    \
  ssize_t name(int file, const void* bytes, size_t count, off_t offset) {    \
    REAL(name);                                                              \
    const int fault = of_descriptor(WRITE, #name, file);                     \
    FAIL_WITH(fault, -1);                                                    \
    return real(file, bytes, shortened(fault, count), offset);               \
  }
PWRITE_CALL(pwrite)
PWRITE_CALL(pwrite64)

ssize_t read(int file, void* bytes, size_t count) {
  REAL(read);
  const int fault = of_descriptor(READ, "read", file);
  FAIL_WITH(fault, -1);
  return real(file, bytes, shortened(fault, count));
}

#define PREAD_CALL(name)                                               \
  ssize_t name(int file, void* bytes, size_t count, off_t offset) {    \
    REAL(name);                                                        \
    const int fault = of_descriptor(READ, #name, file);                \
    FAIL_WITH(fault, -1);                                              \
    return real(file, bytes, shortened(fault, count), offset);         \
  }
PREAD_CALL(pread)
PREAD_CALL(pread64)

#define SYNC_CALL(name)                              \
  int name(int file) {                               \
    REAL(name);                                      \
    FAIL_WITH(of_descriptor(SYNC, #name, file), -1); \
    return control && control->quick ? 0 : real(file); \
  }
SYNC_CALL(fsync)
SYNC_CALL(fdatasync)

/* It closes all the same, as Linux does. */
int close(int file) {
  REAL(close);
  const int fault = of_descriptor(CLOSE, "close", file);
  const int result = real(file);
  FAIL_WITH(fault, -1);
  return result;
}

int rename(const char* from, const char* to) {
  REAL(rename);
  FAIL_WITH(fault_of(RENAME, "rename", to, -1), -1);
  return real(from, to);
}

int renameat(int old_folder, const char* from, int new_folder, const char* to) {
  REAL(renameat);
  FAIL_WITH(fault_of(RENAME, "renameat", to, -1), -1);
  return real(old_folder, from, new_folder, to);
}

int renameat2(int old_folder, const char* from, int new_folder, const char* to, unsigned flags) {
  REAL(renameat2);
  FAIL_WITH(fault_of(RENAME, "renameat2", to, -1), -1);
  return real(old_folder, from, new_folder, to, flags);
}

int link(const char* from, const char* to) {
  REAL(link);
  FAIL_WITH(fault_of(RENAME, "link", to, -1), -1);
  return real(from, to);
}

#define PATH_CALL(kind, name)                       \
  int name(const char* path) {                      \
    REAL(name);                                     \
    FAIL_WITH(fault_of(kind, #name, path, -1), -1); \
    return real(path);                              \
  }
PATH_CALL(REMOVE, unlink)
PATH_CALL(REMOVE, rmdir)
PATH_CALL(REMOVE, remove)

int unlinkat(int folder, const char* path, int flags) {
  REAL(unlinkat);
  FAIL_WITH(fault_of(REMOVE, "unlinkat", path, -1), -1);
  return real(folder, path, flags);
}

int mkdir(const char* path, mode_t mode) {
  REAL(mkdir);
  FAIL_WITH(fault_of(MKDIR, "mkdir", path, -1), -1);
  return real(path, mode);
}

int mkdirat(int folder, const char* path, mode_t mode) {
  REAL(mkdirat);
  FAIL_WITH(fault_of(MKDIR, "mkdirat", path, -1), -1);
  return real(folder, path, mode);
}

#define STAT_CALL(name, type)                       \
  int name(const char* path, struct type* status) { \
    REAL(name);                                     \
    FAIL_WITH(fault_of(STAT, #name, path, -1), -1); \
    return real(path, status);                      \
  }
STAT_CALL(stat, stat)
STAT_CALL(stat64, stat64)
STAT_CALL(lstat, stat)
STAT_CALL(lstat64, stat64)

#define FSTAT_CALL(name, type)                       \
  int name(int file, struct type* status) {          \
    REAL(name);                                      \
    FAIL_WITH(of_descriptor(STAT, #name, file), -1); \
    return real(file, status);                       \
  }
FSTAT_CALL(fstat, stat)
FSTAT_CALL(fstat64, stat64)

#define FSTATAT_CALL(name, type)                                           \
  int name(int folder, const char* path, struct type* status, int flags) { \
    REAL(name);                                                            \
    FAIL_WITH(fault_of(STAT, #name, path, -1), -1);                        \
    return real(folder, path, status, flags);                              \
  }
FSTATAT_CALL(fstatat, stat)
FSTATAT_CALL(fstatat64, stat64)

int statx(int folder, const char* path, int flags, unsigned mask, struct statx* status) {
  REAL(statx);
  FAIL_WITH(fault_of(STAT, "statx", path, -1), -1);
  return real(folder, path, flags, mask, status);
}

int access(const char* path, int wanted) {
  REAL(access);
  FAIL_WITH(fault_of(STAT, "access", path, -1), -1);
  return real(path, wanted);
}

#define TRUNCATE_CALL(name)                              \
  int name(int file, off_t length) {                     \
    REAL(name);                                          \
    FAIL_WITH(of_descriptor(TRUNCATE, #name, file), -1); \
    return real(file, length);                           \
  }
TRUNCATE_CALL(ftruncate)
TRUNCATE_CALL(ftruncate64)

int pipe2(int ends[2], int flags) {
  REAL(pipe2);
  FAIL_WITH(fault_of(PIPE, "pipe2", "", -1), -1);
  return real(ends, flags);
}

/* Tries are made again after waits, and a walk makes thousands of them. */
int clock_nanosleep(clockid_t clock, int flags, const struct timespec* wait, struct timespec* left) {
  REAL(clock_nanosleep);
  if (!control || !control->quick || (flags & TIMER_ABSTIME)) return real(clock, flags, wait, left);
  const int64_t whole = (int64_t)wait->tv_sec * 1000000000 + wait->tv_nsec;
  const struct timespec part = {whole / 100 / 1000000000, whole / 100 % 1000000000};
  return real(clock, flags, &part, left);
}

int nanosleep(const struct timespec* wait, struct timespec* left) {
  if (clock_nanosleep(CLOCK_REALTIME, 0, wait, left) == 0) return 0;
  errno = EINTR;
  return -1;
}
