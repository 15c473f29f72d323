// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/head/head_mesh.h"
#include "authoring/generator/head/head_shape.h"

// Parts of the face that are separate meshes, in model space and the rest pose.
namespace furrow::authoring {

// Both eyeballs with their corneas, side by side in one atlas, looking along +Z.
[[nodiscard]] HeadMesh MakeEyes();

// The lashes of the four lids of a head.
[[nodiscard]] HeadMesh MakeLashes(const HeadShape& shape = DefaultHead());

// Both rows of teeth, with gums.
[[nodiscard]] HeadMesh MakeTeeth();

// The tongue. It lies between the lower teeth and follows the jaw.
[[nodiscard]] HeadMesh MakeTongue();

}  // namespace furrow::authoring
