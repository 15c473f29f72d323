// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include "authoring/generator/body/body_skeleton.h"
#include "authoring/generator/clothes/clothes.h"
#include "authoring/generator/head/face_parts.h"
#include "authoring/generator/head/hair_mesh.h"
#include "authoring/generator/head/head_shape.h"
#include "authoring/generator/head/head_skin.h"
#include "authoring/generator/head/skinning.h"
#include "authoring/generator/mesh/mesh_tools.h"
#include "authoring/generator/textures/textures.h"
#include "authoring/paint/hair_strands.h"

namespace furrow::authoring {
namespace {

character::Mesh MakeSkin(const wrinkle::Skeleton& skeleton) {
  HeadMesh head = MakeHeadSkin();
  SkinHead(skeleton, &head);
  AddHands(BodyShape({}, skeleton, DefaultHead()), &head.mesh);
  FinishSurface(&head.mesh);
  return std::move(head.mesh);
}

std::vector<character::Mesh> AllMeshes() {
  const wrinkle::Skeleton skeleton = MakeSkeleton();
  const BodyShape body({}, skeleton, DefaultHead());
  std::vector<character::Mesh> meshes = {MakeSkin(skeleton), MakeClothes(body).mesh,
                                         MakeLeather(body)};
  for (HeadMesh part : {MakeEyes(), MakeHair(), MakeLashes(), MakeTeeth(), MakeTongue()}) {
    SkinHead(skeleton, &part);
    meshes.push_back(std::move(part.mesh));
  }
  return meshes;
}

TEST(GeneratorMesh, HasNoDegenerateTrianglesAndUnitFrames) {
  for (const character::Mesh& mesh : AllMeshes()) {
    SCOPED_TRACE(mesh.name);
    ASSERT_FALSE(mesh.indices.empty());
    ASSERT_EQ(mesh.indices.size() % 3, 0u);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const glm::vec3 a = mesh.vertices[mesh.indices[i]].position;
      const glm::vec3 b = mesh.vertices[mesh.indices[i + 1]].position;
      const glm::vec3 c = mesh.vertices[mesh.indices[i + 2]].position;
      ASSERT_GT(glm::length(glm::cross(b - a, c - a)), 1e-11f) << "triangle " << i / 3;
    }
    for (const character::Vertex& vertex : mesh.vertices) {
      ASSERT_NEAR(glm::length(vertex.normal), 1.0f, 1e-4f);
      ASSERT_NEAR(glm::dot(vertex.normal, glm::vec3(vertex.tangent)), 0.0f, 1e-3f);
      ASSERT_EQ(std::abs(vertex.tangent.w), 1.0f);
    }
  }
}

TEST(GeneratorMesh, TongueLiesBehindTheLowerTeethAndMovesWithTheJaw) {
  const wrinkle::Skeleton skeleton = MakeSkeleton();
  HeadMesh tongue = MakeTongue();
  SkinHead(skeleton, &tongue);
  std::vector<glm::vec3> lower_teeth;
  for (const HeadVertex& tooth : MakeTeeth().info) {
    if (tooth.mouth_side < 0.0f) lower_teeth.push_back(tooth.place);
  }
  for (const glm::vec3& tooth : lower_teeth) {
    for (const HeadVertex& v : tongue.info) {  // behind the teeth next to it
      if (std::abs(v.place.x - tooth.x) < 0.2f) ASSERT_LT(v.place.z, tooth.z);
    }
  }
  for (const character::Vertex& vertex : tongue.mesh.vertices) {
    ASSERT_EQ(vertex.joints[0], skeleton.Find("jaw"));
    ASSERT_FLOAT_EQ(vertex.skin_weights[0], 1.0f);
  }
}

TEST(GeneratorMesh, SkinWeightsSumToOneOnJointsOfTheSkeleton) {
  const int num_joints = MakeSkeleton().num_joints();
  for (const character::Mesh& mesh : AllMeshes()) {
    SCOPED_TRACE(mesh.name);
    for (const character::Vertex& vertex : mesh.vertices) {
      float sum = 0.0f;
      for (int k = 0; k < 4; ++k) {
        ASSERT_GE(vertex.skin_weights[k], 0.0f);
        ASSERT_LT(vertex.joints[k], num_joints);
        sum += vertex.skin_weights[k];
      }
      ASSERT_NEAR(sum, 1.0f, 1e-5f);
    }
  }
}

// Twice the signed area of (a, b, p).
double Edge(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

// The number of texel centres that lie inside more than one triangle of the unwrapping.
int CountOverlap(const character::Mesh& mesh, int size) {
  std::vector<int> hits(static_cast<std::size_t>(size) * size, 0);
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    glm::dvec2 p[3];
    for (int k = 0; k < 3; ++k) {
      p[k] = glm::dvec2(mesh.vertices[mesh.indices[i + k]].uv) * static_cast<double>(size);
    }
    const double area = Edge(p[0], p[1], p[2]);
    if (std::abs(area) < 1e-9) continue;
    const glm::dvec2 low = glm::min(p[0], glm::min(p[1], p[2]));
    const glm::dvec2 high = glm::max(p[0], glm::max(p[1], p[2]));
    for (int y = static_cast<int>(low.y); y <= high.y && y < size; ++y) {
      for (int x = static_cast<int>(low.x); x <= high.x && x < size; ++x) {
        const glm::dvec2 q(x + 0.5, y + 0.5);
        bool inside = true;
        for (int k = 0; k < 3; ++k) {
          inside = inside && Edge(p[k], p[(k + 1) % 3], q) / area > 1e-4;
        }
        hits[static_cast<std::size_t>(y) * size + x] += inside;
      }
    }
  }
  int overlap = 0;
  for (const int count : hits) overlap += count > 1;
  return overlap;
}

// The part of the hair below the tiles of strands. Locks share those tiles, and the cap has its own
// texels. No triangle uses both.
character::Mesh CapOf(const character::Mesh& hair) {
  character::Mesh cap = hair;
  cap.indices.clear();
  for (std::size_t i = 0; i < hair.indices.size(); i += 3) {
    int below = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      below += hair.vertices[hair.indices[i + k]].uv.y >= kStrandBottom;
    }
    EXPECT_EQ(below % 3, 0);
    if (below > 0) cap.indices.insert(cap.indices.end(), &hair.indices[i], &hair.indices[i] + 3);
  }
  EXPECT_FALSE(cap.indices.empty());
  return cap;
}

