// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/weights/modulation_curve.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/wrinkle/bound_rig.h"
#include "tests/unit/wrinkle/oracle/modulation.h"
#include "wrinkle/rig/rig_check.h"

namespace furrow::wrinkle {
namespace {

using Points = std::vector<CurvePoint>;

struct Worked {
  float x;
  float y;
};

// Exact values of the monotone cubic, from rational arithmetic on the published formulas.
const Points kGentle = {{0.0f, 0.0f}, {0.3f, 0.4f}, {1.0f, 1.0f}};
const Worked kGentleValues[] = {{0.0f, 0.0f},
                                {0.1f, 9208.0f / 63315.0f},
                                {0.3f, 0.4f},
                                {0.5f, 41864.0f / 68943.0f},
                                {0.8f, 300406.0f / 344715.0f},
                                {1.0f, 1.0f}};
// A peak, a level piece, and ends inside the range.
const Points kPeak = {{0.2f, 0.1f}, {0.4f, 0.9f}, {0.6f, 0.3f}, {0.9f, 0.3f}};
const Worked kPeakValues[] = {{0.0f, 0.1f}, {0.1f, 0.1f}, {0.2f, 0.1f}, {0.3f, 0.6875f},
                              {0.4f, 0.9f}, {0.5f, 0.6f}, {0.7f, 0.3f}, {1.0f, 0.3f}};
const Points kLate = {{0.0f, 0.0f}, {0.5f, 0.0f}, {1.0f, 1.0f}};
const Worked kLateValues[] = {{0.25f, 0.0f}, {0.5f, 0.0f}, {0.75f, 0.3125f}};
const Points kFalling = {{0.0f, 1.0f}, {1.0f, 0.0f}};
const Worked kFallingValues[] = {{0.0f, 1.0f}, {0.25f, 0.75f}, {1.0f, 0.0f}};

float ValueOf(const std::vector<CurvePiece>& pieces, float x) {
  const CurvePiece* last = &pieces.front();
  for (const CurvePiece& piece : pieces) {
    if (piece.from <= x) last = &piece;
  }
  const float t = x - last->from;
  return last->c[0] + t * (last->c[1] + t * (last->c[2] + t * last->c[3]));
}

// The weights of blend shapes that feed one region each, shaped by the given curve.
std::vector<float> SolvedWith(const Points& curve, const std::vector<float>& values) {
  Rig rig;
  std::vector<std::string> shapes;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string name = "s" + std::to_string(i);
    shapes.push_back(name);
    Driver& driver = rig.drivers.emplace_back();
    driver.name = name;
    driver.kind = Driver::Kind::kBlendShape;
    driver.blend_shape.blend_shape = name;
    Region& region = rig.regions.emplace_back();
    region.name = name;
    region.curve = curve;
    region.feeds = {{.map = "folds", .sources = {{name, "value"}}}};
  }
  BoundRig bound(rig, Skeleton(), shapes);
  LocalPose pose;
  pose.blend_shapes = values;
  bound.Solve(pose);
  return bound.weights();
}

void ExpectWorked(const Points& curve, std::span<const Worked> worked) {
  const std::vector<CurvePiece> pieces = CurvePieces(curve);
  std::vector<float> xs;
  for (const Worked& value : worked) {
    EXPECT_NEAR(ValueOf(pieces, value.x), value.y, 2e-7f) << value.x;
    EXPECT_NEAR(CurveModulation(curve, double{value.x}), double{value.y}, 2e-7) << value.x;
    xs.push_back(value.x);
  }
  const std::vector<float> weights = SolvedWith(curve, xs);
  for (std::size_t i = 0; i < xs.size(); ++i) EXPECT_NEAR(weights[i], worked[i].y, 5e-7f) << xs[i];
}

TEST(CurvePieces, GiveTheWorkedValues) {
  ExpectWorked(kGentle, kGentleValues);
  ExpectWorked(kPeak, kPeakValues);
  ExpectWorked(kLate, kLateValues);
  ExpectWorked(kFalling, kFallingValues);
}

Points RandomCurve(std::mt19937* random) {
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  Points points(2 + (*random)() % (kMaxCurvePoints - 1));
  float x = 0.05f * uniform(*random);
  for (CurvePoint& point : points) {
    point = {x, uniform(*random)};
    x += kLeastCurveStep + 0.045f * uniform(*random);
  }
  return points;
}

TEST(CurvePieces, PassThroughThePointsWithoutOvershoot) {
  std::mt19937 random(5);
  for (int round = 0; round < 300; ++round) {
    const Points points = RandomCurve(&random);
    const std::vector<CurvePiece> pieces = CurvePieces(points);
    EXPECT_LE(pieces.size(), kMaxCurvePoints + 1);
    EXPECT_EQ(pieces.front().from, 0.0f);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(ValueOf(pieces, points[i].x), points[i].y);
    }
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const float sign = points[i + 1].y < points[i].y ? -1.0f : 1.0f;
      float before = points[i].y;
      for (int k = 1; k <= 50; ++k) {
        const float share = static_cast<float>(k) / 50.0f;
        const float x = points[i].x + share * (points[i + 1].x - points[i].x);
        const float y = ValueOf(pieces, std::min(x, 1.0f));
        EXPECT_GE(sign * (y - before), -2e-6f) << "it turns back between two points";
        before = y;
      }
    }
  }
}

