#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds a container image of furrowd from the Debian packages: only furrowd, its data and the libraries that it loads. No
# shell, no package manager, user 65532. Needs root, mmdebstrap, buildah and a Debian mirror.
#
# usage: deploy/build-container.sh [--pictures] [--packages DIR] [OUTPUT]
#   --pictures      with OpenGL in software and the module of pictures
#   --packages DIR  folder of deploy/build-deb.sh (default: build/deb)
#   OUTPUT          archive in OCI format (default: build/furrowd.oci.tar or build/furrowd-pictures.oci.tar), for
#                   podman load -i OUTPUT
set -euo pipefail
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
packages=$repository/build/deb
include=furrowd,furrow-cluster
name=furrowd
output=''
while [[ $# -gt 0 ]]; do
  case "$1" in
    --pictures) include=$include,furrow-pictures; name=furrowd-pictures; shift ;;
    --packages) packages=${2:?--packages needs a folder}; shift 2 ;;
    -h|--help) sed -n '3,12s/^# \{0,1\}//p' "$0"; exit 0 ;;
    -*) echo "build-container: unknown option '$1' (--help lists them)" >&2; exit 2 ;;
    *) output=$1; shift ;;
  esac
done
output=$(realpath -m "${output:-$repository/build/$name.oci.tar}")

fail() { echo "build-container: $*" >&2; exit 1; }
for tool in mmdebstrap buildah dpkg-scanpackages; do
  command -v "$tool" >/dev/null || fail "$tool is missing; install mmdebstrap, buildah and dpkg-dev"
done
[[ $(id -u) -eq 0 ]] || fail 'needs root'
compgen -G "$packages/furrowd_*.deb" >/dev/null || fail "no packages in $packages; run deploy/build-deb.sh"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/packages"
cp "$packages"/*.deb "$work/packages/"
(cd "$work/packages" && dpkg-scanpackages --multiversion . >Packages 2>/dev/null)
version=$(dpkg-deb -f "$packages"/furrowd_*.deb Version)

# Extracts the packages and what they depend on, without running their scripts.
echo "build-container: extracting $include $version"
root=$work/root
mmdebstrap --quiet --variant=extract --include="$include" --aptopt='APT::Install-Recommends "false"' \
  --dpkgopt='path-exclude=/usr/share/doc/*' --dpkgopt='path-exclude=/usr/share/man/*' \
  --dpkgopt='path-exclude=/usr/share/locale/*' --dpkgopt='path-exclude=/usr/share/lintian/*' \
  bookworm "$root" 'deb http://deb.debian.org/debian bookworm main' "deb [trusted=yes] copy:$work/packages ./"

# The folders in which the loader finds libraries.
libraries() {
  local folder
  echo "$root/usr/lib" "$root/lib"
  for folder in "$root"/usr/lib/*-linux-gnu "$root"/lib/*-linux-gnu; do
    echo "$folder" "$folder/blas" "$folder/lapack" "$folder/dri"
  done
}
# needed FILE...: notes programs and libraries, their links, and the libraries that they load.
declare -A seen=()
needed() {
  local file library folder
  for file in "$@"; do
    [[ -z ${seen[$file]:-} ]] || continue
    seen[$file]=1
    [[ ! -L $file ]] || needed "$(dirname "$file")/$(readlink "$file")"
    while read -r library; do
      for folder in $(libraries); do
        [[ ! -e $folder/$library ]] || { needed "$folder/$library"; break; }
      done
    done < <(readelf -d "$file" 2>/dev/null | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')
  done
}
# Modules and a driver are loaded by their names.
loaded=("$root/usr/bin/furrowd" "$root"/usr/lib/furrow/*.so)
if [[ $name == furrowd-pictures ]]; then
  loaded+=("$root"/usr/lib/*/libEGL*.so.? "$root"/usr/lib/*/lib{,Open}GL*.so.?
           "$root"/usr/lib/*/dri/swrast_dri.so)
fi
needed "${loaded[@]}"
find "$root"/lib "$root"/usr/lib \( -name '*.so' -o -name '*.so.*' \) ! -type d | while read -r file; do
  [[ -n ${seen[$file]:-} || $file == */ld-linux* || $file == */libnss_* ]] || rm "$file"
done
# What the scripts of these packages would link.
for file in "$root"/usr/lib/*/{blas,lapack}/lib*.so.?; do
  [[ ! -e $file ]] || ln -sf "${file#"$(dirname "$(dirname "$file")")/"}" "$(dirname "$(dirname "$file")")/"
done
rm -rf "$root"/{bin,sbin,usr/sbin,usr/games,etc/init.d,etc/systemd,lib/systemd} \
  "$root"/usr/share/{bash-completion,fish,zsh,bug,doc-base,perl5,icons,mime} "$root"/var/{cache,log}/*
find "$root/usr/bin" -mindepth 1 ! -name furrowd -delete
mkdir -p "$root"/{proc,sys,run,tmp,var/lib/furrow,var/cache/furrow}
echo 'furrow:x:65532:65532::/var/lib/furrow:/usr/sbin/nologin' >"$root/etc/passwd"
echo 'furrow:x:65532:' >"$root/etc/group"
chown 65532:65532 "$root"/var/lib/furrow "$root"/var/cache/furrow
chmod 1777 "$root/tmp"

store() { buildah --root "$work/store" --runroot "$work/run" --storage-driver vfs "$@"; }
container=$(store from scratch)
store add --quiet "$container" "$root" / >/dev/null
store config --user 65532:65532 --workingdir /var/lib/furrow \
  --entrypoint '["/usr/bin/furrowd","--config","/etc/furrow/furrow.toml"]' --cmd '' \
  --env HOME=/var/lib/furrow --env XDG_CACHE_HOME=/var/cache/furrow --volume /var/lib/furrow \
  --port 7400/tcp --port 7401/udp --port 7480/tcp --label org.opencontainers.image.title=furrowd \
  --label "org.opencontainers.image.version=$version" --label org.opencontainers.image.licenses=Apache-2.0 "$container"
mkdir -p "$(dirname "$output")"
rm -f "$output"
store commit --quiet --disable-compression=false --format oci "$container" "oci-archive:$output:$name:${version//\~/-}" >/dev/null
echo "build-container: $output: $(du -h "$output" | cut -f1), unpacked $(du -sh "$root" | cut -f1)"
