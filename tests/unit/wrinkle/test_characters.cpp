// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/wrinkle/test_characters.h"

#include <algorithm>

#include "wrinkle/skeleton/retarget.h"

namespace furrow::wrinkle {
namespace {

int IndexOf(const std::vector<ModelJoint>& joints, const std::string& name) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].name == name) return static_cast<int>(i);
  }
  return kNoJoint;
}

Driver PoseDriverOn(const std::string& name, const std::string& joint, const std::string& stretch,
                    const std::string& squash) {
  Driver driver;
  driver.name = name;
  driver.pose.points = {{.joint = joint}};
  driver.pose.values = {{"stretch", stretch}, {"squash", squash}};
  return driver;
}

Driver Hinge(const std::string& name, const std::string& parent, const std::string& joint,
             const glm::vec3& axis) {
  Driver driver;
  driver.name = name;
  driver.kind = Driver::Kind::kHinge;
  driver.hinge = {.parent = parent, .joint = joint, .end = {}, .axis = axis};
  return driver;
}

Driver Ball(const std::string& name, const std::string& parent, const std::string& joint,
            const glm::vec3& bone) {
  Driver driver;
  driver.name = name;
  driver.kind = Driver::Kind::kBall;
  driver.ball = {.parent = parent, .joint = joint, .end = {}, .bone = bone};
  return driver;
}

Feed FeedOf(const std::string& map, const std::string& driver, const std::string& value) {
  return {.map = map, .sources = {{driver, value}}};
}

}  // namespace

Skeleton MakeSkeleton(const std::vector<ModelJoint>& joints, unsigned frame_seed) {
  std::mt19937 random(frame_seed);
  std::vector<glm::quat> frames;
  std::vector<JointDesc> descs;
  for (const ModelJoint& joint : joints) {
    const glm::quat frame =
        frame_seed == 0 ? glm::quat(1.0f, 0.0f, 0.0f, 0.0f) : RandomRotation(&random);
    JointDesc desc;
    desc.name = joint.name;
    desc.parent = IndexOf(joints, joint.parent);
    const bool root = desc.parent == kNoJoint;
    const glm::quat parent_inverse =
        root ? glm::quat(1.0f, 0.0f, 0.0f, 0.0f) : glm::conjugate(frames[desc.parent]);
    const glm::vec3 parent_origin = root ? glm::vec3(0.0f) : joints[desc.parent].origin;
    desc.rest.rotation = glm::normalize(parent_inverse * frame);
    desc.rest.translation = parent_inverse * (joint.origin - parent_origin);
    if (joint.tail) desc.tail = glm::conjugate(frame) * (*joint.tail - joint.origin);
    frames.push_back(frame);
    descs.push_back(desc);
  }
  return Skeleton::Create(descs).value();
}

Skeleton MakeBody(unsigned frame_seed, float scale) {
  std::vector<ModelJoint> joints = {
      {"hips", "", {0.0f, 1.0f, 0.0f}, {}},
      {"spine", "hips", {0.0f, 1.1f, 0.0f}, {}},
      {"neck", "spine", {0.0f, 1.45f, 0.0f}, {}},
      {"neck_upper", "neck", {0.0f, 1.5f, 0.0f}, {}},
      {"head", "neck_upper", {0.0f, 1.55f, 0.0f}, glm::vec3(0.0f, 1.75f, 0.0f)},
      {"brow_l", "head", {0.03f, 1.65f, 0.05f}, glm::vec3(0.03f, 1.66f, 0.1f)},
      {"brow_r", "head", {-0.03f, 1.65f, 0.05f}, glm::vec3(-0.03f, 1.66f, 0.1f)},
      {"cheek_l", "head", {0.04f, 1.6f, 0.05f}, glm::vec3(0.05f, 1.58f, 0.09f)},
      {"upper_arm_l", "spine", {0.15f, 1.4f, 0.0f}, {}},
      {"forearm_l", "upper_arm_l", {0.4f, 1.4f, 0.0f}, {}},
      {"hand_l", "forearm_l", {0.65f, 1.4f, 0.0f}, glm::vec3(0.8f, 1.4f, 0.0f)},
      {"thigh_l", "hips", {0.1f, 0.95f, 0.0f}, {}},
      {"shin_l", "thigh_l", {0.1f, 0.5f, 0.0f}, {}},
      {"foot_l", "shin_l", {0.1f, 0.08f, 0.0f}, glm::vec3(0.1f, 0.0f, 0.15f)},
      {"thigh_r", "hips", {-0.1f, 0.95f, 0.0f}, {}},
      {"shin_r", "thigh_r", {-0.1f, 0.5f, 0.0f}, {}},
      {"foot_r", "shin_r", {-0.1f, 0.08f, 0.0f}, glm::vec3(-0.1f, 0.0f, 0.15f)},
  };
  for (ModelJoint& joint : joints) {
    joint.origin *= scale;
    if (joint.tail) *joint.tail *= scale;
  }
  return MakeSkeleton(joints, frame_seed);
}

