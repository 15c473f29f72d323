# SPDX-License-Identifier: Apache-2.0
# For the scripts beside it, which source it from the repository's folder.

# Sets `build` to the folder of the preset release, after it has built TARGET..., unless the user has named a folder.
use_release_build() {
  [[ -z $build ]] || return 0
  build=build/release
  [[ -f $build/build.ninja ]] || cmake --preset release
  cmake --build --preset release --target "$@"
}
