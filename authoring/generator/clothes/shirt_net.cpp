// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/clothes/shirt_net.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/generator/body/body_skinning.h"
#include "authoring/generator/clothes/cloth_panels.h"
#include "authoring/generator/clothes/collar_net.h"
#include "authoring/generator/mesh/mesh_tools.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

// The grid of the trunk at level 0. Columns run around the trunk from the middle of the front over
// the left side; rows run from the hem to the neckline. The cells of the armholes are left out.
constexpr int kQuarter = 8;          // columns from the front to the side
constexpr int kHoleHalf = 2;         // columns on either side of an armhole's middle
constexpr int kRowsBelow = 11;       // rows from the hem to the armpit
constexpr int kHoleRows = 6;         // rows from the armpit to the top of the shoulder
constexpr int kYokeRows = 4;         // rows from the shoulder to the neckline
constexpr float kHem = 0.985f;       // metres
constexpr float kArmpit = 1.272f;    // metres
constexpr float kHoleTop = 47.0f;    // degrees above the armpit, seen from the middle of the trunk
constexpr float kHoleAngle = 70.0f;  // degrees from the front, the start of an armhole

// The rings of a sleeve beyond the armhole: distances from the shoulder's joint, metres. They are
// dense at the elbow, which bends.
constexpr int kCapRings = 4;
constexpr float kShirtRings[] = {0.150f, 0.178f, 0.202f, 0.222f, 0.239f, 0.254f, 0.268f,
                                 0.282f, 0.296f, 0.312f, 0.332f, 0.360f, 0.395f, 0.428f,
                                 0.454f, 0.465f, 0.473f, 0.505f, 0.535f};

class ShirtMaker {
 public:
  ShirtMaker(const BodyShape& shape, QuadNet* net)
      : shape_(shape),
        net_(net),
        f_(1 << shape.parameters().level),
        solid_([&shape](const vec3& p) { return shape.Shirt(p); }),
        trunk_(f_ * (kRowsBelow + kHoleRows + kYokeRows) + 1, f_ * 4 * kQuarter + 1) {}

  void Make() {
    MakeTrunk();
    PointGrid sleeves[2] = {MakeSleeve(1.0f), MakeSleeve(-1.0f)};
    LayPatches(sleeves);
    Relax(solid_, 24 * f_, net_);
    WeighTrunk();
    for (int i = 0; i < 2; ++i) WeighSleeve(i == 0 ? 1.0f : -1.0f, sleeves[i]);
    SmoothInfluences(3 * f_, net_);
    AddCollar(solid_, Neckline(), net_);
  }

 private:
  // The angle of a column from the front, degrees. The grid is symmetric left to right and front to
  // back.
  float Angle(int column) const {
    const int around = 4 * kQuarter * f_;
    if (column > around / 2) return 360.0f - Angle(around - column);
    const int half = around / 2;
    if (column > half / 2) return 180.0f - Angle(half - column);
    const int hole = (kQuarter - kHoleHalf) * f_;
    if (column <= hole) return kHoleAngle * static_cast<float>(column) / static_cast<float>(hole);
    return kHoleAngle + (90.0f - kHoleAngle) * static_cast<float>(column - hole) /
                            static_cast<float>(kHoleHalf * f_);
  }

  vec3 Neckline(float degrees) const {
    // The neckline slants: it is lower in front.
    const float y = 1.4830f - 0.0200f * std::cos(degrees * kDegrees);
    const vec3 out(std::sin(degrees * kDegrees), 0.0f, std::cos(degrees * kDegrees));
    return CastOut([this](const vec3& p) { return shape_.Neck(p); }, {0.0f, y, -0.032f}, out,
                   0.085f);
  }

  bool InHole(int row, int column) const {  // for cells
    if (row < kRowsBelow * f_ || row >= (kRowsBelow + kHoleRows) * f_) return false;
    const int quarter = kQuarter * f_, half = kHoleHalf * f_;
    const auto near = [&](int side) { return column >= side - half && column < side + half; };
    return near(quarter) || near(3 * quarter);
  }

