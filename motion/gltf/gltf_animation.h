// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "motion/clip/clip.h"

// Skeletal and morph animation in glTF 2.0 (.gltf, .glb) and VRM Animation (.vrma, the extension
// VRMC_vrm_animation 1.0).
namespace furrow::motion {

struct GltfOptions {
  LoadOptions load;              // `scale` and `sample_rate` are read
  std::filesystem::path folder;  // where a buffer's relative URI is looked up; empty: nowhere
};

// Reads the first animation of a glTF file, binary or JSON.
//
// - Joints: the joints of all skins and their ancestors; without a skin, every
//   node of the trees in which a node moves. For VRMA the human bones, named
//   as VRM names them ("hips", "leftUpperArm"), and their ancestors. A joint
//   without a name is "node_<index>"; a repeated name gets "_2", "_3", ...
// - A joint's tail is its node's extras "furrow_tail" ([x, y, z], local), where ClipToGlb() put it.
// - Blend shapes: animated morph weights, named by the mesh's extras "targetNames" (else
//   "<mesh>.<index>"); a name that several meshes have is taken once. For VRMA the expressions,
//   each its node's translation.x. VRMA's lookAt is not read (a warning).
// - Frames: the times of all keys together, or evenly at `sample_rate`. LINEAR (slerp), STEP and
//   CUBICSPLINE; outputs may be floats or normalised integers.
//
// The file is hostile until checked: chunk sizes, JSON depth, every index, range and count before
// it is used, strictly increasing finite times, a node tree without cycles. Buffers are the GLB's
// own, data URIs, or files in `folder` itself; nothing else is opened. Pictures and meshes are not
// looked at. Errors: kParse, kSchema, kLimit, kNonFinite, kCyclic, kUnsupported (sparse accessors,
// meshopt), kNotFound (a buffer's file); `where` is "source_name: field".
[[nodiscard]] Result<Clip> ParseGltfAnimation(std::string_view bytes, std::string_view source_name,
                                              const GltfOptions& options = {},
                                              ClipReport* report = nullptr);

// The clip as one GLB: a node a joint with its rest pose, a skin that
// lists them in order (without a mesh), one LINEAR animation with a
// sampler for each rotation, translation and scale that leaves rest.
//
// - Blend shapes are the morph weights of a mesh "blend_shapes": one
//   triangle without extent, whose targets are all zero and named by
//   extras "targetNames", the way Blender and three.js read names.
// - Every joint's tail is kept in its node's extras "furrow_tail".
// - Times are floats from the clip's first frame on; kInvalidArgument where two frames would
//   coincide, or without frames.
[[nodiscard]] Result<std::string> ClipToGlb(const Clip& clip);

}  // namespace furrow::motion
