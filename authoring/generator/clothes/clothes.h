// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "authoring/generator/body/body_shape.h"
#include "authoring/generator/mesh/unwrap.h"
#include "character/character.h"

namespace furrow::authoring {

// Shirt and trousers as one skinned mesh in the rest pose, with one UV atlas.
struct Clothes {
  character::Mesh mesh;
  std::vector<PanelPlace> panels;  // place of each ClothPanel in the atlas
  std::vector<int> vertex_panels;  // the panel of each vertex
};
// Makes shirt and trousers for a body, with level of detail `shape.parameters().level`.
[[nodiscard]] Clothes MakeClothes(const BodyShape& shape);

// Makes a pair of shoes and the belt as one skinned mesh in the rest pose.
[[nodiscard]] character::Mesh MakeLeather(const BodyShape& shape);

// Appends both hands, skinned, to `skin`, the skin of the head. Their UVs fill the part of the
// head's atlas between the two ears.
void AddHands(const BodyShape& shape, character::Mesh* skin);

}  // namespace furrow::authoring
