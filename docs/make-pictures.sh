#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the pictures of the documents anew from a build: docs/make-pictures.sh [BUILD_DIR]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=${1:-build/release}
furrow=$build/bin/furrow
recordings=$build/share/furrow/recordings
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p docs/pictures

# still NAME RECORDING FRAME [OPTIONS...]
still() {
  "$furrow" render "$recordings/$2.bvh" --frames "$3" --out "$work/$1" --size 480x480 "${@:4}"
  mv "$work/$1"/*.png "$work/$1.png"
}

for wrinkles in off on; do
  still "a_$wrinkles" performance 60 --wrinkles "$wrinkles" --camera face
  still "b_$wrinkles" performance 120 --wrinkles "$wrinkles" --camera face
  still "c_$wrinkles" performance 240 --wrinkles "$wrinkles" --camera face
done
oiiotool "$work"/{a,b,c}_off.png "$work"/{a,b,c}_on.png --mosaic:pad=6 3x2 --resize 900x0 \
  --compression jpeg:82 -o docs/pictures/performance.jpg

for view in final normal mask_texture mask_dynamic weights wireframe; do
  still "view_$view" performance 240 --view "$view" --camera three_quarter
done
oiiotool "$work"/view_{final,normal,mask_texture,mask_dynamic,weights,wireframe}.png --mosaic:pad=6 3x2 \
  --resize 900x0 --compression jpeg:82 -o docs/pictures/views.jpg
ls -l docs/pictures
