// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "character/character.h"

namespace furrow::character {

// What a strain driver's patch is cut out of a character by.
struct PatchOptions {
  std::string name = "patch";  // of the driver
  std::string mesh;            // cut from this mesh alone; empty: from skin and cloth alike
  glm::vec3 centre{0.0f};      // model space, rest pose, metres; carried to the nearest vertex
  float radius = 0.015f;       // metres: triangles whose middle is nearer belong to it
  glm::vec3 direction{0.0f, 1.0f, 0.0f};  // see wrinkle::StrainDriver
  float full_compression = 0.25f;
};

// A strain driver (wrinkle/rig/rig.h) over the triangles around a point, ready to be pasted into a
// rig.
//
// - Where there are more triangles than a driver may have (rig_check.h), those nearest the centre
//   are taken. Only triangles that hang together with the nearest one (weld.h) belong: not the
//   other lip, though it may lie upon this one.
// - Positions are measured from the rig's anchor where it moves the patch or is above what does,
// else
//   from the joint that moves the patch most. Skin weights below 0.001 are dropped.
// Errors: kNotFound (no such mesh; no surface or no triangle within the radius, which names the
// nearest),
// kInvalidArgument (a driver that CheckRigFields() refuses, a patch that one joint alone moves: it
// cannot be compressed).
[[nodiscard]] Result<wrinkle::Driver> CutPatch(const Character& character,
                                               const PatchOptions& options);

// Where a joint starts (model space, rest pose), and the vertex in the middle of what a region's
// mask covers. kNotFound where there is no such joint, region or mask picture.
[[nodiscard]] Result<glm::vec3> PlaceOfJoint(const Character& character, const std::string& joint);
[[nodiscard]] Result<glm::vec3> PlaceOfRegion(const Character& character,
                                              const std::string& region);

}  // namespace furrow::character
