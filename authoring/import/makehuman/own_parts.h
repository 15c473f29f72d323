// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "authoring/import/makehuman/body_parts.h"
#include "authoring/import/makehuman/face/face_landmarks.h"
#include "authoring/import/makehuman/face/skin_paint.h"
#include "character/character.h"

// The parts of a character that the import makes itself, with painted pictures.
namespace furrow::authoring {

// What a part is made from, and the character that receives it. `character` has the skin as its
// first mesh. A part without its group in the base mesh is skipped with a warning.
struct PartSource {
  const BaseMesh& base;
  const FaceLandmarks& face;
  SkinLook look;
  int texture_size = 0;  // of the skin; parts have half of it
  character::Character* character = nullptr;
  std::vector<std::string>* warnings = nullptr;
};

void AddOwnEyes(const PartSource& source);
void AddOwnTeeth(const PartSource& source);
void AddOwnTongue(const PartSource& source);
void AddOwnHair(const PartSource& source);
void AddOwnLashes(const PartSource& source);

// Add to a character and return the index.
int AddPicture(character::Picture picture, character::Character* character);
int AddMaterial(character::Material material, character::Character* character);

}  // namespace furrow::authoring
