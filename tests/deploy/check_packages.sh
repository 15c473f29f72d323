#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Packages a build, checks the packages with lintian, and tries them in a bare Debian 12: install, a pose in, weights
# out, upgrade, purge. Exit code 77: debhelper, lintian, mmdebstrap, root or a Debian mirror is missing.
#
# usage: check_packages.sh BUILD_DIR
set -euo pipefail
source_dir=$(cd "$(dirname "$0")/../.." && pwd)
build_dir=$(realpath "$1")
for tool in dh lintian mmdebstrap unshare; do
  command -v "$tool" >/dev/null || { echo "skipped: $tool is not installed"; exit 77; }
done
[[ $(id -u) -eq 0 ]] || { echo 'skipped: a bare Debian needs root'; exit 77; }

# fail MESSAGE
fail() { echo "check_packages: $*" >&2; exit 1; }

# Kept for the next run.
mkdir -p "$build_dir/deploy"
base=$build_dir/deploy/root.tar
if [[ ! -f $base ]]; then
  mmdebstrap --quiet --variant=minbase --format=tar bookworm "$base.new" || { echo 'skipped: no Debian mirror'; exit 77; }
  mv "$base.new" "$base"
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
packages=$build_dir/deploy/packages  # also for check_container.sh and check_service.sh
newer=$build_dir/deploy/newer
"$source_dir/deploy/build-deb.sh" --from-build "$build_dir" --version 0.1.0 "$packages"
"$source_dir/deploy/build-deb.sh" --from-build "$build_dir" --version 0.1.1 "$newer"
lintian --allow-root --fail-on error,warning --info "$packages"/*.deb || fail 'lintian found faults (listed above)'

mkdir "$work/root"
tar -C "$work/root" -xf "$base"
cp /etc/resolv.conf "$work/root/etc/resolv.conf"
mkdir "$work/root/srv/old" "$work/root/srv/new"
cp "$packages"/*.deb "$work/root/srv/old/"
cp "$newer"/*.deb "$work/root/srv/new/"
cp "$source_dir"/deploy/debian/tests/* "$work/root/srv/"
cat >"$work/root/srv/try" <<'TRY'
set -eu
export DEBIAN_FRONTEND=noninteractive PATH=/usr/sbin:/usr/bin:/sbin:/bin
install() { apt-get install --yes --quiet=2 --no-install-recommends "$@" >/srv/apt.log 2>&1 || { cat /srv/apt.log; exit 1; }; }
files() { find / -xdev \( -path /proc -o -path /srv -o -path /tmp \) -prune -o -iname '*furrow*' -print; }
apt-get update --quiet=2 >/dev/null 2>&1 || { echo 'skipped: no Debian mirror'; exit 77; }
install curl gcc libc6-dev pkg-config
[ -z "$(files)" ] || { files; echo 'not a bare root'; exit 1; }

# Weights need neither pictures nor OpenGL.
install /srv/old/furrowd_*.deb /srv/old/furrow-tools_*.deb /srv/old/furrow-data_*.deb
sh /srv/pose-in-weights-out
install /srv/old/*.deb
sh /srv/pose-in-weights-out
sh /srv/library
furrow render /usr/share/furrow/recordings/performance.bvh --frames 30:30 --size 64x64 --shading diffuse --out /srv/pictures
[ -s /srv/pictures/000030.png ]
[ -L /etc/systemd/system/multi-user.target.wants/furrowd.service ]  # starts at boot
[ ! -e /etc/systemd/system/sockets.target.wants/furrowd-tcp.socket ]
echo '# of the operator' >>/etc/furrow/furrow.toml

install /srv/new/*.deb
dpkg-query -W -f '${Version}\n' furrowd | grep -x 0.1.1
grep -q '# of the operator' /etc/furrow/furrow.toml  # an upgrade keeps changes
sh /srv/pose-in-weights-out

# As systemd makes them for the service.
mkdir -p /var/lib/private/furrow/takes /var/cache/private/furrow
ln -s private/furrow /var/lib/furrow
ln -s private/furrow /var/cache/furrow
apt-get purge --yes --quiet=2 furrowd furrow-pictures furrow-cluster furrow-tools furrow-data libfurrow-client1 libfurrow-client-dev \
  >/srv/apt.log 2>&1 || { cat /srv/apt.log; exit 1; }
left=$(files)
[ -z "$left" ] || { echo "purge left: $left"; exit 1; }
TRY
# The mounts and programs end with the namespaces.
unshare --mount --pid --fork bash -c "mount -t proc proc '$work/root/proc' && mount -t tmpfs none '$work/root/dev' &&
  mknod -m 666 '$work/root/dev/null' c 1 3 && mknod -m 666 '$work/root/dev/urandom' c 1 9 &&
  chroot '$work/root' bash /srv/try"
echo 'check_packages: lintian, install, pose in, weights out, upgrade and purge'
