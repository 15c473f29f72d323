// SPDX-License-Identifier: Apache-2.0
#include "rig/skeleton_match.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "authoring/generator/default_character.h"
#include "base/scalar.h"
#include "motion/clip_file.h"
#include "rig/rig_file.h"
#include "tests/unit/rig/shipped_matcher.h"
#include "wrinkle/hierarchy/hierarchy_roles.h"
#include "wrinkle/solver/subject_solver.h"

namespace furrow::rig {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using enum wrinkle::JointRole;

// A body whose torso, neck and head are `column`, from bottom to top, after the hips.
class NamedBody {
 public:
  NamedBody(const std::string& hips, const std::vector<std::string>& column,
            const std::vector<std::string>& limbs) {
    std::vector<wrinkle::JointDesc> joints = {{hips, -1, {{0, 1, 0}}, {}}};
    for (const std::string& name : column) {
      joints.push_back({name, static_cast<int>(joints.size()) - 1, {{0, 0.1f, 0}}, {}});
    }
    for (const std::string& name : limbs) joints.push_back({name, 0, {{0.1f, 0, 0}}, {}});
    skeleton_ = *wrinkle::Skeleton::Create(std::move(joints));
    pose_.SetRest(skeleton_);
  }

  const wrinkle::Skeleton& skeleton() const { return skeleton_; }
  void Twist(const std::string& joint, float degrees) {
    wrinkle::Transform& local = pose_.joints[static_cast<std::size_t>(skeleton_.Find(joint))];
    local.rotation = glm::angleAxis(degrees * kDegrees, glm::vec3(0, 1, 0));
  }
  const wrinkle::LocalPose& pose() const { return pose_; }

 private:
  wrinkle::Skeleton skeleton_;
  wrinkle::LocalPose pose_;
};

class SkeletonMatching : public testing::Test {
 protected:
  void SetUp() override {
    auto matcher = ShippedMatcher();
    ASSERT_TRUE(matcher.ok()) << matcher.status().ToString();
    matcher_ = *std::move(matcher);
  }
  static wrinkle::Rig Shipped(const std::string& name) {
    return *LoadRig(std::string(FURROW_SOURCE_DIR "/rig/rigs/") + name);
  }
  float Value(const wrinkle::Rig& rig, const NamedBody& body, const std::string& name) const {
    const SkeletonMatch match = matcher_.Match(body.skeleton(), rig, nullptr);
    auto binding = wrinkle::RigBinding::Create(rig, body.skeleton(), {}, match.Options(true));
    EXPECT_TRUE(binding.ok()) << binding.status().ToString();
    auto shared = std::make_shared<const wrinkle::RigBinding>(*std::move(binding));
    wrinkle::SubjectSolver solver(shared, false);
    EXPECT_EQ(solver.Update(body.pose(), 0.0), wrinkle::JobStatus::kOk);
    const auto names = shared->driver_value_names();
    const auto at = std::ranges::find(names, name);
    EXPECT_NE(at, names.end()) << name;
    return solver.driver_values()[static_cast<std::size_t>(at - names.begin())];
  }
  // All driver values of a pose, bound by roles.
  std::vector<float> AllValues(const wrinkle::Rig& rig, const wrinkle::Skeleton& skeleton,
                               const wrinkle::LocalPose& pose) const {
    const SkeletonMatch match = matcher_.Match(skeleton, rig, nullptr);
    auto binding = wrinkle::RigBinding::Create(rig, skeleton, {}, match.Options(true));
    EXPECT_TRUE(binding.ok()) << binding.status().ToString();
    wrinkle::SubjectSolver solver(std::make_shared<const wrinkle::RigBinding>(*std::move(binding)),
                                  false);
    EXPECT_EQ(solver.Update(pose, 0.0), wrinkle::JobStatus::kOk);
    return {solver.driver_values().begin(), solver.driver_values().end()};
  }

