// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "base/status.h"
#include "motion/clip/clip.h"

namespace furrow::motion {

// Loads a clip. The extension, in any case, decides the format: .bvh, .glb, .gltf, .vrma or .csv
// (Live Link Face). BVH files are turned to Y up.
//
// Errors: kNotFound, kIo, kParse, kSchema, kLimit, kNonFinite, kUnsupported. `where` is
// "file:line" or "file: field".
[[nodiscard]] Result<Clip> LoadClip(const std::filesystem::path& path,
                                    const LoadOptions& options = {}, ClipReport* report = nullptr);

// Saves a clip as .bvh, .glb or .csv. The file is replaced in one step, or not at all.
//
// BVH has no blend shapes and the CSV has no joints: `report` lists what is dropped. Errors: kIo,
// kInvalidArgument (frames, joints and blend shapes of different counts), kUnsupported (another
// extension, or nothing of the clip would be left).
[[nodiscard]] Status SaveClip(const Clip& clip, const std::filesystem::path& path,
                              ClipReport* report = nullptr);

}  // namespace furrow::motion
