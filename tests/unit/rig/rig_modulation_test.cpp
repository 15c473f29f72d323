// SPDX-License-Identifier: Apache-2.0
// Reads and writes the modulation of regions and of their maps.
#include <string>

#include <gtest/gtest.h>

#include "rig/rig_file.h"

namespace furrow::rig {
namespace {

// A rig with one region. `region` and `feed`: more fields of both, each after a comma.
Result<wrinkle::Rig> ParseCurves(const std::string& region, const std::string& feed) {
  const std::string json = R"({"name": "jaw",
    "drivers": [{"name": "jaw", "blend_shape": {"blend_shape": "jawOpen"}}],
    "wrinkle_maps": [{"name": "folds"}],
    "regions": [{"name": "chin", "mask": {"kind": "skinning"})" +
                           region + R"(,
      "feeds": [{"map": "folds", "sources": [{"from": "jaw.value"}])" +
                           feed + "}]}]}";
  return ParseRig(json, "jaw.rig.json", ".");
}

TEST(ModulationInARig, ReadsNamesAndCurvesAndWritesThemBack) {
  using Points = std::vector<wrinkle::CurvePoint>;
  const auto rig = ParseCurves(R"(, "curve": [[0, 0], [0.3, 0.4], {"x": 1, "y": 1}])",
                               R"(, "modulation": "cosine")");
  ASSERT_TRUE(rig.ok()) << rig.status().ToString();
  const wrinkle::Region& region = rig->regions[0];
  EXPECT_EQ(region.curve, (Points{{0.0f, 0.0f}, {0.3f, 0.4f}, {1.0f, 1.0f}}));
  EXPECT_EQ(region.feeds[0].modulation, wrinkle::Modulation::kCosine);
  const std::string text = RigToJson(*rig);
  EXPECT_NE(text.find(R"("curve": [[0, 0], [0.3, 0.4], [1, 1]])"), std::string::npos) << text;
  const auto again = ParseRig(text, "again.rig.json", ".");
  ASSERT_TRUE(again.ok()) << again.status().ToString();
  EXPECT_EQ(again->regions[0].curve, region.curve);
  EXPECT_EQ(again->regions[0].feeds[0].modulation, wrinkle::Modulation::kCosine);

  const auto other =
      ParseCurves(R"(, "modulation": "linear")", R"(, "curve": [[0, 0.1], [0.9, 1]])");
  ASSERT_TRUE(other.ok()) << other.status().ToString();
  const auto other_again = ParseRig(RigToJson(*other), "again.rig.json", ".");
  ASSERT_TRUE(other_again.ok()) << other_again.status().ToString();
  EXPECT_EQ(other_again->regions[0].modulation, wrinkle::Modulation::kLinear);
  EXPECT_TRUE(other_again->regions[0].curve.empty());
  EXPECT_FALSE(other_again->regions[0].feeds[0].modulation.has_value());
  EXPECT_EQ(other_again->regions[0].feeds[0].curve, (Points{{0.0f, 0.1f}, {0.9f, 1.0f}}));
}

TEST(ModulationInARig, IsCosineByDefaultAndNotWritten) {
  const auto rig = ParseCurves("", "");
  ASSERT_TRUE(rig.ok()) << rig.status().ToString();
  EXPECT_EQ(rig->regions[0].modulation, wrinkle::Modulation::kCosine);
  EXPECT_FALSE(rig->regions[0].feeds[0].modulation.has_value());
  EXPECT_EQ(RigToJson(*rig).find("modulation"), std::string::npos);
  EXPECT_EQ(RigToJson(*rig).find("curve"), std::string::npos);
}

struct WrongCurve {
  const char* field;
  StatusCode code;
  const char* where;  // after the region or the feed
};

// In a region and in a feed alike.
TEST(ModulationInARig, RejectsWhatIsNoCurve) {
  constexpr StatusCode kBadCurve = StatusCode::kInvalidArgument;
  const WrongCurve wrongs[] = {
      {R"(, "curve": [])", kBadCurve, ".curve"},
      {R"(, "curve": [[0, 0]])", kBadCurve, ".curve"},
      {R"(, "curve": [[0, 0], [1, 1]], "modulation": "cosine")", kBadCurve, ".curve"},
      {R"(, "curve": [[0, 0], [1.5, 1]])", kBadCurve, ".curve[1][0]"},
      {R"(, "curve": [[0, -0.5], [1, 1]])", kBadCurve, ".curve[0][1]"},
      {R"(, "curve": [[0, 0], [0.5, 1], [0.5, 0]])", kBadCurve, ".curve[2][0]"},
      {R"(, "curve": [[0, 0], [0.5, 1], [0.4, 0]])", kBadCurve, ".curve[2][0]"},
      {R"(, "curve": [[0, 0], [0.5, 0.1], [0.509, 1]])", kBadCurve, ".curve[2][0]"},
      {R"(, "curve": [[0, 0], [0.5]])", StatusCode::kSchema, ".curve[1]"},
      {R"(, "curve": [[0, 0], [0.5, "nan"]])", StatusCode::kNonFinite, ".curve[1][1]"},
      {R"(, "curve": [[0, 0], [0.04, 0], [0.08, 0], [0.12, 0], [0.16, 0], [0.2, 0], [0.24, 0],
                      [0.28, 0], [0.32, 0], [0.36, 0], [0.4, 0], [0.44, 0], [0.48, 0], [0.52, 0],
                      [0.56, 0], [0.6, 0], [0.64, 0]])",
       StatusCode::kLimit, ".curve"},
      {R"(, "modulation": 3)", kBadCurve, ".modulation"},
      {R"(, "modulation": "soft")", StatusCode::kSchema, ".modulation"}};
  for (const WrongCurve& wrong : wrongs) {
    const auto ends_with = [](const std::string& text, const std::string& end) {
      return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
    };
    const Status of_region = ParseCurves(wrong.field, "").status();
    EXPECT_EQ(of_region.code(), wrong.code) << of_region.ToString();
    EXPECT_TRUE(ends_with(of_region.where(), std::string("regions[0]") + wrong.where))
        << of_region.ToString();
    const Status of_feed = ParseCurves("", wrong.field).status();
    EXPECT_EQ(of_feed.code(), wrong.code) << of_feed.ToString();
    EXPECT_TRUE(ends_with(of_feed.where(), std::string("regions[0].feeds[0]") + wrong.where))
        << of_feed.ToString();
  }
}

// A step of 0.01 is accepted wherever it lies, although decimals are rounded to floats.
TEST(ModulationInARig, AcceptsTheLeastStepAnywhere) {
  for (int i = 0; i < 99; ++i) {
    const auto number = [](int hundredths) { return std::to_string(hundredths / 100.0); };
    const auto rig =
        ParseCurves(", \"curve\": [[" + number(i) + ", 0], [" + number(i + 1) + ", 1]]", "");
    EXPECT_TRUE(rig.ok()) << rig.status().ToString();
  }
}

// A knee whose map has the field `angles`.
Result<wrinkle::Rig> ParseAngles(const std::string& angles, const std::string& from = "knee.flexed",
                                 const std::string& more = "") {
  const std::string json = R"({"name": "leg",
    "drivers": [
      {"name": "knee", "hinge": {"parent": "hip", "joint": "knee", "axis": [1, 0, 0]}},
      {"name": "jaw", "blend_shape": {"blend_shape": "jawOpen"}}],
    "wrinkle_maps": [{"name": "folds"}],
    "regions": [{"name": "knee", "mask": {"kind": "skinning"},
      "feeds": [{"map": "folds", "sources": [{"from": ")" +
                           from + R"("}], "angles": )" + angles + more + "}]}]}";
  return ParseRig(json, "leg.rig.json", ".");
}

