#!/usr/bin/env bash
# The first five minutes with Sluice, from a fresh clone: installs what is needed, builds, starts the
# service, submits the paper's dam break with the recommended scheme (20 000 particles to T = 8), kills
# its worker and then the service with kill -9, shows that the job resumes, fetches its filtered
# pressure and leaves a report to open in a browser: build/quickstart/NAME.html. What you could type
# yourself is printed as "$ command" before it runs. It makes build/ and a temporary folder that it
# removes, so that it can be run again and again.
#
#   deploy/quickstart.sh [--check] [SCENE.json]     default: schemas/examples/dambreak.json
#   deploy/quickstart.sh --paper                    the paper's own scheme, some five times the work
#   deploy/quickstart.sh --quick                    a smaller dam break, with --check
#
#   --check   also runs the scene without a stop, and compares the digests of both
#
# SLUICE_SIMD=AVX2 (or SSE4) in the environment runs all of it as on a machine without AVX-512.
set -euo pipefail
cd "$(dirname "$0")/.."

scene=schemas/examples/dambreak.json
check=
for argument in "$@"; do
  case "$argument" in
    -h | --help) sed -n '2,16s/^# \{0,1\}//p' "$0"; exit 0 ;;
    --quick) scene=schemas/examples/dambreak-quick.json check=yes ;;
    --paper) scene=schemas/examples/dambreak-paper.json ;;
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
    if [[ $word =~ [^A-Za-z0-9_./:@%+=,-] && $word != '&' && $word != '>' ]]; then word="'$word'"; fi
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

# Asks for news of the job: its state, attempts, percent of the model time and seconds to go.
look() {
  local answer share
  answer=$(ask "$url/v1/jobs/$job?wait=1") || fail "the service does not answer: $answer"
  state=$(field state <<<"$answer")
  attempt=$(field attempts <<<"$answer")
  share=$(field fraction <<<"$answer")
  to_go=$(field eta <<<"$answer")
  pid=$(field pid <<<"$answer")
  percent=$(awk -v share="${share:-0}" 'BEGIN { print int(100 * share) }')
  # Progress is told once a second, so the last of it comes before the end.
  if [[ $state == completed ]]; then percent=100 to_go=0; fi
  [[ $state =~ ^(queued|running|completed)$ ]] || fail "the job is $state: $answer"
}

# A bar that is drawn anew on a terminal, and a line for each tenth elsewhere.
shown=-1
show() {
  local done=$((percent * 30 / 100)) bar line
  printf -v bar '%*s' "$done" ''
  line="  [${bar// /#}$(printf '%*s' $((30 - done)) '')] $percent %  $state, attempt $attempt"
  if [[ $to_go =~ ^[0-9] ]]; then line+=", $(in_words "$to_go") to go"; fi
  if [[ -t 1 ]]; then
    printf '\r%s\033[K' "$line"
  elif ((percent / 10 != shown)); then
    printf '%s\n' "$line"
  fi
  shown=$((percent / 10))
}

# Seconds as a person says them.
in_words() {
  awk -v s="$1" 'BEGIN { if (s < 90) printf "%d s", s + 0.5; else printf "%d min", s / 60 + 0.5 }'
}

# Follows the job until the command holds or the job has ended. A request waits up to a second for
# news, so that nothing spins.
follow() {
  type_out curl "$url/v1/jobs/$job?wait=1"
  shown=-1
  while look && [[ $state != completed ]] && ! "$@"; do show; done
  show
  if [[ -t 1 ]]; then echo; fi
}

has_done() { ((percent >= $1)); }
resumes() { grep -c '"event":"resumed"' "$work/data/jobs/$job/log.jsonl" || true; }
newest_checkpoint() { find "$work/data/jobs/$job" -name 'checkpoint-*.h5' | sort | tail -n 1; }

# Waits until the job has been resumed $1 times, and says from where.
see_it_resumed() {
  while (($(resumes) < $1)) && [[ $state != completed ]]; do look; done
  printf '$ curl %s | grep resumed\n' "$url/v1/jobs/$job/log"
  echo "  resumed from $(ask "$url/v1/jobs/$job/log" | grep '"resumed"' | tail -n 1 | field file)"
}

say "install what is needed (a minute or two where packages are missing)"
run deploy/install-dependencies.sh

say "build (some 5 core-minutes the first time, about $(in_words $((300 / $(nproc)))) on $(nproc) quick cores)"
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
echo "  the job will take about $(in_words "$(field seconds <<<"$answer")")"

say "watch it"
follow has_done 30

if [[ $state == running ]]; then
  say "have it write a checkpoint, and kill its worker"
  before=$(newest_checkpoint)
  type_out curl -X POST "$url/v1/jobs/$job/checkpoint"
  ask -X POST "$url/v1/jobs/$job/checkpoint" >"$work/answer" || true
  while [[ $(newest_checkpoint) == "$before" && $state == running ]]; do look; done
  echo "  wrote $(basename "$(newest_checkpoint)")"
  look
  # It may have ended meanwhile.
  if [[ $pid =~ ^[0-9]+$ ]]; then
    run kill -9 "$pid"
    see_it_resumed 1
  fi
  follow has_done 60
fi

if [[ $state == running ]]; then
  say "kill the service, and start it again"
  run kill -9 "$service"
  wait "$service" 2>/dev/null || true
  before=$(resumes)
  serve "${url##*:}"
  see_it_resumed $((before + 1))
  follow false
fi

say "filtered pressure at P1, dimensionless, no more than 30 samples"
series="$url/v1/jobs/$job/sensors/P1?filter=gaussian&tau=0.002&dimensionless=1&max_points=30&format=csv"
type_out curl "$series"
ask "$series" || fail "the series of P1 cannot be had"

say "against the experiment"
run "$sluice" report "$work/data/jobs/$job"
look_at=build/quickstart/$(basename "$scene" .json).html
mkdir -p "${look_at%/*}"
type_out "$sluice" report "$work/data/jobs/$job" --format html '>' "$look_at"
"$sluice" report "$work/data/jobs/$job" --format html >"$look_at"

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
say "done in $(in_words "$SECONDS"): the job was $state in attempt $attempt; the program is $sluice"
echo "look at file://$PWD/$look_at"
