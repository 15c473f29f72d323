#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs a daemon in all kinds of trouble at once and prints one page: lost, wrong and stale weights, growth of memory and
# open files, latency in and out of trouble. bench/network/soak.py says what happens.
#
# usage: bench/soak.sh [HOURS] [--build DIR] [--no-pictures]
#   HOURS          Length of the run (default: 1); 0.1 is a quick check
#   --build DIR    Build folder with furrow and furrowd (default: build the preset release first)
#   --no-pictures  No renderer, whose memory hides that of the daemon
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

hours=1
build=
flags=()
while [[ $# -gt 0 ]]; do
  case "$1" in
    --build) build=${2:?--build needs a folder}; shift 2 ;;
    --no-pictures) flags+=("$1"); shift ;;
    -h|--help) sed -n '3,9s/^# \{0,1\}//p' "$0"; exit 0 ;;
    [0-9]*) hours=$1; shift ;;
    *) echo "bench/soak.sh: unknown option '$1' (--help lists them)" >&2; exit 2 ;;
  esac
done

. bench/release_build.sh
use_release_build furrow furrow-load furrowd
# A mount namespace of its own, for a disk that is full. Without one, the disk stays as it is.
own=()
if unshare -m true 2>/dev/null; then
  own=(unshare -m)
elif unshare -rm true 2>/dev/null; then
  own=(unshare -rm)
fi
exec "${own[@]}" python3 -B bench/network/soak.py "$build/bin" --hours "$hours" "${flags[@]}"
