"""Checks the rules of the source tree: who may include whom, foreign headers behind one pair of
files, no paths of somebody's machine, a README in every folder.

Usage: check_tree.py [ROOT]. Prints one line per violation; exit status 1 when there is any.
"""

import os
import re
import subprocess
import sys

# Folders a folder may include from, besides itself: dependencies point one way.
CHAIN = ["engine/space", "engine/sph", "engine/scene", "engine/store", "engine/execute", "engine/export", "engine/run",
         "engine/draw", "engine/study", "engine/report", "engine/verify"]
MAY_INCLUDE = {folder: set(CHAIN[:place]) for place, folder in enumerate(CHAIN)}
# Pictures and studies are data: no run is behind them.
for folder in ("engine/draw", "engine/study"):
    MAY_INCLUDE[folder] -= {"engine/export", "engine/run"}
MAY_INCLUDE["engine/run"] -= {"engine/export"}
# Who starts jobs starts processes: the service and the command line. What computes does not.
for folder in CHAIN:
    MAY_INCLUDE[folder] -= {"engine/execute"}
MAY_INCLUDE["engine/verify"] -= {"engine/export", "engine/report"}
# No simulation code runs in the service: its jobs are processes.
MAY_INCLUDE["service"] = {"engine/space", "engine/sph", "engine/scene", "engine/store", "engine/execute", "engine/draw",
                          "engine/study"}
MAY_INCLUDE["cli"] = set(CHAIN) | {"service"}
MAY_INCLUDE["tests"] = set(CHAIN) | {"service", "cli"}

# Rooms of a folder, floor by floor: a room may include from itself and from the floors below it.
FLOORS = {
    "engine/sph": [["kernel", "threads"], ["terms"], ["method"], ["pairs"], ["loops"], ["stability"], ["solver"]],
    "engine/scene": [["model"], ["geometry"], ["filling"], ["format"], ["forecast"], ["checks"]],
    "engine/store": [["disk"], ["hdf5"], ["files"], ["read"]],
    "service": [["http"], ["worker"], ["jobs"], ["scheduler"], ["api"]],
}

# Generated at build time; their content depends on no folder.
GENERATED = "sluice/"

# Where a foreign header may be included: in a room, or in one pair of files, x.hpp and x.cpp.
FOREIGN = {
    "hdf5.h": ["engine/store/hdf5/"],
    "sqlite3.h": ["service/jobs/sqlite_db."],
    "httplib.h": ["service/http/http_response.", "cli/client/http_client."],
}

# The method knows no files, no JSON, no logging.
FORBIDDEN_IN = {
    "engine/sph": re.compile(
        r"^(fstream|iostream|ostream|filesystem|cstdio|stdio\.h|nlohmann/.*|fmt/.*|spdlog/.*)$"
    )
}

# Who may name an axis of space: the border that keeps the number of dimensions out of the rest. Beyond it fields, axes
# and vectors are walked. Pictures and the documents of scenes and files have axes; exact solutions are of the plane.
KNOWS_AXES = ("engine/space/", "engine/sph/", "engine/scene/geometry/", "engine/scene/filling/",
              "engine/draw/", "engine/report/picture_svg.", "engine/report/animation.", "engine/report/frame_painter.",
              "engine/scene/format/", "engine/store/files/snapshot_io.cpp", "engine/verify/", "tests/")
AXIS = re.compile(r"(?:\.|->)[xyz]\(\)|\bv[xyz]\b|\b(?:position|velocity|acceleration)\w*\[\d\]|\.origin_[xyz]\b")

TOP_LEVEL = {
    "CMakeLists.txt", "CMakePresets.json", "README.md", "CHANGELOG.md", "CONTRIBUTING.md",
    "LICENSE", "engine", "service", "cli", "schemas", "tests", "deploy",
}

SOURCE_SUFFIXES = (".hpp", ".cpp", ".h", ".cc", ".hpp.in", ".cpp.in")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
MACHINE_PATH = re.compile(r"(?<![\w.$}])/(?:work|tmp|home|root|Users)/")


def files_of(root):
    """Paths relative to root: what git tracks or would, else every file but build folders."""
    if os.path.exists(os.path.join(root, ".git")):
        listing = subprocess.run(
            ["git", "-c", "safe.directory=*", "-C", root, "ls-files", "-z", "--cached", "--others",
             "--exclude-standard"],
            check=True, capture_output=True, text=True)
        names = [name for name in listing.stdout.split("\0") if name]
        return sorted(name for name in names if os.path.isfile(os.path.join(root, name)))
    found = []
    for folder, folders, names in os.walk(root):
        folders[:] = [name for name in folders if name not in ("build", ".git", "__pycache__")]
        found += [os.path.relpath(os.path.join(folder, name), root) for name in names]
    return sorted(found)


