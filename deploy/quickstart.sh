#!/usr/bin/env bash
# The first five minutes with Sluice, from a fresh clone: installs what is needed, builds, starts the
# service, submits the paper's dam break (20 000 particles to T = 8), kills its worker and then the
# service with kill -9, and shows that the job goes on, its filtered pressure and the comparison with
# the experiment. What you could type yourself is printed as "$ command" before it runs. It makes
# build/release, and a temporary folder that it removes, so that it can be run again and again.
#
#   deploy/quickstart.sh [--check] [SCENE.json]     default: schemas/examples/dambreak-paper.json
#   deploy/quickstart.sh --quick                    a scene of about ten seconds, with --check
#
#   --check   also runs the scene without a stop, and compares the digests of both
set -euo pipefail
cd "$(dirname "$0")/.."

scene=schemas/examples/dambreak-paper.json
check=
for argument in "$@"; do
  case "$argument" in
    -h | --help) sed -n '2,12s/^# \{0,1\}//p' "$0"; exit 0 ;;
    --quick) scene=schemas/examples/dambreak-quick.json check=yes ;;
    --check) check=yes ;;
    -*) echo "quickstart.sh: unknown option '$argument'; try --help" >&2; exit 2 ;;
    *) scene=$argument ;;
  esac
done
[[ -r $scene ]] || { echo "quickstart.sh: cannot read the scene $scene" >&2; exit 2; }

export no_proxy=127.0.0.1
sluice=build/release/cli/sluice
work=$(mktemp -d)
service=
clean_up() {
  if [[ -n $service ]]; then
    kill "$service" 2>/dev/null || true
    wait "$service" 2>/dev/null || true
  fi
  # A worker whose service was killed writes its checkpoint first.
  for _ in {1..100}; do
    rm -rf "$work" 2>/dev/null && break
    sleep 0.1
  done
}
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP

say() { printf '\n== %s\n' "$1"; }

fail() {
  echo "quickstart.sh: $1" >&2
  if [[ -s $work/service.log ]]; then sed 's/^/  service: /' "$work/service.log" >&2; fi
  exit 1
}

# As it would be typed: words that a shell would take apart are quoted.
type_out() {
  local word line='$'
  for word in "$@"; do
    if [[ $word =~ [^A-Za-z0-9_./:@%+=,-] && $word != '&' ]]; then word="'$word'"; fi
    line+=" $word"
  done
  printf '%s\n' "$line"
}

run() {
  type_out "$@"
  "$@"
}

# A program reads JSON with a parser; this is enough for the first value of a key, and needs none.
field() { { grep -o "\"$1\": *[^,}]*" || true; } | sed -n '1{s/^[^:]*: *//; s/"//g; p}'; }

ask() { curl -sS --fail-with-body "$@"; }