  bool InsideHole(int row, int column) const {  // for points
    if (row <= kRowsBelow * f_ || row >= (kRowsBelow + kHoleRows) * f_) return false;
    const int quarter = kQuarter * f_, half = kHoleHalf * f_;
    return std::abs(column - quarter) < half || std::abs(column - 3 * quarter) < half;
  }

  vec3 TrunkPlace(int row, int column) const {
    const float degrees = Angle(column);
    const vec3 out(std::sin(degrees * kDegrees), 0.0f, std::cos(degrees * kDegrees));
    const int below = kRowsBelow * f_;
    if (row <= below) {
      const float y = kHem + (kArmpit - kHem) * static_cast<float>(row) / static_cast<float>(below);
      return CastOut(solid_, {0, y, -0.003f}, out, 0.4f);
    }
    const float rise =
        std::min(static_cast<float>(row - below) / static_cast<float>(kHoleRows * f_), 1.0f);
    const float up = kHoleTop * rise * kDegrees;
    const vec3 shoulder =
        CastOut(solid_, {0, kArmpit, -0.012f}, out * std::cos(up) + vec3(0, std::sin(up), 0), 0.4f);
    const int yoke = row - (kRowsBelow + kHoleRows) * f_;
    if (yoke <= 0) return shoulder;
    const float t = static_cast<float>(yoke) / static_cast<float>(kYokeRows * f_);
    const vec3 place = glm::mix(shoulder, Neckline(degrees), t);
    return yoke == kYokeRows * f_ ? place : OnSurface(solid_, place);
  }

  void MakeTrunk() {
    const int last = trunk_.columns - 1;
    for (int r = 0; r < trunk_.rows; ++r) {
      for (int c = 0; c < last; ++c) {
        if (InsideHole(r, c)) continue;
        const bool edge = r == 0 || r == trunk_.rows - 1;
        const float slack =
            edge ? 0.0f
                 : Smoothstep(1.0f, static_cast<float>(kRowsBelow * f_), static_cast<float>(r));
        trunk_.At(r, c) = net_->AddPoint(TrunkPlace(r, c), slack);
      }
      trunk_.At(r, last) = trunk_.At(r, 0);
    }
  }

  // The points around an armhole, from the armpit over the front, the shoulder and the back to the
  // armpit.
  std::vector<int> Armhole(float side) const {
    const int around = 4 * kQuarter * f_, quarter = kQuarter * f_, half = kHoleHalf * f_;
    const int low = kRowsBelow * f_, high = (kRowsBelow + kHoleRows) * f_;
    const auto at = [&](int row, int column) {
      return trunk_.At(row, side > 0.0f ? column : around - column);
    };
    std::vector<int> loop;
    for (int c = quarter; c > quarter - half; --c) loop.push_back(at(low, c));
    for (int r = low; r < high; ++r) loop.push_back(at(r, quarter - half));
    for (int c = quarter - half; c < quarter + half; ++c) loop.push_back(at(high, c));
    for (int r = high; r > low; --r) loop.push_back(at(r, quarter + half));
    for (int c = quarter + half; c >= quarter; --c) loop.push_back(at(low, c));
    return loop;
  }

  // A point of the left sleeve beyond the cap, by its distance along the arm and its angle.
  vec3 RingPlace(float along, float turn) const {
    const vec3 out = shape_.arm_outward() * std::cos(turn) + shape_.arm_forward() * std::sin(turn);
    const Solid sleeve = [&](const vec3& p) { return shape_.Sleeve(p); };
    return CastOut(sleeve, shape_.shoulder() + shape_.arm() * along, out, 0.15f);
  }

  std::vector<float> FineRings() const {
    std::vector<float> fine;
    for (std::size_t i = 0; i + 1 < std::size(kShirtRings); ++i) {
      for (int k = 0; k < f_; ++k) {
        fine.push_back(kShirtRings[i] + (kShirtRings[i + 1] - kShirtRings[i]) *
                                            static_cast<float>(k) / static_cast<float>(f_));
      }
    }
    fine.push_back(kShirtRings[std::size(kShirtRings) - 1]);
    return fine;
  }

