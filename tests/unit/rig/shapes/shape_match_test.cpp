// SPDX-License-Identifier: Apache-2.0
#include "rig/shapes/shape_match.h"

#include <algorithm>
#include <limits>
#include <map>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/rig/shapes/shipped_shape_maps.h"

namespace furrow::rig {
namespace {

using Names = std::vector<std::string>;
using Values = std::map<std::string, float>;
using ShapeBy = ShapeMatch::By;

const ShapeMatcher& Matcher() {
  static const ShapeMatcher matcher = ShippedShapeMatcher();
  return matcher;
}

// The weights of `targets` for a stream of these names and values.
Values Weights(const ShapeMatcher& matcher, const Names& stream, const std::vector<float>& values,
               const Names& targets) {
  const ShapeMatch match = matcher.Match(stream, targets);
  std::vector<float> weights(targets.size(), -9.0f);
  EXPECT_EQ(match.program.Run(values, weights), wrinkle::JobStatus::kOk);
  Values result;
  for (std::size_t i = 0; i < targets.size(); ++i) result[targets[i]] = weights[i];
  return result;
}

Values Weights(const Values& stream, const Names& targets) {
  Names names;
  std::vector<float> values;
  for (const auto& [name, value] : stream) {
    names.push_back(name);
    values.push_back(value);
  }
  return Weights(Matcher(), names, values, targets);
}

// Random coefficients in ARKit's order. A closed mouth never exceeds the open jaw, as on a phone.
std::vector<float> RandomFace(std::mt19937* random) {
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  std::vector<float> values(kNumArkitShapes);
  for (float& value : values) value = unit(*random);
  auto& close = values[static_cast<std::size_t>(FindArkitShape("mouthClose"))];
  close = std::min(close, values[static_cast<std::size_t>(FindArkitShape("jawOpen"))]);
  return values;
}

TEST(ShapeMatch, EqualNamesGiveTheBitsOfByName) {
  std::mt19937 random(1);
  const Names stream = ArkitNamesForTests();
  Names targets = stream;
  std::ranges::reverse(targets);
  for (std::string& name : targets) name[0] = static_cast<char>(std::toupper(name[0]));
  const ShapeMatch match = Matcher().Match(stream, targets);
  EXPECT_EQ(match.num_mapped(), 0);
  EXPECT_EQ(Describe(match), "");
  const auto plain = wrinkle::ShapeProgram::ByName(stream, targets);
  for (int i = 0; i < 20; ++i) {
    std::vector<float> values = RandomFace(&random);
    values[3] = 1.7f;
    values[4] = -0.3f;
    std::vector<float> a(targets.size());
    std::vector<float> b(targets.size());
    ASSERT_EQ(match.program.Run(values, a), wrinkle::JobStatus::kOk);
    ASSERT_EQ(plain.Run(values, b), wrinkle::JobStatus::kOk);
    EXPECT_EQ(a, b);
  }
}

TEST(ShapeMatch, VrmPresetsMoveArkit) {
  const Names targets = ArkitNamesForTests();
  const Values joy = Weights({{"Joy", 1}, {"A", 0}, {"Blink", 0}, {"Blink_L", 0}}, targets);
  EXPECT_FLOAT_EQ(joy.at("mouthSmileLeft"), 1.0f);
  EXPECT_FLOAT_EQ(joy.at("cheekSquintRight"), 0.25f);
  EXPECT_FLOAT_EQ(joy.at("jawOpen"), 0.0f);
  const Values a = Weights({{"Joy", 0}, {"A", 0.5f}, {"Blink", 1}, {"Blink_L", 0.5f}}, targets);
  EXPECT_FLOAT_EQ(a.at("jawOpen"), 0.4f);
  EXPECT_FLOAT_EQ(a.at("eyeBlinkLeft"), 1.0f);
  EXPECT_FLOAT_EQ(a.at("eyeBlinkRight"), 1.0f);
}

TEST(ShapeMatch, PresetsPassBetweenVersionsOfVrm) {
  const Values old = Weights({{"Joy", 0.3f}, {"A", 0.7f}, {"Blink_L", 0.2f}, {"Sorrow", 0.1f}},
                             {"happy", "aa", "blinkLeft", "sad", "surprised"});
  EXPECT_EQ(old.at("happy"), 0.3f);
  EXPECT_EQ(old.at("aa"), 0.7f);
  EXPECT_EQ(old.at("blinkLeft"), 0.2f);
  EXPECT_EQ(old.at("sad"), 0.1f);
  const Values vroid = Weights({{"Joy", 0.3f}, {"A", 0.7f}, {"Blink_L", 0.2f}},
                               {"Fcl_ALL_Joy", "Fcl_MTH_A", "Fcl_EYE_Close_L"});
  EXPECT_EQ(vroid.at("Fcl_ALL_Joy"), 0.3f);
  EXPECT_EQ(vroid.at("Fcl_EYE_Close_L"), 0.2f);
}

TEST(ShapeMatch, ArkitMovesEachVocabulary) {
  const auto one = [](const std::string& name, const Names& targets) {
    Values stream;
    for (const std::string& arkit : ArkitNamesForTests())
      stream[arkit] = arkit == name ? 1.0f : 0.0f;
    return Weights(stream, targets);
  };
  EXPECT_EQ(one("eyeLookInLeft", {"Eye_L_Look_L", "Eye_L_Look_R", "Jaw_L", "Cheek_Raise_L"})
                .at("Eye_L_Look_R"),
            1.0f);
  EXPECT_EQ(
      one("eyeLookInLeft", {"Eye_Left_Left", "Eye_Left_Right", "Mouth_Pout"}).at("Eye_Left_Right"),
      1.0f);
  EXPECT_EQ(one("eyeLookInLeft", {"CTRL_expressions_eyeLookRightL", "CTRL_expressions_jawFwd",
                                  "CTRL_expressions_eyeLookLeftL"})
                .at("CTRL_expressions_eyeLookRightL"),
            1.0f);
  EXPECT_EQ(one("mouthPucker", {"CTRL_expressions_mouthFunnelUL", "CTRL_expressions_jawFwd",
                                "CTRL_expressions_mouthLipsTowardsDR"}),
            (Values{{"CTRL_expressions_mouthFunnelUL", 0.75f},
                    {"CTRL_expressions_jawFwd", 0.0f},
                    {"CTRL_expressions_mouthLipsTowardsDR", 0.41f}}));
  EXPECT_EQ(one("browInnerUp", {"A01_Brow_Inner_Up", "A25_Jaw_Open", "A20_Cheek_Puff"})
                .at("A01_Brow_Inner_Up"),
            1.0f);
  EXPECT_EQ(one("mouthSmileRight", {"AU12_R", "AU12_L", "AU26"}).at("AU12_R"), 1.0f);
}

// SRanipal's ape shape is a closed mouth on an open jaw.
TEST(ShapeMatch, TheApeShapeContainsTheJaw) {
  const Values stream = {{"Jaw_Open", 0.2f}, {"Mouth_Ape_Shape", 0.5f}, {"Mouth_Pout", 0.0f}};
  const Values arkit = Weights(stream, {"jawOpen", "mouthClose", "mouthPucker"});
  EXPECT_FLOAT_EQ(arkit.at("jawOpen"), 0.7f);
  EXPECT_FLOAT_EQ(arkit.at("mouthClose"), 0.5f);
  const Values back = Weights({{"jawOpen", 0.7f}, {"mouthClose", 0.5f}, {"mouthPucker", 0.0f}},
                              {"Jaw_Open", "Mouth_Ape_Shape", "Mouth_Pout"});
  EXPECT_FLOAT_EQ(back.at("Jaw_Open"), 0.2f);
  EXPECT_FLOAT_EQ(back.at("Mouth_Ape_Shape"), 0.5f);
}

TEST(ShapeMatch, MouthCloseIsAtMostJawOpen) {
  const Values stream = {{"mouth_close", 0.9f}, {"jaw_open", 0.4f}, {"mouth_pucker", 0.0f}};
  EXPECT_FLOAT_EQ(Weights(stream, {"mouthClose", "jawOpen"}).at("mouthClose"), 0.4f);
  EXPECT_FLOAT_EQ(Weights(stream, {"jawOpen", "mouthClose"}).at("mouthClose"), 0.4f);
  // By its own name it stays as it is.
  const Values own = {{"mouthClose", 0.9f}, {"jawOpen", 0.4f}, {"mouthPucker", 0.0f}};
  EXPECT_FLOAT_EQ(Weights(own, {"mouthClose", "jawOpen"}).at("mouthClose"), 0.9f);
}

// Ready Player Me's avatars have ARKit's shapes, visemes and shapes for both sides at once.
TEST(ShapeMatch, AFaceWithTwoVocabulariesMovesOnce) {
  Names targets = ArkitNamesForTests();
  for (const char* more : {"viseme_aa", "viseme_O", "mouthSmile", "mouthOpen", "eyesClosed"}) {
    targets.emplace_back(more);
  }
  Values stream;
  for (const std::string& name : ArkitNamesForTests()) stream[name] = 1.0f;
  const Values face = Weights(stream, targets);
  EXPECT_EQ(face.at("jawOpen"), 1.0f);
  for (const char* more : {"viseme_aa", "viseme_O", "mouthSmile", "mouthOpen", "eyesClosed"}) {
    EXPECT_EQ(face.at(more), 0.0f) << more;
  }
  const ShapeMatch match = Matcher().Match(ArkitNamesForTests(), targets);
  EXPECT_EQ(match.missing.size(), 5u);
}

// A shape for both eyes takes their mean, not their sum.
TEST(ShapeMatch, MeansAreMeans) {
  const Values half = {{"eyeBlinkLeft", 0.5f}, {"eyeBlinkRight", 0.5f}, {"jawOpen", 0.0f}};
  EXPECT_FLOAT_EQ(Weights(half, {"blink", "happy", "aa"}).at("blink"), 0.5f);
  const Values wink = {{"eyeBlinkLeft", 1.0f}, {"eyeBlinkRight", 0.0f}, {"jawOpen", 0.0f}};
  EXPECT_FLOAT_EQ(Weights(wink, {"eyesClosed", "jawOpen"}).at("eyesClosed"), 0.5f);
  const Values brow = {{"BrowLowererLeft", 0.4f}, {"BrowPinchLeft", 0.8f}, {"EyeClosedLeft", 0.0f}};
  EXPECT_FLOAT_EQ(Weights(brow, {"browDownLeft"}).at("browDownLeft"), 0.5f) << "stated shares";
}

TEST(ShapeMatch, FallbacksFillWhatIsMissingAndAreNamed) {
  // A face without a jaw opens its mouth by a viseme.
  Values stream;
  for (const std::string& name : ArkitNamesForTests()) stream[name] = 0.5f;
  const Names face = {"mouthSmileLeft", "mouthSmileRight", "browInnerUp", "viseme_aa", "viseme_O"};
  const Values weights = Weights(stream, face);
  EXPECT_EQ(weights.at("viseme_aa"), 0.5f);
  const ShapeMatch match = Matcher().Match(ArkitNamesForTests(), face);
  EXPECT_THAT(match.fallbacks,
              testing::ElementsAre("viseme_aa for jawOpen", "viseme_O for mouthPucker"));
  EXPECT_EQ(match.by.at(3), ShapeBy::kFallback);
  EXPECT_THAT(Describe(match), testing::HasSubstr("by fallback: viseme_aa for jawOpen, viseme_O"));
  // Half a brow is named as a fallback: the mean lacks a share.
  const ShapeMatch half = Matcher().Match(
      Names{"BrowLowererLeft", "EyeClosedLeft", "MouthCornerPullLeft"}, Names{"browDownLeft"});
  EXPECT_THAT(half.fallbacks, testing::ElementsAre("browDownLeft"));
  EXPECT_THAT(Describe(half), testing::HasSubstr("by fallback: browDownLeft"));
  const Values brow =
      Weights({{"BrowLowererLeft", 0.6f}, {"EyeClosedLeft", 0.0f}, {"MouthCornerPullLeft", 0.0f}},
              {"browDownLeft"});
  EXPECT_FLOAT_EQ(brow.at("browDownLeft"), 0.6f);
}

TEST(ShapeMatch, CorrectivesAreProductsAndTents) {
  const Names targets = {"jawOpen",
                         "mouthSmileLeft",
                         "mouthSmileRight",
                         "jawOpen_mouthSmileLeft",
                         "jawOpen_x_mouthSmileRight",
                         "jawOpen__mouthSmile_L",
                         "jawOpen_mouthSmile_LR",
                         "jawOpen25",
                         "jawOpen50",
                         "mouthSmileLeft_hat"};
  const Values face =
      Weights({{"jawOpen", 0.5f}, {"mouthSmileLeft", 0.5f}, {"mouthSmileRight", 0.25f}}, targets);
  EXPECT_FLOAT_EQ(face.at("jawOpen_mouthSmileLeft"), 0.25f);
  EXPECT_FLOAT_EQ(face.at("jawOpen_x_mouthSmileRight"), 0.125f);
  EXPECT_FLOAT_EQ(face.at("jawOpen__mouthSmile_L"), 0.25f);
  EXPECT_FLOAT_EQ(face.at("jawOpen_mouthSmile_LR"), 0.0625f);
  EXPECT_FLOAT_EQ(face.at("jawOpen50"), 1.0f);
  EXPECT_FLOAT_EQ(face.at("jawOpen25"), 0.0f);
  EXPECT_EQ(face.at("mouthSmileLeft_hat"), 0.0f);
  const Values quarter =
      Weights({{"jawOpen", 0.375f}, {"mouthSmileLeft", 0.0f}, {"mouthSmileRight", 0.0f}}, targets);
  EXPECT_FLOAT_EQ(quarter.at("jawOpen50"), 0.5f);
  EXPECT_FLOAT_EQ(quarter.at("jawOpen25"), 0.5f);
  // The words of a part may themselves be joined by '_'.
  const Values split =
      Weights({{"jawOpen", 0.5f}, {"mouthSmileLeft", 0.5f}, {"mouthSmileRight", 0.0f}},
              {"Jaw_Open", "Mouth_Smile_Left", "Jaw_Open_Mouth_Smile_Left"});
  EXPECT_FLOAT_EQ(split.at("Jaw_Open_Mouth_Smile_Left"), 0.25f);
}

// For every map: raising a coefficient of ARKit never lowers it after the way to the vocabulary and
// back, whatever the rest of the face does.
TEST(ShapeMatch, RoundTripsKeepTheOrder) {
  const Names arkit = ArkitNamesForTests();
  std::mt19937 random(7);
  for (const ShapeMap& map : ShippedShapeMaps()) {
    const Names names = NamesOf(map);
    const auto there = Matcher().Match(arkit, names);
    const auto back = ShapeMatcher(ShippedShapeMaps(), &map).Match(names, arkit);
    const auto trip = [&](const std::vector<float>& face) {
      std::vector<float> own(names.size());
      std::vector<float> result(arkit.size());
      EXPECT_EQ(there.program.Run(face, own), wrinkle::JobStatus::kOk);
      for (const float value : own) EXPECT_TRUE(value >= 0.0f && value <= 1.0f) << map.name;
      EXPECT_EQ(back.program.Run(own, result), wrinkle::JobStatus::kOk);
      return result;
    };
    EXPECT_EQ(trip(std::vector<float>(arkit.size(), 0.0f)), std::vector<float>(arkit.size(), 0.0f))
        << map.name << ": a neutral face stays neutral";
    int responding = 0;
    for (std::size_t shape = 0; shape < arkit.size(); ++shape) {
      std::vector<float> alone(arkit.size(), 0.0f);
      alone[shape] = 1.0f;
      // mouthClose exists on an open jaw only.
      if (arkit[shape] == "mouthClose") alone[17] = 1.0f;
      responding += trip(alone)[shape] > 0.0f ? 1 : 0;
      for (int sample = 0; sample < 20; ++sample) {
        std::vector<float> face = RandomFace(&random);
        float before = -1.0f;
        const float least = arkit[shape] == "jawOpen" ? face[18] : 0.0f;
        const float most = arkit[shape] == "mouthClose" ? face[17] : 1.0f;
        for (int step = 0; step <= 4; ++step) {
          face[shape] = std::lerp(least, most, static_cast<float>(step) / 4.0f);
          const float now = trip(face)[shape];
          EXPECT_GE(now, before - 1e-6f) << map.name << ": " << arkit[shape];
          before = now;
        }
      }
    }
    EXPECT_GE(responding, map.name == "oculus-visemes" ? 8 : 18) << map.name;
  }
}

// A vocabulary that renames all 52 gives their values back unchanged.
TEST(ShapeMatch, RenamedStreamsGiveTheSameWeights) {
  std::mt19937 random(3);
  const Names arkit = ArkitNamesForTests();
  for (int spelling = 0; spelling < 3; ++spelling) {
    for (int sample = 0; sample < 5; ++sample) {
      const std::vector<float> face = RandomFace(&random);
      std::vector<std::size_t> order(arkit.size());
      for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
      std::ranges::shuffle(order, random);
      Names names;
      std::vector<float> values;
      for (const std::size_t i : order) {
        std::string name = arkit[i];
        if (spelling == 1) {
          for (const auto& [from, to] : {std::pair("Left", "_L"), std::pair("Right", "_R")}) {
            if (name.ends_with(from) && name != std::string("jaw") + from &&
                name != std::string("mouth") + from) {
              name.replace(name.size() - std::string(from).size(), std::string::npos, to);
            }
          }
        } else if (spelling == 2) {
          name = "head_geo.ARKit_" + name + ".002";
        }
        names.push_back(name);
        values.push_back(face[i]);
      }
      const Values weights = Weights(Matcher(), names, values, arkit);
      for (std::size_t i = 0; i < arkit.size(); ++i) EXPECT_EQ(weights.at(arkit[i]), face[i]);
    }
  }
}

TEST(ShapeMatch, OrderOfNamesDoesNotMatter) {
  std::mt19937 random(5);
  const Names targets = ArkitNamesForTests();
  for (const ShapeMap& map : ShippedShapeMaps()) {
    Names names = NamesOf(map);
    std::vector<float> values(names.size());
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (float& value : values) value = unit(random);
    const Values expected = Weights(Matcher(), names, values, targets);
    std::vector<std::size_t> order(names.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::shuffle(order, random);
    Names shuffled;
    std::vector<float> moved;
    for (const std::size_t i : order) {
      shuffled.push_back(names[i]);
      moved.push_back(values[i]);
    }
    Names other_targets = targets;
    std::ranges::shuffle(other_targets, random);
    EXPECT_EQ(Weights(Matcher(), shuffled, moved, other_targets), expected) << map.name;
  }
}

TEST(ShapeMatch, SwappingSidesMirrors) {
  std::mt19937 random(11);
  const Names arkit = ArkitNamesForTests();
  for (const ShapeMap& map : ShippedShapeMaps()) {
    const Names names = NamesOf(map);
    const auto there = Matcher().Match(arkit, names);
    const auto back = ShapeMatcher(ShippedShapeMaps(), &map).Match(names, arkit);
    const auto trip = [&](const std::vector<float>& face) {
      std::vector<float> own(names.size());
      std::vector<float> result(arkit.size());
      EXPECT_EQ(there.program.Run(face, own), wrinkle::JobStatus::kOk);
      EXPECT_EQ(back.program.Run(own, result), wrinkle::JobStatus::kOk);
      return result;
    };
    const auto mirrored = [](const std::vector<float>& face) {
      std::vector<float> other(face.size());
      for (int i = 0; i < kNumArkitShapes; ++i) {
        other[static_cast<std::size_t>(MirroredArkitShape(i))] = face[static_cast<std::size_t>(i)];
      }
      return other;
    };
    for (int sample = 0; sample < 10; ++sample) {
      const std::vector<float> face = RandomFace(&random);
      const auto a = trip(mirrored(face));
      const auto b = mirrored(trip(face));
      for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_NEAR(a[i], b[i], 1e-6f) << map.name << ": " << arkit[i];
      }
    }
  }
}

TEST(ShapeMatch, OddInputsAreHarmless) {
  const Names targets = ArkitNamesForTests();
  const Names stream = {"Joy", "joy", "", "A", "Blink", std::string(5000, 'x'), "Fun", "A"};
  const ShapeMatch match = Matcher().Match(stream, targets);
  std::vector<float> weights(targets.size(), 7.0f);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(match.program.Run(std::vector<float>{nan, 0, 0, 0, 0, 0, 0, 0}, weights),
            wrinkle::JobStatus::kNonFinite);
  EXPECT_EQ(weights, std::vector<float>(targets.size(), 7.0f));
  for (const float odd : {-5.0f, 7.0f, 1e30f, -1e30f}) {
    const std::vector<float> values(stream.size(), odd);
    ASSERT_EQ(match.program.Run(values, weights), wrinkle::JobStatus::kOk);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      EXPECT_TRUE(weights[i] >= 0.0f && weights[i] <= 1.0f) << targets[i] << ": " << weights[i];
    }
  }
  // Fewer coefficients than names.
  ASSERT_EQ(match.program.Run(std::vector<float>{1.0f}, weights), wrinkle::JobStatus::kOk);
  EXPECT_EQ(weights[static_cast<std::size_t>(FindArkitShape("mouthSmileLeft"))], 1.0f);
  EXPECT_EQ(Matcher().Match({}, targets).missing.size(), targets.size());
  EXPECT_TRUE(Matcher().Match(stream, {}).program.empty());
  EXPECT_TRUE(ShapeMatcher().Match(stream, targets).program.empty());
}

TEST(ShapeMatch, SaysWhatItDid) {
  const ShapeMatch match = Matcher().Match(Names{"Joy", "A", "Blink", "Custom"},
                                           Names{"mouthSmileLeft", "jawOpen", "tongueOut"});
  EXPECT_EQ(match.stream_map, "vrm0");
  EXPECT_EQ(match.target_map, "arkit");
  EXPECT_THAT(match.unknown, testing::ElementsAre("Custom"));
  EXPECT_EQ(Describe(match),
            "shape map 'vrm0' to 'arkit': 2 of 3 blend shapes; missing: tongueOut");
}

TEST(ShapeMatch, AChosenMapNeedsNoMinimum) {
  const auto maps = ShippedShapeMaps();
  const auto vrm0 = std::ranges::find(maps, "vrm0", &ShapeMap::name);
  const ShapeMatch match = ShapeMatcher(maps, &*vrm0).Match(Names{"Joy"}, Names{"mouthSmileLeft"});
  EXPECT_EQ(match.by.at(0), ShapeBy::kFormula);
  EXPECT_EQ(Matcher().Match(Names{"Joy"}, Names{"mouthSmileLeft"}).by.at(0), ShapeBy::kNothing);
}

// Apple's mouthClose brings the lips together on an open jaw. A face does nothing with the rest.
TEST(ShapeMatch, MouthCloseOfAFaceNeedsAnOpenJaw) {
  const ShapeMatcher matcher = ShippedShapeMatcher();
  const std::vector<std::string> names = ArkitNamesForTests();
  const auto close = static_cast<std::size_t>(FindArkitShape("mouthClose"));
  const auto jaw = static_cast<std::size_t>(FindArkitShape("jawOpen"));
  std::vector<float> sent(names.size(), 0.0f), face(names.size()), rig(names.size());
  sent[close] = 0.8f;
  for (const float open : {0.0f, 0.3f, 1.0f}) {
    sent[jaw] = open;
    ASSERT_EQ(matcher.MatchFace(names, names).program.Run(sent, face), wrinkle::JobStatus::kOk);
    ASSERT_EQ(matcher.Match(names, names).program.Run(sent, rig), wrinkle::JobStatus::kOk);
    EXPECT_FLOAT_EQ(face[close], std::min(open, 0.8f));
    EXPECT_FLOAT_EQ(rig[close], 0.8f) << "rigs read what the stream sends";
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (i == close) continue;
      EXPECT_EQ(face[i], sent[i]);
    }
  }
}

