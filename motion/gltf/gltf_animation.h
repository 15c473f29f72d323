// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "motion/clip/clip.h"

// Skeletal and morph animation in glTF 2.0 (.gltf, .glb) and VRM Animation (.vrma: the extension
// VRMC_vrm_animation 1.0). gltf/ parses the files; this folder turns them into clips and back.
namespace furrow::motion {

struct GltfOptions {
  LoadOptions load;                             // `scale`, `sample_rate` and `animation` are used
  std::optional<std::filesystem::path> folder;  // for external buffers; none: none are opened
};

// Reads one animation of a glTF file, binary or JSON.
//
// - Joints: the joints of all skins and their ancestors, and nodes that the animation moves:
//     - nodes below a joint of a skin;
//     - nodes below a moving ancestor of joints, if branches with joints or limbs meet there;
//     - nodes that lead to a mesh without a skin and lie below a joint or below an ancestor of one.
//   Without a skin: all nodes of the trees in which a node moves. VRMA: the human bones, under
//   VRM's names ("hips", "leftUpperArm"), and their ancestors. gltf::ListJoints() names the others
//   and makes names unique.
// - A joint's tail is its node's extra "furrow_tail" ([x, y, z], local), which ClipToGlb() writes.
// - Blend shapes: the animated morph weights, named by the mesh's extra "targetNames", else
//   "<mesh>.<index>". If several meshes share a name, the first counts. VRMA: the expressions, with
//   their node's translation.x as the value. VRMA's lookAt is ignored with a warning.
// - Frames: the times of all keys together, or evenly spaced at `sample_rate`.
// - Meshes, materials and images are not read.
//
// Errors: those of gltf::Document::Open(), gltf::ReadNodes() and gltf::ReadAnimation(); kLimit
// (motion/clip/limits.h, wrinkle::kMaxJoints), kSchema (nothing moves), kNonFinite. `where` is
// "source_name: field". `report` receives the document's warnings.
[[nodiscard]] Result<Clip> ParseGltfAnimation(std::string_view bytes, std::string_view source_name,
                                              const GltfOptions& options = {},
                                              ClipReport* report = nullptr);

// Writes a clip as a GLB: one node per joint with its rest pose, a skin without a mesh that lists
// the joints in order, and one LINEAR animation. Only rotations, translations and scales that
// differ from the rest pose get a track.
//
// - Blend shapes become the morph weights of a mesh "blend_shapes". Its only triangle has no area,
//   its targets are zero, and its extra "targetNames" names them, as Blender and three.js expect.
// - Every joint's tail is written as its node's extra "furrow_tail".
// - Times are floats that count from the clip's first frame.
//
// Errors: kInvalidArgument (no frames, or two frames too close for floats), kUnsupported (neither
// joints nor blend shapes), kLimit (4 GiB).
[[nodiscard]] Result<std::string> ClipToGlb(const Clip& clip);

}  // namespace furrow::motion
