#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Demonstrates Furrow on a new machine: installs missing packages, builds, starts furrowd with the default
# character, plays a performance to it over UDP and prints the weights as they arrive. Writes to demo-out/:
# weights.csv, pictures/, contact-sheet.jpg. Then repeats the performance, prints the address of the preview
# page, and runs until Ctrl-C.
#
# usage: ./demo.sh [--once]
#   --once   Exit after the performance (default if standard output is not a terminal)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

once=no
[[ -t 1 ]] || once=yes
while [[ $# -gt 0 ]]; do
  case "$1" in
    --once) once=yes; shift ;;
    -h|--help) sed -n '3,9s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "demo.sh: unknown option '$1' (--help lists them)" >&2; exit 2 ;;
  esac
done

say() { printf '\n== %s\n' "$*"; }

say "Debian packages"
deploy/install-deps.sh build

say "build (preset release)"
if [[ ! -f build/release/build.ninja ]]; then
  mkdir -p build
  cmake --preset release -DFURROW_BUILD_TESTS=OFF >build/release-configure.log 2>&1 ||
    { cat build/release-configure.log >&2; exit 1; }
fi
cmake --build --preset release -j "$(nproc)" --target furrow_demo

bin=$PWD/build/release/bin
share=$PWD/build/release/share/furrow
performance=$share/recordings/performance.bvh
out=$PWD/demo-out
rm -rf "$out"
mkdir -p "$out/pictures"

daemon=''
watchers=()
stop() {
  trap - EXIT INT TERM
  [[ ${#watchers[@]} -eq 0 ]] || kill "${watchers[@]}" 2>/dev/null || true
  [[ -z $daemon ]] || { kill -TERM "$daemon" 2>/dev/null || true; wait "$daemon" 2>/dev/null || true; }
}
trap stop EXIT
trap 'stop; exit 0' INT TERM

say "furrowd with the default character"
: >"$out/furrowd.out"
printf 'shading = "skin"\n' >"$out/look.toml"
"$bin/furrowd" --tcp 0 --udp 0 --render-settings "$out/look.toml" >"$out/furrowd.out" 2>"$out/furrowd.log" &
daemon=$!
until grep -q '^furrowd ready' "$out/furrowd.out"; do
  kill -0 "$daemon" 2>/dev/null || { cat "$out/furrowd.log" >&2; exit 1; }
  read -r -t 0.1 <> <(:) || true
done
cat "$out/furrowd.out"
tcp=$(sed -n 's/.* tcp=[^ ]*:\([0-9]*\).*/\1/p' "$out/furrowd.out")
udp=$(sed -n 's/.* udp=[^ ]*:\([0-9]*\).*/\1/p' "$out/furrowd.out")
http=$(sed -n 's/.* http=[^ ]*:\([0-9]*\).*/\1/p' "$out/furrowd.out")

say "a performance over UDP; one row of weights per second (all rows: demo-out/weights.csv)"
"$bin/furrow" watch "localhost:$tcp" --subject demo --wait --format csv >"$out/weights.csv" &
watchers+=($!)
"$bin/furrow" watch "localhost:$tcp" --subject demo --wait --format table --rate 1 &
watchers+=($!)
"$bin/furrow" frames "localhost:$tcp" --subject demo --wait --out "$out/pictures" --size 640x640 \
  --rate 10 --camera face --format jpeg &
watchers+=($!)
"$bin/furrow" play "$performance" --to "localhost:$udp" --udp --subject demo
wait "${watchers[@]}"
watchers=()

pictures=$(find "$out/pictures" -name '*.jpg' | wc -l)
rows=$(($(wc -l <"$out/weights.csv") - 1))
[[ $rows -gt 0 && $pictures -gt 0 ]] || { echo "demo.sh: received $rows rows of weights and $pictures pictures; see demo-out/furrowd.log" >&2; exit 1; }

say "contact sheet"
mapfile -t all < <(find "$out/pictures" -name '*.jpg' | sort)
chosen=()
for i in 0 1 2 3 4 5 6 7 8 9 10 11; do chosen+=("${all[$((i * ${#all[@]} / 12))]}"); done
oiiotool "${chosen[@]}" --mosaic:pad=4 4x3 --resize 1280x0 -o "$out/contact-sheet.jpg"

echo "demo-out/: weights.csv ($rows rows), pictures/ ($pictures), contact-sheet.jpg"
if [[ $once == yes ]]; then exit 0; fi

say "the performance repeats; watch and control it in a browser (stop with Ctrl-C):"
"$bin/furrow" play "$performance" --to "localhost:$udp" --udp --subject demo --loop &
watchers+=($!)
echo "  weights in a terminal:  build/release/bin/furrow watch localhost:$tcp"
echo
echo "  http://localhost:$http/"
wait "$daemon"
