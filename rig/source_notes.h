// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace furrow::character {

// What one mesh of a file was before it was made fit to be drawn.
struct MeshNotes {
  bool skinned = false;
  bool has_uvs = false;
  bool has_normals = false;
  bool has_tangents = false;
  int unskinned_vertices = 0;     // of a skinned mesh: their weights sum to 0
  int unnormalised_vertices = 0;  // their weights sum to something else than 1, by more than 0.01
  float worst_sum = 1.0f;         // the sum furthest from 1 among those
  int truncated_vertices = 0;     // had more than four joints
  int morph_targets = 0;          // blend shapes, which are not carried
};

// What a glTF said before it was made fit to be drawn: for importers and `furrow character check`.
struct SourceNotes {
  std::vector<MeshNotes> meshes;              // as Character::meshes
  std::vector<std::string> missing_pictures;  // "name: why"
  int nameless_joints = 0;                    // they are named "node_<number>"
};

// How ParseCharacter() reads.
struct ReadOptions {
  // Reads what it otherwise refuses, and notes it: an unskinned vertex takes the skin weights of
  // the nearest skinned one along the mesh's edges (the skin's first joint where there is none),
  // and materials lose pictures that are absent or cannot be decoded.
  bool lenient = false;
  SourceNotes* notes = nullptr;  // filled when set
};

}  // namespace furrow::character