TEST(GeneratorMesh, UvsLieInTheUnitSquareAndDoNotOverlap) {
  for (const character::Mesh& mesh : AllMeshes()) {
    SCOPED_TRACE(mesh.name);
    for (const character::Vertex& vertex : mesh.vertices) {
      ASSERT_GE(vertex.uv.x, 0.0f);
      ASSERT_LE(vertex.uv.x, 1.0f);
      ASSERT_GE(vertex.uv.y, 0.0f);
      ASSERT_LE(vertex.uv.y, 1.0f);
    }
    if (mesh.name == "lashes") continue;  // all lashes show the same texels
    EXPECT_EQ(CountOverlap(mesh.name == "hair" ? CapOf(mesh) : mesh, 1024), 0);
  }
}

// The last mip level of a lash is below the cut-off, and the first level shows all of the lash.
TEST(GeneratorMesh, LashesFadeInTheDistance) {
  const character::Picture lash = PaintLash();
  double sum = 0.0;
  int drawn = 0;
  for (int y = 0; y < lash.height; ++y) {
    int row = 0;
    for (int x = 0; x < lash.width; ++x) {
      const float alpha = character::ChannelAt(
          lash, (glm::vec2(x, y) + 0.5f) / glm::vec2(lash.width, lash.height), 3);
      sum += alpha;
      row += alpha >= kStrandCutoff;
    }
    drawn += row > 0;
  }
  EXPECT_LT(sum / (lash.width * lash.height), kStrandCutoff);
  EXPECT_EQ(drawn, lash.height);
}

