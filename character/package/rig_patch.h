// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "character/character.h"

namespace furrow::character {

// Where to cut the patch of a strain driver, a piece of surface, out of a character.
struct PatchOptions {
  std::string name = "patch";  // the driver's name
  std::string mesh;            // name of the mesh to cut from; empty: all skin and cloth
  glm::vec3 centre{0.0f};      // model space, rest pose, metres; snaps to the nearest vertex
  float radius = 0.015f;       // metres; selects triangles by their centroid
  // The next two are copied to the driver: the direction in which compression is measured, and the
  // compression (1 - length / rest length) that gives the value 1.
  glm::vec3 direction{0.0f, 1.0f, 0.0f};
  float full_compression = 0.25f;
};

// Makes a strain driver from the triangles around a point, ready to be pasted into a rig.
//
// - If the radius holds more triangles or vertices than a driver may have
//   (wrinkle::kMaxPatchTriangles, kMaxPatchVertices), the nearest ones are taken.
// - Only triangles connected to the nearest one are taken, so a patch on one lip never includes the
//   other lip.
// - Positions are relative to the rig's anchor joint if it is an ancestor of all joints that move
//   the patch, and otherwise to the joint that moves the patch most. Skin weights below 0.001 are
//   dropped.
// - The character's shapes move the patch as they move the surface. Deltas below 5 um are dropped.
//
// Errors: kNotFound (no such mesh, or no triangle within the radius; the message names the
// nearest), kInvalidArgument (a driver that CheckRigFields() rejects, or a patch that a single
// joint and no shape moves and that therefore cannot be compressed).
[[nodiscard]] Result<wrinkle::Driver> CutPatch(const Character& character,
                                               const PatchOptions& options);

// The origin of a joint: metres, model space, rest pose. Error: kNotFound (no such joint).
[[nodiscard]] Result<glm::vec3> JointPosition(const Character& character, const std::string& joint);
// The position of the vertex nearest to the centroid of a region's painted mask: metres, model
// space, rest pose. Error: kNotFound (no such region, no mask picture, or a mask without vertices).
[[nodiscard]] Result<glm::vec3> RegionPosition(const Character& character,
                                               const std::string& region);

}  // namespace furrow::character