  SkeletonMatcher matcher_;
};

const std::vector<std::string> kMixamoLimbs = {"mixamorig:LeftUpLeg", "mixamorig:RightUpLeg",
                                               "mixamorig:LeftArm", "mixamorig:RightArm"};
const std::vector<std::string> kMakeHumanLimbs = {"upperleg01.L", "upperleg01.R", "upperarm01.L",
                                                  "upperarm01.R"};

// CMU's neck has two joints, Mixamo's has one. Neck and head together give 1 at 75 degrees.
TEST_F(SkeletonMatching, AJointThatPlaysTwoTwistsOnce) {
  NamedBody body("mixamorig:Hips",
                 {"mixamorig:Spine", "mixamorig:Spine1", "mixamorig:Spine2", "mixamorig:Neck",
                  "mixamorig:Head"},
                 kMixamoLimbs);
  body.Twist("mixamorig:Neck", 30.0f);
  EXPECT_NEAR(Value(Shipped("cmu.json"), body, "neck.twist_left"), 0.4f, 1e-5f);
  body.Twist("mixamorig:Head", 15.0f);
  EXPECT_NEAR(Value(Shipped("cmu.json"), body, "neck.twist_left"), 0.6f, 1e-5f);
}

// The default character has two joints in the spine and one in the neck, MakeHuman five and three.
TEST_F(SkeletonMatching, AllJointsOfAChainCount) {
  const wrinkle::Rig rig = Shipped("default.json");
  for (const char* joint : {"spine05", "spine04", "spine03", "spine02", "spine01"}) {
    NamedBody body("root",
                   {"spine05", "spine04", "spine03", "spine02", "spine01", "neck01", "neck02",
                    "neck03", "head"},
                   kMakeHumanLimbs);
    body.Twist(joint, -9.0f);
    EXPECT_NEAR(Value(rig, body, "waist_twist.twist_right"), 0.2f, 1e-5f) << joint;
    EXPECT_EQ(Value(rig, body, "neck.twist_right"), 0.0f) << joint;
    body.Twist("neck02", 15.0f);
    EXPECT_NEAR(Value(rig, body, "neck.twist_left"), 0.2f, 1e-5f);
  }
}

// CMU's spine has three roles. A body with two of them can still twist its waist.
TEST_F(SkeletonMatching, ARoleThatOnlyTheRigHasIsNoGap) {
  NamedBody body("hips", {"spine", "chest", "neck", "head"},
                 {"upper_leg_l", "upper_leg_r", "upper_arm_l", "upper_arm_r"});
  body.Twist("spine", 9.0f);
  body.Twist("chest", 18.0f);
  EXPECT_NEAR(Value(Shipped("cmu.json"), body, "waist_twist.twist_left"), 0.6f, 1e-5f);
}

// "Spine" is the chest of CMU's files and the spine of Mixamo's.
TEST_F(SkeletonMatching, RolesDecideWhereEqualNamesMeanOtherJoints) {
  NamedBody body("Hips", {"Spine", "Spine1", "Spine2", "Neck", "Head", "HeadTop_End"},
                 {"LeftUpLeg", "RightUpLeg", "LeftArm", "RightArm", "LeftHandThumb1",
                  "LeftHandThumb2", "LeftHandIndex2", "LeftHandIndex3"});
  const wrinkle::Rig rig = Shipped("cmu.json");
  ASSERT_EQ(matcher_.Match(body.skeleton(), rig, nullptr).stream.map, "mixamo");
  body.Twist("Spine", 3.0f);
  body.Twist("Spine1", 6.0f);
  body.Twist("Spine2", 18.0f);
  EXPECT_NEAR(Value(rig, body, "waist_twist.twist_left"), 0.6f, 1e-5f);
}

// On its own skeleton a rig reads the joints that it names, and no others of their chains.
TEST_F(SkeletonMatching, EqualNamesStayAlone) {
  wrinkle::Rig rig;
  rig.drivers.resize(1);
  rig.drivers[0].name = "waist";
  rig.drivers[0].kind = wrinkle::Driver::Kind::kTwist;
  rig.drivers[0].twist = {.joint = "spine05", .full_degrees = 45.0f, .through = {"spine03"}};
  NamedBody body("root", {"spine05", "spine04", "spine03", "spine02", "spine01", "neck01", "head"},
                 kMakeHumanLimbs);
  EXPECT_THAT(matcher_.Match(body.skeleton(), rig, nullptr).role_chains, IsEmpty());
  body.Twist("spine04", 9.0f);
  EXPECT_EQ(Value(rig, body, "waist.twist_left"), 0.0f);
  body.Twist("spine03", 9.0f);
  EXPECT_NEAR(Value(rig, body, "waist.twist_left"), 0.2f, 1e-5f);
}

TEST_F(SkeletonMatching, OnlyTwistDriversReadWholeChains) {
  const NamedBody body("root", {"spine05", "spine04", "neck01", "head"}, kMakeHumanLimbs);
  const SkeletonMatch match = matcher_.Match(body.skeleton(), Shipped("default.json"), nullptr);
  std::vector<std::string> joints;
  for (const wrinkle::RoleChain& chain : match.role_chains) joints.push_back(chain.joint);
  EXPECT_THAT(joints, ElementsAre("chest", "neck", "spine"));
  EXPECT_TRUE(match.Reads("spine04"));
  EXPECT_FALSE(match.Reads("clavicle.L"));
}

// Quarter turns about all axes: files that are Z-up, and bodies that face any side.
std::vector<glm::quat> QuarterTurns() {
  std::vector<glm::quat> turns;
  const glm::vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const glm::vec3& axis : axes) {
    for (const float degrees : {90.0f, 180.0f, -90.0f}) {
      turns.push_back(glm::angleAxis(degrees * kDegrees, axis));
    }
  }
  turns.push_back(turns[3] * turns[0]);
  turns.push_back(turns[0] * turns[5]);
  return turns;
}

