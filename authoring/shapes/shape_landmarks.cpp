// SPDX-License-Identifier: Apache-2.0
#include "authoring/shapes/shape_landmarks.h"

#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

namespace furrow::authoring {
namespace {

using glm::vec3;

enum class Rule { kArgMax, kCentre };

class Finder {
 public:
  explicit Finder(const FaceSkin& skin) : skin_(skin) {}

  // `side`: 1 left, -1 right, 0 near the middle.
  std::optional<vec3> Find(const std::string& shape, int side, Rule rule) const {
    const std::vector<vec3> moves = skin_.Moves(shape);
    double sum = 0.0, most = 0.0;
    glm::dvec3 centre(0.0), best(0.0);
    for (std::size_t v = 0; v < moves.size(); ++v) {
      const vec3& p = skin_.positions()[v];
      if (!IsOn(p.x - skin_.middle(), side)) continue;
      const double length = static_cast<double>(glm::length(moves[v]));
      const double share = length * length * length * length;
      sum += share;
      centre += share * glm::dvec3(p);
      if (length <= most) continue;
      most = length;
      best = glm::dvec3(p);
    }
    if (!(most > 0.0)) return std::nullopt;
    return vec3(rule == Rule::kArgMax ? best : centre / sum);
  }

  LandmarkPair Pair(const std::string& shape, Rule rule) const {
    return {Find(shape + "Left", 1, rule), Find(shape + "Right", -1, rule)};
  }

 private:
  [[nodiscard]] bool IsOn(float x, int side) const {
    const float middle = 0.08f * skin_.eye_distance();
    return side == 0 ? std::abs(x) <= middle : x * static_cast<float>(side) >= 0.0f;
  }

  const FaceSkin& skin_;
};

}  // namespace

ShapeLandmarks FindShapeLandmarks(const FaceSkin& skin) {
  const Finder finder(skin);
  ShapeLandmarks found;
  found.brow_inner = finder.Pair("browDown", Rule::kArgMax);
  found.brow_outer = finder.Pair("browOuterUp", Rule::kArgMax);
  found.inner_rise = {finder.Find("browInnerUp", 1, Rule::kArgMax),
                      finder.Find("browInnerUp", -1, Rule::kArgMax)};
  found.upper_lid = finder.Pair("eyeBlink", Rule::kArgMax);
  found.lower_lid = finder.Pair("eyeSquint", Rule::kCentre);
  found.mouth_corner = finder.Pair("mouthSmile", Rule::kArgMax);
  found.nose_wing = finder.Pair("noseSneer", Rule::kCentre);
  found.cheek = finder.Pair("cheekSquint", Rule::kArgMax);
  found.chin = finder.Find("jawOpen", 0, Rule::kArgMax);
  found.upper_lip = finder.Find("mouthRollUpper", 0, Rule::kArgMax);
  found.lower_lip = finder.Find("mouthRollLower", 0, Rule::kArgMax);
  return found;
}

}  // namespace furrow::authoring