Values FaceWeights(const Values& stream, const Names& shapes,
                   const std::vector<wrinkle::ShapeRule>& rules = {}) {
  Names names;
  std::vector<float> values;
  for (const auto& [name, value] : stream) {
    names.push_back(name);
    values.push_back(value);
  }
  const ShapeMatch match = Matcher().MatchFace(names, shapes, rules);
  std::vector<float> weights(shapes.size(), -9.0f);
  EXPECT_EQ(match.program.Run(values, weights), wrinkle::JobStatus::kOk);
  Values result;
  for (std::size_t i = 0; i < shapes.size(); ++i) result[shapes[i]] = weights[i];
  return result;
}

// A closing lid must not go through the eye, whatever the shapes are called. Rigs read the stream.
TEST(ShapeMatch, LidsOfAFaceFadeAsTheEyeCloses) {
  const Values wink = {{"eyeBlinkLeft", 0.5f},    {"eyeBlinkRight", 0.0f},
                       {"eyeSquintLeft", 1.0f},   {"eyeSquintRight", 0.7f},
                       {"eyeLookDownLeft", 0.4f}, {"eyeLookDownRight", 0.4f},
                       {"eyeWideLeft", 0.3f}};
  Names arkit;
  for (const auto& [name, value] : wink) arkit.push_back(name);
  const Values face = FaceWeights(wink, arkit);
  EXPECT_FLOAT_EQ(face.at("eyeSquintLeft"), 0.6f);
  EXPECT_EQ(face.at("eyeSquintRight"), 0.7f) << "the other eye keeps its bits";
  EXPECT_FLOAT_EQ(face.at("eyeLookDownLeft"), 0.2f);
  EXPECT_EQ(face.at("eyeLookDownRight"), 0.4f);
  EXPECT_EQ(face.at("eyeWideLeft"), 0.3f);
  EXPECT_EQ(Weights(wink, arkit), wink) << "rigs read what the stream sends";
  const Values cc = FaceWeights(
      wink, {"Eye_Blink_L", "Eye_Blink_R", "Eye_Squint_L", "Eye_Squint_R", "Eye_L_Look_Down"});
  EXPECT_FLOAT_EQ(cc.at("Eye_Squint_L"), 0.6f);
  EXPECT_EQ(cc.at("Eye_Squint_R"), 0.7f);
  EXPECT_FLOAT_EQ(cc.at("Eye_L_Look_Down"), 0.2f);
  // A blink by a preset closes the lids of ARKit's squint, too.
  const Values vrm = FaceWeights({{"blink", 1.0f}, {"eyeSquintLeft", 1.0f}, {"lookDown", 1.0f}},
                                 {"blink", "eyeSquintLeft", "lookDown"});
  EXPECT_FLOAT_EQ(vrm.at("eyeSquintLeft"), 0.2f);
  EXPECT_FLOAT_EQ(vrm.at("lookDown"), 0.0f);
}

