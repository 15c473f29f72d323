// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/clothes/trousers_net.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/generator/body/body_skinning.h"
#include "authoring/generator/clothes/cloth_panels.h"
#include "authoring/generator/mesh/mesh_tools.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

// The grid at level 0. Columns run around a leg from its inside over the front; rows run from the
// hem upward.
constexpr int kColumns = 18;
constexpr int kRise = 9;  // rows from the crotch to the waist
constexpr float kCrotch = 0.79f;
constexpr float kWaist = 1.042f;
// The rings of a leg: heights above the floor, metres. They are dense at the knee, which bends.
constexpr float kTrouserRings[] = {0.052f, 0.085f, 0.125f, 0.17f,  0.22f,  0.27f,  0.315f, 0.355f,
                                   0.390f, 0.418f, 0.442f, 0.462f, 0.480f, 0.497f, 0.514f, 0.532f,
                                   0.553f, 0.578f, 0.610f, 0.648f, 0.688f, 0.725f, 0.757f};
constexpr int kLips = 2;  // rows of cloth that turn inward at the hem and at the waist

class TrouserMaker {
 public:
  TrouserMaker(const BodyShape& shape, QuadNet* net)
      : shape_(shape),
        net_(net),
        f_(1 << shape.parameters().level),
        solid_([&shape](const vec3& p) { return shape.Trousers(p); }) {
    for (std::size_t i = 0; i < std::size(kTrouserRings); ++i) {
      const float next = i + 1 < std::size(kTrouserRings) ? kTrouserRings[i + 1] : kCrotch;
      for (int k = 0; k < f_; ++k) {
        rings_.push_back(kTrouserRings[i] + (next - kTrouserRings[i]) * static_cast<float>(k) /
                                                static_cast<float>(f_));
      }
    }
  }

  void Make() {
    PointGrid left = MakeLeg();
    const PointGrid right = Mirror(left);
    AddPatch(left, kTrousersLeft, false, {}, net_);
    AddPatch(right, kTrousersRight, true, {}, net_);
    Relax(solid_, 20 * f_, net_);
    for (QuadNet::Point& point : net_->points) {
      point.skin = TrouserInfluences(shape_, point.place);
    }
    SmoothInfluences(3 * f_, net_);
  }

 private:
  // A point below the crotch. `turn` is 0 on the inside of the leg and a quarter turn in front.
  vec3 LegPlace(float y, float turn) const {
    const Solid leg = [this](const vec3& p) { return shape_.TrouserLeg(p); };
    return CastOut(leg, {LegMiddle(), y, -0.004f}, {-std::cos(turn), 0.0f, std::sin(turn)}, 0.2f);
  }
  float LegMiddle() const {
    const auto& skeleton = shape_.skeleton();
    return skeleton.rest_model()[skeleton.Find("lower_leg_l")][3].x;
  }

  // The middle of the front (`ahead` +1) or the back (-1), from the crotch to the waist in equal
  // steps.
  // Rays fan out from a focus in the pelvis, from the crotch to straight ahead, and then rise to
  // the waist. The line is cut into steps of equal length.
  std::vector<vec3> Middle(float ahead) const {
    constexpr int kFine = 64;
    constexpr float kFocus = 0.90f;
    std::vector<vec3> line;
    for (int i = 0; i <= kFine; ++i) {
      const float angle = 0.5f * kPi * static_cast<float>(i) / kFine;
      line.push_back(
          CastOut(solid_, {0, kFocus, 0}, {0, -std::cos(angle), ahead * std::sin(angle)}, 0.3f));
    }
    for (int i = 1; i <= kFine; ++i) {
      const float y = kFocus + (kWaist - kFocus) * static_cast<float>(i) / kFine;
      line.push_back(CastOut(solid_, {0, y, 0}, {0, 0, ahead}, 0.3f));
    }
    std::vector<float> along{0.0f};
    for (std::size_t i = 1; i < line.size(); ++i) {
      along.push_back(along.back() + glm::distance(line[i - 1], line[i]));
    }
    std::vector<vec3> steps;
    const int count = kRise * f_;
    std::size_t at = 1;
    for (int i = 0; i <= count; ++i) {
      const float want = along.back() * static_cast<float>(i) / static_cast<float>(count);
      while (at + 1 < along.size() && along[at] < want) ++at;
      const float t = (want - along[at - 1]) / (along[at] - along[at - 1]);
      steps.push_back(glm::mix(line[at - 1], line[at], std::clamp(t, 0.0f, 1.0f)));
    }
    return steps;
  }

