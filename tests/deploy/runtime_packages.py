"""The packages that install-dependencies.sh --runtime names bring every library that the program is
linked with: what the container and other machines have.

usage: runtime_packages.py SLUICE ROOT
"""

import os
import re
import shutil
import subprocess
import sys

# A Debian system, or what every C++ library of Debian depends on.
ALWAYS_THERE = {"libc6", "libgcc-s1", "libstdc++6"}


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def package_of(path):
    """Debian knows files in /usr/lib by that name or, from before the merge, by /lib."""
    real = os.path.realpath(path)
    for name in (real, real.removeprefix("/usr"), path, path.removeprefix("/usr")):
        found = subprocess.run(["dpkg-query", "-S", name], capture_output=True, text=True)
        if found.returncode == 0:
            return found.stdout.split(":")[0]
    raise SystemExit(f"{path} belongs to no package")


def main():
    program, root = sys.argv[1:]
    if not shutil.which("dpkg-query") or not shutil.which("objdump"):
        print("no dpkg-query or objdump here")
        sys.exit(77)
    needed = re.findall(r"NEEDED\s+(\S+)", output_of("objdump", "-p", program))
    where = dict(re.findall(r"(\S+) => (/\S+)", output_of("ldd", program)))
    packages = {package_of(where[name]) for name in needed if name in where}
    assert "libhdf5-103-1" in packages, packages
    named = set(output_of(f"{root}/deploy/install-dependencies.sh", "--runtime", "--list").split())
    missing = packages - named - ALWAYS_THERE
    if missing:
        sys.exit(f"install-dependencies.sh --runtime does not name {', '.join(sorted(missing))}")


if __name__ == "__main__":
    main()