  PointGrid MakeSleeve(float side) {
    const std::vector<int> hole = Armhole(side);
    const std::vector<float> rings = FineRings();
    const int columns = static_cast<int>(hole.size());
    const int cap = kCapRings * f_;
    constexpr int kLips = 2;
    PointGrid grid(cap + static_cast<int>(rings.size()) + kLips, columns);
    const vec3 flip(side, 1.0f, 1.0f);
    for (int k = 0; k + 1 < columns; ++k) {
      grid.At(0, k) = hole[k];
      const float turn =
          kPi * (1.0f - 2.0f * static_cast<float>(k) / static_cast<float>(columns - 1));
      const vec3 first = net_->points[hole[k]].place * flip;
      const vec3 second = RingPlace(rings[0], turn);
      for (int r = 1; r < cap; ++r) {
        const float t = static_cast<float>(r) / static_cast<float>(cap);
        grid.At(r, k) = net_->AddPoint(OnSurface(solid_, glm::mix(first, second, t) * flip), 1.0f);
      }
      for (std::size_t r = 0; r < rings.size(); ++r) {
        grid.At(cap + static_cast<int>(r), k) = net_->AddPoint(RingPlace(rings[r], turn) * flip);
      }
      // The cuff turns inward.
      for (int r = 0; r < kLips; ++r) {
        const float along = rings.back() + (r == 0 ? 0.001f : -0.035f);
        const vec3 axis = shape_.shoulder() + shape_.arm() * along;
        const float in = r == 0 ? 0.0025f : 0.006f;
        const vec3 rim = RingPlace(rings.back(), turn) + shape_.arm() * (along - rings.back());
        const vec3 place = rim - glm::normalize(rim - axis) * in;
        grid.At(cap + static_cast<int>(rings.size()) + r, k) = net_->AddPoint(place * flip);
      }
    }
    for (int r = 0; r < grid.rows; ++r) grid.At(r, columns - 1) = grid.At(r, 0);
    return grid;
  }

  void LayPatches(const PointGrid (&sleeves)[2]) {
    const int around = 4 * kQuarter * f_, quarter = kQuarter * f_;
    PointGrid front(trunk_.rows, 2 * quarter + 1), back(trunk_.rows, 2 * quarter + 1);
    for (int r = 0; r < trunk_.rows; ++r) {
      for (int c = 0; c <= 2 * quarter; ++c) {
        front.At(r, c) = trunk_.At(r, (c - quarter + around) % around);
        back.At(r, c) = trunk_.At(r, c + quarter);
      }
    }
    AddPatch(
        front, kShirtFront, false,
        [&](int r, int c) { return InHole(r, (c - quarter + around) % around); }, net_);
    AddPatch(
        back, kShirtBack, false, [&](int r, int c) { return InHole(r, c + quarter); }, net_);
    AddPatch(sleeves[0], kSleeveLeft, true, {}, net_);
    AddPatch(sleeves[1], kSleeveRight, false, {}, net_);
  }

  void WeighTrunk() {
    for (const int point : trunk_.points) {
      if (point < 0) continue;
      net_->points[point].skin = TorsoInfluences(shape_, net_->points[point].place);
    }
  }

  void WeighSleeve(float side, const PointGrid& grid) {
    for (int k = 0; k + 1 < grid.columns; ++k) {
      const Influences hole = net_->points[grid.At(0, k)].skin;
      const vec3 first = net_->points[grid.At(0, k)].place;
      for (int r = 1; r < grid.rows; ++r) {
        QuadNet::Point& point = net_->points[grid.At(r, k)];
        const float from_hole = glm::distance(point.place, first);
        point.skin = SleeveInfluences(shape_, side, point.place, hole, from_hole);
      }
    }
  }

  std::vector<int> Neckline() const {
    std::vector<int> line;
    for (int c = 0; c < trunk_.columns; ++c) line.push_back(trunk_.At(trunk_.rows - 1, c));
    return line;
  }

  const BodyShape& shape_;
  QuadNet* net_;
  int f_;
  Solid solid_;
  PointGrid trunk_;
};

}  // namespace

QuadNet MakeShirt(const BodyShape& shape) {
  QuadNet net;
  ShirtMaker(shape, &net).Make();
  return net;
}

}  // namespace furrow::authoring
