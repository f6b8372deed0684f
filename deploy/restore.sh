#!/usr/bin/env bash
# Makes a data folder from a copy that deploy/backup.sh made, after it has checked each file of it.
#
#   deploy/restore.sh COPY DATA     DATA must not exist, or be empty
set -euo pipefail

die() { echo "restore.sh: $1" >&2; exit "${2:-1}"; }

if (($# != 2)) || [[ $1 == -* ]]; then
  sed -n '2,4s/^# \{0,1\}//p' "$0"
  [[ ${1:-} == -h || ${1:-} == --help ]] && exit 0 || exit 2
fi
copy=${1%/}
data=${2%/}
[[ -f $copy/SHA256SUMS ]] || die "$copy is no copy made by backup.sh: it has no SHA256SUMS" 2
if [[ -e $data ]]; then
  rmdir "$data" 2>/dev/null || die "$data is there and not empty; choose another name" 2
fi
(cd "$copy" && sha256sum --check --quiet --strict SHA256SUMS) || die "the copy is damaged; take another"

umask 077
part=$data.part
mkdir "$part" || die "cannot make $part; remove what a broken restore left, or choose another name"
trap 'rm -rf "$part"' EXIT
trap 'exit 130' INT TERM HUP
cp -a "$copy/jobs.sqlite" "$copy/jobs" "$part/"
if [[ -d $copy/studies ]]; then cp -a "$copy/studies" "$part/"; fi
sync -f "$part"
mv -T "$part" "$data"
echo "restored into $data; start: sluice serve --data $data"