// The face's mouthClose opens the jaw itself, as Audio2Face's does.
TEST(ShapeMatch, AMouthCloseThatContainsTheJawTakesItBack) {
  const Names face = {"mouthClose", "jawOpen", "mouthPucker"};
  const std::vector<wrinkle::ShapeRule> rules = {{.shape = 0, .contains = 1}};
  const auto weights = [&](float jaw, float close) {
    return FaceWeights({{"jawOpen", jaw}, {"mouthClose", close}, {"mouthPucker", 0.5f}}, face,
                       rules);
  };
  EXPECT_EQ(weights(1.0f, 1.0f),
            (Values{{"mouthClose", 1.0f}, {"jawOpen", 0.0f}, {"mouthPucker", 0.5f}}));
  EXPECT_FLOAT_EQ(weights(0.7f, 0.2f).at("jawOpen"), 0.5f);
  EXPECT_FLOAT_EQ(weights(0.7f, 0.2f).at("mouthClose"), 0.2f);
  EXPECT_FLOAT_EQ(weights(0.3f, 0.8f).at("jawOpen"), 0.0f);
  EXPECT_FLOAT_EQ(weights(0.3f, 0.8f).at("mouthClose"), 0.3f) << "no more than the jaw";
  // By other names, from a stream whose mouthClose contains the jaw as well.
  const Values ape =
      FaceWeights({{"Jaw_Open", 0.2f}, {"Mouth_Ape_Shape", 0.5f}, {"Mouth_Pout", 0.0f}},
                  {"mouthClosed", "jawOpen", "mouthPucker"}, rules);
  EXPECT_FLOAT_EQ(ape.at("jawOpen"), 0.2f);
  EXPECT_FLOAT_EQ(ape.at("mouthClosed"), 0.5f);
}