TEST(CurvePieces, HaveAContinuousSlopeBetweenFirstAndLastPoint) {
  std::mt19937 random(6);
  for (int round = 0; round < 300; ++round) {
    const std::vector<CurvePiece> pieces = CurvePieces(RandomCurve(&random));
    const std::size_t first = pieces[0].c[1] == 0.0f && pieces[0].c[3] == 0.0f ? 1 : 0;
    for (std::size_t i = first; i + 2 < pieces.size(); ++i) {  // the last is constant
      const double t = double{pieces[i + 1].from} - double{pieces[i].from};
      const double left = pieces[i].c[1] + t * (2.0 * pieces[i].c[2] + t * 3.0 * pieces[i].c[3]);
      EXPECT_NEAR(left, pieces[i + 1].c[1], 1e-4 * (1.0 + std::abs(left)));
    }
  }
}

TEST(CurvePieces, EqualTheOracle) {
  std::mt19937 random(7);
  for (int round = 0; round < 100; ++round) {
    const Points points = RandomCurve(&random);
    const std::vector<CurvePiece> pieces = CurvePieces(points);
    for (int k = 0; k <= 200; ++k) {
      const float x = static_cast<float>(k) / 200.0f;
      EXPECT_NEAR(double{ValueOf(pieces, x)}, CurveModulation(points, double{x}), 1e-6);
    }
  }
}

TEST(FeedModulation, IsTheFeedsOwnOrElseTheRegions) {
  const Points curve = {{0.0f, 0.0f}, {1.0f, 0.5f}};
  const Rig rig;
  Region region;
  Feed feed;
  EXPECT_EQ(ModulationName(ModulationOf(rig, region, feed)), "cosine");
  region.modulation = Modulation::kCubic;
  EXPECT_EQ(ModulationName(ModulationOf(rig, region, feed)), "cubic");
  region.curve = curve;
  EXPECT_EQ(ModulationName(ModulationOf(rig, region, feed)), "curve");
  feed.modulation = Modulation::kLinear;
  EXPECT_EQ(ModulationName(ModulationOf(rig, region, feed)), "linear");
  feed.curve = curve;
  EXPECT_EQ(ModulationName(ModulationOf(rig, region, feed)), "curve");
  EXPECT_EQ(ModulationOf(rig, region, feed).curve, feed.curve);
}

// Degrees of a hinge that bends by 150 degrees at most, and its value by thesis 4.6.
double HingeValue(double degrees) {
  constexpr double kDegree = 3.14159265358979 / 180.0;
  return std::min((1.0 - std::cos(degrees * kDegree)) / (1.0 + std::cos(30.0 * kDegree)), 1.0);
}

Rig KneeByAngles(const std::string& value, const Points& angles) {
  Rig rig;
  Driver& knee = rig.drivers.emplace_back();
  knee.name = "knee";
  knee.kind = Driver::Kind::kHinge;
  rig.regions.emplace_back().feeds.push_back(
      {.map = "folds", .sources = {{"knee", value, 1.0f}}, .angles = angles});
  return rig;
}

