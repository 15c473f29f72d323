#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds, runs every test. Safe to run twice, quick the second time.
#
# usage: ./test.sh [--preset NAME] [--full] [-- CTEST ARGS...]
#   --preset NAME   dev (default), release, asan-ubsan, tsan, coverage
#   --full          also: asan-ubsan and tsan over the whole suite, and every fuzz target for 60 s
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

preset=dev
full=no
while [[ $# -gt 0 ]]; do
  case "$1" in
    --preset) preset=${2:?--preset needs a name}; shift 2 ;;
    --full) full=yes; shift ;;
    --) shift; break ;;
    -h|--help) sed -n '3,8s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "test.sh: unknown option '$1' (--help lists them)" >&2; exit 2 ;;
  esac
done

jobs=$(nproc)

step() { printf '\n== %s\n' "$*"; }

# build PRESET [TARGET]
build() {
  step "build: $1"
  if [[ ! -f build/$1/build.ninja ]]; then
    local log=build/$1-configure.log
    mkdir -p build
    cmake --preset "$1" >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
  fi
  cmake --build --preset "$1" -j "$jobs" --target "${2:-all}"
}

run_tests() {
  step "tests: $1"
  ctest --preset "$1" -j "$jobs" "${@:2}"
}

fuzz_all() {
  build fuzz fuzz_targets
  local target name corpus log
  for target in build/fuzz/bin/fuzz_*; do
    name=$(basename "$target")
    corpus=build/fuzz/corpus/$name
    mkdir -p "$corpus"
    step "fuzz: $name, 60 s"
    local seeds=()
    case "$name" in
      fuzz_datagram) seeds=(protocol/vectors) ;;
      fuzz_rig) seeds=(rig/rigs) ;;
      *) [[ ! -d tests/fuzz/seeds/${name#fuzz_} ]] || seeds=("tests/fuzz/seeds/${name#fuzz_}") ;;
    esac
    log=build/fuzz/$name.log
    if ! "$target" -max_total_time=60 -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
        -artifact_prefix="build/fuzz/$name-" "$corpus" "${seeds[@]}" >"$log" 2>&1; then
      tail -n 40 "$log" >&2
      echo "test.sh: $name found a fault; the input lies at build/fuzz/$name-*, the log at $log" >&2
      exit 1
    fi
    grep -E 'stat::number_of_executed_units|stat::peak_rss_mb' "$log"
  done
}

if [[ $full == yes ]]; then deploy/install-deps.sh full; else deploy/install-deps.sh test; fi
build "$preset"
run_tests "$preset" "$@"
if [[ $full == yes ]]; then
  for extra in asan-ubsan tsan; do
    build "$extra"
    run_tests "$extra" "$@"
  done
  fuzz_all
fi
