#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the packages that check_packages.sh has left in a bare Debian 12 that systemd has booted: the service starts,
# restarts and reloads, the packages are upgraded while a subject streams, and purged. The system has a network of its
# own. Exit code 77: mmdebstrap, root, the packages or a Debian mirror is missing, or systemd cannot be booted here.
#
# usage: check_service.sh BUILD_DIR
set -euo pipefail
source_dir=$(cd "$(dirname "$0")/../.." && pwd)
build_dir=$(realpath "$1")
for tool in mmdebstrap unshare ip; do
  command -v "$tool" >/dev/null || { echo "skipped: $tool is not installed"; exit 77; }
done
[[ $(id -u) -eq 0 ]] || { echo 'skipped: booting systemd needs root'; exit 77; }
[[ -d $build_dir/deploy/packages && -d $build_dir/deploy/newer ]] || {
  echo "skipped: no packages in $build_dir/deploy"
  exit 77
}

# Kept for the next run.
base=$build_dir/deploy/systemd.tar
if [[ ! -f $base ]]; then
  mmdebstrap --quiet --variant=minbase --include=systemd,systemd-sysv,dbus,curl --format=tar bookworm "$base.new" ||
    { echo 'skipped: no Debian mirror'; exit 77; }
  mv "$base.new" "$base"
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
root=$work/root
mkdir "$root"
tar -C "$root" -xf "$base"
cp -r "$build_dir/deploy/packages" "$root/srv/old"
cp -r "$build_dir/deploy/newer" "$root/srv/new"
cp "$source_dir"/deploy/debian/tests/* "$root/srv/"

# What the packages depend on, because there is no network later.
cp /etc/resolv.conf "$root/etc/resolv.conf"
cat >"$root/srv/download" <<'DOWNLOAD'
set -eu
export DEBIAN_FRONTEND=noninteractive PATH=/usr/sbin:/usr/bin:/sbin:/bin
apt-get update --quiet=2 >/dev/null 2>&1 || { echo 'skipped: no Debian mirror'; exit 77; }
apt-get install --yes --quiet=2 --no-install-recommends --download-only /srv/old/furrow*.deb >/srv/apt.log 2>&1 ||
  { cat /srv/apt.log; exit 1; }
DOWNLOAD
chroot "$root" bash /srv/download

cat >"$root/srv/try" <<'TRY'
set -eu
export DEBIAN_FRONTEND=noninteractive PATH=/usr/sbin:/usr/bin:/sbin:/bin
touch /srv/booted
fail() { echo "check_service: $*"; journalctl --no-pager --unit furrowd | tail -n 40; exit 1; }
install() { apt-get install --yes --quiet=2 --no-install-recommends "$@" >/srv/apt.log 2>&1 || { cat /srv/apt.log; exit 1; }; }
files() { find / -xdev \( -path /proc -o -path /srv -o -path /tmp -o -path /var/log/journal \) -prune -o -iname '*furrow*' -print; }
# wait_for COMMAND...: until it succeeds, at most a minute.
wait_for() {
  for _ in $(seq 600); do
    if "$@"; then return 0; fi
    sleep 0.1
  done
  fail "this did not happen: $*"
}
has_lines() { [ "$(wc -l </srv/frames)" -ge "$1" ]; }

install /srv/old/furrow*.deb
systemctl is-active --quiet furrowd || fail 'the package does not start the service'
sh /srv/service || fail 'the service does not do what it must (above)'

! journalctl --no-pager --unit furrowd | grep 'shaders are compiled at every start' || fail 'the service has no cache'

# The newer version goes on with the sockets and the sessions of the older one.
furrow watch 127.0.0.1 --udp --subject ada --wait --format csv 2>/srv/watch \
  > >(perl -MTime::HiRes=time -ne 'BEGIN { $| = 1 } printf "%.3f,%s", time, $_' >/srv/frames) &
watcher=$!
wait_for grep -q waiting /srv/watch
furrow play /usr/share/furrow/recordings/performance.bvh --to 127.0.0.1 --udp --subject ada --loop >/srv/play 2>&1 &
player=$!
wait_for has_lines 60
before=$(systemctl show --property MainPID --value furrowd)
install /srv/new/furrow*.deb
now=$(systemctl show --property MainPID --value furrowd)
[ "$before" != "$now" ] || fail 'the upgrade does not restart the service'
has_gone_on() { journalctl --no-pager "_PID=$now" | grep -q 'resumed [2-9] peers and [1-9] subject'; }
wait_for has_gone_on
wait_for has_lines $(($(wc -l </srv/frames) + 60))
kill $player $watcher
wait $player $watcher || true
perl -F, -ane '
  next if $F[1] eq "frame";
  if (defined $frame) {
    die "frame $F[1] comes after $frame\n" if $F[1] != $frame + 1;
    $longest = $F[0] - $time if $F[0] - $time > $longest;
  }
  ($time, $frame) = @F;
  END { printf "upgrade: all %d frames in order, at most %.0f ms without one\n", $. - 1, 1000 * $longest }' /srv/frames ||
  fail 'the upgrade loses frames or changes their order'

# Keys by LoadCredential=.
dropin=/etc/systemd/system/furrowd.service.d
mkdir -p $dropin
grep -v 'furrow\.\(crt\|key\):' /usr/share/doc/furrowd/examples/furrowd-credentials.conf >$dropin/credentials.conf
cp /etc/furrow/furrow.toml /srv/open.toml
printf '[security]\nmode = "required"\nkeys = "/run/credentials/furrowd.service/furrow.keys"\n' >>/etc/furrow/furrow.toml
furrow token key new --key /etc/furrow/furrow.keys >/dev/null
furrow token new --role publish,watch --for 1h --key /etc/furrow/furrow.keys --out /srv/token
furrowd --config /etc/furrow/furrow.toml --check | grep -q 'the configuration is valid' || fail 'a good configuration is refused'
systemctl daemon-reload
systemctl restart furrowd
furrow play /usr/share/furrow/recordings/performance.bvh --to 127.0.0.1 --subject ada --loop --token /srv/token >/srv/play 2>&1 &
player=$!
weights() { furrow watch 127.0.0.1 --subject ada --wait --frames 1 --token /srv/token >/dev/null 2>/srv/watch; }
weights || fail "a token is refused: $(cat /srv/watch)"
! furrow watch 127.0.0.1 --subject ada --wait --frames 1 >/dev/null 2>/srv/watch || fail 'a client without a token is let in'
grep -q 'requires a token' /srv/watch || fail "a client without a token hears: $(cat /srv/watch)"
key=$(furrow token key list --key /etc/furrow/furrow.keys | awk 'NR == 2 { print $1 }')
furrow token key new --key /etc/furrow/furrow.keys >/dev/null
furrow token key retire "$key" --key /etc/furrow/furrow.keys >/dev/null
systemctl reload furrowd
says_restart() { journalctl --no-pager --unit furrowd | grep -q 'LoadCredential=): changes take'; }
wait_for says_restart
systemctl restart furrowd
! weights || fail 'a token of a retired key is taken after a restart'
grep -q 'does not have the key' /srv/watch || fail "a client with a token of a retired key hears: $(cat /srv/watch)"
kill $player
wait $player || true
echo 'service: keys by LoadCredential=, tokens, a retired key'
cp /srv/open.toml /etc/furrow/furrow.toml
rm -r $dropin /etc/furrow/furrow.keys
systemctl daemon-reload

# A stop leaves nothing to the next start.
systemctl stop furrowd
[ "$(systemctl show --property NFileDescriptorStore furrowd)" = NFileDescriptorStore=0 ] || fail 'a stop leaves sockets'
systemctl start furrowd
apt-get purge --yes --quiet=2 $(dpkg-query -W -f '${Package} ' 'furrow*') >/srv/apt.log 2>&1 ||
  { cat /srv/apt.log; exit 1; }
! systemctl is-active --quiet furrowd || fail 'the service runs after a purge'
left=$(files)
[ -z "$left" ] || fail "purge left: $left"
TRY
cat >"$root/etc/systemd/system/check.service" <<'UNIT'
[Unit]
SuccessAction=exit
FailureAction=exit

[Service]
ExecStart=/bin/bash -c 'bash /srv/try >/srv/log 2>&1; echo $? >/srv/code'

[Install]
WantedBy=multi-user.target
UNIT
mkdir -p "$root/etc/systemd/system/multi-user.target.wants"
ln -s ../check.service "$root/etc/systemd/system/multi-user.target.wants/"
ln -s /dev/null "$root/etc/systemd/system/console-getty.service"

# As container managers boot it. The mounts and programs end with the namespaces.
cat >"$work/boot" <<'BOOT'
set -eu
root=$1
ip link set lo up
mount --make-rprivate /
mount --bind "$root" "$root"
mount -t proc proc "$root/proc"
mount -t sysfs -o ro sysfs "$root/sys"
for folder in run tmp dev; do mount -t tmpfs tmpfs "$root/$folder"; done
mkdir "$root/dev/shm" "$root/dev/pts"
mount -t devpts -o newinstance,ptmxmode=0666 devpts "$root/dev/pts"
ln -s pts/ptmx "$root/dev/ptmx"
for device in null zero full random urandom tty; do
  touch "$root/dev/$device"
  mount --bind "/dev/$device" "$root/dev/$device"
done
if [ -e /sys/fs/cgroup/cgroup.controllers ]; then
  mount -t cgroup2 cgroup2 "$root/sys/fs/cgroup"
else
  mount -t tmpfs tmpfs "$root/sys/fs/cgroup"
  mkdir "$root/sys/fs/cgroup/systemd"
  mount -t cgroup -o none,name=systemd cgroup "$root/sys/fs/cgroup/systemd"
fi
# systemd makes namespaces for the service, which must begin at the root of this one.
cd "$root"
pivot_root . .
umount -l .
# The service gets its credentials by a mount that comes from outside its namespace.
mount --make-rshared /
export container=furrow
exec chroot . /lib/systemd/systemd --log-target=journal --show-status=no
BOOT
timeout --kill-after=5 300 unshare --net --mount --pid --ipc --uts --cgroup --fork --kill-child --mount-proc \
  bash "$work/boot" "$root" >"$work/log" 2>&1 || true
[[ -f $root/srv/booted ]] || { echo "skipped: systemd cannot be booted here: $(tail -n 5 "$work/log")"; exit 77; }
cat "$root/srv/log"
[[ $(cat "$root/srv/code" 2>/dev/null || echo none) == 0 ]] || { echo 'check_service: the checks failed (above)' >&2; exit 1; }
echo 'check_service: start, restart, reload, upgrade, stop and purge under systemd'
