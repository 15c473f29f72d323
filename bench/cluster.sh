#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs three daemons as a cluster, makes parts of it fail again and again, and prints what a viewer notices: the time
# without frames, frames that came twice or in the wrong order, and moments at which two daemons served one epoch.
#
# usage: bench/cluster.sh [ROUNDS] [--build DIR]
#   ROUNDS        How often each part fails (default: 20)
#   --build DIR   Build folder with furrow and furrowd (default: build the preset release first)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

rounds=20
build=
while [[ $# -gt 0 ]]; do
  case "$1" in
    --build) build=${2:?--build needs a folder}; shift 2 ;;
    -h|--help) sed -n '3,8s/^# \{0,1\}//p' "$0"; exit 0 ;;
    [0-9]*) rounds=$1; shift ;;
    *) echo "bench/cluster.sh: unknown option '$1' (--help lists them)" >&2; exit 2 ;;
  esac
done

if [[ -z $build ]]; then
  build=build/release
  [[ -f $build/build.ninja ]] || cmake --preset release
  cmake --build --preset release --target furrow furrowd
fi
export FURROW_BIN=$PWD/$build/bin FURROW_SOURCE=$PWD PYTHONPATH=tests/cluster:tests/end_to_end
exec python3 -B bench/cluster/measure.py "$rounds"