TEST(AnglesInARig, AreReadAndWrittenBack) {
  const auto rig = ParseAngles("[[12, 0], [45, 0.6], [110, 1]]");
  ASSERT_TRUE(rig.ok()) << rig.status().ToString();
  const wrinkle::Feed& feed = rig->regions[0].feeds[0];
  EXPECT_EQ(feed.angles,
            (std::vector<wrinkle::CurvePoint>{{12.0f, 0.0f}, {45.0f, 0.6f}, {110.0f, 1.0f}}));
  const std::string text = RigToJson(*rig);
  EXPECT_NE(text.find(R"("angles": [[12, 0], [45, 0.6], [110, 1]])"), std::string::npos) << text;
  const auto again = ParseRig(text, "again.rig.json", ".");
  ASSERT_TRUE(again.ok()) << again.status().ToString();
  EXPECT_EQ(again->regions[0].feeds[0].angles, feed.angles);
}

TEST(AnglesInARig, AreCheckedPointByPoint) {
  constexpr StatusCode kBadCurve = StatusCode::kInvalidArgument;
  const std::string at = "regions[0].feeds[0].angles";
  struct WrongAngles {
    const char* angles;
    const char* from;
    StatusCode code;
    std::string where;
  };
  const WrongAngles wrongs[] = {
      {"[]", "knee.flexed", kBadCurve, at},
      {"[[12, 0]]", "knee.flexed", kBadCurve, at},
      {"[[-1, 0], [45, 1]]", "knee.flexed", kBadCurve, at + "[0][0]"},
      {"[[0, 0], [181, 1]]", "knee.flexed", kBadCurve, at + "[1][0]"},
      {"[[0, 0], [45, 1.1]]", "knee.flexed", kBadCurve, at + "[1][1]"},
      {"[[45, 0], [12, 1]]", "knee.flexed", kBadCurve, at + "[1][0]"},
      {"[[45, 0], [46.9, 1]]", "knee.flexed", kBadCurve, at + "[1][0]"},
      {"[[0, 0], [45, 1]]", "jaw.value", kBadCurve, at},
      {"[[0, 0], [\"nan\", 1]]", "knee.flexed", StatusCode::kNonFinite, at + "[1][0]"}};
  for (const WrongAngles& wrong : wrongs) {
    const Status status = ParseAngles(wrong.angles, wrong.from).status();
    EXPECT_EQ(status.code(), wrong.code) << wrong.angles << ": " << status.ToString();
    EXPECT_TRUE(status.where().ends_with(wrong.where)) << wrong.angles << ": " << status.ToString();
  }
  const Status both =
      ParseAngles("[[0, 0], [45, 1]]", "knee.flexed", R"(, "modulation": "linear")").status();
  EXPECT_EQ(both.code(), kBadCurve);
  EXPECT_NE(both.what().find("angles excludes modulation and curve"), std::string::npos);
}

}  // namespace
}  // namespace furrow::rig
