// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/body/body_skinning.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "authoring/generator/mesh/mesh_tools.h"
#include "authoring/skinning/influences.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

// Adds up the shares of joints by their names.
class Shares {
 public:
  explicit Shares(const wrinkle::Skeleton& skeleton) : skeleton_(skeleton) {}

  void Add(const std::string& joint, float share) {
    sum_.Add(static_cast<std::uint16_t>(skeleton_.Find(joint)), share);
  }
  void Add(const Influences& skin, float share) { sum_.Add(skin, share); }

  // Where one joint of a limb hands over to the next: the middle and half the width of the blend.
  struct Border {
    float at;
    float half_width;
  };
  // Distributes `share` over the joints of a limb. `borders` has one entry fewer than `joints`.
  void AddChain(std::span<const std::string> joints, std::span<const Border> borders, float place,
                float share) {
    // Each border passes on what the joints before it have left, so the shares always sum to
    // `share`.
    float rest = share;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      float beyond = 0.0f;
      if (i < borders.size()) {
        const Border& b = borders[i];
        beyond = Smoothstep(b.at - b.half_width, b.at + b.half_width, place);
      }
      Add(joints[i], rest * (1.0f - beyond));
      rest *= beyond;
    }
  }

  [[nodiscard]] Influences Strongest() const { return sum_.Strongest(); }

 private:
  const wrinkle::Skeleton& skeleton_;
  InfluenceSum sum_;
};

const char* Suffix(float side) { return side >= 0.0f ? "_l" : "_r"; }

}  // namespace

Influences TorsoInfluences(const BodyShape& shape, const vec3& place) {
  const std::string side = Suffix(place.x);
  const float x = std::abs(place.x);
  const vec3 shoulder = shape.shoulder();
  // The border of the arm leans from the cap of the shoulder in to the armpit. It applies only
  // above the armpit.
  const vec3 from(x - shoulder.x, place.y - shoulder.y, 0.0f);
  const float across = glm::dot(from, vec3(0.97f, 0.24f, 0.0f));
  const float arm = Smoothstep(-0.055f, 0.075f, across) * Smoothstep(1.20f, 1.36f, place.y);
  const float shoulder_share =
      0.85f * Smoothstep(0.045f, 0.15f, x) * Smoothstep(1.27f, 1.43f, place.y);
  Shares shares(shape.skeleton());
  shares.Add("upper_arm" + side, arm);
  shares.Add("shoulder" + side, (1.0f - arm) * shoulder_share);
  const std::string joints[] = {"hips", "spine", "chest", "neck"};
  const Shares::Border borders[] = {{1.065f, 0.075f}, {1.20f, 0.10f}, {1.495f, 0.035f}};
  shares.AddChain(joints, borders, place.y, (1.0f - arm) * (1.0f - shoulder_share));
  return shares.Strongest();
}

Influences SleeveInfluences(const BodyShape& shape, float side, const vec3& place,
                            const Influences& hole, float from_hole) {
  const vec3 left(place.x * side, place.y, place.z);
  const float along = glm::dot(left - shape.shoulder(), shape.arm());
  const float elbow =
      glm::distance(vec3(shape.skeleton().rest_model()[shape.skeleton().Find("lower_arm_l")][3]),
                    vec3(shape.skeleton().rest_model()[shape.skeleton().Find("upper_arm_l")][3]));
  // At the armhole, the sleeve must move exactly like the torso that it is sewn to. It becomes free
  // within 10 cm.
  const float free = Smoothstep(0.0f, 0.10f, from_hole);
  Shares shares(shape.skeleton());
  shares.Add(hole, 1.0f - free);
  const std::string joints[] = {std::string("upper_arm") + Suffix(side),
                                std::string("lower_arm") + Suffix(side),
                                std::string("hand") + Suffix(side)};
  const Shares::Border borders[] = {{elbow, 0.055f}, {0.56f, 0.03f}};
  shares.AddChain(joints, borders, along, free);
  return shares.Strongest();
}

Influences TrouserInfluences(const BodyShape& shape, const vec3& place) {
  const std::string side = Suffix(place.x);
  const float x = std::abs(place.x);
  // The groin rises toward the side in front. Behind, the seat follows the thigh for a while.
  const float front = Smoothstep(-0.06f, 0.06f, place.z);
  const float groin = glm::mix(0.845f + 0.25f * x, 0.855f + 0.42f * x, front);
  const float half_width = glm::mix(0.085f, 0.06f, front);
  const float below = Smoothstep(groin + half_width, groin - half_width, place.y);
  // Where the legs meet, each has half of the weight.
  const float apart = Smoothstep(-0.045f, 0.045f, x);
  const float leg =
      below * glm::mix(Smoothstep(0.0f, 0.05f, x), apart, Smoothstep(0.83f, 0.78f, place.y));
  Shares shares(shape.skeleton());
  const std::string upper = "upper_leg" + side;
  const std::string pelvis[] = {"hips", "spine"};
  const Shares::Border waist[] = {{1.085f, 0.075f}};
  shares.AddChain(pelvis, waist, place.y, 1.0f - leg);
  const std::string joints[] = {upper, "lower_leg" + side, "foot" + side};
  const Shares::Border borders[] = {{-0.497f, 0.075f}, {-0.03f, 0.06f}};
  shares.AddChain(joints, borders, -place.y, leg);
  return shares.Strongest();
}

Influences ShoeInfluences(const BodyShape& shape, const vec3& place) {
  const std::string side = Suffix(place.x);
  Shares shares(shape.skeleton());
  const std::string joints[] = {"foot" + side, "toes" + side};
  const Shares::Border borders[] = {{0.110f, 0.03f}};
  shares.AddChain(joints, borders, place.z, 1.0f);
  return shares.Strongest();
}

Influences InfluenceOf(const wrinkle::Skeleton& skeleton, const std::string& joint) {
  Shares shares(skeleton);
  shares.Add(joint, 1.0f);
  return shares.Strongest();
}

// Inverts linear blend skinning per point: the renderer's skinning of the result gives back the
// modelled surface in the modelling pose.
void CarryToRest(const BodyShape& shape, QuadNet* net) {
  for (QuadNet::Point& point : net->points) {
    glm::mat4 blended(0.0f);
    for (int k = 0; k < 4; ++k) {
      blended += shape.skin_matrices()[point.skin.joints[k]] * point.skin.weights[k];
    }
    point.place = vec3(glm::inverse(blended) * glm::vec4(point.place, 1.0f));
  }
}

}  // namespace furrow::authoring
