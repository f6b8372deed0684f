#!/usr/bin/env bash
# Copies a data folder of the service, also while it runs: jobs go on undisturbed, and a restored job
# resumes from its last checkpoint in the copy, bit by bit. Needs sqlite3.
#
#   deploy/backup.sh DATA COPY      COPY must not exist; restore it with deploy/restore.sh
#
# The rows come first, so that the folders are never older than they: the service follows the folders
# when it starts. A job deleted meanwhile may be in the copy as a row without a folder.
set -euo pipefail

die() { echo "backup.sh: $1" >&2; exit "${2:-1}"; }

if (($# != 2)) || [[ $1 == -* ]]; then
  sed -n '2,8s/^# \{0,1\}//p' "$0"
  [[ ${1:-} == -h || ${1:-} == --help ]] && exit 0 || exit 2
fi
data=${1%/}
copy=${2%/}
[[ -f $data/jobs.sqlite && -d $data/jobs ]] || die "$data is no data folder of sluice serve" 2
[[ ! -e $copy ]] || die "$copy is there already; choose another name" 2
command -v sqlite3 >/dev/null || die "needs sqlite3: apt-get install sqlite3"

umask 077
exec 9<"$data/jobs"
flock --nonblock 9 || die "another backup of $data is being made"
# What a killed backup left.
rm -rf "$data"/.backup-*
part=$copy.part
mkdir "$part" || die "cannot make $part; remove what a broken backup left, or choose another name"
# On the disk of the data, for links.
links=$(mktemp -d "$data/.backup-XXXXXX")
trap 'rm -rf "$links" "$part"' EXIT
trap 'exit 130' INT TERM HUP

sqlite3 -cmd '.timeout 10000' "$data/jobs.sqlite" "VACUUM INTO '${part//\'/\'\'}/jobs.sqlite'"

# The service puts files in place by a rename and never edits them, so a link keeps a file as it is
# now, whatever the job does next. A listing that a new checkpoint overtook is taken again.
link_job() {
  local _
  for _ in {1..50}; do
    if cp -al "$1" "$links/" 2>"$links/why"; then return; fi
    rm -rf "${links:?}/${1##*/}"
    [[ -d $1 ]] || return 0
  done
  die "$1 cannot be linked: $(tail -n 1 "$links/why")"
}

mkdir "$part/jobs"
jobs=0
for folder in "$data"/jobs/*/; do
  [[ -d $folder ]] || continue
  link_job "${folder%/}"
  job=$links/$(basename "$folder")
  [[ -d $job ]] || continue
  find "$job" -name '.*.tmp' -delete
  cp -a --no-preserve=links "$job" "$part/jobs/"
  rm -rf "$job"
  jobs=$((jobs + 1))
done

if [[ -d $data/studies ]]; then
  cp -a "$data/studies" "$part/"
  find "$part/studies" -name '.*.tmp' -delete
fi

(cd "$part" && find . -type f ! -name SHA256SUMS -print0 | sort -z | xargs -0 sha256sum >SHA256SUMS)
sync -f "$part"
mv -T "$part" "$copy"
echo "$jobs jobs in $copy ($(du -sh "$copy" | cut -f 1))"