def module_of(path):
    """The folder that the dependency rules know `path` by, or None."""
    parts = path.split("/")
    if parts[0] == "engine":
        return "/".join(parts[:2]) if len(parts) > 2 else "engine"
    return parts[0] if len(parts) > 1 else None


def floor_of(path):
    """The room of `path` in its folder and the floor it is on, or None where the folder has none."""
    module = module_of(path)
    room = path[len(module) + 1:].split("/")[0] if module else ""
    for floor, rooms in enumerate(FLOORS.get(module, [])):
        if room in rooms:
            return room, floor
    return None


def read(root, path):
    with open(os.path.join(root, path), encoding="utf-8", errors="replace") as stream:
        return stream.read().splitlines()


def check_include(path, number, quoted, target, known):
    """Violations of one #include line."""
    where = f"{path}:{number}"
    module = module_of(path)
    pattern = FORBIDDEN_IN.get(module)
    if pattern and pattern.match(target):
        yield f"{where}: {module} may not include {target}"
    inside = target.split("/")[0] in TOP_LEVEL
    if quoted and not inside and not target.startswith((GENERATED, "hwy/")):
        yield f"{where}: \"{target}\" is not a path from the root of the tree"
        return
    if not inside:
        return
    if target not in known:
        yield f"{where}: \"{target}\" does not exist"
        return
    other = module_of(target)
    if other != module and other not in MAY_INCLUDE.get(module, set()):
        yield f"{where}: {module} may not include from {other} ({target})"
    here, there = floor_of(path), floor_of(target)
    if other == module and here and there and here[0] != there[0] and here[1] <= there[1]:
        yield f"{where}: {module}/{here[0]} may not include from {module}/{there[0]} ({target})"


def check_axes(root, files):
    for path in files:
        if not path.endswith(SOURCE_SUFFIXES) or path.startswith(KNOWS_AXES):
            continue
        for number, line in enumerate(read(root, path), 1):
            named = AXIS.search(line.split("//")[0])
            if named:
                yield (f"{path}:{number}: {named.group(0)} names an axis of space outside of the border; walk the "
                       f"table of fields or the axes")


def check_includes(root, files):
    known = set(files)
    for path in files:
        if not path.endswith(SOURCE_SUFFIXES):
            continue
        for number, line in enumerate(read(root, path), 1):
            match = INCLUDE.match(line)
            if not match:
                continue
            target = match.group(2)
            yield from check_include(path, number, match.group(1) == '"', target, known)
            places = FOREIGN.get(target)
            if places and not path.startswith(tuple(places)):
                yield f"{path}:{number}: {target} may be included in {' and '.join(places)} alone"


def check_paths(root, files):
    for path in files:
        for number, line in enumerate(read(root, path), 1):
            match = MACHINE_PATH.search(line)
            if match:
                yield f"{path}:{number}: path of a machine: {line.strip()[:60]}"


def check_folders(files):
    """A README.md in each top-level folder, each folder of engine and each room; nothing else at the top."""
    known = set(files)
    folders = {module_of(path) for path in files} - {None}
    folders |= {f"{module_of(path)}/{floor_of(path)[0]}" for path in files if floor_of(path)}
    folders |= {"engine"} if any(folder.startswith("engine/") for folder in folders) else set()
    for folder in sorted(folders):
        if not folder.startswith(".") and f"{folder}/README.md" not in known:
            yield f"{folder}: has no README.md"
    for name in sorted({path.split("/")[0] for path in files}):
        if not name.startswith(".") and name not in TOP_LEVEL:
            yield f"{name}: is not a known top-level name"


def check_rooms(files):
    """Every source of a folder with rooms is in one of them."""
    for path in files:
        module = module_of(path)
        if module in FLOORS and path.endswith(SOURCE_SUFFIXES) and not floor_of(path):
            yield f"{path}: is in no room of {module}"


def violations(root):
    files = files_of(root)
    return [*check_includes(root, files), *check_axes(root, files), *check_paths(root, files), *check_folders(files),
            *check_rooms(files)]


def main():
    root = sys.argv[1] if len(sys.argv) > 1 else os.getcwd()
    found = violations(root)
    for line in found:
        print(line)
    print(f"{len(found)} violations" if found else "the tree keeps its rules")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
