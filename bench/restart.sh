#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Restarts a daemon again and again while a subject streams, and prints what a viewer notices: the time without frames,
# frames that are missing, came twice or in the wrong order, and whether its session went on.
#
# usage: bench/restart.sh [RESTARTS] [--build DIR] [--render]
#   RESTARTS      How often the daemon restarts per way to connect (default: 10)
#   --build DIR   Build folder with furrow and furrowd (default: build the preset release first)
#   --render      With the renderer, which starts meanwhile
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

restarts=10
build=
render=()
while [[ $# -gt 0 ]]; do
  case "$1" in
    --build) build=${2:?--build needs a folder}; shift 2 ;;
    --render) render=(--render); shift ;;
    -h|--help) sed -n '3,9s/^# \{0,1\}//p' "$0"; exit 0 ;;
    [0-9]*) restarts=$1; shift ;;
    *) echo "bench/restart.sh: unknown option '$1' (--help lists them)" >&2; exit 2 ;;
  esac
done

. bench/release_build.sh
use_release_build furrow furrowd
export FURROW_BIN=$PWD/$build/bin FURROW_SOURCE=$PWD PYTHONPATH=tests/end_to_end
exec python3 -B bench/restart/measure.py "$restarts" "${render[@]}"