# Starts the service on port $1 and waits for the line that tells its address.
serve() {
  local line=
  : >"$work/service.out"
  type_out "$sluice" serve --data "$work/data" --port "$1" '&'
  "$sluice" serve --data "$work/data" --port "$1" >"$work/service.out" 2>>"$work/service.log" &
  service=$!
  until line=$(grep -m 1 ' at http://' "$work/service.out"); do
    kill -0 "$service" 2>/dev/null || fail "the service ended instead of starting"
    sleep 0.05
  done
  echo "  $line"
  url=${line##* }
}

# Asks for news of the job: its state, attempts and percent of the model time.
look() {
  local answer share
  answer=$(ask "$url/v1/jobs/$job?wait=5") || fail "the service does not answer: $answer"
  state=$(field state <<<"$answer")
  attempt=$(field attempts <<<"$answer")
  share=$(field fraction <<<"$answer")
  percent=$(awk -v share="${share:-0}" 'BEGIN { print int(100 * share) }')
  # Progress is told once a second, so the last of it comes before the end.
  if [[ $state == completed ]]; then percent=100; fi
  [[ $state =~ ^(queued|running|completed)$ ]] || fail "the job is $state: $answer"
}

show() { echo "  $state, attempt $attempt, $percent % of the model time"; }

# Follows the job until the command holds or the job has ended. A request waits for news, so that
# nothing spins.
follow() {
  local shown=-10
  type_out curl "$url/v1/jobs/$job?wait=5"
  while look && [[ $state != completed ]] && ! "$@"; do
    if ((percent >= shown + 10)); then
      show
      shown=$percent
    fi
  done
  show
}

has_done() { ((percent >= $1)); }
resumes() { grep -c '"event":"resumed"' "$work/data/jobs/$job/log.jsonl" || true; }
newest_checkpoint() { find "$work/data/jobs/$job" -name 'checkpoint-*.h5' | sort | tail -n 1; }

# Waits until the job has been resumed $1 times, and says from where.
see_it_resumed() {
  while (($(resumes) < $1)); do look; done
  printf '$ curl %s | grep resumed\n' "$url/v1/jobs/$job/log"
  echo "  went on from $(ask "$url/v1/jobs/$job/log" | grep '"resumed"' | tail -n 1 | field file)"
}

say "install what is needed"
run deploy/install-dependencies.sh

say "build"
if [[ ! -f build/release/build.ninja ]]; then
  type_out cmake --preset release -DSLUICE_TESTS=OFF
  cmake --preset release -DSLUICE_TESTS=OFF >"$work/configure" || { cat "$work/configure"; exit 1; }
fi
run cmake --build --preset release --target sluice
run "$sluice" --version

say "start the service"
serve 0

say "submit $scene"
threads=$(nproc)
jobs_url="$url/v1/jobs?threads=$((threads < 8 ? threads : 8))"
type_out curl --data-binary "@$scene" "$jobs_url"
answer=$(ask --data-binary "@$scene" "$jobs_url") || fail "refused: $answer"
echo "${answer:0:160}..."
job=$(field id <<<"$answer")

say "watch it"
follow has_done 30

if [[ $state == running ]]; then
  say "have it write a checkpoint, and kill its worker"
  before=$(newest_checkpoint)
  type_out curl -X POST "$url/v1/jobs/$job/checkpoint"
  ask -X POST "$url/v1/jobs/$job/checkpoint" >"$work/answer" || true
  while [[ $(newest_checkpoint) == "$before" && $state == running ]]; do look; done
  echo "  wrote $(basename "$(newest_checkpoint)")"
  run kill -9 "$(ask "$url/v1/jobs/$job" | field pid)"
  see_it_resumed 1
  follow has_done 60
fi

if [[ $state == running ]]; then
  say "kill the service, and start it again"
  run kill -9 "$service"
  wait "$service" 2>/dev/null || true
  serve "${url##*:}"
  see_it_resumed 2
  follow false
fi

say "filtered pressure at P1, dimensionless, no more than 30 samples"
series="$url/v1/jobs/$job/sensors/P1?filter=gaussian&tau=0.002&dimensionless=1&max_points=30&format=csv"
type_out curl "$series"
ask "$series" || fail "the series of P1 cannot be had"

say "against the experiment"
run "$sluice" report "$work/data/jobs/$job"

if [[ -n $check ]]; then
  say "the same scene without a stop"
  type_out "$sluice" run "$scene" --folder "$work/undisturbed"
  "$sluice" run "$scene" --folder "$work/undisturbed" >"$work/progress"
  digests() { sed -n '/"digests"/,/^  }/p' "$1/outcome.json"; }
  digests "$work/undisturbed" >"$work/expected"
  digests "$work/data/jobs/$job" | diff "$work/expected" - ||
    fail "the killed job and the run without a stop differ"
  count=$(grep -cE '"[0-9a-f]{64}"' "$work/expected") || fail "the run has no digests"
  echo "identical: all $count digests (SHA-256), first $(field physics <"$work/expected")"
fi

say "stop the service"
run kill "$service"
wait "$service" || fail "the service ended with exit code $?"
service=
say "done in $SECONDS s: the job was $state in attempt $attempt; the program is $sluice"
