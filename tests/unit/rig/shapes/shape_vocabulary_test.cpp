// SPDX-License-Identifier: Apache-2.0
#include "rig/shapes/shape_vocabulary.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/unit/rig/shapes/shipped_shape_maps.h"

namespace furrow::rig {
namespace {

TEST(ShapeVocabulary, EveryMapRecognisesItsOwnNames) {
  const ShapeMatcher matcher = ShippedShapeMatcher();
  for (const ShapeVocabulary& vocabulary : matcher.vocabularies()) {
    const auto names = NamesOf(vocabulary.map());
    const VocabularyFit fit = vocabulary.Fit(names);
    EXPECT_EQ(fit.explained, static_cast<int>(names.size())) << vocabulary.map().name;
    EXPECT_EQ(fit.exact, fit.explained) << vocabulary.map().name;
    EXPECT_EQ(fit.unexplained, 0);
    const ShapeVocabulary* best = matcher.VocabularyOf(names);
    ASSERT_NE(best, nullptr);
    EXPECT_EQ(best->map().name, vocabulary.map().name);
  }
}

TEST(ShapeVocabulary, RealNamesMatchTheirVocabulary) {
  const ShapeMatcher matcher = ShippedShapeMatcher();
  for (RealNames list : RealNameLists()) {
    for (int order = 0; order < 2; ++order) {
      const ShapeVocabulary* best = matcher.VocabularyOf(list.names);
      ASSERT_NE(best, nullptr) << list.names[0];
      EXPECT_EQ(best->map().name, list.map) << list.names[0];
      std::ranges::reverse(list.names);
    }
  }
}

TEST(ShapeVocabulary, FindsNoSimilarNames) {
  const ShapeVocabulary arkit(ShippedShapeMaps().front());
  for (const char* name : {"", "eyeBlinkLef", "eyeBlinkLeftt", "jaw", "smile", "mouthSmile_X"}) {
    EXPECT_EQ(arkit.Find(name).shape, -1) << name;
  }
  std::string long_name(300, 'x');
  long_name += ".jawOpen";
  EXPECT_EQ(arkit.Find(long_name).shape, -1);
  EXPECT_GE(arkit.Find("ARKit_jaw_open").shape, 0);
  EXPECT_FALSE(arkit.Find("ARKit_jaw_open").exact);
  EXPECT_TRUE(arkit.Find("JAWOPEN").exact);
}

TEST(ShapeVocabulary, AFewMatchesAreNoVocabulary) {
  const ShapeMatcher matcher = ShippedShapeMatcher();
  EXPECT_EQ(matcher.VocabularyOf(std::vector<std::string>{"A", "cameraZoom", "hatSize"}), nullptr);
  EXPECT_EQ(matcher.VocabularyOf({}), nullptr);
}

}  // namespace
}  // namespace furrow::rig