// The axes of a file change nothing: neither axes, sides and poses of the rig, nor its weights.
TEST_F(SkeletonMatching, ValuesDoNotDependOnTheAxesOfTheFile) {
  const wrinkle::Rig rig = Shipped("default.json");
  const wrinkle::Skeleton upright =
      authoring::MakeDefaultCharacter(rig, {.texture_size = 64}).skeleton;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  wrinkle::LocalPose pose;
  pose.SetRest(upright);
  for (wrinkle::Transform& local : pose.joints) {
    const glm::vec3 axis(uniform(random), uniform(random), uniform(random));
    local.rotation = local.rotation * glm::angleAxis(0.5f * uniform(random), glm::normalize(axis));
    local.translation += 0.004f * glm::vec3(uniform(random), uniform(random), uniform(random));
  }
  const std::vector<float> wanted = AllValues(rig, upright, pose);
  EXPECT_GT(std::ranges::count_if(wanted, [](float v) { return v > 0.1f; }), 10);
  for (const glm::quat& turn : QuarterTurns()) {
    const wrinkle::Skeleton turned = wrinkle::TurnRoots(upright, turn);
    wrinkle::LocalPose other = pose;
    wrinkle::TurnRoots(upright, turn, other.joints);
    const std::vector<float> found = AllValues(rig, turned, other);
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(found[i], wanted[i], 2e-4f) << i;
  }
}

