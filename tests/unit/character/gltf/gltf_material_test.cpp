// SPDX-License-Identifier: Apache-2.0
#include "character/gltf/gltf_material.h"

#include <utility>

#include <gtest/gtest.h>

namespace furrow::character {
namespace {

using Kind = Material::Kind;

// Names that Ready Player Me, VRoid Studio, Character Creator and MakeHuman write.
TEST(GltfMaterial, NamesTellTheKind) {
  const std::pair<const char*, Kind> kNames[] = {
      {"Wolf3D_Skin", Kind::kSkin},
      {"Wolf3D_Body", Kind::kSkin},
      {"Wolf3D_Eye", Kind::kEye},
      {"Wolf3D_Hair", Kind::kHair},
      {"Wolf3D_Teeth", Kind::kOther},
      {"Wolf3D_Glasses", Kind::kOther},
      {"Wolf3D_Outfit_Top", Kind::kCloth},
      {"Wolf3D_Outfit_Footwear", Kind::kOther},
      {"N00_000_00_Face_00_SKIN (Instance)", Kind::kSkin},
      {"N00_000_00_FaceMouth_00_FACE (Instance)", Kind::kOther},
      {"N00_000_00_FaceBrow_00_FACE (Instance)", Kind::kHair},
      {"N00_008_01_Shoes_01_CLOTH_01 (Instance)", Kind::kOther},
      {"N00_007_01_Tops_01_CLOTH_01 (Instance)", Kind::kCloth},
      {"Std_Eyelash", Kind::kHair},
      {"Std_Tongue", Kind::kOther},
      {"Std_Skin_Head", Kind::kSkin},
      {"male_casualsuit01", Kind::kCloth},
      {"lambert1", Kind::kOther},
      {"", Kind::kOther}};
  for (const auto& [name, kind] : kNames) EXPECT_EQ(GuessMaterialKind(name), kind) << name;
}

}  // namespace
}  // namespace furrow::character