// VRM's override rules act on what a shape means.
TEST(ShapeMatch, RulesOfAFaceLimitShapesByMeaning) {
  using Limits = wrinkle::ShapeRule::Limits;
  const Names shapes = {"happy", "eyeBlinkLeft", "eyeLookUpLeft", "jawOpen", "browInnerUp", "fun"};
  Values stream;
  for (const std::string& name : shapes) stream[name] = 0.5f;
  const Values blocked = FaceWeights(
      stream, shapes, {{.shape = 0, .limits = {Limits::kBlock, Limits::kBlock, Limits::kBlock}}});
  EXPECT_EQ(blocked, (Values{{"happy", 0.5f},
                             {"eyeBlinkLeft", 0.0f},
                             {"eyeLookUpLeft", 0.0f},
                             {"jawOpen", 0.0f},
                             {"browInnerUp", 0.5f},
                             {"fun", 0.5f}}));
  const Values faded = FaceWeights(
      stream, shapes, {{.shape = 0, .limits = {Limits::kBlend, Limits::kNothing, Limits::kBlend}}});
  EXPECT_FLOAT_EQ(faded.at("eyeBlinkLeft"), 0.25f);
  EXPECT_FLOAT_EQ(faded.at("eyeLookUpLeft"), 0.5f);
  EXPECT_FLOAT_EQ(faded.at("jawOpen"), 0.25f);
}