// Drivers that measure roots: poses without an anchor, and the twist of the hips.
TEST_F(SkeletonMatching, ValuesOfModelSpaceDoNotDependOnTheAxesEither) {
  const auto parsed = ParseRig(R"({"name": "r", "reference_poses": [
      {"name": "step", "joints": [
        {"joint": "hips", "translation": [0.1, 0.02, 0.3], "euler_degrees": [5, 20, 0]}]},
      {"name": "reach", "joints": [
        {"joint": "upper_arm_l", "euler_degrees": [0, -60, 25]},
        {"joint": "hips", "translation": [-0.1, -0.05, 0.1]}]}],
    "drivers": [
      {"name": "away", "pose": {"points": [{"joint": "hips", "kind": "origin"}, {"joint": "hand_l"}],
        "values": [{"name": "step", "reference_pose": "step"},
                   {"name": "reach", "reference_pose": "reach"}]}},
      {"name": "falls", "pose": {"points": [{"joint": "hand_l"}], "falloff": 2,
        "values": [{"name": "reach", "reference_pose": "reach"}]}},
      {"name": "both", "pose": {"points": [{"joint": "head"}, {"joint": "hand_l"}], "solve": "nnls",
        "values": [{"name": "step", "reference_pose": "step"},
                   {"name": "reach", "reference_pose": "reach"}]}},
      {"name": "heading", "twist": {"joint": "hips", "axis": [0, 1, 0], "full_degrees": 45}},
      {"name": "along", "twist": {"joint": "hips", "through": ["spine"]}}]})",
                               "r.json", ".");
  ASSERT_TRUE(parsed.ok()) << parsed.status().ToString();
  const wrinkle::Skeleton upright =
      authoring::MakeDefaultCharacter(Shipped("default.json"), {.texture_size = 64}).skeleton;
  wrinkle::LocalPose pose;
  pose.SetRest(upright);
  wrinkle::Transform& hips = pose.joints[static_cast<std::size_t>(upright.Find("hips"))];
  hips.translation += glm::vec3(0.03f, 0.0f, 0.17f);
  hips.rotation = glm::angleAxis(0.3f, glm::normalize(glm::vec3(0.1f, 1, 0))) * hips.rotation;
  wrinkle::Transform& arm = pose.joints[static_cast<std::size_t>(upright.Find("upper_arm_l"))];
  arm.rotation = arm.rotation * glm::angleAxis(0.4f, glm::normalize(glm::vec3(0, -0.9f, 0.4f)));
  const std::vector<float> wanted = AllValues(*parsed, upright, pose);
  EXPECT_GT(std::ranges::count_if(wanted, [](float v) { return v > 0.1f; }), 5);
  EXPECT_NEAR(wanted[5], 0.3f / (45.0f * kDegrees), 0.01f);
  for (const glm::quat& turn : QuarterTurns()) {
    wrinkle::LocalPose other = pose;
    wrinkle::TurnRoots(upright, turn, other.joints);
    const std::vector<float> found = AllValues(*parsed, wrinkle::TurnRoots(upright, turn), other);
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(found[i], wanted[i], 2e-4f) << i;
  }
}

// A stream of a head has too few joints for a skeleton map, but enough to tell its axes.
TEST_F(SkeletonMatching, AHeadTellsItsAxes) {
  const wrinkle::Rig rig = Shipped("default.json");
  const wrinkle::Skeleton head =
      *wrinkle::Skeleton::Create({{"neck", -1, {{0, 1.5f, 0}}, {}},
                                  {"head", 0, {{0, 0.1f, 0.02f}}, {}},
                                  {"eye_l", 1, {{0.03f, 0.1f, 0.08f}}, {}},
                                  {"eye_r", 1, {{-0.03f, 0.1f, 0.08f}}, {}},
                                  {"jaw", 1, {{0, -0.04f, 0.01f}}, {}}});
  EXPECT_TRUE(matcher_.Match(head, rig, nullptr).stream.roles.empty());
  for (const glm::quat& turn : QuarterTurns()) {
    const SkeletonMatch match = matcher_.Match(wrinkle::TurnRoots(head, turn), rig, nullptr);
    EXPECT_NEAR(std::abs((match.turn() * turn).w), 1.0f, 1e-5f);
    EXPECT_THAT(Describe(match), HasSubstr("the rest pose faces"));
    EXPECT_THAT(WarningsOf(match), IsEmpty());
  }
}

TEST_F(SkeletonMatching, WarnsOfAxesThatNobodyTells) {
  const wrinkle::Rig rig = Shipped("default.json");
  const auto warnings = [&](const char* joint) {
    const auto skeleton = wrinkle::Skeleton::Create({{joint, -1, {}, {}}});
    return WarningsOf(matcher_.Match(*skeleton, rig, nullptr));
  };
  EXPECT_THAT(warnings("frontalis_inner_l"), ElementsAre(HasSubstr("+Y is taken as up")));
  EXPECT_THAT(warnings("camera"), IsEmpty()) << "the rig reads no such joint";
  EXPECT_THAT(WarningsOf(matcher_.Match(wrinkle::Skeleton(), rig, nullptr)), IsEmpty());
}

