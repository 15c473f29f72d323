#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs three daemons as a cluster, makes parts of it fail again and again, and prints what a viewer notices: the time
# without frames, frames that came twice or in the wrong order, and moments at which two daemons served one epoch.
#
# usage: bench/cluster.sh [ROUNDS] [--subjects N] [--only WORDS] [--build DIR], or --capacity [--build DIR]
#   ROUNDS        How often each part fails (default: 20)
#   --subjects N  Subjects at 30 poses per second, each with a publisher and a viewer (default: 8)
#   --only WORDS  Only the rows whose name contains WORDS, for example 'cut'
#   --capacity    Instead, load the daemons and compare what they use with 'furrow plan'; needs root
#   --build DIR   Build folder with furrow and furrowd (default: build the preset release first)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

rounds=20
subjects=8
only=
what=measure
build=
while [[ $# -gt 0 ]]; do
  case "$1" in
    --build) build=${2:?--build needs a folder}; shift 2 ;;
    --subjects) subjects=${2:?--subjects needs a number}; shift 2 ;;
    --only) only=${2:?--only needs words}; shift 2 ;;
    --capacity) what=capacity; shift ;;
    -h|--help) sed -n '3,11s/^# \{0,1\}//p' "$0"; exit 0 ;;
    [0-9]*) rounds=$1; shift ;;
    *) echo "bench/cluster.sh: unknown option '$1' (--help lists them)" >&2; exit 2 ;;
  esac
done

. bench/release_build.sh
use_release_build furrow furrowd
export FURROW_BIN=$PWD/$build/bin FURROW_SOURCE=$PWD PYTHONPATH=tests/cluster:tests/end_to_end:bench/report
exec python3 -B "bench/cluster/$what.py" "$rounds" "$subjects" "$only"