TEST(FeedModulation, AnglesAreValuesOfTheFirstSource) {
  const Points angles = {{12.0f, 0.0f}, {30.0f, 0.43f}, {60.0f, 0.69f}, {110.0f, 1.0f}};
  const Rig rig = KneeByAngles("flexed", angles);
  const Region& region = rig.regions[0];
  const FeedModulation modulation = ModulationOf(rig, region, region.feeds[0]);
  ASSERT_EQ(modulation.curve.size(), 4u);
  const std::vector<CurvePiece> pieces = CurvePieces(modulation.curve);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double x = HingeValue(double{angles[i].x});
    EXPECT_NEAR(double{modulation.curve[i].x}, x, 1e-6);
    EXPECT_NEAR(double{ValueOf(pieces, static_cast<float>(x))}, double{angles[i].y}, 1e-4);
  }
  EXPECT_EQ(ValueOf(pieces, static_cast<float>(HingeValue(11.0))), 0.0f);
  EXPECT_EQ(ValueOf(pieces, static_cast<float>(HingeValue(140.0))), 1.0f);
}

TEST(FeedModulation, AnglesOfAFallingValueAreReversed) {
  const Rig rig = KneeByAngles("extended", {{0.0f, 1.0f}, {50.0f, 0.0f}});
  const Region& region = rig.regions[0];
  const FeedModulation modulation = ModulationOf(rig, region, region.feeds[0]);
  ASSERT_EQ(modulation.curve.size(), 2u);
  EXPECT_NEAR(double{modulation.curve[0].x}, 1.0 - HingeValue(50.0), 1e-6);
  EXPECT_EQ(modulation.curve[0].y, 0.0f);
  EXPECT_EQ(modulation.curve[1], (CurvePoint{1.0f, 1.0f}));
}

// Beyond full flexion the value stays at 1, so those angles are one point.
TEST(FeedModulation, AnglesBeyondTheRangeOfTheDriverCountOnce) {
  const Rig rig = KneeByAngles("flexed", {{150.0f, 0.5f}, {160.0f, 0.7f}, {170.0f, 1.0f}});
  const Region& region = rig.regions[0];
  const std::vector<CurvePiece> pieces =
      CurvePieces(ModulationOf(rig, region, region.feeds[0]).curve);
  EXPECT_NEAR(ValueOf(pieces, 1.0f), 0.5f, 1e-6f);
  EXPECT_NEAR(ValueOf(pieces, 0.0f), 0.5f, 1e-6f);
}

// Below a ball's threshold the value is 0; the weight at the threshold counts.
TEST(FeedModulation, AnglesBelowAThresholdCountOnce) {
  Rig rig = KneeByAngles("front", {{0.0f, 0.0f}, {10.0f, 0.2f}, {20.0f, 1.0f}, {60.0f, 0.0f}});
  rig.drivers[0].kind = Driver::Kind::kBall;
  rig.drivers[0].ball.front.threshold_degrees = 20.0f;
  const Region& region = rig.regions[0];
  const FeedModulation modulation = ModulationOf(rig, region, region.feeds[0]);
  ASSERT_EQ(modulation.curve.size(), 2u);
  EXPECT_EQ(modulation.curve[0], (CurvePoint{0.0f, 1.0f}));
}

// The weight at an angle is exact, however values are combined and whatever their gain is.
TEST(FeedModulation, AnglesHoldForEveryCombination) {
  for (const Combine combine :
       {Combine::kMax, Combine::kSum, Combine::kMean, Combine::kSumModulated}) {
    Rig rig = KneeByAngles("flexed", {{12.0f, 0.0f}, {45.0f, 1.0f}, {90.0f, 0.25f}});
    rig.regions[0].combine = combine;
    rig.regions[0].feeds[0].sources[0].gain = 0.5f;
    const Region& region = rig.regions[0];
    const FeedModulation modulation = ModulationOf(rig, region, region.feeds[0]);
    const bool scaled = combine == Combine::kMax || combine == Combine::kSum;
    EXPECT_NEAR(double{modulation.curve[1].x}, (scaled ? 0.5 : 1.0) * HingeValue(45.0), 1e-6);
  }
}