// A person whose joints are numbered.
TEST_F(SkeletonMatching, AStreamThatNoMapFitsGetsRolesFromItsHierarchy) {
  std::vector<wrinkle::JointDesc> joints;
  const auto add = [&](int parent, const glm::vec3& offset) {
    joints.push_back({"j" + std::to_string(joints.size()), parent, {offset}, {}});
    return static_cast<int>(joints.size()) - 1;
  };
  const int hips = add(-1, {0, 1, 0});
  const int chest = add(add(hips, {0, 0.2f, 0}), {0, 0.2f, 0});
  add(add(chest, {0, 0.1f, 0}), {0, 0.1f, 0});
  int knee = -1;
  for (const float side : {1.0f, -1.0f}) {
    add(add(add(chest, {0.2f * side, 0, 0}), {0.3f * side, 0, 0}), {0.3f * side, 0, 0});
    knee = add(add(hips, {0.1f * side, -0.1f, 0}), {0, -0.4f, 0});
    add(add(knee, {0, -0.4f, 0}), {0, -0.1f, 0.15f});
  }
  const wrinkle::Skeleton person = *wrinkle::Skeleton::Create(joints);
  const SkeletonRoles found = matcher_.RolesOf(person);
  ASSERT_EQ(found.map, kFromHierarchy);
  EXPECT_EQ(found.roles[static_cast<std::size_t>(person.Find("j" + std::to_string(knee)))],
            wrinkle::JointRole::kRightLowerLeg);
  EXPECT_THAT(Describe(found), HasSubstr("guessed from the hierarchy"));
  // The proposed map finds the same roles.
  const auto map =
      ParseSkeletonMap(ProposeSkeletonMap("mine", person.joint_names(), found.roles), "mine.json");
  ASSERT_TRUE(map.ok()) << map.status().ToString();
  EXPECT_EQ(ApplySkeletonMap(*map, person.joint_names()).roles, found.roles);
}

// The joints' names: hips, spine, chest, neck, head; of each side, first the left: arm, elbow,
// hand, thigh, knee, foot, toes; then both eyes.
wrinkle::Skeleton PersonCalled(const std::vector<std::string>& names) {
  std::vector<wrinkle::JointDesc> joints;
  const auto add = [&](int parent, const glm::vec3& offset) {
    joints.push_back({names[joints.size()], parent, {offset}, {}});
    return static_cast<int>(joints.size()) - 1;
  };
  const int hips = add(-1, {0, 1, 0});
  const int spine = add(hips, {0, 0.2f, 0});
  const int chest = add(spine, {0, 0.2f, 0});
  const int neck = add(chest, {0, 0.1f, 0});
  const int head = add(neck, {0, 0.1f, 0});
  for (const float side : {1.0f, -1.0f}) {
    const int arm = add(chest, {0.2f * side, 0, 0});
    const int elbow = add(arm, {0.3f * side, 0, 0});
    add(elbow, {0.3f * side, 0, 0});
    const int thigh = add(hips, {0.1f * side, -0.1f, 0});
    const int knee = add(thigh, {0, -0.4f, 0});
    const int foot = add(knee, {0, -0.4f, 0});
    add(foot, {0, -0.1f, 0.15f});
  }
  for (const float side : {1.0f, -1.0f}) add(head, {0.03f * side, 0.05f, 0.1f});
  return *wrinkle::Skeleton::Create(std::move(joints));
}

// A map knows the trunk and the arms, and nothing of the legs.
std::vector<std::string> HalfKnown(const std::string& left, const std::string& right) {
  std::vector<std::string> names = {"hips", "spine", "chest", "neck", "head"};
  for (const std::string& side : {left, right}) {
    for (const char* part : {"UpperArm", "LowerArm", "Hand"}) names.push_back(side + part);
    for (const char* part : {"bein", "knie", "fuss", "zehen"}) names.push_back(part + side);
  }
  names.insert(names.end(), {left + "Eye", right + "Eye"});
  return names;
}

TEST_F(SkeletonMatching, TheHierarchyWinsIfItTellsMoreThanAMap) {
  const wrinkle::Skeleton person = PersonCalled(HalfKnown("left", "right"));
  const SkeletonRoles found = matcher_.RolesOf(person);
  EXPECT_EQ(found.map, kFromHierarchy);
  const auto role = [&](const char* joint) {
    return found.roles.at(static_cast<std::size_t>(person.Find(joint)));
  };
  EXPECT_EQ(role("leftUpperArm"), kLeftUpperArm);
  EXPECT_EQ(role("beinleft"), kLeftUpperLeg);
  EXPECT_EQ(role("fussright"), kRightFoot);
  EXPECT_EQ(role("rightEye"), kRightEye) << "the map's, since the hierarchy tells nothing of faces";
  EXPECT_THAT(Describe(found), HasSubstr("guessed from the hierarchy: 21 roles, 21 of 21 joints"));
}

