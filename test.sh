#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the missing packages, builds, and runs the tests. Can be run twice; the second run is quick.
#
# usage: ./test.sh [--preset NAME] [--all | --full] [-- CTEST ARGS...]
#   --preset NAME   build preset: dev (default), release, asan-ubsan, tsan, coverage
#   --all           add the slow tier: tests labelled `all` and 10 s of fuzzing per target (CI runs this)
#   --full          add to --all: asan-ubsan and tsan over the whole suite, a build without unity files,
#                   and 60 s of fuzzing per target
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

preset=dev
tier=default
while [[ $# -gt 0 ]]; do
  case "$1" in
    --preset) preset=${2:?--preset needs a name}; shift 2 ;;
    --all|--full) tier=${1#--}; shift ;;
    --) shift; break ;;
    -h|--help) sed -n '3,10s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "test.sh: unknown option '$1' (--help lists them)" >&2; exit 2 ;;
  esac
done

jobs=$(nproc)
ahead=  # the process of build_fuzz_ahead

step() { printf '\n== %s\n' "$*"; }

# configure PRESET
configure() {
  [[ ! -f build/$1/build.ninja ]] || return 0
  local log=build/$1-configure.log
  mkdir -p build
  cmake --preset "$1" >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
}

# build PRESET [TARGET]
build() {
  step "build: $1"
  configure "$1"
  cmake --build --preset "$1" -j "$jobs" --target "${2:-all}"
}

# run_tests PRESET [CTEST ARGS...]. Tests labelled `all` run in the tiers above the default one. One test more than there are
# cores, because tests with several processes often wait.
run_tests() {
  step "tests: $1"
  local exclude=()
  [[ $tier != default ]] || exclude=(--label-exclude '^all$')
  ctest --preset "$1" -j "$((jobs + 1))" "${exclude[@]}" "${@:2}"
}

# Builds the fuzz targets in the background, with what the tests leave of the processor: many of them run alone, and often wait.
# fuzz_all completes the build, and shows its faults.
build_fuzz_ahead() {
  configure fuzz
  nice -n 19 ninja -C build/fuzz -j "$jobs" fuzz_targets >build/fuzz-ahead.log 2>&1 &
  ahead=$!
  trap 'kill "$ahead" 2>/dev/null || true' EXIT
}

# fuzz_one TARGET SECONDS: runs one fuzz target with the committed seeds, and prints what it did when it ends.
fuzz_one() {
  local name corpus log statistics seeds=() options=() leaks=1
  name=$(basename "$1")
  corpus=build/fuzz/corpus/$name
  mkdir -p "$corpus"
  case "$name" in
    fuzz_datagram) seeds=(protocol/vectors) ;;
    fuzz_token|fuzz_secure) seeds=("tests/fuzz/seeds/${name#fuzz_}" protocol/vectors/secure) ;;
    fuzz_rig|fuzz_bind) seeds=(rig/rigs) ;;
    fuzz_gltf) seeds=(tests/fuzz/seeds/gltf tests/unit/character/gltf/fixtures) ;;
    fuzz_config) seeds=(tests/fuzz/seeds/config server/osc/profiles) ;;
    *) [[ ! -d tests/fuzz/seeds/${name#fuzz_} ]] || seeds=("tests/fuzz/seeds/${name#fuzz_}") ;;
  esac
  # OpenImageIO never frees the text of a reader's last error. The largest pictures have 1 GiB.
  [[ $name != fuzz_picture ]] || { options=(-rss_limit_mb=4096); leaks=0; }
  log=build/fuzz/$name.log
  if ! ASAN_OPTIONS=detect_leaks=$leaks "$1" -max_total_time="$2" -timeout=10 -rss_limit_mb=2048 \
      -print_final_stats=1 "${options[@]}" -artifact_prefix="build/fuzz/$name-" \
      "$corpus" "${seeds[@]}" >"$log" 2>&1; then
    tail -n 40 "$log" >&2
    echo "test.sh: $name found a fault; the input is build/fuzz/$name-*, the log is $log" >&2
    return 1
  fi
  statistics=$(grep -E 'stat::number_of_executed_units|stat::peak_rss_mb' "$log")
  printf '\n== fuzz: %s, %s s\n%s\n' "$name" "$2" "$statistics"
}

# fuzz_all SECONDS: runs every fuzz target for SECONDS, one per core at a time.
fuzz_all() {
  [[ -z $ahead ]] || wait "$ahead" || true
  ahead=
  build fuzz fuzz_targets
  local target running=0 failed=0
  for target in build/fuzz/bin/fuzz_*; do
    fuzz_one "$target" "$1" &
    running=$((running + 1))
    if ((running >= jobs)); then
      wait -n || failed=1
      running=$((running - 1))
    fi
  done
  while ((running > 0)); do
    wait -n || failed=1
    running=$((running - 1))
  done
  return "$failed"
}

case "$tier" in
  default) deploy/install-deps.sh test ;;
  *) deploy/install-deps.sh "$tier" ;;
esac
build "$preset"
[[ $tier != all ]] || build_fuzz_ahead
run_tests "$preset" "$@"
case "$tier" in
  all) fuzz_all 10 ;;
  full)
    for extra in asan-ubsan tsan; do
      build "$extra"
      run_tests "$extra" "$@"
    done
    build no-unity
    fuzz_all 60
    ;;
esac
