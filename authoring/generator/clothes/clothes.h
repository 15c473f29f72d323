// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "authoring/generator/body/body_shape.h"
#include "authoring/generator/mesh/unwrap.h"
#include "character/character.h"

namespace furrow::authoring {

// Shirt and trousers in one atlas, skinned, at rest.
struct Clothes {
  character::Mesh mesh;
  std::vector<PanelPlace> panels;  // place of each ClothPanel in the atlas
  std::vector<int> vertex_panels;  // the panel of each vertex
};
[[nodiscard]] Clothes MakeClothes(const BodyShape& shape);

// A pair of shoes and the belt, skinned.
[[nodiscard]] character::Mesh MakeLeather(const BodyShape& shape);

// Appends both hands, skinned, to the skin of the head. They use the free middle of its lowest band
// in the atlas.
void AddHands(const BodyShape& shape, character::Mesh* skin);

}  // namespace furrow::authoring
