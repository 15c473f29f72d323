#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what building and testing Furrow needs on Debian 12. Quiet when nothing is missing; safe to
# run twice; sudo only where it is needed.
#
# usage: deploy/install-deps.sh [build|test|full]      (default test; each set holds the one before it)
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
want=${1:-test}
case "$want" in
  build) sets='build' ;;
  test) sets='build test' ;;
  full) sets='build test full' ;;
  *) echo "install-deps: unknown set '$want' (build, test or full)" >&2; exit 2 ;;
esac

if ! command -v dpkg-query >/dev/null; then
  echo "install-deps: not a Debian system; install what deploy/packages.txt lists by hand" >&2
  exit 1
fi

# Also what another package stands for: NodeSource's nodejs brings npm and conflicts with Debian's.
provided=$(dpkg-query -W -f='${db:Status-Status}, ${Provides}\n' | sed -n 's/^installed, //p' |
           tr ',' '\n' | awk '{ print $1 }')
missing=()
while read -r set package; do
  [[ $set == '#'* || -z $set ]] && continue
  [[ " $sets " == *" $set "* ]] || continue
  state=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $state == installed ]] || grep -qxF -- "$package" <<<"$provided" || missing+=("$package")
done < "$here/packages.txt"

# npm_ci FOLDER WHAT: the packages of FOLDER's lock file, unless they are there. WHAT is lost without them.
npm_ci() {
  local folder=$here/../$1
  command -v npm >/dev/null || return 0
  cmp -s "$folder/package-lock.json" "$folder/node_modules/.furrow-lock" && return 0
  echo "install-deps: npm ci in $1"
  if (cd "$folder" && npm ci --ignore-scripts --no-audit --no-fund >/dev/null 2>&1); then
    cp "$folder/package-lock.json" "$folder/node_modules/.furrow-lock"
  else
    echo "install-deps: npm ci failed in $1; $2" >&2
  fi
}
install_npm_packages() {
  npm_ci web 'the preview page will be left out'
  [[ $want != build ]] || return 0
  npm_ci tests/mcap_interop 'the tests that need @mcap/core will be skipped'
  npm_ci tests/browser 'the tests in a browser will be skipped'
}
if [[ ${#missing[@]} -eq 0 ]]; then
  install_npm_packages
  exit 0
fi

sudo=()
if [[ $(id -u) -ne 0 ]]; then
  command -v sudo >/dev/null || {
    echo "install-deps: run as root, or install: ${missing[*]}" >&2
    exit 1
  }
  sudo=(sudo)
fi

echo "install-deps: installing ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
export DEBIAN_FRONTEND=noninteractive
if ! { "${sudo[@]}" apt-get update &&
       "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive \
         apt-get install -y --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
  tail -n 30 "$log" >&2
  echo "install-deps: apt-get failed; its last lines stand above" >&2
  exit 1
fi
install_npm_packages
