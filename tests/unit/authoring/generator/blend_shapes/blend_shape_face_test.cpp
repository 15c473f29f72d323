// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/blend_shapes/blend_shape_face.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "authoring/generator/default_character.h"
#include "authoring/generator/head/head_shape.h"
#include "authoring/shapes/morph.h"
#include "rig/rig_check.h"
#include "rig/rig_file.h"
#include "rig/shapes/arkit_shapes.h"
#include "wrinkle/shapes/blend_shape_pose.h"
#include "wrinkle/skeleton/pose.h"
#include "wrinkle/solver/solver.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

// How far a shape moves the meshes, head space, centimetres.
struct Motion {
  vec3 centre{0.0f};  // the mean of the moved points, weighted by how far they move
  vec3 mean{0.0f};    // the mean motion, weighted likewise
  float sum = 0.0f;
  float largest = 0.0f;
};

class BlendShapeFaceTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto rig = rig::LoadRig(std::filesystem::path(FURROW_SOURCE_DIR) / "rig/rigs/default.json");
    ASSERT_TRUE(rig.ok()) << rig.status().ToString();
    jointed_ = new character::Character(MakeDefaultCharacter(*rig, {.texture_size = 64}));
    shaped_ = new character::Character(*jointed_);
    const Status status = MakeBlendShapeFace(shaped_);
    ASSERT_TRUE(status.ok()) << status.ToString();
  }
  static void TearDownTestSuite() {
    delete jointed_;
    delete shaped_;
  }

  static int ShapeOf(const std::string& name) {
    const auto& shapes = shaped_->shapes;
    return static_cast<int>(std::find(shapes.begin(), shapes.end(), name) - shapes.begin());
  }

  static const character::Mesh& MeshOf(const character::Character& c, const std::string& name) {
    const auto mesh = std::find_if(c.meshes.begin(), c.meshes.end(),
                                   [&](const auto& m) { return m.name == name; });
    EXPECT_NE(mesh, c.meshes.end()) << name;
    return mesh == c.meshes.end() ? c.meshes.front() : *mesh;
  }

  static Motion MotionOf(const character::Mesh& mesh, const std::string& shape) {
    Motion motion;
    for (const character::MorphTarget& target : mesh.morph_targets) {
      if (target.shape != ShapeOf(shape)) continue;
      for (const character::MorphDelta& delta : target.deltas) {
        const float length = 100.0f * glm::length(delta.position);
        motion.centre += length * ModelToHead(mesh.vertices[delta.vertex].position);
        motion.mean += length * 100.0f * delta.position;
        motion.sum += length;
        motion.largest = std::max(motion.largest, length);
      }
    }
    if (motion.sum > 0.0f) {
      motion.centre /= motion.sum;
      motion.mean /= motion.sum;
    }
    return motion;
  }

  // The skin under the jointed face's pose of `shape` at 1.
  static std::vector<vec3> Jointed(const character::Mesh& mesh, const std::string& shape) {
    const character::Character& c = *jointed_;
    const auto pose = wrinkle::BlendShapePose::Create(c.rig, c.skeleton, std::vector{shape});
    std::vector<wrinkle::Transform> local(c.skeleton.rest_pose().begin(),
                                          c.skeleton.rest_pose().end());
    EXPECT_EQ(pose.Run(std::vector{1.0f}, local), wrinkle::JobStatus::kOk);
    std::vector<glm::mat4> model(local.size());
    EXPECT_EQ((wrinkle::LocalToModelJob{&c.skeleton, local, model}.Run()), wrinkle::JobStatus::kOk);
    std::vector<vec3> positions;
    for (const character::Vertex& vertex : mesh.vertices) {
      vec3 sum(0.0f);
      for (int k = 0; k < 4; ++k) {
        const glm::mat4 skin = model[vertex.joints[k]] * c.inverse_bind_matrices[vertex.joints[k]];
        sum += vertex.skin_weights[k] * vec3(skin * glm::vec4(vertex.position, 1.0f));
      }
      positions.push_back(sum);
    }
    return positions;
  }

  static std::vector<float> Weights(const std::map<std::string, float>& values) {
    std::vector<float> weights(shaped_->shapes.size(), 0.0f);
    for (const auto& [name, value] : values)
      weights[static_cast<std::size_t>(ShapeOf(name))] = value;
    return weights;
  }

  static character::Character* jointed_;
  static character::Character* shaped_;
};
character::Character* BlendShapeFaceTest::jointed_ = nullptr;
character::Character* BlendShapeFaceTest::shaped_ = nullptr;