TEST_F(SkeletonMatching, AMapWinsIfTheHierarchyContradictsItOrTheUserChoseIt) {
  const wrinkle::Skeleton exchanged = PersonCalled(HalfKnown("right", "left"));
  EXPECT_NE(matcher_.RolesOf(exchanged).map, kFromHierarchy);
  EXPECT_FALSE(matcher_.RolesOf(exchanged).roles.empty());
  const auto chosen = ShippedMatcher("vrm");
  ASSERT_TRUE(chosen.ok()) << chosen.status().ToString();
  EXPECT_EQ(chosen->RolesOf(PersonCalled(HalfKnown("left", "right"))).map, "vrm");
}

// CMU's names say which joint is which.
TEST_F(SkeletonMatching, TheHierarchyOfCmuAgreesWithItsNames) {
  const std::filesystem::path take = FURROW_SHARED_DATA "/cmu/01_01.bvh";
  if (!std::filesystem::exists(take)) GTEST_SKIP() << take << " is missing";
  const auto clip = motion::LoadClip(take);
  ASSERT_TRUE(clip.ok()) << clip.status().ToString();
  const SkeletonRoles named = matcher_.RolesOf(clip->skeleton);
  ASSERT_EQ(named.map, "cmu");
  const wrinkle::JointRoles guessed = wrinkle::RolesFromHierarchy(clip->skeleton);
  ASSERT_EQ(guessed.size(), named.roles.size());
  for (std::size_t i = 0; i < guessed.size(); ++i) {
    if (!wrinkle::IsOfLimb(named.roles[i])) continue;
    EXPECT_EQ(guessed[i], named.roles[i]) << clip->skeleton.joint_names()[i];
  }
}

TEST_F(SkeletonMatching, DescribesOtherAxesAndExchangedSides) {
  const wrinkle::Rig rig = Shipped("default.json");
  const wrinkle::Skeleton upright =
      authoring::MakeDefaultCharacter(rig, {.texture_size = 64}).skeleton;
  EXPECT_THAT(Describe(matcher_.Match(upright, rig, nullptr)), Not(HasSubstr("faces")));
  const wrinkle::Skeleton lying =
      wrinkle::TurnRoots(upright, glm::angleAxis(90.0f * kDegrees, glm::vec3(1, 0, 0)));
  const SkeletonMatch match = matcher_.Match(lying, rig, nullptr);
  EXPECT_THAT(Describe(match), HasSubstr("the rest pose faces -Y, up is +Z"));
  EXPECT_THAT(WarningsOf(match), IsEmpty());

  std::vector<wrinkle::JointDesc> mirrored;
  for (int j = 0; j < upright.num_joints(); ++j) {
    const auto at = static_cast<std::size_t>(j);
    std::string name = upright.joint_names()[at];
    if (name.ends_with("_l")) {
      name.back() = 'r';
    } else if (name.ends_with("_r")) {
      name.back() = 'l';
    }
    mirrored.push_back({name, upright.joint_parents()[at], upright.rest_pose()[at], {}});
  }
  const auto exchanged = wrinkle::Skeleton::Create(mirrored);
  ASSERT_TRUE(exchanged.ok());
  EXPECT_THAT(WarningsOf(matcher_.Match(*exchanged, rig, nullptr)),
              ElementsAre(HasSubstr("the toes point backwards")));
}

// A package whose joints no map knows, and no hierarchy: one leg has no foot.
class StatedRoles : public SkeletonMatching {
 protected:
  static wrinkle::Skeleton Called(const std::vector<std::string>& names) {
    const int parents[] = {-1, 0, 1, 2, 2, 4, 5, 2, 7, 8, 0, 10, 11, 0, 13};
    std::vector<wrinkle::JointDesc> joints;
    for (std::size_t i = 0; i < names.size(); ++i) {
      joints.push_back({names[i], parents[i], {{0.1f, 0.1f, 0.0f}}, {}});
    }
    return *wrinkle::Skeleton::Create(std::move(joints));
  }
  static std::vector<std::string> Numbered() {
    std::vector<std::string> names;
    for (int i = 0; i < 15; ++i) names.push_back("ctl_" + std::to_string(i));
    return names;
  }

