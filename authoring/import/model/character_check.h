// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "authoring/import/model/character_space.h"
#include "authoring/import/model/joint_finder.h"
#include "character/character.h"
#include "character/source_notes.h"
#include "rig/shapes/shape_match.h"

namespace furrow::authoring {

enum class Severity {
  kError,    // prevents baking or drawing wrinkles
  kWarning,  // wrinkles work, but look or move wrong
  kNote,     // for information
};
[[nodiscard]] const char* ToString(Severity severity);  // "error", "warning", "note"

// One fault or missing feature.
struct Finding {
  Severity severity = Severity::kNote;
  std::string code;   // stable, for scripts: "uv-overlap"
  std::string where;  // "mesh 'skin'"; empty: the whole character
  std::string what;   // one sentence
  std::string todo;   // how to mend it; may be empty
};

// The state of a character with respect to wrinkles.
struct CharacterReport {
  std::string name;
  std::vector<std::pair<std::string, std::size_t>> counts;  // "joints" -> 163
  CharacterSpace space;
  FoundJoints joints;
  std::size_t face_joints = 0;    // below the head, without eyes and jaw
  std::vector<Finding> findings;  // errors first

  [[nodiscard]] std::size_t Count(Severity severity) const;
};

// Checks a character that was read leniently, together with the notes of its reader. `maps`:
// skeleton maps that give joints their roles by name; `shapes`: shape maps that know blend shapes
// by other names than ARKit's. `rig_given`: the character has a rig to check; else the report has
// the note no-rig.
//
// Codes
//   errors    no-skin (a note if blend shapes move the face), uv-missing, unskinned-vertices,
//             rig-binding, rig-poses and rig-surface (`furrow bake` would refuse the rig's poses or
//             the surfaces of its maps)
//   warnings  uv-overlap (parts that share texels fold alike), uv-flat, weights-sum,
//             normals-missing, picture-missing, units, up-axis, joint-names, no-roles (a note if
//             blend shapes move the face), rig, rig-picture, rig-poses (no pose folds a surface),
//             rig-surface (maps that `furrow bake` leaves out)
//   notes     degenerate-triangles, uv-outside, weights-truncated, tangents-missing, idle-shapes,
//             roles-missing, shape-face, few-shapes, no-face-joints, no-rig
[[nodiscard]] CharacterReport CheckCharacter(const character::Character& character,
                                             const character::SourceNotes& notes,
                                             const rig::SkeletonMaps& maps, bool rig_given,
                                             const rig::ShapeMatcher& shapes = {});

// Counts triangles without area: coinciding corners or corners on one line. Triangles that a morph
// target opens do not count.
[[nodiscard]] std::size_t CountDegenerateTriangles(const character::Mesh& mesh);
// Removes the triangles without area and returns their number. The mesh may be empty afterwards.
std::size_t DropDegenerateTriangles(character::Mesh* mesh);

}  // namespace furrow::authoring
