"""Faults in the file system calls of a program: the control file that interpose.c shares with it."""

import errno
import mmap
import os
import signal
import struct

KINDS = ("", "open", "read", "write", "sync", "close", "rename", "remove", "mkdir", "stat", "truncate",
         "pipe")
KILL, SHORT = -1, -2
MOST_CALLS = 1 << 20
HEAD = struct.Struct("=IIIIiII484s")  # struct Control of interpose.c, without the kinds of calls

# What can happen to a call of each kind. EINTR only where Linux or a network file system gives it.
FITTING = {
    "open": (errno.EIO, errno.EMFILE, errno.EINTR, errno.ENOSPC),
    "read": (errno.EIO, errno.EINTR, SHORT),
    "write": (errno.EIO, errno.ENOSPC, errno.EINTR, SHORT),
    "sync": (errno.EIO, errno.ENOSPC, errno.EINTR),
    "close": (errno.EIO, errno.EINTR),
    "rename": (errno.EIO, errno.ENOSPC),
    "remove": (errno.EIO,),
    "mkdir": (errno.EIO, errno.ENOSPC),
    "stat": (errno.EIO, errno.ENOMEM),
    "truncate": (errno.EIO, errno.EINTR),
    "pipe": (errno.EMFILE,),
}


def name_of(fault):
    return {KILL: "a kill", SHORT: "a cut"}.get(fault) or errno.errorcode[fault]


def fitting(kind):
    return FITTING[kind] + (KILL,)


class Control:
    """Shared with a program that runs with `environment()`."""

    burst = 1  # so many calls in a row fail

    def __init__(self, interposer, path, quick=True):
        self.interposer = interposer
        self.path = os.fspath(path)
        with open(self.path, "wb") as stream:
            stream.truncate(HEAD.size + MOST_CALLS)
        with open(self.path, "r+b") as stream:
            self.memory = mmap.mmap(stream.fileno(), HEAD.size + MOST_CALLS)
        self.quick = int(quick)
        self.disarm()

    def environment(self):
        return {**os.environ, "LD_PRELOAD": self.interposer, "SLUICE_FAULTS": self.path}

    def arm(self, at=0, fault=0):
        """From now on calls are counted; the `at`-th fails. With 0 none does."""
        HEAD.pack_into(self.memory, 0, 0, 0, at, self.burst, fault, 0, self.quick, b"")
        self.memory[0:4] = struct.pack("=I", 1)

    def disarm(self):
        HEAD.pack_into(self.memory, 0, 0, 0, 0, 0, 0, 0, self.quick, b"")

    def stop(self):
        """Counts no more; what was counted stays to be read."""
        self.memory[0:4] = struct.pack("=I", 0)

    def _head(self):
        return HEAD.unpack_from(self.memory)

    def fired(self):
        return self._head()[5] != 0

    def what(self):
        return self._head()[7].rstrip(b"\0").decode(errors="replace")

    def calls(self):
        """The kinds of all calls since it was armed."""
        count = min(self._head()[1], MOST_CALLS - 1)
        kinds = self.memory[HEAD.size + 1:HEAD.size + 1 + count]
        return [KINDS[kind] for kind in kinds]

    def close(self):
        self.memory.close()
        os.remove(self.path)


class Case:
    """One fault at one call of one operation."""

    def __init__(self, operation, number, kind, fault):
        self.operation = operation
        self.number = number
        self.kind = kind
        self.fault = fault

    def __str__(self):
        return f"{self.operation}: {name_of(self.fault)} at call {self.number} ({self.kind})"


def cases_of(operation, kinds):
    """All faults that fit its calls."""
    return [Case(operation, number, kind, fault)
            for number, kind in enumerate(kinds, 1) for fault in fitting(kind)]


def was_killed(status):
    return status == -signal.SIGKILL


def must_pass_unseen(fault):
    """What every caller of the system has to expect of a healthy one."""
    return fault in (errno.EINTR, SHORT)
