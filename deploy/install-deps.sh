#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the packages that Furrow needs on Debian 12. Prints nothing if all are installed, uses sudo only
# if a package is missing, and never removes a package. It is safe to run it again.
#
# usage: deploy/install-deps.sh [build|test|all|full]   (default: test; each set includes the sets before it)
#   build  build and run the demo
#   test   ./test.sh
#   all    ./test.sh --all
#   full   ./test.sh --full
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
want=${1:-test}
case "$want" in
  build) sets='build' ;;
  test) sets='build test' ;;
  all) sets='build test all' ;;
  full) sets='build test all full' ;;
  *) echo "install-deps: unknown set '$want' (build, test, all or full)" >&2; exit 2 ;;
esac

if ! command -v dpkg-query >/dev/null; then
  echo "install-deps: this is not a Debian system; install the packages in deploy/packages.txt by hand" >&2
  exit 1
fi

# Packages that an installed package provides count as installed: NodeSource's nodejs provides npm and
# conflicts with Debian's npm.
provided=$(dpkg-query -W -f='${db:Status-Status}, ${Provides}\n' | sed -n 's/^installed, //p' |
           tr ',' '\n' | awk '{ print $1 }')
missing=()
while read -r set package; do
  [[ $set == '#'* || -z $set ]] && continue
  [[ " $sets " == *" $set "* ]] || continue
  state=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $state == installed ]] || grep -qxF -- "$package" <<<"$provided" || missing+=("$package")
done < "$here/packages.txt"

# npm_ci FOLDER CONSEQUENCE: installs the packages in FOLDER's lock file unless they are installed.
# CONSEQUENCE is the second half of the error message.
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
  npm_ci client/js 'the npm packages and the preview page will not be built'
  npm_ci web 'the preview page will not be built'
  [[ $want != build ]] || return 0
  npm_ci tests/mcap_interop 'the tests that need @mcap/core will be skipped'
  npm_ci tests/browser 'the browser tests will be skipped'
  npm_ci tests/deploy/kubernetes 'the test of the Kubernetes manifests will be skipped'
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

export DEBIAN_FRONTEND=noninteractive
log=$(mktemp)
trap 'rm -f "$log"' EXIT

# fail MESSAGE: prints the end of apt-get's output and MESSAGE, and exits.
fail() {
  tail -n 30 "$log" >&2
  echo "install-deps: $1" >&2
  exit 1
}

echo "install-deps: installing ${missing[*]}"
"${sudo[@]}" apt-get update >"$log" 2>&1 || fail 'apt-get update failed (output above)'

# Stops before an installation that would remove packages, and lists those packages.
"${sudo[@]}" apt-get install --simulate --no-install-recommends "${missing[@]}" >"$log" 2>&1 ||
  fail "apt-get cannot install: ${missing[*]} (reason above)"
removed=$(sed -n 's/^Remv \([^ ]*\).*/\1/p' "$log" | tr '\n' ' ')
if [[ -n $removed ]]; then
  cat >&2 <<MESSAGE
install-deps: nothing was installed, because apt would remove: $removed
  Either remove those packages yourself and install the missing ones:
    apt-get install --no-install-recommends ${missing[*]}
  or build in a container or chroot with Debian 12.
MESSAGE
  exit 1
fi
"${sudo[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y --no-remove --no-install-recommends "${missing[@]}" >"$log" 2>&1 ||
  fail 'apt-get install failed (output above)'
install_npm_packages
