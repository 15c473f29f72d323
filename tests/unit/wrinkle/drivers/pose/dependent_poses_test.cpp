// SPDX-License-Identifier: Apache-2.0
// nnls drivers with reference poses that depend on one another, against an oracle that knows the
// poses in double precision.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/scalar.h"
#include "tests/unit/wrinkle/bound_rig.h"
#include "tests/unit/wrinkle/oracle/nnls/lawson_hanson.h"

namespace furrow::wrinkle {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kRidge = 1e-6;  // docs/ALGORITHM.md
constexpr int kPoints = 2;

// A movement of all control points: three numbers per point.
using Movement = std::vector<double>;

Movement operator+(const Movement& a, const Movement& b) {
  Movement sum = a;
  for (std::size_t i = 0; i < a.size(); ++i) sum[i] += b[i];
  return sum;
}
Movement operator*(double factor, Movement m) {
  for (double& value : m) value *= factor;
  return m;
}
double Length(const Movement& m) {
  double square = 0.0;
  for (const double value : m) square += value * value;
  return std::sqrt(square);
}

// Two points on stalks, far from the anchor compared with the movements. Both the stalks and the
// points can move, so that one movement has many expressions, which differ by rounding.
class Stalks {
 public:
  explicit Stalks(unsigned seed)
      : random_(seed),
        skeleton_(MakeSkeleton({{"anchor", "", {0, 0, 0}, {}},
                                {"stalk0", "anchor", {0.3f, 0.8f, 0.2f}, {}},
                                {"point0", "stalk0", {0.4f, 1.1f, 0.6f}, {}},
                                {"stalk1", "anchor", {-0.4f, 0.7f, 0.3f}, {}},
                                {"point1", "stalk1", {-0.5f, 1.2f, 0.5f}, glm::vec3(0)}},
                               seed + 1)) {
    rig_.anchor = "anchor";
    rig_.drivers.resize(1);
    Driver& driver = rig_.drivers[0];
    driver.name = "d";
    driver.pose.solve = PoseSolve::kNnls;
    for (int i = 0; i < kPoints; ++i) {
      driver.pose.points.push_back(
          {.joint = "point" + std::to_string(i), .kind = ControlPoint::Kind::kOrigin});
    }
  }

  Movement Random(double length) {
    std::normal_distribution<double> normal;
    Movement m(3 * kPoints);
    for (double& value : m) value = normal(random_);
    return (length / Length(m)) * m;
  }
  double Uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  // The movement as a reference pose, with a random part of it done by the stalks.
  void AddPose(const Movement& m) {
    const std::string name = "p" + std::to_string(columns_.size());
    ReferencePose pose{.name = name};
    for (int i = 0; i < kPoints; ++i) {
      const glm::dvec3 move(m[3 * i], m[3 * i + 1], m[3 * i + 2]);
      const double share = Uniform(-1.0, 2.0);
      const std::string index = std::to_string(i);
      pose.joints.push_back({.joint = "stalk" + index, .translation = share * move});
      pose.joints.push_back({.joint = "point" + index, .translation = (1.0 - share) * move});
    }
    rig_.reference_poses.push_back(pose);
    rig_.drivers[0].pose.values.push_back({name, name});
    columns_.push_back(m);
  }

  // The driver's values for a movement, by the solver.
  std::vector<float> Solve(const Movement& m) {
    if (!bound_) bound_.emplace(rig_, skeleton_);
    LocalPose pose = RestPose(skeleton_);
    for (int i = 0; i < kPoints; ++i) {
      Move(skeleton_, "point" + std::to_string(i), glm::dvec3(m[3 * i], m[3 * i + 1], m[3 * i + 2]),
           &pose);
    }
    bound_->Solve(pose);
    return bound_->values();
  }

  // The same by the oracle, with unit columns, as documented.
  std::vector<float> Expected(const Movement& m, double ridge = kRidge) const {
    std::vector<Movement> units;
    for (const Movement& column : columns_) units.push_back((1.0 / Length(column)) * column);
    const std::vector<double> lengths = LawsonHanson(units, m, ridge);
    std::vector<float> values;
    for (std::size_t k = 0; k < lengths.size(); ++k) {
      values.push_back(Saturate(static_cast<float>(lengths[k] / Length(columns_[k]))));
    }
    return values;
  }

  std::span<const std::string> Warnings() {
    if (!bound_) bound_.emplace(rig_, skeleton_);
    return bound_->binding()->warnings();
  }

