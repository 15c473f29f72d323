// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gltf/document/draco_mesh.h"
#include "gltf/scene/vrm_look_at.h"

namespace furrow::character {

// What one mesh of a glTF file contained, before the reader computed missing data.
struct MeshNotes {
  bool skinned = false;
  bool has_uvs = false;
  bool has_normals = false;
  bool has_tangents = false;
  int unskinned_vertices = 0;     // in a skinned mesh, vertices whose weights sum to 0
  int unnormalised_vertices = 0;  // vertices whose weights miss a sum of 1 by more than 0.01
  float worst_sum = 1.0f;         // the sum furthest from 1
  int truncated_vertices = 0;     // vertices with more than four joints
  int morph_targets = 0;          // in the file, including those that move nothing
};

// What a glTF file contained before the reader computed missing data. Used by importers and by
// `furrow character check`.
struct SourceNotes {
  std::vector<MeshNotes> meshes;              // one per mesh of Character::meshes, in that order
  std::vector<std::string> missing_pictures;  // "name: reason"
  std::vector<std::string> idle_shapes;       // morph targets that move nothing visibly; left out
  std::optional<gltf::VrmLookAt> look_at;     // of the eyes' joints
  int nameless_joints = 0;  // joints without a name, which are now called "node_<number>"
};

// Which pictures of a character are decoded.
enum class Pictures {
  kLoad,
  // Only the base colours of the materials are decoded, and reduced to at most 512 texels per side,
  // which takes a fraction of the time. Every other picture is a stand-in
  // (character/package/stand_ins.h), so that drawing needs the same programs.
  kColours,
  // All pictures are stand-ins.
  kStandIns,
  // No picture is decoded, and materials have none. Weights need no pictures, and a daemon without
  // the module that decodes them still has weights.
  kLeaveOut
};

// Options of ParseCharacter().
struct ReadOptions {
  // Accepts files that are otherwise rejected, and notes the changes. An unskinned vertex takes the
  // skin weights of the nearest skinned vertex along the mesh's edges, or the skin's first joint.
  // Materials lose pictures that are missing or cannot be decoded.
  bool lenient = false;
  Pictures pictures = Pictures::kLoad;
  SourceNotes* notes = nullptr;               // receives the notes, unless null; the caller owns it
  const gltf::DracoDecoder* draco = nullptr;  // null: files that require Draco are refused
  // True for the name of an eye; then a rigid eyeball outside all skins gets a joint. Empty: false.
  std::function<bool(const std::string&)> is_eye_name;
};

}  // namespace furrow::character
