// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/clothes/clothes.h"

#include <glm/vec2.hpp>

#include "authoring/generator/body/body_skinning.h"
#include "authoring/generator/body/hand_net.h"
#include "authoring/generator/clothes/cloth_panels.h"
#include "authoring/generator/clothes/leather_net.h"
#include "authoring/generator/clothes/shirt_net.h"
#include "authoring/generator/clothes/trousers_net.h"
#include "authoring/generator/mesh/mesh_tools.h"

namespace furrow::authoring {
namespace {

// The place of the hands in the atlas of the head's skin: low and high corner.
constexpr glm::vec2 kHandsLow{0.415f, 0.876f};
constexpr glm::vec2 kHandsHigh{0.583f, 0.991f};

}  // namespace

Clothes MakeClothes(const BodyShape& shape) {
  QuadNet net = MakeShirt(shape);
  Join(MakeTrousers(shape), &net);
  FlattenPanels(&net);
  Clothes clothes;
  clothes.panels = PackPanels(0.006f, &net);
  CarryToRest(shape, &net);
  clothes.mesh.name = "clothes";
  AppendNet(net, &clothes.mesh);
  FinishSurface(&clothes.mesh);
  for (const QuadNet::Corner& corner : net.corners) clothes.vertex_panels.push_back(corner.panel);
  return clothes;
}

character::Mesh MakeLeather(const BodyShape& shape) {
  QuadNet net = MakeShoe(shape, 1.0f, 0);
  Join(MakeShoe(shape, -1.0f, 2), &net);
  Join(MakeBelt(shape, 4), &net);
  FlattenPanels(&net);
  static_cast<void>(PackPanels(0.01f, &net));
  character::Mesh mesh;
  mesh.name = "leather";
  AppendNet(net, &mesh);
  FinishSurface(&mesh);
  return mesh;
}

void AddHands(const BodyShape& shape, character::Mesh* skin) {
  const int level = shape.parameters().level;
  QuadNet net = MakeHand(shape.skeleton(), 1.0f, 0, level);
  Join(MakeHand(shape.skeleton(), -1.0f, 2, level), &net);
  FlattenPanels(&net);
  static_cast<void>(PackPanels(0.02f, &net));
  for (QuadNet::Corner& corner : net.corners) {
    corner.uv = kHandsLow + corner.uv * (kHandsHigh - kHandsLow);
  }
  AppendNet(net, skin);
}

}  // namespace furrow::authoring