 private:
  std::mt19937 random_;
  Skeleton skeleton_;
  Rig rig_;
  std::vector<Movement> columns_;
  std::optional<BoundRig> bound_;
};

float LargestError(const std::vector<float>& a, const std::vector<float>& b) {
  float worst = 0.0f;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
  return worst;
}

enum class Kind { kGeneral, kCoincident, kOpposite, kOfTwoOthers, kNear, kNearlyOpposite };

void AddPoses(Kind kind, Stalks* stalks) {
  const Movement a = stalks->Random(stalks->Uniform(0.02, 0.2));
  const Movement b = stalks->Random(stalks->Uniform(0.02, 0.2));
  // Small angles, down to a thousandth of a radian.
  const double angle = std::pow(10.0, stalks->Uniform(-3.0, -0.5));
  const double longer = stalks->Uniform(0.5, 2.0);
  stalks->AddPose(a);
  switch (kind) {
    case Kind::kGeneral: break;
    case Kind::kCoincident: stalks->AddPose(a); break;
    case Kind::kOpposite: stalks->AddPose(-1.0 * a); break;
    case Kind::kOfTwoOthers: stalks->AddPose(0.7 * a + 0.6 * b); break;
    case Kind::kNear: stalks->AddPose(longer * (a + stalks->Random(angle * Length(a)))); break;
    case Kind::kNearlyOpposite:
      stalks->AddPose(-longer * (a + stalks->Random(angle * Length(a))));
      break;
  }
  stalks->AddPose(b);
}

// A hundred random rigs of each kind, with movements inside the cone of the poses and outside.
TEST(DependentPoses, AgreeWithAnOracleInDoublePrecision) {
  for (const Kind kind : {Kind::kGeneral, Kind::kCoincident, Kind::kOpposite, Kind::kOfTwoOthers,
                          Kind::kNear, Kind::kNearlyOpposite}) {
    int wrong = 0;
    float worst = 0.0f;
    for (unsigned seed = 0; seed < 100; ++seed) {
      Stalks stalks(1000 * static_cast<unsigned>(kind) + seed);
      AddPoses(kind, &stalks);
      float error = 0.0f;
      for (int i = 0; i < 5; ++i) {
        const Movement m = stalks.Random(stalks.Uniform(0.0, 0.1));
        error = std::max(error, LargestError(stalks.Solve(m), stalks.Expected(m)));
      }
      // A ridge turns rounding of the pose, about 1e-6, into at most 1e-6 / (2 sqrt(ridge)).
      wrong += error > 2e-3f ? 1 : 0;
      worst = std::max(worst, error);
    }
    std::printf("kind %d: largest error %.6f\n", static_cast<int>(kind), worst);
    EXPECT_EQ(wrong, 0) << "kind " << static_cast<int>(kind) << ", largest error " << worst;
  }
}

// What the ridge costs where poses are independent.
TEST(DependentPoses, TheRidgeDoesNotShowInIndependentPoses) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    Stalks stalks(seed);
    AddPoses(Kind::kGeneral, &stalks);
    const Movement m = stalks.Random(0.1);
    EXPECT_LT(LargestError(stalks.Solve(m), stalks.Expected(m, 0.0)), 1e-4f) << seed;
  }
}

TEST(DependentPoses, OppositePosesNeverRiseTogether) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    Stalks stalks(seed);
    const Movement a = stalks.Random(0.1);
    stalks.AddPose(a);
    stalks.AddPose(-1.0 * a);
    // Something that neither pose explains comes on top.
    Movement across = stalks.Random(1.0);
    double along = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) along += across[i] * a[i] / 0.01;
    across = across + (-along) * a;
    const std::vector<float> values = stalks.Solve(0.24 * a + 0.05 * across);
    EXPECT_NEAR(values[0], 0.24f, 1e-3f) << seed;
    EXPECT_NEAR(values[1], 0.0f, 1e-3f) << seed;
  }
}

TEST(DependentPoses, AreReported) {
  Stalks coincident(1);
  AddPoses(Kind::kCoincident, &coincident);
  EXPECT_THAT(coincident.Warnings(),
              ElementsAre(AllOf(HasSubstr("driver 'd': reference poses 'p0' and 'p1' move its "
                                          "control points in almost the same direction"),
                                HasSubstr("cosine 1.0000"))));
  Stalks opposite(2);
  AddPoses(Kind::kOpposite, &opposite);
  EXPECT_THAT(opposite.Warnings(),
              ElementsAre(AllOf(HasSubstr("'p0' and 'p1'"), HasSubstr("opposite directions"),
                                HasSubstr("cosine -1.0000"))));
  Stalks mixed(3);
  AddPoses(Kind::kOfTwoOthers, &mixed);
  EXPECT_THAT(mixed.Warnings(),
              ElementsAre(AllOf(HasSubstr("'p0', 'p1' and 'p2'"), HasSubstr("cosine 1.0000"))));
  Stalks general(4);
  AddPoses(Kind::kGeneral, &general);
  EXPECT_THAT(general.Warnings(), IsEmpty());
}

}  // namespace
}  // namespace furrow::wrinkle
