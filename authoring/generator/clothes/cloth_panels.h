// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow::authoring {

// The pieces that shirt and trousers are cut from. Each is one panel of the clothes' atlas.
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

}  // namespace furrow::authoring
