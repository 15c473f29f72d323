#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the Debian packages from the last commit, in a clean copy of it. Debug packages go into OUTPUT/debug.
#
# usage: deploy/build-deb.sh [--clean-root | --from-build DIR] [--version V] [OUTPUT]   (default: build/deb)
#   (no option)        build on this system; it needs debhelper and the packages of 'deploy/install-deps.sh build'
#   --clean-root       build in a fresh Debian 12 made by mmdebstrap, with the packages of deploy/debian/control alone;
#                      needs root and a Debian mirror
#   --from-build DIR   package the files of a build that exists (build/dev, ...), and the working tree's deploy/:
#                      for trying out the packages in a minute
#   --version V        version of the packages (default: that of CMakeLists.txt, before its release with the
#                      commit's date and name: 0.1.0~20261127.1530.0a1b2c3)
set -euo pipefail
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
mode=in-place
build_dir=''
version=''
output=''
while [[ $# -gt 0 ]]; do
  case "$1" in
    --clean-root) mode=clean-root; shift ;;
    --from-build) mode=from-build; build_dir=$(realpath "${2:?--from-build needs a folder}"); shift 2 ;;
    --version) version=${2:?--version needs a version}; shift 2 ;;
    -h|--help) sed -n '3,13s/^# \{0,1\}//p' "$0"; exit 0 ;;
    -*) echo "build-deb: unknown option '$1' (--help lists them)" >&2; exit 2 ;;
    *) output=$1; shift ;;
  esac
done
output=$(realpath -m "${output:-$repository/build/deb}")

say() { echo "build-deb: $*"; }
fail() { echo "build-deb: $*" >&2; exit 1; }
need() {
  command -v "$1" >/dev/null || fail "$1 is missing; install it with 'apt-get install $2'"
}

default_version() {
  local release
  release=$(sed -n 's/^project(furrow VERSION \([0-9.]*\).*/\1/p' "$repository/CMakeLists.txt")
  if [[ $(git -C "$repository" tag --points-at HEAD) == *"v$release"* ]]; then
    echo "$release"
  else
    # The tilde sorts before the release, and the date by itself.
    echo "$release~$(TZ=UTC git -C "$repository" log -1 --date=format-local:%Y%m%d.%H%M --format=%cd.%h)"
  fi
}

# Copies the sources to FOLDER. Nothing that is not in git reaches a package, except npm's packages, which
# Debian does not have: deploy/install-deps.sh has installed them as the lock files state.
export_sources() {
  local folder=$1 modules
  if [[ $mode == from-build ]]; then
    git -C "$repository" ls-files -z | tar -C "$repository" --null -T - --ignore-failed-read -c | tar -C "$folder" -x
  else
    git -C "$repository" diff --quiet HEAD || say 'changes that are not committed are left out'
    git -C "$repository" archive HEAD | tar -C "$folder" -x
    for modules in web/node_modules client/js/node_modules; do
      if [[ -d $repository/$modules ]]; then
        cp -a "$repository/$modules" "$folder/$modules"
      else
        fail "$modules is missing, so the packages would lack the web page; run deploy/install-deps.sh build"
      fi
    done
  fi
  cp -r "$folder/deploy/debian" "$folder/debian"
  sed -i "1s/(.*)/($version)/; s/^\( -- .*>\)  .*/\1  $(git -C "$repository" log -1 --format=%cD)/" \
    "$folder/debian/changelog"
}

# Builds in a fresh root, without a network once its packages are installed.
build_in_clean_root() {
  local root=$work/root inside=/packages/furrow-$version
  need mmdebstrap mmdebstrap
  [[ $(id -u) -eq 0 ]] || fail '--clean-root needs root'
  say 'making a clean root (mmdebstrap)'
  mmdebstrap --quiet --variant=buildd --customize-hook="copy-in $work/packages /" \
    --customize-hook="chroot \"\$1\" apt-get build-dep --yes --quiet=2 $inside" bookworm "$root"
  # The mount ends with the namespace.
  unshare --net --mount bash -c "mount -t proc proc '$root/proc' && chroot '$root' bash -c \
    'cd $inside && dpkg-buildpackage -b -us -uc -j$(nproc)'"
  mv "$root"/packages/*.deb "$work/packages/"
}

need git git
need dpkg-buildpackage dpkg-dev
[[ -n $version ]] || version=$(default_version)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sources=$work/packages/furrow-$version
mkdir -p "$sources" "$output"
export_sources "$sources"
case "$mode" in
  clean-root)
    say "building $version in a clean Debian 12; this compiles everything"
    build_in_clean_root
    ;;
  in-place)
    need dh debhelper
    say "building $version on this system; this compiles everything"
    (cd "$sources" && dpkg-buildpackage -b -us -uc -j"$(nproc)")
    ;;
  from-build)
    need dh debhelper
    say "packaging $version from $build_dir"
    (cd "$sources" && FURROW_DEB_BUILD_DIR=$build_dir dpkg-buildpackage -b -us -uc -d >"$work/log" 2>&1) ||
      { tail -n 40 "$work/log" >&2; fail 'dpkg-buildpackage failed (output above)'; }
    ;;
esac
mkdir -p "$output/debug"
# Of former builds.
rm -f "$output"/furrow*_*.deb "$output"/libfurrow-client*_*.deb "$output"/debug/{furrow,libfurrow-client}*-dbgsym_*.deb
mv "$work"/packages/*-dbgsym_*.deb "$output/debug/"
mv "$work"/packages/*.deb "$output/"
say "packages in $output:"
(cd "$output" && du -h ./furrow*_*.deb ./libfurrow-client*_*.deb)