  const wrinkle::Skeleton character_ = Called(Numbered());
  const wrinkle::JointRoles roles_ = {kHips,          kSpine,         kChest,        kHead,
                                      kLeftUpperArm,  kLeftLowerArm,  kLeftHand,     kRightUpperArm,
                                      kRightLowerArm, kRightHand,     kLeftUpperLeg, kLeftLowerLeg,
                                      kLeftFoot,      kRightUpperLeg, kRightLowerLeg};
  const wrinkle::Skeleton vrm_ =
      Called({"hips", "spine", "chest", "head", "leftUpperArm", "leftLowerArm", "leftHand",
              "rightUpperArm", "rightLowerArm", "rightHand", "leftUpperLeg", "leftLowerLeg",
              "leftFoot", "rightUpperLeg", "rightLowerLeg"});
};

TEST_F(StatedRoles, AreThoseOfTheCharacterAndOfItsRig) {
  wrinkle::Rig rig;
  rig.drivers.resize(1);
  rig.drivers[0].name = "elbow";
  rig.drivers[0].kind = wrinkle::Driver::Kind::kHinge;
  rig.drivers[0].hinge = {.parent = "ctl_4", .joint = "ctl_5", .end = "ctl_6"};
  SkeletonMatch match = matcher_.Match(vrm_, rig, &character_);
  EXPECT_THAT(match.aliases, IsEmpty());
  EXPECT_TRUE(match.character.roles.empty());

  matcher_.SetCharacterRoles(character_, roles_);
  match = matcher_.Match(vrm_, rig, &character_);
  EXPECT_EQ(match.stream.num_roles, 15);
  EXPECT_EQ(match.character.map, kFromPackage);
  EXPECT_EQ(match.character.roles, roles_);
  EXPECT_EQ(match.character.num_roles, 15);
  EXPECT_THAT(match.aliases,
              ElementsAre(std::pair("ctl_4", "leftUpperArm"), std::pair("ctl_5", "leftLowerArm"),
                          std::pair("ctl_6", "leftHand")));
  EXPECT_TRUE(MakeRetarget(match, vrm_, character_).by_role());
  // Weights are the same without pictures.
  EXPECT_EQ(matcher_.Match(vrm_, rig, nullptr).aliases, match.aliases);
}

TEST_F(StatedRoles, AreThoseOfTheCharactersOwnRecordings) {
  matcher_.SetCharacterRoles(character_, roles_);
  const SkeletonMatch own = matcher_.Match(character_, wrinkle::Rig(), &character_);
  EXPECT_EQ(own.stream.roles, roles_);
  EXPECT_THAT(Describe(own), HasSubstr("joint roles of the character's package: 15 roles"));
  // A stream without one of the joints is another skeleton.
  std::vector<std::string> names = Numbered();
  names[5] = "other";
  EXPECT_TRUE(matcher_.Match(Called(names), wrinkle::Rig(), nullptr).stream.roles.empty());
}

TEST_F(StatedRoles, GiveWayToAMapThatTheUserChoseForStreams) {
  auto chosen = ShippedMatcher("vrm");
  ASSERT_TRUE(chosen.ok()) << chosen.status().ToString();
  chosen->SetCharacterRoles(character_, roles_);
  const SkeletonMatch match = chosen->Match(character_, wrinkle::Rig(), &character_);
  EXPECT_EQ(match.stream.map, "vrm");
  EXPECT_EQ(match.character.roles, roles_);
}

TEST_F(StatedRoles, OfAPackageWithoutAnyChangeNothing) {
  matcher_.SetCharacterRoles(character_, {});
  EXPECT_NE(matcher_.Match(vrm_, wrinkle::Rig(), &vrm_).character.map, kFromPackage);
  matcher_.SetCharacterRoles(character_, wrinkle::JointRoles(15, kNone));
  EXPECT_NE(matcher_.Match(vrm_, wrinkle::Rig(), &vrm_).character.map, kFromPackage);
}

}  // namespace
}  // namespace furrow::rig