TEST_F(BlendShapeFaceTest, HasTheNamesOfArkit) {
  ASSERT_EQ(shaped_->shapes.size(), 52u);
  for (std::size_t i = 0; i < 52; ++i) EXPECT_EQ(shaped_->shapes[i], rig::ArkitShapes()[i]);
  for (const character::Mesh& mesh : shaped_->meshes) {
    int last = -1;
    for (const character::MorphTarget& target : mesh.morph_targets) {
      EXPECT_GT(target.shape, last) << mesh.name;
      last = target.shape;
      ASSERT_FALSE(target.deltas.empty()) << mesh.name;
      for (std::size_t i = 1; i < target.deltas.size(); ++i) {
        ASSERT_LT(target.deltas[i - 1].vertex, target.deltas[i].vertex) << mesh.name;
      }
      ASSERT_LT(target.deltas.back().vertex, mesh.vertices.size()) << mesh.name;
    }
  }
}

// Where each shape acts and where it moves the face: the left one of a pair, from the proportions
// of a head (eyes at y = 0, mouth at -6.9, its corner at x = 2.5, brow at 2.5).
TEST_F(BlendShapeFaceTest, EachShapeMovesWhatItsNameSays) {
  const struct {
    const char* shape;
    const char* mesh;
    vec3 centre;
    float reach;     // how far the centre may be away
    vec3 direction;  // of the mean motion; zero: not tested
  } kCases[] = {
      {"eyeBlink", "head", {3.2f, 0.6f, 8.4f}, 1.2f, {0, -1, 0}},
      {"eyeLookDown", "head", {3.2f, 0.5f, 8.4f}, 1.2f, {0, -1, 0}},
      {"eyeLookDown", "eyes", {3.2f, 0, 7.3f}, 1.0f, {0, 0, 0}},
      {"eyeLookIn", "eyes", {3.2f, 0, 7.3f}, 1.0f, {0, 0, 0}},
      {"eyeLookOut", "eyes", {3.2f, 0, 7.3f}, 1.0f, {0, 0, 0}},
      {"eyeLookUp", "head", {3.2f, 0.8f, 8.4f}, 1.2f, {0, 1, 0}},
      {"eyeSquint", "head", {3.2f, -0.6f, 8.2f}, 1.2f, {0, 0, 0}},
      {"eyeWide", "head", {3.2f, 0.8f, 8.4f}, 1.2f, {0, 1, 0}},
      {"mouthSmile", "head", {2.7f, -6.2f, 8.4f}, 1.5f, {1, 1, 0}},
      {"mouthFrown", "head", {2.5f, -7.3f, 8.6f}, 1.5f, {0, -1, 0}},
      {"mouthDimple", "head", {2.6f, -6.9f, 8.6f}, 1.2f, {1, 0, -1}},
      {"mouthStretch", "head", {2.6f, -8.2f, 7.8f}, 2.4f, {1, 0, 0}},
      {"mouthPress", "head", {1.2f, -7.0f, 9.3f}, 1.2f, {0, 0, -1}},
      {"mouthLowerDown", "head", {1.3f, -7.7f, 9.2f}, 1.2f, {0, -1, 0}},
      {"mouthUpperUp", "head", {1.5f, -6.0f, 9.3f}, 1.2f, {0, 1, 0}},
      {"browDown", "head", {2.3f, 2.2f, 8.6f}, 1.5f, {0, -1, 0}},
      {"browOuterUp", "head", {4.0f, 2.7f, 7.8f}, 1.5f, {0, 1, 0}},
      {"cheekSquint", "head", {3.9f, -2.8f, 7.6f}, 1.5f, {0, 1, 0}},
      {"noseSneer", "head", {1.3f, -3.6f, 9.5f}, 1.8f, {0, 1, 0}},
      {"jawForward", "head", {0, -9.5f, 6.0f}, 2.5f, {0, 0, 1}},
      {"jawLeft", "head", {0, -9.5f, 6.0f}, 2.5f, {1, 0, 0}},
      {"jawRight", "head", {0, -9.5f, 6.0f}, 2.5f, {-1, 0, 0}},
      {"jawOpen", "head", {0, -9.5f, 7.0f}, 2.5f, {0, -1, 0}},
      {"mouthClose", "head", {0, -7.5f, 9.3f}, 1.2f, {0, 1, 0}},
      {"mouthFunnel", "head", {0, -7.0f, 9.3f}, 1.2f, {0, 0, 1}},
      {"mouthPucker", "head", {0, -7.0f, 9.3f}, 1.2f, {0, 0, 1}},
      {"mouthLeft", "head", {0, -7.0f, 9.2f}, 1.2f, {1, 0, 0}},
      {"mouthRight", "head", {0, -7.0f, 9.2f}, 1.2f, {-1, 0, 0}},
      {"mouthRollLower", "head", {0, -7.5f, 9.5f}, 1.0f, {0, 0, -1}},
      {"mouthRollUpper", "head", {0, -6.4f, 9.5f}, 1.0f, {0, 0, -1}},
      {"mouthShrugLower", "head", {0, -8.6f, 9.2f}, 1.6f, {0, 1, 0}},
      {"mouthShrugUpper", "head", {0, -6.2f, 9.5f}, 1.2f, {0, 0, 1}},  // outward (Apple)
      {"browInnerUp", "head", {0, 2.4f, 9.0f}, 1.2f, {0, 1, 0}},
      {"cheekPuff", "head", {0, -5.9f, 8.4f}, 1.8f, {0, 0, 1}},
      {"tongueOut", "tongue", {0, -7.9f, 6.5f}, 1.5f, {0, 0, 1}},
  };
  for (const auto& c : kCases) {
    const std::string base = c.shape;
    const bool pair = ShapeOf(base) == 52;
    for (const float side : {1.0f, -1.0f}) {
      if (!pair && side < 0.0f) continue;
      const std::string name = pair ? base + (side > 0.0f ? "Left" : "Right") : base;
      SCOPED_TRACE(name + " on " + c.mesh);
      ASSERT_LT(ShapeOf(name), 52);
      const Motion motion = MotionOf(MeshOf(*shaped_, c.mesh), name);
      const vec3 centre(side * c.centre.x, c.centre.y, c.centre.z);
      EXPECT_LT(glm::distance(motion.centre, centre), c.reach)
          << motion.centre.x << " " << motion.centre.y << " " << motion.centre.z;
      EXPECT_GT(motion.largest, 0.05f);
      if (c.direction == vec3(0.0f)) continue;
      const vec3 direction(side * c.direction.x, c.direction.y, c.direction.z);
      EXPECT_GT(glm::dot(glm::normalize(motion.mean), glm::normalize(direction)), 0.5f)
          << motion.mean.x << " " << motion.mean.y << " " << motion.mean.z;
    }
  }
}