// Every edge (by position) is used at most once in each direction, so neighbouring triangles have
// the same outside.
TEST(GeneratorMesh, NeighbouringTrianglesHaveTheSameWinding) {
  const character::Mesh skin = MakeSkin(MakeSkeleton());
  using Place = std::array<long, 3>;
  const auto place = [&](std::uint32_t i) {
    const glm::vec3 p = skin.vertices[i].position;
    return Place{std::lround(p.x * 1e6), std::lround(p.y * 1e6), std::lround(p.z * 1e6)};
  };
  std::map<std::pair<Place, Place>, int> edges;
  for (std::size_t i = 0; i < skin.indices.size(); i += 3) {
    for (int k = 0; k < 3; ++k) {
      ++edges[{place(skin.indices[i + k]), place(skin.indices[i + (k + 1) % 3])}];
    }
  }
  int twice = 0;
  for (const auto& [edge, count] : edges) twice += count > 1;
  EXPECT_EQ(twice, 0);
}

// The face looks along +Z, and the normals of its front point outwards.
TEST(GeneratorMesh, NormalsPointOutOfTheHead) {
  const HeadMesh head = MakeHeadSkin();
  int outward = 0;
  int front = 0;
  for (std::size_t i = 0; i < head.info.size(); ++i) {
    const glm::vec3 p = head.info[i].place;
    if (head.info[i].part != kFacePart || std::abs(DefaultHead().Distance(p)) > 0.01f) continue;
    ++front;
    outward += glm::dot(head.mesh.vertices[i].normal, DefaultHead().Normal(p)) > 0.0f;
  }
  ASSERT_GT(front, 2000);
  EXPECT_GT(outward, front * 99 / 100);
}

// An ear is closed except at the head. With outward winding its volume is positive.
TEST(GeneratorMesh, EarsFaceOutward) {
  const HeadMesh head = MakeHeadSkin();
  float volume[2] = {0.0f, 0.0f};  // cubic centimetres; right, left
  for (std::size_t i = 0; i < head.mesh.indices.size(); i += 3) {
    const std::uint32_t* t = &head.mesh.indices[i];
    if (head.info[t[0]].part != kEar) continue;
    const float side = head.info[t[0]].place.x > 0.0f ? 1.0f : -1.0f;
    const glm::vec3 inside(side * 7.5f, -1.35f, -1.5f);
    const glm::vec3 a = head.info[t[0]].place - inside;
    const glm::vec3 b = head.info[t[1]].place - inside;
    const glm::vec3 c = head.info[t[2]].place - inside;
    volume[side > 0.0f] += glm::dot(a, glm::cross(b, c)) / 6.0f;
  }
  EXPECT_GT(volume[0], 1.0f);
  EXPECT_GT(volume[1], 1.0f);
}

TEST(GeneratorMesh, HasAdultProportions) {
  const HeadMesh head = MakeHeadSkin();
  glm::vec3 low(1e9f), high(-1e9f);
  for (const HeadVertex& info : head.info) {
    if (info.part != kFacePart || info.place.y < -8.0f) continue;
    low = glm::min(low, info.place);
    high = glm::max(high, info.place);
  }
  EXPECT_NEAR(high.y, 11.5f, 0.6f);                         // crown above the eyes: half of 23 cm
  EXPECT_NEAR(high.x - low.x, 15.2f, 1.0f);                 // width of the skull
  EXPECT_GT(EyeCentre(1.0f).x - EyeCentre(-1.0f).x, 6.0f);  // pupils 63 mm apart
  EXPECT_LT(EyeCentre(1.0f).x - EyeCentre(-1.0f).x, 6.6f);
  // The eyelids touch the eyeball: the nearest skin is within 1 mm of it, and no skin is inside it.
  float nearest = 1e9f;
  for (const HeadVertex& info : head.info) {
    nearest = std::min(nearest, glm::distance(info.place, EyeCentre(1.0f)) - kEyeRadius);
  }
  EXPECT_LT(nearest, 0.1f);
  EXPECT_GT(nearest, 0.0f);
}

