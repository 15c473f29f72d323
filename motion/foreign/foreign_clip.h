// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "motion/clip/clip.h"

namespace furrow::motion {

// Converts an animation of an FBX or Collada file to a GLB that ParseGltfAnimation() reads, in the
// helper program furrow-assimp. This process neither links assimp nor trusts it.
//
// - `extension` selects the format: ".fbx" or ".dae". `animation` is LoadOptions::animation.
// - The helper may use 1 GiB of memory, 60 s of processor time and 180 s in all.
// - `report` receives warnings and the file's animations.
//
// Errors: those of CallHelper(); kParse, kSchema (no animation), kNotFound (no such animation).
[[nodiscard]] Result<std::string> ForeignClipToGlb(std::string_view bytes,
                                                   const std::string& extension,
                                                   const std::string& animation,
                                                   ClipReport* report);

// A report as the notes of the helper's reply.
[[nodiscard]] std::vector<std::string> NotesOf(const ClipReport& report);

}  // namespace furrow::motion