// The head is slightly asymmetric, so the sides are nearly equal.
TEST_F(BlendShapeFaceTest, SidesMirrorEachOther) {
  int pairs = 0;
  for (const std::string& left : shaped_->shapes) {
    if (!left.ends_with("Left")) continue;
    const std::string right = left.substr(0, left.size() - 4) + "Right";
    for (const char* name : {"head", "eyes"}) {
      const character::Mesh& mesh = MeshOf(*shaped_, name);
      const Motion l = MotionOf(mesh, left), r = MotionOf(mesh, right);
      SCOPED_TRACE(left + " on " + mesh.name);
      EXPECT_NEAR(l.sum, r.sum, 0.1f * l.sum + 0.05f);
      if (l.sum < 1.0f) continue;
      EXPECT_LT(glm::distance(l.centre, vec3(-r.centre.x, r.centre.y, r.centre.z)), 0.35f);
      EXPECT_LT(glm::distance(l.mean, vec3(-r.mean.x, r.mean.y, r.mean.z)), 0.05f);
      ++pairs;
    }
  }
  EXPECT_GT(pairs, 20);
}

TEST_F(BlendShapeFaceTest, EachShapeAloneIsTheJointedFace) {
  for (const std::string& shape : shaped_->shapes) {
    if (shape == "tongueOut" || shape == "mouthClose") continue;
    for (std::size_t m = 0; m < shaped_->meshes.size(); ++m) {
      const auto want = Jointed(jointed_->meshes[m], shape);
      const auto is = MorphedPositions(shaped_->meshes[m], Weights({{shape, 1.0f}}));
      ASSERT_EQ(want.size(), is.size());
      float worst = 0.0f;
      for (std::size_t v = 0; v < is.size(); ++v) {
        worst = std::max(worst, glm::distance(want[v], is[v]));
      }
      EXPECT_LT(worst, 3e-6f) << shape << " on " << shaped_->meshes[m].name;
    }
  }
}