// Two maps of one region, three of another: named modulations and curves side by side in one block.
TEST(FeedModulation, ShapesEveryMapByItself) {
  Rig rig;
  Driver& driver = rig.drivers.emplace_back();
  driver.name = "jaw";
  driver.kind = Driver::Kind::kBlendShape;
  driver.blend_shape.blend_shape = "jawOpen";
  const auto feed = [](const char* map) { return Feed{.map = map, .sources = {{"jaw", "value"}}}; };
  Region chin;
  chin.name = "chin";
  chin.feeds = {feed("as_region"), feed("linear")};
  chin.feeds[1].modulation = Modulation::kLinear;
  Region cheek;
  cheek.name = "cheek";
  cheek.curve = kGentle;
  cheek.feeds = {feed("as_region"), feed("own"), feed("cosine")};
  cheek.feeds[1].curve = kPeak;
  cheek.feeds[2].modulation = Modulation::kCosine;
  rig.regions = {chin, cheek};
  BoundRig bound(rig, Skeleton());
  LocalPose pose;
  pose.blend_shapes = {0.5f};
  bound.Solve(pose);
  EXPECT_NEAR(bound.Weight("chin.as_region"), 0.5f, 1e-6f);
  EXPECT_EQ(bound.Weight("chin.linear"), 0.5f);
  EXPECT_NEAR(bound.Weight("cheek.as_region"), 41864.0f / 68943.0f, 5e-7f);
  EXPECT_NEAR(bound.Weight("cheek.own"), 0.6f, 5e-7f);
  EXPECT_NEAR(bound.Weight("cheek.cosine"), 0.5f, 1e-6f);
  pose.blend_shapes = {0.1f};
  bound.Solve(pose);
  EXPECT_NEAR(bound.Weight("chin.as_region"), 0.0244717f, 1e-6f);  // (1 - cos 18 degrees) / 2
  EXPECT_NEAR(bound.Weight("chin.linear"), 0.1f, 1e-7f);
  EXPECT_NEAR(bound.Weight("cheek.as_region"), 9208.0f / 63315.0f, 5e-7f);
  EXPECT_NEAR(bound.Weight("cheek.own"), 0.1f, 1e-7f);  // before the first point
  EXPECT_NEAR(bound.Weight("cheek.cosine"), 0.0244717f, 1e-6f);
}

// Masks by skin weight take the modulation of their map, too.
TEST(FeedModulation, ShapesTheInfluenceOfJoints) {
  Rig rig = MakeRig();
  for (Region& region : rig.regions) {
    if (region.name == "neck_left") region.feeds[0].curve = kGentle;
  }
  BoundRig bound(rig, MakeBody());
  LocalPose pose = RestPose(bound.skeleton());
  Turn(bound.skeleton(), "neck", AngleAxis(45.0f, {0, 1, 0}), &pose);  // half of 90 degrees
  bound.Solve(pose);
  const auto masks = bound.binding()->dynamic_masks();
  std::vector<float> influences(bound.skeleton().num_joints() * masks.size());
  const JointInfluenceJob job{
      .binding = bound.binding().get(), .driver_values = bound.values(), .influences = influences};
  ASSERT_EQ(job.Run(), JobStatus::kOk);
  const std::size_t neck = static_cast<std::size_t>(bound.skeleton().Find("neck")) * masks.size();
  EXPECT_NEAR(influences[neck + 1], 41864.0f / 68943.0f, 1e-5f);
}

// The renderer prepares masks for these places, also for folds that a full bend removes.
TEST(FeedModulation, JointsThatACurveEverInfluencesAreListed) {
  Rig rig = MakeRig();
  for (Region& region : rig.regions) {
    if (region.name == "neck_left") region.feeds[0].curve = {{0.0f, 1.0f}, {0.5f, 0.0f}};
  }
  BoundRig bound(rig, MakeBody());
  const auto masks = bound.binding()->dynamic_masks();
  const std::size_t neck = static_cast<std::size_t>(bound.skeleton().Find("neck")) * masks.size();
  const std::vector<std::size_t> places = bound.binding()->InfluencedPlaces();
  EXPECT_TRUE(std::ranges::binary_search(places, neck + 1));
  EXPECT_TRUE(std::ranges::is_sorted(places));
}

}  // namespace
}  // namespace furrow::wrinkle