// Closed lips separate when the jaw opens, because only the lower lip follows the jaw.
TEST(GeneratorMesh, LipsPartWithTheJaw) {
  const wrinkle::Skeleton skeleton = MakeSkeleton();
  HeadMesh head = MakeHeadSkin();
  SkinHead(skeleton, &head);
  const auto under_jaw = [&](const character::Vertex& vertex) {
    float share = 0.0f;
    for (int k = 0; k < 4; ++k) {
      if (skeleton.IsAncestor(skeleton.Find("jaw"), vertex.joints[k])) {
        share += vertex.skin_weights[k];
      }
    }
    return share;
  };
  int upper = 0, lower = 0;
  for (std::size_t i = 0; i < head.info.size(); ++i) {
    const HeadVertex& info = head.info[i];
    if (info.part != kFacePart || std::abs(info.place.x) > 1.0f || info.place.z < 8.0f) continue;
    if (std::abs(info.place.y - kMouthY) > 0.3f) continue;
    if (info.mouth_side > 0.0f) {
      ++upper;
      EXPECT_LT(under_jaw(head.mesh.vertices[i]), 0.05f);
    } else if (info.mouth_side < 0.0f) {
      ++lower;
      EXPECT_GT(under_jaw(head.mesh.vertices[i]), 0.9f);
    }
  }
  EXPECT_GE(upper, 5);
  EXPECT_GE(lower, 5);
}

// Coincident vertices have equal skin weights, so that no gap opens at the UV seam or between the
// lips and the lining of the mouth.
TEST(GeneratorMesh, SeamsStayClosed) {
  HeadMesh head = MakeHeadSkin();
  SkinHead(MakeSkeleton(), &head);
  // The key includes the side of the opening: the two lips and the two lids touch but must
  // separate.
  using Place = std::tuple<float, float, float, float, float>;
  std::map<Place, const character::Vertex*> first;
  int pairs = 0;
  for (std::size_t i = 0; i < head.info.size(); ++i) {
    const HeadVertex& info = head.info[i];
    const character::Vertex& vertex = head.mesh.vertices[i];
    const Place place{info.place.x, info.place.y, info.place.z, info.mouth_side, info.eye_side};
    const auto [found, is_new] = first.emplace(place, &vertex);
    if (is_new) continue;
    ++pairs;
    for (int k = 0; k < 4; ++k) {
      EXPECT_EQ(found->second->joints[k], vertex.joints[k]) << "vertex " << i;
      EXPECT_EQ(found->second->skin_weights[k], vertex.skin_weights[k]) << "vertex " << i;
    }
  }
  EXPECT_GT(pairs, 40);
}

TEST(GeneratorSkeleton, StandsOnTheFloorAndIsSymmetric) {
  const wrinkle::Skeleton skeleton = MakeSkeleton();
  ASSERT_EQ(skeleton.num_joints(), static_cast<int>(JointPlaces().size()));
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    const std::string& name = skeleton.joint_names()[j];
    EXPECT_EQ(skeleton.rest_pose()[j].rotation, glm::quat(1, 0, 0, 0)) << name;
    if (!name.ends_with("_l")) continue;
    const int other = skeleton.Find(name.substr(0, name.size() - 2) + "_r");
    ASSERT_NE(other, wrinkle::kNoJoint) << name;
    EXPECT_NEAR(skeleton.rest_model()[j][3].x, -skeleton.rest_model()[other][3].x, 1e-5f) << name;
    EXPECT_GT(skeleton.rest_model()[j][3].x, 0.0f) << name;
  }
  float low = 1e9f, high = -1e9f;
  for (const character::Mesh& mesh : AllMeshes()) {
    for (const character::Vertex& vertex : mesh.vertices) {
      low = std::min(low, vertex.position.y);
      high = std::max(high, vertex.position.y);
    }
  }
  EXPECT_NEAR(low, 0.0f, 0.005f);
  EXPECT_NEAR(high, 1.77f, 0.03f);  // 1.75 m plus the hair
}

}  // namespace
}  // namespace furrow::authoring