// jawOpen alone parts the lips by centimetres. mouthClose closes them on the open jaw.
TEST_F(BlendShapeFaceTest, MouthCloseClosesTheOpenJaw) {
  const character::Mesh& skin = MeshOf(*shaped_, "head");
  // The middles of the lips: the points that each roll moves farthest, near x = 0.
  const auto middle = [&](const char* shape) {
    std::uint32_t best = 0;
    float most = 0.0f;
    for (const character::MorphTarget& target : skin.morph_targets) {
      if (target.shape != ShapeOf(shape)) continue;
      for (const character::MorphDelta& delta : target.deltas) {
        if (std::abs(skin.vertices[delta.vertex].position.x) > 0.004f) continue;
        if (glm::length(delta.position) <= most) continue;
        most = glm::length(delta.position);
        best = delta.vertex;
      }
    }
    return best;
  };
  const std::uint32_t upper = middle("mouthRollUpper"), lower = middle("mouthRollLower");
  const auto gap = [&](const std::map<std::string, float>& weights) {
    const auto p = MorphedPositions(skin, Weights(weights));
    return p[upper].y - p[lower].y;
  };
  const float neutral = gap({});
  EXPECT_GT(gap({{"jawOpen", 1.0f}}), neutral + 0.015f);
  EXPECT_NEAR(gap({{"jawOpen", 1.0f}, {"mouthClose", 1.0f}}), neutral, 0.001f)
      << gap({{"jawOpen", 1.0f}});
}

TEST_F(BlendShapeFaceTest, ShapesAddUp) {
  const character::Mesh& skin = MeshOf(*shaped_, "head");
  const auto base = MorphedPositions(skin, {});
  const auto smile = MorphedPositions(skin, Weights({{"mouthSmileLeft", 0.7f}}));
  const auto jaw = MorphedPositions(skin, Weights({{"jawOpen", 0.4f}}));
  const auto both = MorphedPositions(skin, Weights({{"mouthSmileLeft", 0.7f}, {"jawOpen", 0.4f}}));
  float moved = 0.0f;
  for (std::size_t v = 0; v < base.size(); ++v) {
    EXPECT_LT(glm::distance(both[v], smile[v] + jaw[v] - base[v]), 1e-6f);
    moved = std::max(moved, glm::distance(both[v], base[v]));
  }
  EXPECT_GT(moved, 0.005f);
}

TEST_F(BlendShapeFaceTest, NormalsFollowTheMovedSurface) {
  const character::Mesh& skin = MeshOf(*shaped_, "head");
  int turned = 0;
  for (const character::MorphTarget& target : skin.morph_targets) {
    for (const character::MorphDelta& delta : target.deltas) {
      const character::Vertex& vertex = skin.vertices[delta.vertex];
      const vec3 normal = glm::normalize(vertex.normal + delta.normal);
      const vec3 tangent = vec3(vertex.tangent) + delta.tangent;
      ASSERT_LT(std::abs(glm::dot(normal, glm::normalize(tangent))), 0.05f);
      turned += glm::dot(normal, vertex.normal) < 0.99f ? 1 : 0;
    }
  }
  EXPECT_GT(turned, 1000);
}