Driver CheekPatch() {
  Driver driver;
  driver.name = "cheek_patch";
  driver.kind = Driver::Kind::kStrain;
  StrainDriver& strain = driver.strain;
  strain.joint = "head";
  strain.joints = {"head", "cheek_l"};
  strain.direction = {0.0f, 1.0f, 0.0f};
  strain.size = SkeletonSize(MakeBody());
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 3; ++x) {
      const glm::vec2 at(static_cast<float>(x), static_cast<float>(y));
      StrainDriver::Vertex& vertex = strain.vertices.emplace_back();
      vertex.position = {0.03f + 0.01f * at.x, 0.03f + 0.01f * at.y, 0.08f - 0.004f * at.x};
      vertex.joints = {0, 1};  // the cheek moves what is low
      vertex.skin_weights = {0.5f * at.y, 1.0f - 0.5f * at.y};
      const int corner = y * 3 + x;
      if (x == 2 || y == 2) continue;
      for (const int i : {0, 1, 3, 1, 4, 3}) strain.triangles.push_back(corner + i);
    }
  }
  return driver;
}

Rig MakeRig() {
  Rig rig;
  rig.name = "test";
  rig.anchor = "head";
  const glm::vec3 x(1.0f, 0.0f, 0.0f);
  rig.reference_poses = {
      {.name = "stretch",
       .joints = {{"brow_l", AngleAxis(-25.0f, x)}, {"brow_r", AngleAxis(-25.0f, x)}}},
      {.name = "squash",
       .joints = {{"brow_l", AngleAxis(20.0f, {0.8f, 0.6f, 0.0f})},
                  {"brow_r", AngleAxis(20.0f, {0.8f, -0.6f, 0.0f})}}},
      {.name = "smile", .joints = {{"cheek_l", {1.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.02f, 0.005f}}}},
  };
  rig.drivers = {PoseDriverOn("brow_l", "brow_l", "stretch", "squash"),
                 PoseDriverOn("brow_r", "brow_r", "stretch", "squash"),
                 Hinge("knee_l", "thigh_l", "shin_l", x),
                 Ball("hip_l", "hips", "thigh_l", {0.0f, -1.0f, 0.0f}),
                 Ball("waist", "hips", "spine", {0.0f, 1.0f, 0.0f})};
  rig.drivers.back().ball.end = "neck";  // the spine's tail is the mean of neck and arm
  Driver smile;
  smile.name = "cheek_l";
  smile.pose.points = {{.joint = "cheek_l"}, {"cheek_l", ControlPoint::Kind::kOrigin}};
  smile.pose.values = {{"squash", "smile"}};
  smile.pose.falloff = 1.0f;
  rig.drivers.push_back(smile);
  Driver neck;
  neck.name = "neck";
  neck.kind = Driver::Kind::kTwist;
  neck.twist = {.joint = "neck", .axis = glm::vec3(0.0f, 1.0f, 0.0f), .through = {"neck_upper"}};
  rig.drivers.push_back(neck);
  Driver jaw;
  jaw.name = "jaw";
  jaw.kind = Driver::Kind::kBlendShape;
  jaw.blend_shape = {.blend_shape = "jawOpen"};
  rig.drivers.push_back(CheekPatch());
  rig.drivers.push_back(jaw);

  rig.wrinkle_maps = {
      {.name = "stretch", .opposes = "squash"}, {.name = "squash"}, {.name = "folds"}};
  const auto region = [](const std::string& name, std::vector<Feed> feeds,
                         Mask::Kind mask = Mask::Kind::kTexture) {
    Region result;
    result.name = name;
    result.mask.kind = mask;
    result.feeds = std::move(feeds);
    return result;
  };
  rig.regions = {
      region("brow_l",
             {FeedOf("stretch", "brow_l", "stretch"), FeedOf("squash", "brow_l", "squash")}),
      region("brow_r",
             {FeedOf("stretch", "brow_r", "stretch"), FeedOf("squash", "brow_r", "squash")}),
      region("cheek_l", {FeedOf("squash", "cheek_l", "squash")}, Mask::Kind::kSkinning),
      region("mouth", {FeedOf("stretch", "jaw", "value")}),
      region("knee_l_inner", {FeedOf("folds", "knee_l", "flexed")}, Mask::Kind::kSkinning),
      region("knee_l_outer", {FeedOf("folds", "knee_l", "extended")}),
      region("hip_l_front", {FeedOf("folds", "hip_l", "front")}),
      region("waist_left", {FeedOf("folds", "waist", "left")}),
      region("neck_left", {FeedOf("folds", "neck", "twist_left")}, Mask::Kind::kSkinning),
  };
  rig.regions[0].neighbours = {"brow_r"};
  return rig;
}