  // A point above the crotch, between the side and the middle of the front or the back.
  vec3 RisePlace(int i, float around, const vec3& middle) const {
    const float rise = static_cast<float>(i) / static_cast<float>(kRise * f_);
    const float ox = glm::mix(LegMiddle(), 0.03f, Smoothstep(0.0f, 0.7f, rise));
    const float side_y = kCrotch + (kWaist - kCrotch) * rise;
    const float start = std::atan2(std::abs(middle.z), ox);
    const float turn = glm::mix(start, kPi, around);
    const float y = glm::mix(middle.y, side_y, Smoothstep(0.0f, 0.8f, around));
    const float ahead = middle.z >= 0.0f ? 1.0f : -1.0f;
    return CastOut(solid_, {ox, y, 0}, {-std::cos(turn), 0.0f, ahead * std::sin(turn)}, 0.3f);
  }

  PointGrid MakeLeg() {
    const int columns = kColumns * f_;
    const int legs = static_cast<int>(rings_.size());
    const int rise = kRise * f_;
    PointGrid grid(kLips + legs + rise + 1 + kLips, columns + 1);
    const std::vector<vec3> front = Middle(1.0f), back = Middle(-1.0f);
    for (int c = 0; c <= columns; ++c) {
      const float turn = 2.0f * kPi * static_cast<float>(c) / static_cast<float>(columns);
      for (int r = 0; r < legs && c < columns; ++r) {
        const float slack = Smoothstep(0.62f, 0.72f, rings_[r]);
        grid.At(kLips + r, c) =
            net_->AddPoint(LegPlace(rings_[r] + HemDrop(rings_[r], turn), turn), slack);
      }
      for (int i = 0; i <= rise; ++i) {
        const int row = kLips + legs + i;
        const float around =
            1.0f - std::abs(1.0f - 2.0f * static_cast<float>(c) / static_cast<float>(columns));
        const vec3& middle = 2 * c <= columns ? front[i] : back[i];
        if (c == columns && i == 0) continue;  // both legs share one crotch point
        const bool on_middle = c == 0 || c == columns;
        const vec3 place = on_middle ? middle : RisePlace(i, around, middle);
        const float slack = on_middle || i == rise
                                ? 0.0f
                                : Smoothstep(0.0f, 4.0f * f_, static_cast<float>(rise - i));
        grid.At(row, c) = net_->AddPoint(place, slack);
      }
    }
    for (int r = 0; r <= legs; ++r) grid.At(kLips + r, columns) = grid.At(kLips + r, 0);
    AddLips(&grid);
    return grid;
  }

  // The hem is lower at the heel.
  static float HemDrop(float y, float turn) {
    return -0.012f * Smoothstep(0.12f, 0.05f, y) * (0.5f - 0.5f * std::sin(turn));
  }

  void AddLips(PointGrid* grid) {
    const int last = grid->rows - 1;
    for (int c = 0; c < grid->columns; ++c) {
      const auto turned = [&](int edge, float in, float along) {
        const vec3 p = net_->points[grid->At(edge, c)].place;
        const vec3 out =
            edge < grid->rows / 2 ? p - vec3(LegMiddle(), p.y, -0.004f) : p - vec3(0, p.y, 0);
        return net_->AddPoint(p - glm::normalize(out) * in + vec3(0, along, 0));
      };
      const bool closes = c == grid->columns - 1;
      grid->At(1, c) = closes ? grid->At(1, 0) : turned(kLips, 0.003f, 0.0f);
      grid->At(0, c) = closes ? grid->At(0, 0) : turned(kLips, 0.006f, 0.03f);
      grid->At(last - 1, c) = turned(last - kLips, 0.003f, 0.001f);
      grid->At(last, c) = turned(last - kLips, 0.005f, -0.02f);
    }
  }

  PointGrid Mirror(const PointGrid& grid) {
    PointGrid mirrored(grid.rows, grid.columns);
    std::vector<int> twin(net_->points.size(), -1);
    for (std::size_t i = 0; i < grid.points.size(); ++i) {
      const int point = grid.points[i];
      const QuadNet::Point original = net_->points[point];
      if (twin[point] < 0) {
        const vec3& p = original.place;
        twin[point] =
            std::abs(p.x) < 1e-6f ? point : net_->AddPoint({-p.x, p.y, p.z}, original.slack);
      }
      mirrored.points[i] = twin[point];
    }
    return mirrored;
  }

  const BodyShape& shape_;
  QuadNet* net_;
  int f_;
  Solid solid_;
  std::vector<float> rings_;
};

}  // namespace

QuadNet MakeTrousers(const BodyShape& shape) {
  QuadNet net;
  TrouserMaker(shape, &net).Make();
  return net;
}

}  // namespace furrow::authoring
