// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "character/character.h"

namespace furrow::character {

// How to cut a strain driver's patch out of a character.
struct PatchOptions {
  std::string name = "patch";  // the driver's name
  std::string mesh;            // the mesh to cut from; empty: skin and cloth
  glm::vec3 centre{0.0f};      // model space, rest pose, metres; snaps to the nearest vertex
  float radius = 0.015f;       // metres; selects triangles by their centroid
  glm::vec3 direction{0.0f, 1.0f, 0.0f};  // see wrinkle::StrainDriver
  float full_compression = 0.25f;
};

// Makes a strain driver (wrinkle/rig/rig.h) from the triangles around a point, ready to be pasted
// into a rig.
//
// - If the radius holds more triangles than a driver may have (wrinkle/rig/rig_check.h), the
//   nearest ones are taken.
// - Only triangles connected to the nearest one (weld.h) are taken, so a patch on one lip never
//   includes the other lip.
// - Positions are relative to the rig's anchor if the anchor moves the patch or is an ancestor of
//   the joints that do, and otherwise to the joint that moves the patch most. Skin weights below
//   0.001 are dropped.
//
// Errors: kNotFound (no such mesh, or no triangle within the radius; the message names the
// nearest), kInvalidArgument (a driver that CheckRigFields() rejects, or a patch that a single
// joint moves and that therefore cannot be compressed).
[[nodiscard]] Result<wrinkle::Driver> CutPatch(const Character& character,
                                               const PatchOptions& options);

// The origin of a joint, and the vertex at the centre of a region's mask; model space, rest pose.
// Error: kNotFound (no such joint, region or mask picture).
[[nodiscard]] Result<glm::vec3> JointPosition(const Character& character, const std::string& joint);
[[nodiscard]] Result<glm::vec3> RegionPosition(const Character& character,
                                               const std::string& region);

}  // namespace furrow::character
