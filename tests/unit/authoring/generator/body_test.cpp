// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "authoring/generator/body/body_skeleton.h"
#include "authoring/generator/body/hand_net.h"
#include "authoring/generator/clothes/cloth_masks.h"
#include "authoring/generator/clothes/cloth_panels.h"
#include "authoring/generator/clothes/cloth_texture.h"
#include "authoring/generator/clothes/clothes.h"
#include "authoring/generator/clothes/shirt_net.h"
#include "authoring/generator/clothes/trousers_net.h"
#include "authoring/generator/mesh/mesh_tools.h"

namespace furrow::authoring {
namespace {

using glm::vec3;
using RoundedPlace = std::array<long, 3>;

RoundedPlace PlaceOf(const vec3& p) {
  return {std::lround(p.x * 1e5), std::lround(p.y * 1e5), std::lround(p.z * 1e5)};
}

// A body with its clothes.
struct Dressed {
  explicit Dressed(int level) : shape({.level = level}, skeleton, DefaultHead()) {}

  const wrinkle::Skeleton skeleton = MakeSkeleton();
  const BodyShape shape;
  const QuadNet shirt = MakeShirt(shape);
  const QuadNet trousers = MakeTrousers(shape);
  const Clothes clothes = MakeClothes(shape);
};

// Made once per level of detail, because it takes seconds.
const Dressed& DressedAt(int level) {
  static std::map<int, std::unique_ptr<const Dressed>> made;
  std::unique_ptr<const Dressed>& found = made[level];
  if (found == nullptr) found = std::make_unique<const Dressed>(level);
  return *found;
}

class BodyTest : public ::testing::TestWithParam<int> {
 protected:
  const Dressed& body_ = DressedAt(GetParam());
  const wrinkle::Skeleton& skeleton_ = body_.skeleton;
};

// The rims of a surface: the positions of edges that belong to one triangle only, with counts.
std::map<RoundedPlace, int> Rims(const character::Mesh& mesh) {
  std::map<std::pair<RoundedPlace, RoundedPlace>, int> uses;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    for (int k = 0; k < 3; ++k) {
      const RoundedPlace a = PlaceOf(mesh.vertices[mesh.indices[i + k]].position);
      const RoundedPlace b = PlaceOf(mesh.vertices[mesh.indices[i + (k + 1) % 3]].position);
      ++uses[std::minmax(a, b)];
    }
  }
  std::map<RoundedPlace, int> rims;
  for (const auto& [edge, count] : uses) {
    if (count == 1) ++rims[edge.first], ++rims[edge.second];
  }
  return rims;
}

TEST_P(BodyTest, ShirtAndSleevesAreOneSurface) {
  character::Mesh shirt;
  AppendNet(body_.shirt, &shirt);
  // Trunk and sleeves are open only at the hem and the cuffs. The collar has rims above the
  // neckline.
  for (const auto& [place, count] : Rims(shirt)) {
    const vec3 p = vec3(place[0], place[1], place[2]) * 1e-5f;
    const bool hem = p.y < 1.0f && std::abs(p.x) < 0.2f;
    const bool cuff = std::abs(p.x) > 0.4f;
    const bool collar = p.y > 1.40f && std::abs(p.x) < 0.13f;
    EXPECT_TRUE(hem || cuff || collar) << p.x << " " << p.y << " " << p.z;
  }
}

TEST_P(BodyTest, TrousersAreSewnBetweenTheLegs) {
  character::Mesh trousers;
  AppendNet(body_.trousers, &trousers);
  for (const auto& [place, count] : Rims(trousers)) {
    const float y = static_cast<float>(place[1]) * 1e-5f;
    EXPECT_TRUE(y < 0.1f || y > 1.0f) << y;
  }
}

// Singular values of each triangle's map from cloth to atlas, relative to its scale.
TEST_P(BodyTest, ClothUnwrapsWithLittleStretch) {
  QuadNet net = body_.shirt;
  Join(body_.trousers, &net);
  FlattenPanels(&net);
  double area = 0.0, stretched = 0.0;
  for (const std::array<int, 4>& quad : net.quads) {
    vec3 p[3];
    glm::vec2 uv[3];
    for (int k = 0; k < 3; ++k) {
      p[k] = net.points[net.corners[quad[k]].point].place;
      uv[k] = net.corners[quad[k]].uv;
    }
    const vec3 a = p[1] - p[0], b = p[2] - p[0];
    const float length = glm::length(a), along = glm::dot(a, b) / length;
    const float across = glm::length(glm::cross(a, b)) / length;
    if (length * across < 1e-8f) continue;
    const glm::vec2 du = (uv[1] - uv[0]) / length;
    const glm::vec2 dv = ((uv[2] - uv[0]) - du * along) / across;
    const float e = glm::dot(du, du), g = glm::dot(dv, dv), f = glm::dot(du, dv);
    const float root = std::sqrt((e - g) * (e - g) + 4 * f * f);
    const float most = std::sqrt(0.5f * (e + g + root));
    const float least = std::sqrt(std::max(0.5f * (e + g - root), 0.0f));
    const double weight = length * across;
    area += weight;
    if (most > 1.15f || least < 0.85f) stretched += weight;
  }
  EXPECT_LT(stretched, 0.05 * area);
}

TEST_P(BodyTest, SeamsStayClosed) {
  const Clothes& clothes = body_.clothes;
  ASSERT_EQ(clothes.vertex_panels.size(), clothes.mesh.vertices.size());
  ASSERT_EQ(clothes.panels.size(), static_cast<std::size_t>(kNumClothPanels));
  std::map<RoundedPlace, const character::Vertex*> first;
  int pairs = 0;
  for (const character::Vertex& vertex : clothes.mesh.vertices) {
    const auto [found, is_new] = first.emplace(PlaceOf(vertex.position), &vertex);
    if (is_new || found->second->position != vertex.position) continue;
    ++pairs;
    for (int k = 0; k < 4; ++k) {
      EXPECT_EQ(found->second->joints[k], vertex.joints[k]);
      EXPECT_EQ(found->second->skin_weights[k], vertex.skin_weights[k]);
    }
  }
  EXPECT_GT(pairs, 100);
}

// The skin weight of a joint at a point.
float ShareOf(const Influences& skin, int joint) {
  float share = 0.0f;
  for (int k = 0; k < 4; ++k) share += skin.joints[k] == joint ? skin.weights[k] : 0.0f;
  return share;
}

// Along each edge of the clothes the weight of a joint changes only by a fraction, so that the
// cloth bends smoothly.
TEST_P(BodyTest, ClothSkinWeightsAreSmooth) {
  for (const QuadNet& net : {body_.shirt, body_.trousers}) {
    const std::vector<std::vector<int>> neighbours = Neighbours(net);
    float steepest = 0.0f;
    for (std::size_t i = 0; i < net.points.size(); ++i) {
      for (const int n : neighbours[i]) {
        for (int j = 0; j < skeleton_.num_joints(); ++j) {
          steepest = std::max(
              steepest, std::abs(ShareOf(net.points[i].skin, j) - ShareOf(net.points[n].skin, j)));
        }
      }
    }
    EXPECT_LT(steepest, GetParam() == 0 ? 0.5f : 0.3f);
  }
}

// At least eight rings of edges lie within 10 cm of each elbow and knee.
TEST_P(BodyTest, LimbsHaveEdgeRingsAtTheirBends) {
  std::set<long> elbow, knee;
  for (const character::Vertex& vertex : body_.clothes.mesh.vertices) {
    const vec3& p = vertex.position;
    if (std::abs(p.x - 0.455f) < 0.1f) elbow.insert(std::lround(p.x * 500.0f));
    if (std::abs(p.y - 0.495f) < 0.1f && std::abs(p.x) < 0.2f)
      knee.insert(std::lround(p.y * 500.0f));
  }
  EXPECT_GE(elbow.size(), 8u);
  EXPECT_GE(knee.size(), 8u);
}

// In a fist every finger bends at its three joints until its tip is near the palm.
TEST_P(BodyTest, FingersClose) {
  for (const float side : {1.0f, -1.0f}) {
    const std::string suffix = side > 0.0f ? "_l" : "_r";
    const QuadNet hand = MakeHand(skeleton_, side, 0, GetParam());
    std::vector<glm::mat4> model(skeleton_.num_joints());
    for (int j = 0; j < skeleton_.num_joints(); ++j) {
      const std::string& name = skeleton_.joint_names()[j];
      const bool finger = name.find("_proximal" + suffix) != std::string::npos ||
                          name.find("_intermediate" + suffix) != std::string::npos ||
                          name.find("_distal" + suffix) != std::string::npos;
      const bool thumb = name.starts_with("thumb");
      const float angle = finger && !thumb ? -side * 1.4f : 0.0f;
      const glm::mat4 local =
          glm::rotate(glm::translate(glm::mat4(1.0f), skeleton_.rest_pose()[j].translation), angle,
                      vec3(0, 0, 1));
      const int parent = skeleton_.joint_parents()[j];
      model[j] = parent == wrinkle::kNoJoint ? local : model[parent] * local;
    }
    const vec3 wrist(skeleton_.rest_model()[skeleton_.Find("hand" + suffix)][3]);
    float stretched = 0.0f, closed = 0.0f;
    for (const QuadNet::Point& point : hand.points) {
      vec3 posed(0.0f);
      for (int k = 0; k < 4; ++k) {
        const int j = point.skin.joints[k];
        const glm::mat4 skin =
            model[j] * glm::translate(glm::mat4(1.0f), -vec3(skeleton_.rest_model()[j][3]));
        posed += point.skin.weights[k] * vec3(skin * glm::vec4(point.place, 1.0f));
      }
      stretched = std::max(stretched, side * (point.place.x - wrist.x));
      closed = std::max(closed, side * (posed.x - wrist.x));
    }
    EXPECT_GT(stretched, 0.17f);
    EXPECT_LT(closed, 0.135f);  // knuckles and the width of the first bones remain
  }
}

TEST_P(BodyTest, HandsAreOpenOnlyAtTheWrist) {
  character::Mesh hand;
  AppendNet(MakeHand(skeleton_, 1.0f, 0, GetParam()), &hand);
  for (const auto& [place, count] : Rims(hand)) EXPECT_LT(place[0], 70000);  // inside the cuff
}

INSTANTIATE_TEST_SUITE_P(Levels, BodyTest, ::testing::Values(0, 1));

TEST(GeneratorBody, BaseLevelHasAboutEightThousandTriangles) {
  const Dressed& body = DressedAt(0);
  character::Mesh hands;
  AddHands(body.shape, &hands);
  const std::size_t indices = body.clothes.mesh.indices.size() +
                              MakeLeather(body.shape).indices.size() + hands.indices.size();
  EXPECT_GT(indices / 3, 7000u);
  EXPECT_LT(indices / 3, 10000u);
}

TEST(GeneratorBody, ParametersChangeTheBody) {
  const BodyShape& man = DressedAt(0).shape;
  const BodyShape other({.waist = 1.1f, .hips = 1.12f, .bust = 0.03f, .level = 0},
                        DressedAt(0).skeleton, DefaultHead());
  const auto front = [](const BodyShape& shape, float y) {
    return CastOut([&](const vec3& p) { return shape.Shirt(p); }, {0, y, 0}, {0, 0, 1}, 0.4f).z;
  };
  EXPECT_GT(front(other, 1.265f), front(man, 1.265f) + 0.015f);
  EXPECT_LT(other.Trousers({0.18f, 0.9f, 0.0f}), man.Trousers({0.18f, 0.9f, 0.0f}));
}

// The two sides of a bend have separate masks, and each mask is full somewhere.
TEST(GeneratorBody, MasksDistinguishInnerFromOuter) {
  const auto masks = PaintClothMasks(DressedAt(0).clothes, 256);
  for (std::size_t i = 0; i < masks.size(); ++i) {
    const character::Picture& mask = masks[i];
    ASSERT_EQ(mask.name, kClothMaskNames[i]);
    int most[4] = {0, 0, 0, 0};
    for (std::size_t t = 0; t < mask.pixels.size(); t += 4) {
      int sum = 0;
      for (int c = 0; c < 4; ++c) {
        most[c] = std::max<int>(most[c], mask.pixels[t + c]);
        sum += mask.pixels[t + c];
      }
      EXPECT_LE(sum, 258);  // the masks share the surface; 3 for rounding
    }
    const int channels = mask.name == "cloth_masks_g" ? 2 : 4;
    for (int c = 0; c < channels; ++c) EXPECT_GT(most[c], 200) << mask.name << " " << c;
  }
}

}  // namespace
}  // namespace furrow::authoring
