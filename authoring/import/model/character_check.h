// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "authoring/import/model/character_space.h"
#include "authoring/import/model/joint_finder.h"
#include "character/character.h"

namespace furrow::authoring {

enum class Severity {
  kError,    // wrinkles cannot be baked or drawn
  kWarning,  // they can, and will look or move wrong
  kNote,     // worth knowing
};
[[nodiscard]] const char* ToString(Severity severity);  // "error", "warning", "note"

// One thing that is missing or wrong.
struct Finding {
  Severity severity = Severity::kNote;
  std::string code;   // stable, for scripts: "uv-overlap"
  std::string where;  // "mesh 'skin'"; empty: the whole character
  std::string what;
  std::string todo;
};

// What a character lacks for wrinkles.
struct CharacterReport {
  std::string name;
  std::vector<std::pair<std::string, std::size_t>> counts;  // "joints" -> 163
  CharacterSpace space;
  FoundJoints joints;
  std::size_t face_joints = 0;    // below the head, eyes and jaw aside
  std::vector<Finding> findings;  // errors first

  [[nodiscard]] std::size_t Count(Severity severity) const;
};

// Looks at a character that was read leniently, and at the notes that its reader took.
//
// `rig_given`: Character::rig is meant to go with it; where none is, that is a note, not an error.
//
// Codes
//   errors    no-skin, uv-missing, unskinned-vertices, degenerate-triangles, rig-binding
//   warnings  uv-overlap (a bake refuses it), uv-flat, weights-sum, normals-missing,
//             picture-missing, units, up-axis, joint-names, no-roles, rig, rig-picture
//   notes     uv-outside, weights-truncated, tangents-missing, blend-shapes, roles-missing,
//             no-face-joints, no-rig
[[nodiscard]] CharacterReport CheckCharacter(const character::Character& character,
                                             const character::SourceNotes& notes,
                                             const character::SkeletonMaps& maps, bool rig_given);

// Triangles without area: two corners in one place, or all on a line.
[[nodiscard]] std::size_t CountDegenerateTriangles(const character::Mesh& mesh);
// Takes them out; how many there were. A mesh may be left without triangles.
std::size_t DropDegenerateTriangles(character::Mesh* mesh);

}  // namespace furrow::authoring
