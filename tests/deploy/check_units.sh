#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Checks the units: that systemd understands them, and how exposed the service is (at most 1.5 of 10).
# Exit code 77: systemd-analyze is not installed.
set -eu
cd "$(dirname "$0")/../../deploy/systemd"
command -v systemd-analyze >/dev/null || exit 77
systemd-analyze security --no-pager --offline=true --threshold=15 "$PWD/furrowd.service"
# The template is the same service with other names.
different=$(diff furrowd.service furrowd@.service | grep '^>' | grep -vE '%i|^> # ' || true)
[ -z "$different" ] || { echo "furrowd@.service differs: $different"; exit 1; }
# A copy with a program that exists: the package may not be installed.
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
for unit in furrowd.service furrowd@.service furrowd-tcp.socket furrowd-http.socket; do
  sed 's|/usr/bin/furrowd|/bin/true|' "$unit" >"$copy/$unit"
done
mkdir "$copy/furrowd.service.d"
cp furrowd-*.conf "$copy/furrowd.service.d/"
SYSTEMD_UNIT_PATH="$copy:" systemd-analyze verify --man=no "$copy"/furrowd.service "$copy/furrowd@a.service" "$copy"/*.socket 2>&1 | tee "$copy/log"
! grep -q furrowd "$copy/log"