// A coefficient of 1 is a gaze of 30 degrees. A look that the stream sends is a weight already.
TEST(ShapeMatch, LooksFollowTheRangesOfTheAvatar) {
  const Names shapes = {"lookUp", "lookLeft", "happy"};
  const std::vector<wrinkle::ShapeRule> rules = {
      {.shape = 0, .gaze = wrinkle::ShapeRule::Gaze{.input = 60.0f, .output = 0.8f}},
      {.shape = 1, .gaze = wrinkle::ShapeRule::Gaze{.input = 10.0f, .output = 1.0f}},
      {.shape = 2, .gaze = wrinkle::ShapeRule::Gaze{.input = 60.0f, .output = 0.1f}}};
  const Values gaze = {{"eyeLookUpLeft", 0.5f},   {"eyeLookUpRight", 0.5f},
                       {"eyeLookOutLeft", 0.2f},  {"eyeLookInRight", 0.2f},
                       {"mouthSmileLeft", 1.0f},  {"mouthSmileRight", 1.0f},
                       {"cheekSquintLeft", 1.0f}, {"cheekSquintRight", 1.0f}};
  const Values face = FaceWeights(gaze, shapes, rules);
  EXPECT_FLOAT_EQ(face.at("lookUp"), 0.8f * 15.0f / 60.0f);
  EXPECT_FLOAT_EQ(face.at("lookLeft"), 0.6f);
  EXPECT_FLOAT_EQ(face.at("happy"), 1.0f) << "not a look";
  EXPECT_EQ(FaceWeights({{"LookUp", 0.5f}, {"LookLeft", 0.2f}, {"Joy", 0.0f}}, shapes, rules)
                .at("lookUp"),
            0.5f);
}

// An eyeball that a shape turns must not be turned by its joint as well, whatever the shape's name.
TEST(ShapeMatch, AllNamesOfAFaceIncludeArkits) {
  const std::vector<std::string> shapes = {"Eye_L_Look_R", "Jaw_Open", "Brow_Drop_L", "scar"};
  const std::vector<std::string> names = ShippedShapeMatcher().AllNamesOf(shapes);
  EXPECT_THAT(names, testing::ElementsAre("Eye_L_Look_R", "Jaw_Open", "Brow_Drop_L", "scar",
                                          "eyeLookInLeft", "jawOpen", "browDownLeft"));
  EXPECT_EQ(ShapeMatcher().AllNamesOf(shapes), shapes);
}

}  // namespace
}  // namespace furrow::rig
