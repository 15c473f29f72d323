#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Measures the fast path: the solver, the codec, sending to subscribers, and furrowd end to end compared with raw
# UDP echo servers, also where the daemon sleeps between two poses ("cold"). Writes fast_path.md and fast_path.json,
# load.md, load.json and curves of the load (SVG). Takes about half an hour and needs an otherwise idle machine.
#
# usage: bench/run.sh [--quick] [--out DIR] [--build DIR]
#   --quick      Take a few minutes to check that everything works; the figures are inaccurate
#   --out DIR    Folder for the results (default: docs/performance, with --quick bench-out)
#   --build DIR  Build folder with the benchmarks (default: build the preset bench first)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

quick=no
out=
build=
while [[ $# -gt 0 ]]; do
  case "$1" in
    --quick) quick=yes; shift ;;
    --out) out=${2:?--out needs a folder}; shift 2 ;;
    --build) build=${2:?--build needs a folder}; shift 2 ;;
    -h|--help) sed -n '3,10s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "bench/run.sh: unknown option '$1' (--help lists them)" >&2; exit 2 ;;
  esac
done

micro=(--benchmark_repetitions=5 --benchmark_enable_random_interleaving=true --benchmark_min_time=0.2)
fanout=()
load=()
if [[ $quick == yes ]]; then
  micro=(--benchmark_repetitions=2 --benchmark_min_time=0.01)
  fanout=(--subjects 1,4 --repetitions 3)
  load=(--rounds 1 --seconds 0.3)
fi
[[ -n $out ]] || { [[ $quick == yes ]] && out=bench-out || out=docs/performance; }
mkdir -p "$out"

step() { printf '\n== %s\n' "$*"; }

if [[ -z $build ]]; then
  build=build/bench
  step "build: bench"
  [[ -f $build/build.ninja ]] || cmake --preset bench
  cmake --build --preset bench --target bench_wrinkle bench_codec bench_fanout bench_load bench_fast_path
fi
bin=$build/bin
raw=$(mktemp -d)
trap 'rm -rf "$raw"' EXIT

step "the solver"
"$bin/bench_wrinkle" "${micro[@]}" --benchmark_out="$raw/wrinkle.json"
step "the codec"
"$bin/bench_codec" "${micro[@]}" --benchmark_out="$raw/codec.json"
step "sending to 64 subscribers"
"$bin/bench_fanout" "${fanout[@]}" --out "$raw"
step "end to end"
"$bin/bench_load" "${load[@]}" --out "$out"
"$bin/bench_fast_path" --from "$raw" --out "$out"
step "done: $out/fast_path.md, $out/load.md"
