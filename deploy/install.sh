#!/usr/bin/env bash
# Installs Sluice as a systemd service, or upgrades it: builds, puts the program and the unit in
# place, makes a token when there is none, and starts. Jobs that run write a checkpoint, and go on
# after an upgrade. Needs root.
#
#   deploy/install.sh               installs under /usr/local and /etc
#   DESTDIR=root deploy/install.sh  installs into the folder root instead and starts nothing
set -euo pipefail
cd "$(dirname "$0")/.."

if (($#)); then
  sed -n '2,7s/^# \{0,1\}//p' "$0"
  [[ $1 == -h || $1 == --help ]] && exit 0 || exit 2
fi
root=${DESTDIR:-}
if [[ -z $root ]] && ((EUID != 0)); then
  echo "install.sh: needs root: sudo $0" >&2
  exit 1
fi

if [[ ! -x build/release/cli/sluice ]]; then
  deploy/install-dependencies.sh
  cmake --preset release -DSLUICE_TESTS=OFF
fi
cmake --build --preset release --target sluice

install -D -m 755 build/release/cli/sluice "$root/usr/local/bin/sluice"
share=$root/usr/local/share
install -d -m 755 "$share/man/man1" "$share/bash-completion/completions"
build/release/cli/sluice man >"$share/man/man1/sluice.1"
build/release/cli/sluice completion bash >"$share/bash-completion/completions/sluice"
install -D -m 644 deploy/sluice.service "$root/etc/systemd/system/sluice.service"
token=$root/etc/sluice/token
if [[ ! -e $token ]]; then
  install -d -m 700 "$root/etc/sluice"
  (umask 077 && od -An -N32 -tx1 /dev/urandom | tr -d ' \n' >"$token.part" && mv "$token.part" "$token")
fi

if [[ -n $root || ! -d /run/systemd/system ]]; then
  echo "installed; systemd does not run here, so nothing was started"
  exit 0
fi
systemctl daemon-reload
systemctl enable --quiet sluice
systemctl restart sluice
systemctl --no-pager --lines=3 status sluice
echo "try: curl -H \"Authorization: Bearer \$(sudo cat /etc/sluice/token)\" http://127.0.0.1:8080/v1/jobs"
