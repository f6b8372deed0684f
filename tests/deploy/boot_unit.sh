#!/usr/bin/env bash
# The unit under a real systemd: installs into a throw-away layer over this system, boots that with
# systemd-nspawn without a network, and restarts, kills, backs up and restores the service while a job
# runs. Needs root, systemd-container, sqlite3 and overlayfs; skipped (77) without them.
#
#   tests/deploy/boot_unit.sh SLUICE ROOT
set -euo pipefail

skip() { echo "skipped: $1"; exit 77; }

((EUID == 0)) || skip "needs root"
command -v systemd-nspawn >/dev/null || skip "there is no systemd-nspawn here (package systemd-container)"
command -v sqlite3 >/dev/null || skip "there is no sqlite3 here"
if [[ ${SLUICE_BOOT_INNER:-} != yes ]]; then
  unshare --mount true 2>/dev/null || skip "namespaces are not allowed here"
  SLUICE_BOOT_INNER=yes exec unshare --mount "$0" "$@"
fi
sluice=$(realpath "$1")
root=$(realpath "$2")

# Mounts are this process's own, and go with it.
work=$(mktemp -d)
trap 'umount -R "$work" 2>/dev/null || true; rmdir "$work"' EXIT
mount -t tmpfs -o mode=755 none "$work"
mkdir "$work"/{upper,scratch,system,out,units}
mount -t overlay overlay -o "lowerdir=/,upperdir=$work/upper,workdir=$work/scratch" "$work/system" \
  2>/dev/null || skip "overlayfs does not work here"

# Nothing of this system but the installed service is to be started.
cp "$root/deploy/sluice.service" "$work/units/"
cat >"$work/units/probe.target" <<'END'
[Unit]
Wants=sluice.service probe.service
END
cat >"$work/units/probe.service" <<'END'
[Unit]
Wants=sluice.service
After=sluice.service
[Service]
Type=oneshot
ExecStart=/bin/bash /out/probe.sh
StandardOutput=append:/out/said
StandardError=append:/out/said
ExecStopPost=/bin/systemctl --no-block poweroff
END
install -D -m 755 "$sluice" "$work/system/usr/local/bin/sluice"
rm -f "$work/system/etc/default/sluice"
install -d -m 700 "$work/system/etc/sluice"
(umask 077 && echo 0123456789abcdef0123456789abcdef >"$work/system/etc/sluice/token")
cp "$root/schemas/examples/dambreak-quick.json" "$work/out/scene.json"
cp "$root"/deploy/{backup,restore}.sh "$work/out/"
rm -f "$work/system/etc/machine-id"
echo 0123456789abcdef0123456789abcdef >"$work/system/etc/machine-id"

# landlock_create_ruleset, which has this number everywhere, tells its version.
if python3 -c 'import ctypes, sys; sys.exit(ctypes.CDLL(None).syscall(444, 0, 0, 1) < 1)'; then
  touch "$work/out/kernel_has_landlock"
fi

cat >"$work/out/probe.sh" <<'END'
set -euo pipefail
trap 'journalctl -u sluice --no-pager -o cat | tail -n 60' ERR
ask() { curl -sS --fail -H "Authorization: Bearer $(cat /etc/sluice/token)" "$@"; }
jobs=http://127.0.0.1:8080/v1/jobs
until_it_holds() {
  for _ in {1..600}; do if "$@" 2>/dev/null; then return; fi; sleep 0.1; done
  echo "waited in vain: $*"
  return 1
}
log_has() { [[ $(grep -c "\"event\":\"$1\"" "/var/lib/private/sluice/jobs/$job/log.jsonl") -ge $2 ]]; }
main_pid() { systemctl show -p MainPID --value sluice; }

systemctl is-active sluice
job=$(ask --data-binary @/out/scene.json "$jobs" | grep -o 'j[0-9a-v]\{20\}' | head -n 1)
until_it_holds log_has started 1
[[ $(ps -o user= -p "$(main_pid)") == sluice ]]
[[ $(grep -c '^CapEff:.0*$' "/proc/$(main_pid)/status") == 1 ]]
if [[ -e /out/kernel_has_landlock ]] && journalctl -u sluice -o cat | grep 'has no'; then exit 1; fi

systemctl restart sluice
until_it_holds log_has resumed 1
ask "$jobs/$job" | grep '"attempts":2,"crashes":0'
echo "a restart drains, and the job goes on"

before=$(main_pid)
kill -9 "$before"
until_it_holds log_has resumed 2
[[ $(main_pid) != "$before" ]]
echo "a killed service comes back, and the job goes on"

/out/backup.sh /var/lib/private/sluice /out/copy
systemctl stop sluice
mv /var/lib/private/sluice /var/lib/private/sluice.old
/out/restore.sh /out/copy /var/lib/private/sluice
systemctl start sluice
until_it_holds log_has resumed 3
echo "a copy made meanwhile is restored, and the job goes on"

systemctl stop sluice
[[ $(systemctl show -p Result --value sluice) == success ]]
if pgrep -x sluice; then exit 1; fi
echo "a stop ends all of it"
END

# nspawn has a filter of its own, which keeps Landlock away unless told.
timeout 300 systemd-nspawn --quiet --register=no --keep-unit --private-network --resolv-conf=off \
  --system-call-filter="landlock_create_ruleset landlock_add_rule landlock_restrict_self" \
  --directory="$work/system" --bind-ro="$work/units:/etc/systemd/system" --bind="$work/out:/out" \
  --boot systemd.unit=probe.target </dev/null >"$work/out/console" 2>&1 || true
if grep -qx 'a stop ends all of it' "$work/out/said" 2>/dev/null; then
  grep -E '^a ' "$work/out/said"
else
  # Where systemd itself does not come up, nothing is said of the unit.
  [[ -s $work/out/said ]] || { tail -n 20 "$work/out/console"; skip "systemd does not boot here"; }
  cat "$work/out/said"
  exit 1
fi
