#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Draws the pictures of the documents again, from a build: docs/make-pictures.sh [BUILD_DIR [NAMES...]]
# NAMES: functions below; only their pictures are drawn: docs/make-pictures.sh build/dev subsurface "bodies default"
#
# FURROW_SHARED_DATA (default ../shared/data): MakeHuman's data and a recording for its skeleton. If that
# folder is missing, the pictures of the MakeHuman character stay as they are.
# MAKEHUMAN_DATA: the data folder of MakeHuman's source with its assets, for the picture of saved people, which stays as
# it is without one.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=${1:-build/release}
shared=${FURROW_SHARED_DATA:-../shared/data}
people=${MAKEHUMAN_DATA:-}
furrow=$build/bin/furrow
share=$build/share/furrow
recordings=$share/recordings
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
out=docs/pictures
mkdir -p "$out"

# still NAME [OPTIONS...]: one picture, $work/NAME.png
still() {
  "$furrow" render "${@:2}" --out "$work/$1" --size "${size:-320x320}" --shading "${shading:-skin}"
  mv "$work/$1"/*.png "$work/$1.png"
}

# sheet OUT COLUMNSxROWS WIDTH NAMES...
sheet() {
  local files=()
  for name in "${@:4}"; do files+=("$work/$name.png"); done
  oiiotool "${files[@]}" --mosaic:pad=4 "$2" --resize "$3x0" --eraseattrib ".*" --compression jpeg:84 \
    --nosoftwareattrib -o "$out/$1.jpg"
}

# default_faces PREFIX CHARACTER: upper row without wrinkles, lower row with; neutral, stretch, squash, emotions.
default_faces() {
  local prefix=$1 character=$share/$2.glb names=() wrinkles
  for wrinkles in off on; do
    local options=(--character "$character" --wrinkles "$wrinkles" --camera face)
    for pose in neutral stretch squash; do
      still "${prefix}_${pose}_$wrinkles" --pose "$pose" "${options[@]}"
    done
    still "${prefix}_happiness_$wrinkles" "$recordings/happiness.bvh" --frames 85 "${options[@]}"
    still "${prefix}_anger_$wrinkles" "$recordings/anger.bvh" --frames 140 "${options[@]}"
    still "${prefix}_sadness_$wrinkles" "$recordings/sadness.bvh" --frames 120 "${options[@]}"
    still "${prefix}_disgust_$wrinkles" "$recordings/disgust.bvh" --frames 100 "${options[@]}"
    for name in neutral stretch squash happiness anger sadness disgust; do
      names+=("${prefix}_${name}_$wrinkles")
    done
  done
  sheet "${prefix}_faces" 7x2 1680 "${names[@]}"
}

# bodies PREFIX OPTIONS...: a walk and a squat, without and with wrinkles.
bodies() {
  local prefix=$1 wrinkles
  for wrinkles in off on; do
    size=360x640 still "${prefix}_walk_$wrinkles" "$recordings/walk.bvh" --frames 100 \
      --camera body --wrinkles "$wrinkles" "${@:2}"
    size=360x640 still "${prefix}_squat_$wrinkles" "$recordings/squat.bvh" --frames 60 \
      --camera body --wrinkles "$wrinkles" "${@:2}"
  done
  sheet "${prefix}_body" 4x1 1200 "${prefix}"_{walk,squat}_{off,on}
}

# The picture of the README: three moments of a performance, without and with wrinkles.
performance() {
  local names=() wrinkles
  for wrinkles in off on; do
    for frame in 60 120 240; do
      size=480x480 still "p${frame}_$wrinkles" "$recordings/performance.bvh" --frames "$frame" \
        --wrinkles "$wrinkles" --camera face
      names+=("p${frame}_$wrinkles")
    done
  done
  sheet performance 3x2 900 "${names[@]}"
}

views() {
  local names=()
  for view in final normal mask_texture mask_dynamic weights wireframe; do
    size=480x480 still "view_$view" "$recordings/performance.bvh" --frames 240 --view "$view" \
      --camera three_quarter
    names+=("view_$view")
  done
  sheet views 3x2 900 "${names[@]}"
}

# The light of each file in share/furrow/environments, in the order of the page.
environments() {
  local names=()
  for light in studio overcast sunset stage neutral; do
    size=400x460 still "light_$light" "$recordings/performance.bvh" --frames 120 --camera face \
      --settings "$share/environments/$light.toml"
    names+=("light_$light")
  done
  sheet environments 5x1 1400 "${names[@]}"
}

# One pose with texture masks and with masks by skinning weights.
masks() {
  local names=()
  for view in final mask_texture mask_dynamic; do
    size=480x480 still "mask_$view" --pose squash --view "$view" --camera face
    names+=("mask_$view")
  done
  sheet masks 3x1 1080 "${names[@]}"
}

# The reference poses: the face in the upper row, its normals with the blended maps in the lower row.
reference_poses() {
  local names=()
  for view in final normal; do
    for pose in neutral stretch squash; do
      size=480x480 still "ref_${pose}_$view" --pose "$pose" --view "$view" --camera face
      names+=("ref_${pose}_$view")
    done
  done
  sheet reference_poses 3x2 1080 "${names[@]}"
}

# The reference poses under the lights of the thesis, with diffuse shading, above their blended normals.
thesis_poses() {
  local names=() pose view
  for view in final normal; do
    for pose in neutral stretch squash; do
      size=480x480 shading=diffuse still "thesis_${pose}_$view" --pose "$pose" --view "$view" --camera face --lights thesis
      names+=("thesis_${pose}_$view")
    done
  done
  sheet thesis_poses 3x2 1080 "${names[@]}"
}

# Three emotions under the lights of the thesis with skin shading, without and with wrinkles.
thesis_wrinkles() {
  local names=() wrinkles options=(--camera face --lights thesis)
  for wrinkles in off on; do
    size=480x480 still "thesis_anger_$wrinkles" "$recordings/anger.bvh" --frames 140 --wrinkles "$wrinkles" "${options[@]}"
    size=480x480 still "thesis_smile_$wrinkles" "$recordings/happiness.bvh" --frames 85 --wrinkles "$wrinkles" "${options[@]}"
    size=480x480 still "thesis_brows_$wrinkles" --pose stretch --wrinkles "$wrinkles" "${options[@]}"
    names+=("thesis_anger_$wrinkles" "thesis_smile_$wrinkles" "thesis_brows_$wrinkles")
  done
  sheet thesis_wrinkles 3x2 1080 "${names[@]}"
}

# The outer corner of an eye at four times the size of a face of 512 pixels, in squash: without wrinkles, with the
# character's own maps of 1024 texels, and with maps of 4096 texels.
eye_corner() {
  local names=() way rig=$work/eye-maps/default.rig.json
  "$furrow" bake "$share/default.glb" --strokes rig/rigs/default.strokes.json --map squash --size 4096 \
    --out "$work/eye-maps"
  local options=(--character "$share/default.glb" --pose squash --camera face)
  size=2048x2048 still corner_off "${options[@]}" --wrinkles off
  size=2048x2048 still corner_1024 "${options[@]}"
  size=2048x2048 still corner_4096 "${options[@]}" --rig "$rig"
  for way in off 1024 4096; do
    oiiotool "$work/corner_$way.png" --cut 400x400+540+900 -o "$work/cut_$way.png"
    names+=("cut_$way")
  done
  sheet eye_corner 3x1 1200 "${names[@]}"
}

# Close-ups of clothing at hinge and ball joints, without and with wrinkles: arm, then leg.
cloth_joints() {
  local names=() wrinkles
  for wrinkles in off on; do
    size=1600x1600 still "squat_$wrinkles" "$recordings/squat.bvh" --frames 60 --camera body \
      --wrinkles "$wrinkles"
    oiiotool "$work/squat_$wrinkles.png" --cut 420x420+450+420 -o "$work/arm_$wrinkles.png"
    oiiotool "$work/squat_$wrinkles.png" --cut 420x420+600+620 -o "$work/leg_$wrinkles.png"
  done
  sheet cloth_joints 4x1 1200 arm_off arm_on leg_off leg_on
}

# Pictures of docs/RENDERING.md: comparisons of settings.
shading() {
  for way in diffuse skin; do
    shading=$way size=640x640 still "shading_$way" --pose neutral --camera three_quarter
  done
  sheet shading 2x1 1080 shading_diffuse shading_skin
}

wrinkles() {
  for way in off on; do
    size=640x640 still "wrinkles_$way" "$recordings/anger.bvh" --frames 140 --wrinkles "$way" \
      --character "$share/elder.glb" --camera face
  done
  sheet wrinkles 2x1 1080 wrinkles_off wrinkles_on
}

subsurface() {
  local above=() below=()
  for method in off gaussians separable burley preintegrated; do
    size=1000x1000 still "whole_$method" --pose neutral --camera mouth --lights hard \
      --set "subsurface.method=$method"
    oiiotool "$work/whole_$method.png" --cut 320x320+360+40 -o "$work/subsurface_$method.png"
    above+=("subsurface_$method")
  done
  for method in off gaussians separable burley preintegrated; do
    oiiotool "$work/subsurface_$method.png" "$work/subsurface_gaussians.png" --absdiff --mulc 6 \
      -o "$work/difference_$method.png"
    below+=("difference_$method")
  done
  sheet subsurface 5x2 1600 "${above[@]}" "${below[@]}"
}

# Ten people who play one recording, each at another moment.
crowd() {
  size=1280x640 still crowd "$recordings/performance.bvh" --subjects 10 --frames 60 --camera face
  sheet crowd 1x1 1080 crowd
}

# Close-up of a forehead in profile with raised brows, without and with displacement.
displacement() {
  local names=()
  for way in off on; do
    size=1200x1200 still "profile_$way" --pose stretch --camera profile \
      --character "$share/elder.glb" --set "displacement.enabled=$way"
    oiiotool "$work/profile_$way.png" --cut 260x320+170+300 -o "$work/forehead_$way.png"
    names+=("forehead_$way")
  done
  sheet displacement 2x1 1080 "${names[@]}"
}

# Blood flow at strengths 0, 1 and 2; a smile in the upper row, a frown in the lower row.
blood_flow() {
  local strength
  for strength in 0 1 2; do
    size=560x560 still "smile_$strength" "$recordings/happiness.bvh" --frames 85 --camera face \
      --set "wrinkle_maps.blood_flow=$strength"
    size=560x560 still "frown_$strength" "$recordings/anger.bvh" --frames 140 --camera face \
      --character "$share/elder.glb" --set "wrinkle_maps.blood_flow=$strength"
  done
  sheet blood_flow 3x2 1080 smile_{0,1,2} frown_{0,1,2}
}

# A leg that swings forwards, diagonally and sideways. Upper row: the rig's masks, painted for four
# directions. Lower row: one sliding mask. Both are baked first.
sliding_masks() {
  local names=() rig pose
  for rig in fixed sliding; do
    python3 docs/sliding_rig.py "$rig" "$share/default.rig.json" "$work/$rig.rig.json"
    "$furrow" bake "$share/default.glb" --rig "$work/$rig.rig.json" --map folds --size 1024 \
      --out "$work/$rig-maps"
    for pose in forwards between aside; do
      size=1000x1000 still "${rig}_$pose" --pose "leg_$pose" --camera body \
        --rig "$work/$rig-maps/default.rig.json"
      oiiotool "$work/${rig}_$pose.png" --cut 360x360+420+330 -o "$work/hip_${rig}_$pose.png"
      names+=("hip_${rig}_$pose")
    done
  done
  sheet sliding_masks 3x2 1080 "${names[@]}"
}

makehuman() {
  export FURROW_ASSET_PATH="$shared/makehuman/poseunits"
  "$furrow" character import "$shared/makehuman" --out "$work/makehuman.glb"
  local names=() wrinkles
  for wrinkles in off on; do
    # The frames of neutral and of the peaks of smile, anger, sadness, disgust and laughter.
    for frame in 0 60 180 300 420 540; do
      still "mh_${frame}_$wrinkles" "$shared/performances/emotions.bvh" --frames "$frame" \
        --character "$work/makehuman.glb" --wrinkles "$wrinkles" --camera face
      names+=("mh_${frame}_$wrinkles")
    done
  done
  sheet makehuman_faces 6x2 1440 "${names[@]}"
  bodies makehuman --character "$work/makehuman.glb"
}

# person NAME GENDER AGE AFRICAN ASIAN CAUCASIAN MUSCLE WEIGHT HAIR: a save of MakeHuman, imported to $work/NAME.glb
person() {
  printf '%s\n' "version v1.2.0" "modifier macrodetails/Gender $2" "modifier macrodetails/Age $3" \
    "modifier macrodetails/African $4" "modifier macrodetails/Asian $5" "modifier macrodetails/Caucasian $6" \
    "modifier macrodetails-universal/Muscle $7" "modifier macrodetails-universal/Weight $8" \
    "hair $9" "eyelashes eyelashes02" "eyes HighPolyEyes" "clothes male_casualsuit01" >"$work/$1.mhm"
  "$furrow" character import "$work/$1.mhm" --data "$people" --out "$work/$1.glb"
}

makehuman_people() {
  export FURROW_ASSET_PATH="$shared/makehuman/poseunits"
  person child 0 0.19 0 0 1 0.5 0.5 ponytail01
  person heavy 1 0.6 0 0 1 0.3 1 short02
  person asian 0 0.5 0 1 0 0.5 0.5 long01
  person african 0 0.45 1 0 0 0.5 0.4 braid01
  person muscular 1 0.5 0 0 1 1 0.5 short01
  person old 0 0.97 0 0 1 0.4 0.5 ponytail01
  local names=() frame name
  for frame in 0 60; do
    for name in child heavy asian african muscular old; do
      still "${name}_$frame" "$shared/performances/emotions.bvh" --frames "$frame" --character "$work/$name.glb" \
        --camera face
      names+=("${name}_$frame")
    done
  done
  sheet makehuman_people 6x2 1440 "${names[@]}"
}

# Normals as engines draw them, beside the renderer's, from the test that compares them. Needs Blender and Godot.
engine_normals() {
  local names=() set engine
  FURROW_PARITY_PICTURES=$work FURROW_BIN=$(realpath "$build/bin") FURROW_SOURCE=$PWD \
    python3 -B tests/engine_parity/test_parity.py
  for set in squash mixed; do
    for engine in furrow cycles blender_eevee godot; do
      oiiotool "$work/${engine}_$set.png" --ch R,G,B --cut 360x440+140+110 -o "$work/cut_${engine}_$set.png"
      names+=("cut_${engine}_$set")
    done
  done
  sheet engine_normals 4x2 1000 "${names[@]}"
}

# Skin shading by furrow render and by Chromium, and eight times their difference, from the test that compares them. Needs
# Chromium and the packages of tests/browser/package-lock.json.
browser_skin() {
  local names=() frame way
  FURROW_BIN=$(realpath "$build/bin") FURROW_SHARE=$(realpath "$share") FURROW_JS=$(realpath "$build/client/js") \
    FURROW_ARTEFACTS=$work node --test --test-name-pattern 'the skin of the face' tests/browser/skin.test.mjs
  for frame in 60 195 270; do
    oiiotool "$work/skin-$frame.png" --ch R,G,B --cut 300x380+75+25 -o "$work/skin_${frame}_furrow.png"
    oiiotool "$work/skin-$frame.png" --ch R,G,B --cut 300x380+523+25 -o "$work/skin_${frame}_browser.png"
    oiiotool "$work/skin_${frame}_furrow.png" "$work/skin_${frame}_browser.png" --absdiff --mulc 8 \
      -o "$work/skin_${frame}_difference.png"
  done
  for way in furrow browser difference; do names+=("skin_60_$way" "skin_195_$way" "skin_270_$way"); done
  sheet browser_skin 3x3 900 "${names[@]}"
}

# The dashboard with what its test has measured: four performers leave, the daemon stands still, and datagrams get lost.
# Needs Prometheus, Chromium, and the packages of tests/browser/package-lock.json and web/package-lock.json.
dashboard() {
  FURROW_DASHBOARD=$work/series.json FURROW_BIN=$(realpath "$build/bin") FURROW_SOURCE=$PWD PYTHONPATH=tests/end_to_end \
    python3 -B tests/deploy/test_dashboard.py DashboardTest.test_every_query_has_a_result_and_alerts_fire
  FURROW_ARTEFACTS=$work node docs/dashboard/draw.mjs deploy/grafana/furrow.json "$work/series.json" "$work/dashboard.png"
  sheet dashboard 1x1 1200 dashboard
}

if (($# > 1)); then
  for name in "${@:2}"; do $name; done  # split: a name may have arguments
  exit
fi

performance
views
environments
masks
reference_poses
thesis_poses
thesis_wrinkles
eye_corner
cloth_joints
shading
wrinkles
subsurface
crowd
displacement
blood_flow
sliding_masks
default_faces default default
default_faces elder elder
bodies default
if command -v blender godot3-runner xvfb-run >/dev/null; then
  engine_normals
else
  echo "make-pictures: Blender, Godot or xvfb-run is missing; the picture of engines stays as it is" >&2
fi
if [[ -x /usr/bin/chromium && -d tests/browser/node_modules ]]; then
  browser_skin
else
  echo "make-pictures: Chromium or its packages are missing; the picture of browsers stays as it is" >&2
fi
if command -v prometheus >/dev/null && [[ -x /usr/bin/chromium && -d tests/browser/node_modules ]]; then
  dashboard
else
  echo "make-pictures: Prometheus, Chromium or its packages are missing; the dashboard stays as it is" >&2
fi
if [[ -d $shared/makehuman && -f $shared/performances/emotions.bvh ]]; then
  makehuman
  if [[ -n $people ]]; then makehuman_people; fi
else
  echo "make-pictures: $shared/makehuman is missing; the MakeHuman pictures stay as they are" >&2
fi
ls -l "$out"
