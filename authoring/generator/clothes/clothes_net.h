// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/body/body_shape.h"
#include "authoring/generator/mesh/quad_net.h"

namespace furrow::character::generator {

// The pieces that clothes are cut from; each is one panel of the atlas.
enum ClothPanel {
  kShirtFront,
  kShirtBack,
  kSleeveLeft,
  kSleeveRight,
  kCollarStand,
  kCollarLeaf,
  kCollarLining,
  kTrousersLeft,
  kTrousersRight,
  kNumClothPanels,
};

// A shirt in the modelling pose with its influences, tucked in: trunk and sleeves are one surface
// that is sewn at the armholes, at the sides and along the inside of the arms; the collar stands on
// its neckline.
[[nodiscard]] QuadNet MakeShirt(const BodyShape& shape);

// The collar on a neckline that runs once round the neck from the middle of the front (columns of
// points, counter-clockwise from above); its leaf lies on `shirt`.
void AddCollar(const Solid& shirt, const std::vector<int>& neckline, QuadNet* net);

// Trousers in the modelling pose with their influences: each leg is a panel that runs from the hem
// to the waist, sewn along the inside of the leg and the middle of the front and the back.
[[nodiscard]] QuadNet MakeTrousers(const BodyShape& shape);

}  // namespace furrow::character::generator