TEST_F(BlendShapeFaceTest, OnlyTheFaceLosesItsJoints) {
  const wrinkle::Skeleton& skeleton = shaped_->skeleton;
  for (const char* gone : {"jaw", "eye_l", "risorius_r", "platysma_l", "mentalis"}) {
    EXPECT_EQ(skeleton.Find(gone), wrinkle::kNoJoint) << gone;
  }
  ASSERT_EQ(shaped_->inverse_bind_matrices.size(), static_cast<std::size_t>(skeleton.num_joints()));
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    const int old = jointed_->skeleton.Find(skeleton.joint_names()[static_cast<std::size_t>(j)]);
    ASSERT_NE(old, wrinkle::kNoJoint);
    const glm::mat4& model = skeleton.rest_model()[static_cast<std::size_t>(j)];
    EXPECT_LT(
        glm::distance(vec3(model[3]),
                      vec3(jointed_->skeleton.rest_model()[static_cast<std::size_t>(old)][3])),
        1e-6f);
    const vec3 origin(model * shaped_->inverse_bind_matrices[static_cast<std::size_t>(j)] *
                      glm::vec4(0, 0, 0, 1));
    EXPECT_LT(glm::length(origin), 1e-5f);
  }
  for (const character::Mesh& mesh : shaped_->meshes) {
    for (const character::Vertex& vertex : mesh.vertices) {
      float sum = 0.0f;
      for (int k = 0; k < 4; ++k) {
        ASSERT_LT(vertex.joints[k], skeleton.num_joints());
        sum += vertex.skin_weights[k];
      }
      ASSERT_NEAR(sum, 1.0f, 1e-5f) << mesh.name;
    }
  }
}

// A tracker's stream has no joints; both rigs then compute equal weights.
TEST_F(BlendShapeFaceTest, WeightsOfAnArkitStreamAreThoseOfTheJointedFace) {
  ASSERT_TRUE(rig::CheckRig(shaped_->rig).ok());
  ASSERT_TRUE(
      wrinkle::RigBinding::Create(shaped_->rig, shaped_->skeleton, shaped_->shapes, {}).ok());
  const auto solver = [&](const wrinkle::Rig& rig) {
    auto binding = wrinkle::RigBinding::Create(rig, wrinkle::Skeleton(), shaped_->shapes,
                                               {.allow_missing = true});
    EXPECT_TRUE(binding.ok()) << binding.status().ToString();
    return wrinkle::SubjectSolver(
        std::make_shared<const wrinkle::RigBinding>(std::move(binding).value()), false);
  };
  wrinkle::SubjectSolver jointed = solver(jointed_->rig), shaped = solver(shaped_->rig);
  for (int frame = 0; frame < 60; ++frame) {
    wrinkle::LocalPose pose;
    for (int i = 0; i < 52; ++i) {
      pose.blend_shapes.push_back(static_cast<float>((frame * 37 + i * 61) % 101) / 100.0f);
    }
    ASSERT_EQ(jointed.Update(pose, 1.0 / 60.0), wrinkle::JobStatus::kOk);
    ASSERT_EQ(shaped.Update(pose, 1.0 / 60.0), wrinkle::JobStatus::kOk);
    const auto names = shaped.binding().weight_names();
    const auto others = jointed.binding().weight_names();
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto other = std::find(others.begin(), others.end(), names[i]);
      ASSERT_NE(other, others.end()) << names[i];
      EXPECT_EQ(shaped.wrinkle_weights()[i], jointed.wrinkle_weights()[other - others.begin()])
          << names[i];
    }
    EXPECT_EQ(names.size(), others.size());
  }
}

TEST_F(BlendShapeFaceTest, IsReproducible) {
  character::Character again = *jointed_;
  ASSERT_TRUE(MakeBlendShapeFace(&again).ok());
  for (std::size_t m = 0; m < again.meshes.size(); ++m) {
    const auto &a = again.meshes[m].morph_targets, &b = shaped_->meshes[m].morph_targets;
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t t = 0; t < a.size(); ++t) {
      ASSERT_EQ(a[t].deltas.size(), b[t].deltas.size());
      for (std::size_t i = 0; i < a[t].deltas.size(); ++i) {
        ASSERT_EQ(a[t].deltas[i].position, b[t].deltas[i].position);
        ASSERT_EQ(a[t].deltas[i].normal, b[t].deltas[i].normal);
      }
    }
  }
}

TEST_F(BlendShapeFaceTest, ARigWithoutThePosesIsNotFound) {
  character::Character without = *jointed_;
  without.rig.reference_poses.clear();
  EXPECT_EQ(MakeBlendShapeFace(&without).code(), StatusCode::kNotFound);
}

}  // namespace
}  // namespace furrow::authoring
