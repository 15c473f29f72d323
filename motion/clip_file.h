// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/status.h"
#include "motion/clip/clip.h"

namespace furrow::motion {

// Splits "FILE#NAME", or "FILE#INDEX" with an index from 0, which chooses an animation (take) of a
// file. `path` is a file name as a whole if a file of this name exists, or if nothing before a '#'
// has the extension of a recording. `animation` is then empty.
void SplitClipPath(const std::filesystem::path& path, std::filesystem::path* file,
                   std::string* animation);

// Loads a clip. The content decides the format for FBX, Collada and binary glTF, and else the
// extension, in any case: .bvh, .glb, .gltf, .vrma, .csv (Live Link Face), .fbx, .dae or .mhpose
// (an expression of MakeHuman: one frame). BVH files are turned to Y up; other files state their
// axes and unit. FBX and Collada files are read by the helper program furrow-assimp. The pose units
// of an expression, face-poseunits.json and .bvh, are searched in ../poseunits and poseunits
// relative to the file, beside it, and in FURROW_ASSET_PATH.
//
// `path` may choose an animation of a glTF, FBX or Collada file; see SplitClipPath().
//
// Errors: kNotFound, kInvalidArgument (a folder or a device), kIo, kParse, kSchema, kLimit,
// kNonFinite, kUnsupported. `where` is "file:line" or "file: field".
[[nodiscard]] Result<Clip> LoadClip(const std::filesystem::path& path,
                                    const LoadOptions& options = {}, ClipReport* report = nullptr);

// Reads a clip from the bytes of a file that is not on this computer, such as an upload. `name`: of
// the file; its extension chooses the format as for LoadClip(), and messages repeat it. No file is
// opened.
//
// Errors: those of LoadClip(), and kUnsupported for formats that need other files: .mhpose, and a
// .gltf with buffers of its own.
[[nodiscard]] Result<Clip> ParseClip(std::string_view bytes, const std::string& name,
                                     const LoadOptions& options = {}, ClipReport* report = nullptr);

// True if only a helper program reads such bytes: FBX and Collada.
[[nodiscard]] bool NeedsHelperProgram(std::string_view bytes, const std::string& name);

// Saves a clip as .bvh, .glb or .csv. The file is replaced in one step, or not at all.
//
// BVH has no blend shapes and the CSV has no joints: `report` lists what is dropped. Errors: kIo,
// kInvalidArgument (frames, joints and blend shapes of different counts), kUnsupported (another
// extension, or nothing of the clip would be left).
[[nodiscard]] Status SaveClip(const Clip& clip, const std::filesystem::path& path,
                              ClipReport* report = nullptr);

}  // namespace furrow::motion