LocalPose RestPose(const Skeleton& skeleton) {
  LocalPose pose;
  pose.SetRest(skeleton);
  return pose;
}

void Turn(const Skeleton& skeleton, const std::string& joint, const glm::quat& rotation,
          LocalPose* pose) {
  const int index = skeleton.Find(joint);
  ASSERT_NE(index, kNoJoint) << joint;
  const glm::quat frame = skeleton.rest_model_rotations()[index];
  glm::quat& local = pose->joints[index].rotation;
  local = glm::normalize(skeleton.rest_pose()[index].rotation * glm::conjugate(frame) * rotation *
                         frame);
}

void Move(const Skeleton& skeleton, const std::string& joint, const glm::vec3& translation,
          LocalPose* pose) {
  const int index = skeleton.Find(joint);
  ASSERT_NE(index, kNoJoint) << joint;
  const int parent = skeleton.joint_parents()[index];
  const glm::vec3 local =
      parent == kNoJoint ? translation
                         : glm::conjugate(skeleton.rest_model_rotations()[parent]) * translation;
  pose->joints[index].translation = skeleton.rest_pose()[index].translation + local;
}

glm::quat AngleAxis(float degrees, const glm::vec3& axis) {
  return glm::angleAxis(glm::radians(degrees), glm::normalize(axis));
}

glm::quat RandomRotation(std::mt19937* random) {
  std::normal_distribution<float> normal;
  return glm::normalize(
      glm::quat(normal(*random), normal(*random), normal(*random), normal(*random)));
}

glm::vec3 RandomVector(std::mt19937* random, float length) {
  std::normal_distribution<float> normal;
  return length * glm::normalize(glm::vec3(normal(*random), normal(*random), normal(*random)));
}

void RandomPose(const Skeleton& skeleton, std::mt19937* random, LocalPose* pose) {
  pose->SetRest(skeleton);
  for (Transform& joint : pose->joints) {
    joint.rotation = RandomRotation(random);
    joint.translation += RandomVector(random, 0.05f);
  }
}

}  // namespace furrow::wrinkle
