#!/usr/bin/env bash
# Requests per second and times of the service on loopback, idle and while two jobs run:
# submissions, status, lists and filtered series, held against their aims. For a machine that does
# nothing else, with a disk that nobody else writes to (TMPDIR says where the data go).
#
#   tests/bench/load.sh [SECONDS [SLUICE]]    10 s each; SLUICE by default of the release build
set -euo pipefail
cd "$(dirname "$0")/../.."
command -v wrk >/dev/null || {
  echo "load.sh: there is no wrk: deploy/install-dependencies.sh --tests" >&2
  exit 1
}
program=${2:-build/release/cli/sluice}
[[ -x $program ]] || {
  echo "load.sh: $program is not built: cmake --preset release && cmake --build --preset release" >&2
  exit 1
}
exec /usr/bin/python3 tests/bench/load.py "$(realpath "$program")" "${1:-10}"
