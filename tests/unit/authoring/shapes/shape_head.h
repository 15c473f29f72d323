// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "authoring/generator/blend_shapes/blend_shape_face.h"
#include "authoring/generator/default_character.h"
#include "rig/rig_file.h"

namespace furrow::authoring {

// The default head with ARKit's 52 shapes, with small textures. On an error the test fails.
[[nodiscard]] inline character::Character MakeShapeHead() {
  const auto rig = rig::LoadRig(FURROW_SOURCE_DIR "/rig/rigs/default.json");
  EXPECT_TRUE(rig.ok()) << rig.status().ToString();
  if (!rig.ok()) return {};
  character::Character head = MakeDefaultCharacter(*rig, {.texture_size = 64});
  EXPECT_TRUE(MakeBlendShapeFace(&head).ok());
  return head;
}

}  // namespace furrow::authoring
