#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the container image of the packages that check_packages.sh has left, and runs it under podman with a read-only
# root: a pose goes in, weights come out. Exit code 77: the packages, buildah, podman or root is missing, or no container
# can be started here.
#
# usage: check_container.sh BUILD_DIR
set -euo pipefail
source_dir=$(cd "$(dirname "$0")/../.." && pwd)
build_dir=$(realpath "$1")
packages=$build_dir/deploy/packages
for tool in buildah podman runc mmdebstrap; do
  command -v "$tool" >/dev/null || { echo "skipped: $tool is not installed"; exit 77; }
done
[[ $(id -u) -eq 0 ]] || { echo 'skipped: the image needs root'; exit 77; }
[[ -d $packages ]] || { echo "skipped: no packages in $packages"; exit 77; }

fail() { echo "check_container: $*" >&2; exit 1; }
work=$(mktemp -d)
daemon=''
cleanup() {
  if [[ -n $daemon ]]; then
    podman rm --force --all >/dev/null 2>&1 || true
    wait "$daemon" || true
  fi
  rm -rf "$work"
}
trap cleanup EXIT

podman() {
  command podman --root "$work/store" --runroot "$work/run" --storage-driver vfs --runtime runc \
    --cgroup-manager cgroupfs "$@"
}
# A container may not have more than the shell that starts it.
run=(run --rm --network host --read-only --tmpfs /tmp --cap-drop ALL --security-opt no-new-privileges
     --ulimit "nofile=$(ulimit -Hn):$(ulimit -Hn)" --ulimit nproc=1000:1000)
furrow=$build_dir/bin/furrow
port() { sed -n "s/.* $1=[^ ]*:\([0-9]*\).*/\1/p" "$work/line"; }

# build MOST_BYTES [OPTION]: makes an image and sets `image` and `bytes`.
build() {
  local most=$1
  shift
  "$source_dir/deploy/build-container.sh" "$@" --packages "$packages" "$work/image.tar"
  bytes=$(stat -c %s "$work/image.tar")
  ((bytes < most)) || fail "the image has $bytes bytes, at most $most are allowed"
  podman load --quiet --input "$work/image.tar" >"$work/loaded"
  image=$(sed -n 's/^Loaded image: //p' "$work/loaded")
}
# start ARGUMENT...: runs a daemon and waits until it serves.
start() {
  : >"$work/ready"
  podman "${run[@]}" --name daemon "$image" --tcp 0 --udp 0 --http 0 "$@" >"$work/ready" 2>"$work/log" &
  daemon=$!
  grep -m 1 '^furrowd ready' < <(tail -n +1 -f --pid=$daemon "$work/ready") >"$work/line" ||
    fail "the daemon is not ready: $(cat "$work/log")"
}
stop() {
  podman stop --time 20 daemon >/dev/null  # by SIGTERM
  wait $daemon || fail 'SIGTERM did not end the daemon with 0'
  daemon=''
}

build 120000000
podman "${run[@]}" "$image" --version >"$work/version" 2>"$work/error" || {
  echo "skipped: no container can be started here: $(cat "$work/error")"
  exit 77
}
grep '^furrowd [0-9]' "$work/version"
start
timeout 60 "$furrow" watch "127.0.0.1:$(port tcp)" --subject ann --wait --format csv --frames 20 >"$work/weights.csv" &
watcher=$!
timeout 60 "$furrow" play performance --to "127.0.0.1:$(port udp)" --udp --subject ann --loop >/dev/null 2>&1 &
player=$!
wait $watcher || fail "no weights: $(cat "$work/log")"
kill $player
[[ $(wc -l <"$work/weights.csv") -eq 21 ]] || fail 'expected a header and 20 lines of weights'
stop
echo "check_container: pose in, weights out of an image with $bytes bytes"

build 400000000 --pictures
start --require-render
timeout 120 "$furrow" play performance --to "127.0.0.1:$(port udp)" --udp --subject ann --loop >/dev/null 2>&1 &
player=$!
timeout 100 "$furrow" frames "127.0.0.1:$(port tcp)" --subject ann --wait --frames 1 --size 64x64 --out "$work/frames" ||
  fail "no pictures: $(cat "$work/log")"
kill $player
compgen -G "$work/frames/*.jpg" >/dev/null || fail 'no picture was written'
stop
echo "check_container: pose in, a picture out of an image with $bytes bytes"
