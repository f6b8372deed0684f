#!/usr/bin/env bash
# Installs what Sluice needs on Debian 12: the one package list, used by the quick start, the tests
# and continuous integration alike. Needs root, or sudo, only when something is missing.
#
#   deploy/install-dependencies.sh            what a build and a run need
#   deploy/install-dependencies.sh --tests    also what tests/run.sh needs
#   deploy/install-dependencies.sh --browser  also Chromium, which a test of label long opens a report in
#   deploy/install-dependencies.sh --runtime  only what a program that is built already needs
#   deploy/install-dependencies.sh --list     prints the names instead (combines with the others)
set -euo pipefail

build_packages=(
  g++ cmake ninja-build pkg-config
  libeigen3-dev         # small vectors
  libhdf5-dev           # checkpoints, series and frames
  nlohmann-json3-dev    # scenes and reports
  libfmt-dev            # text
  libcli11-dev          # command line
  libxxhash-dev         # checksums of files
  libssl-dev            # SHA-256 of results
  libhwy-dev            # SIMD with run-time dispatch
  libsqlite3-dev        # the service's job rows
  libpng-dev            # pictures in reports
  libcpp-httplib-dev    # the service's answers
  curl ca-certificates  # quickstart.sh
  sqlite3               # backup.sh
)
# The libraries that the build packages bring, by the names of Debian 12.
runtime_packages=(
  libhdf5-103-1 libfmt9 libxxhash0 libssl3 libhwy1 libsqlite3-0 libpng16-16 libcpp-httplib0.11
)
test_packages=(
  libgtest-dev libgmock-dev
  librapidcheck-dev     # property tests
  libbenchmark-dev wrk valgrind  # tests/bench
  clang clang-format clang-tidy libclang-rt-14-dev
  python3 python3-jsonschema python3-h5py python3-numpy
)

usage() { sed -n '2,9s/^# \{0,1\}//p' "$0"; }

packages=("${build_packages[@]}")
action=install
for argument in "$@"; do
  case "$argument" in
    --tests) packages+=("${test_packages[@]}") ;;
    --browser) packages+=(chromium) ;;
    --runtime) packages=("${runtime_packages[@]}") ;;
    --list) action=list ;;
    -h | --help) usage; exit 0 ;;
    *) echo "install-dependencies.sh: unknown argument '$argument'" >&2; usage >&2; exit 2 ;;
  esac
done
if [[ $action == list ]]; then
  printf '%s\n' "${packages[@]}"
  exit 0
fi

if ! command -v dpkg-query >/dev/null; then
  echo "install-dependencies.sh: this is not a Debian system; install the equivalents of:" >&2
  printf '  %s\n' "${packages[@]}" >&2
  exit 1
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $status == installed ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  echo "dependencies: all ${#packages[@]} packages are installed"
  exit 0
fi

as_root=()
if ((EUID != 0)); then
  if ! command -v sudo >/dev/null; then
    echo "install-dependencies.sh: missing ${missing[*]}; run this as root, or install sudo" >&2
    exit 1
  fi
  as_root=(sudo)
fi

echo "dependencies: installing ${missing[*]}"
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=300)
"${apt[@]}" update
"${apt[@]}" install -y --no-install-recommends "${missing[@]}" >/dev/null
echo "dependencies: installed ${#missing[@]} packages"
