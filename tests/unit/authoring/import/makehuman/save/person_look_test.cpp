// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/save/person_look.h"

#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

PersonLook WithSkin(const char* skin) {
  MhmSave save;
  save.modifiers = {{"macrodetails/African", 0.0f}, {"macrodetails/Age", 0.75f}};
  save.skin_material = skin;
  return LookOf(save);
}

TEST(LookOf, FollowsTheMacrosOrTheNameOfTheSkin) {
  const PersonLook plain = WithSkin("skins/default.mhmat");
  EXPECT_FLOAT_EQ(plain.old, 0.5f);
  EXPECT_FLOAT_EQ(plain.asian, 0.5f);
  EXPECT_FLOAT_EQ(plain.african, 0.0f);
  const PersonLook african = WithSkin("skins/old_african_female/old_african_female.mhmat");
  EXPECT_FLOAT_EQ(african.old, 0.8f);
  EXPECT_FLOAT_EQ(african.asian, 0.0f);
  EXPECT_FLOAT_EQ(african.african, 1.0f);
  // "caucasian" contains "asian".
  EXPECT_FLOAT_EQ(WithSkin("skins/young_caucasian_male/x.mhmat").asian, 0.0f);
  EXPECT_FLOAT_EQ(WithSkin("skins/young_asian_male/x.mhmat").asian, 1.0f);
  EXPECT_FLOAT_EQ(WithSkin("skins/middleage_asian_male/x.mhmat").old, 0.5f);
}

}  // namespace
}  // namespace furrow::authoring
