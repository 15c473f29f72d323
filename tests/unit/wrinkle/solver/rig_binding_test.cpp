// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/wrinkle/test_characters.h"
#include "wrinkle/drivers/pose/pose_driver.h"
#include "wrinkle/rig/rig_check.h"
#include "wrinkle/solver/solver.h"

namespace furrow::wrinkle {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::vector<std::string> kBlendShapes = {"eyeBlinkLeft", "JawOpen"};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Result<RigBinding> BindRig(const Rig& rig, bool allow_missing = false,
                           const Skeleton& skeleton = MakeBody(2)) {
  return RigBinding::Create(rig, skeleton, kBlendShapes, {.allow_missing = allow_missing});
}

TEST(RigBinding, BindsAGoodRig) {
  const Result<RigBinding> binding = BindRig(MakeRig());
  ASSERT_TRUE(binding.ok()) << binding.status().ToString();
  EXPECT_THAT(binding->warnings(), IsEmpty());
  EXPECT_THAT(binding->missing_joints(), IsEmpty());
  EXPECT_THAT(
      binding->weight_names(),
      ElementsAre("brow_l.stretch", "brow_l.squash", "brow_r.stretch", "brow_r.squash",
                  "cheek_l.squash", "mouth.stretch", "knee_l_inner.folds", "knee_l_outer.folds",
                  "hip_l_front.folds", "waist_left.folds", "neck_left.folds"));
  EXPECT_THAT(binding->driver_value_names(),
              ElementsAre("brow_l.stretch", "brow_l.squash", "brow_r.stretch", "brow_r.squash",
                          "knee_l.flexed", "knee_l.extended", "hip_l.front", "hip_l.back",
                          "hip_l.left", "hip_l.right", "waist.front", "waist.back", "waist.left",
                          "waist.right", "cheek_l.squash", "neck.twist_left", "neck.twist_right",
                          "cheek_patch.along", "cheek_patch.across", "cheek_patch.diagonal_left",
                          "cheek_patch.diagonal_right", "jaw.value"));
}

// One mistake in a valid rig, and the expected message.
struct Fault {
  const char* name;
  std::function<void(Rig*)> make;
  StatusCode code;
  const char* message;
};

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

class RigFaults : public testing::TestWithParam<Fault> {};

TEST_P(RigFaults, AreRefusedByNameAndField) {
  Rig rig = MakeRig();
  GetParam().make(&rig);
  const Status status = BindRig(rig).status();
  EXPECT_EQ(status.code(), GetParam().code) << status.ToString();
  EXPECT_THAT(status.ToString(), HasSubstr(GetParam().message));
}

Driver& DriverNamed(Rig* rig, const std::string& name) {
  for (Driver& driver : rig->drivers) {
    if (driver.name == name) return driver;
  }
  return rig->drivers.front();
}

const Fault kReferenceFaults[] = {
    {"anchor", [](Rig* r) { r->anchor = "skull"; }, StatusCode::kNotFound, "'skull'"},
    {"own_anchor", [](Rig* r) { r->drivers[0].pose.anchor = "skull"; }, StatusCode::kNotFound,
     "driver 'brow_l': anchor names joint 'skull'"},
    {"pose_joint", [](Rig* r) { r->drivers[0].pose.points[0].joint = "brow_x"; },
     StatusCode::kNotFound, "driver 'brow_l': points names joint 'brow_x'"},
    {"reference_pose_joint", [](Rig* r) { r->reference_poses[0].joints[0].joint = "brow_x"; },
     StatusCode::kNotFound, "reference pose 'stretch': joint names joint 'brow_x'"},
    {"reference_pose", [](Rig* r) { r->drivers[1].pose.values[0].reference_pose = "shock"; },
     StatusCode::kNotFound, "driver 'brow_r': value 'stretch' names reference pose 'shock'"},
    {"hinge_parent", [](Rig* r) { DriverNamed(r, "knee_l").hinge.parent = "leg"; },
     StatusCode::kNotFound, "driver 'knee_l': parent names joint 'leg'"},
    {"hinge_end", [](Rig* r) { DriverNamed(r, "knee_l").hinge.end = "toe"; }, StatusCode::kNotFound,
     "end names joint 'toe'"},
    {"twist_through", [](Rig* r) { DriverNamed(r, "neck").twist.through = {"neck99"}; },
     StatusCode::kNotFound, "through names joint 'neck99'"},
    {"blend_shape", [](Rig* r) { DriverNamed(r, "jaw").blend_shape.blend_shape = "jaw"; },
     StatusCode::kNotFound, "driver 'jaw': blend shape 'jaw'"},
    {"feed_driver", [](Rig* r) { r->regions[0].feeds[0].sources[0].driver = "brows"; },
     StatusCode::kNotFound, "region 'brow_l': feed 'stretch' names driver value 'brows.stretch'"},
    {"feed_value", [](Rig* r) { r->regions[0].feeds[0].sources[0].value = "strech"; },
     StatusCode::kNotFound, "'brow_l.strech'"},
    {"feed_map", [](Rig* r) { r->regions[0].feeds[0].map = "strech"; }, StatusCode::kNotFound,
     "region 'brow_l': a feed names wrinkle map 'strech'"},
    {"opposes", [](Rig* r) { r->wrinkle_maps[0].opposes = "squish"; }, StatusCode::kNotFound,
     "wrinkle map 'stretch': opposes names wrinkle map 'squish'"},
    {"neighbour", [](Rig* r) { r->regions[0].neighbours = {"brow_x"}; }, StatusCode::kNotFound,
     "region 'brow_l': neighbours names 'brow_x'"},
    {"own_neighbour", [](Rig* r) { r->regions[0].neighbours = {"brow_l"}; },
     StatusCode::kInvalidArgument, "the region itself"},
    {"export",
     [](Rig* r) {
       r->exports = {{"osc", "brow.squash", "x"}};
     },
     StatusCode::kNotFound, "export 'osc' names wrinkle weight 'brow.squash'"},
    {"parent_below", [](Rig* r) { DriverNamed(r, "knee_l").hinge.parent = "foot_l"; },
     StatusCode::kInvalidArgument, "parent 'foot_l' is not above joint 'shin_l'"},
    {"end_elsewhere", [](Rig* r) { DriverNamed(r, "knee_l").hinge.end = "foot_r"; },
     StatusCode::kInvalidArgument, "end 'foot_r' is not below joint 'shin_l'"},
    {"axis_along_bone", [](Rig* r) { DriverNamed(r, "knee_l").hinge.axis = glm::vec3(0, 1, 0); },
     StatusCode::kInvalidArgument, "axis lies along"},
    {"axis_along_stated_bone",
     [](Rig* r) { DriverNamed(r, "knee_l").hinge.bone = glm::vec3(1, 0.05f, 0); },
     StatusCode::kInvalidArgument, "axis lies along the straight bone"},
    {"forward_along_bone",
     [](Rig* r) {
       DriverNamed(r, "waist").ball.forward = {0, 1, 0};
     },
     StatusCode::kInvalidArgument, "forward lies along"},
};

const Fault kNumberFaults[] = {
    {"duplicate_driver", [](Rig* r) { r->drivers[1].name = "brow_l"; },
     StatusCode::kInvalidArgument, "drivers[1].name: the name 'brow_l' is given twice"},
    {"duplicate_pose", [](Rig* r) { r->reference_poses[1].name = "stretch"; },
     StatusCode::kInvalidArgument, "reference_poses[1].name: the name 'stretch' is given twice"},
    {"duplicate_map", [](Rig* r) { r->wrinkle_maps[1].name = "stretch"; },
     StatusCode::kInvalidArgument, "wrinkle_maps[1].name: the name 'stretch' is given twice"},
    {"duplicate_region", [](Rig* r) { r->regions[1].name = "brow_l"; },
     StatusCode::kInvalidArgument, "regions[1].name: the name 'brow_l' is given twice"},
    {"duplicate_value", [](Rig* r) { r->drivers[0].pose.values[1].name = "stretch"; },
     StatusCode::kInvalidArgument,
     "drivers[0].pose.values[1].name: the name 'stretch' is given twice"},
    {"duplicate_feed", [](Rig* r) { r->regions[0].feeds[1].map = "stretch"; },
     StatusCode::kInvalidArgument, "regions[0].feeds[1].map: the name 'stretch' is given twice"},
    {"dotted_driver", [](Rig* r) { r->drivers[0].name = "brow.l"; }, StatusCode::kInvalidArgument,
     "drivers[0].name: the name 'brow.l' holds"},
    {"long_region", [](Rig* r) { r->regions[0].name.assign(256, 'r'); }, StatusCode::kLimit,
     "regions[0].name: the name has 256 bytes"},
    {"control_byte", [](Rig* r) { r->drivers[0].pose.points[0].joint = "brow\n"; },
     StatusCode::kInvalidArgument, "drivers[0].pose.points[0].joint: the name holds a control"},
    {"unnamed_driver", [](Rig* r) { r->drivers[0].name.clear(); }, StatusCode::kInvalidArgument,
     "drivers[0].name: the name is empty"},
    {"no_points", [](Rig* r) { r->drivers[0].pose.points.clear(); }, StatusCode::kInvalidArgument,
     "drivers[0].pose.points: a pose driver needs"},
    {"no_values", [](Rig* r) { r->drivers[0].pose.values.clear(); }, StatusCode::kInvalidArgument,
     "drivers[0].pose.values: a pose driver needs"},
    {"no_sources", [](Rig* r) { r->regions[0].feeds[0].sources.clear(); },
     StatusCode::kInvalidArgument, "regions[0].feeds[0].sources: a feed needs a source"},
    {"too_many_nnls",
     [](Rig* r) {
       r->drivers[0].pose.solve = PoseSolve::kNnls;
       r->drivers[0].pose.values.clear();
       for (int i = 0; i < 17; ++i) {
         r->drivers[0].pose.values.push_back({"v" + std::to_string(i), "stretch"});
       }
     },
     StatusCode::kLimit, "drivers[0].pose.values: 17 entries, at most 16"},
    {"too_many_points",
     [](Rig* r) { r->drivers[0].pose.points.resize(kMaxControlPoints + 1, {.joint = "brow_l"}); },
     StatusCode::kLimit, "drivers[0].pose.points: 257 entries"},
    {"falloff", [](Rig* r) { r->drivers[0].pose.falloff = -1.0f; }, StatusCode::kInvalidArgument,
     "drivers[0].pose.falloff: -1 is out of range [0, 1000]"},
    {"falloff_nan", [](Rig* r) { r->drivers[0].pose.falloff = kNan; }, StatusCode::kNonFinite,
     "drivers[0].pose.falloff"},
    {"own_anchor_label", [](Rig* r) { r->drivers[0].pose.anchor = "a\n"; },
     StatusCode::kInvalidArgument, "drivers[0].pose.anchor: the name holds a control"},
    {"offset_nan", [](Rig* r) { r->drivers[0].pose.points[0].offset.y = kNan; },
     StatusCode::kNonFinite, "drivers[0].pose.points[0].offset"},
    {"beta", [](Rig* r) { DriverNamed(r, "knee_l").hinge.beta_degrees = 180.0f; },
     StatusCode::kInvalidArgument, ".hinge.beta_degrees: 180 is out of range [0, 179]"},
    {"axis_too_long", [](Rig* r) { DriverNamed(r, "knee_l").hinge.axis = glm::vec3(1e30f); },
     StatusCode::kInvalidArgument, ".hinge.axis: the direction has no"},
    {"hinge_bone", [](Rig* r) { DriverNamed(r, "knee_l").hinge.bone = glm::vec3(0.0f); },
     StatusCode::kInvalidArgument, ".hinge.bone: the direction has no length"},
    {"bone_too_short", [](Rig* r) { DriverNamed(r, "waist").ball.bone = glm::vec3(1e-20f); },
     StatusCode::kInvalidArgument, ".ball.bone: the direction has no"},
    {"axis_zero", [](Rig* r) { DriverNamed(r, "knee_l").hinge.axis = glm::vec3(0.0f); },
     StatusCode::kInvalidArgument, ".hinge.axis: the direction has no length"},
    {"ball_beta", [](Rig* r) { DriverNamed(r, "waist").ball.beta_degrees = -1.0f; },
     StatusCode::kInvalidArgument, ".ball.beta_degrees"},
    {"ball_bone", [](Rig* r) { DriverNamed(r, "waist").ball.bone.x = kNan; },
     StatusCode::kNonFinite, ".ball.bone"},
    {"ball_forward", [](Rig* r) { DriverNamed(r, "waist").ball.forward = glm::vec3(0.0f); },
     StatusCode::kInvalidArgument, ".ball.forward"},
    {"twist_full", [](Rig* r) { DriverNamed(r, "neck").twist.full_degrees = 0.0f; },
     StatusCode::kInvalidArgument, ".twist.full_degrees: 0 is out of range [1, 180]"},
    {"twist_axis", [](Rig* r) { DriverNamed(r, "neck").twist.axis = glm::vec3(0.0f); },
     StatusCode::kInvalidArgument, ".twist.axis"},
    {"blend_shape_range", [](Rig* r) { DriverNamed(r, "jaw").blend_shape.full = 0.0f; },
     StatusCode::kInvalidArgument, ".blend_shape.full"},
    {"delta_rotation", [](Rig* r) { r->reference_poses[0].joints[0].rotation.w = 3.0f; },
     StatusCode::kInvalidArgument,
     "reference_poses[0].joints[0].rotation: the rotation is not a unit quaternion"},
    {"delta_translation", [](Rig* r) { r->reference_poses[2].joints[0].translation.x = kNan; },
     StatusCode::kNonFinite, "reference_poses[2].joints[0].translation"},
    {"source_size", [](Rig* r) { r->reference_poses[0].source_size = -1.0f; },
     StatusCode::kInvalidArgument, "reference_poses[0].source_size"},
    {"gain", [](Rig* r) { r->regions[0].feeds[0].sources[0].gain = -0.5f; },
     StatusCode::kInvalidArgument,
     "regions[0].feeds[0].sources[0].gain: -0.5 is out of range [0, 100]"},
    {"gain_nan", [](Rig* r) { r->regions[0].feeds[0].sources[0].gain = kNan; },
     StatusCode::kNonFinite, "regions[0].feeds[0].sources[0].gain"},
    {"mean_of_nothing",
     [](Rig* r) {
       r->regions[0].combine = Combine::kMean;
       r->regions[0].feeds[0].sources[0].gain = 0.0f;
     },
     StatusCode::kInvalidArgument, "which leaves no mean"},
    {"channel", [](Rig* r) { r->regions[0].mask.channel = 4; }, StatusCode::kInvalidArgument,
     "regions[0].mask.channel"},
    {"smooth_width", [](Rig* r) { r->regions[0].mask.smooth_width = 0.0f; },
     StatusCode::kInvalidArgument, "regions[0].mask.smooth_width"},
    {"amplitude", [](Rig* r) { r->wrinkle_maps[0].amplitude = kNan; }, StatusCode::kNonFinite,
     "wrinkle_maps[0].amplitude"},
    {"opposes_itself", [](Rig* r) { r->wrinkle_maps[0].opposes = "stretch"; },
     StatusCode::kInvalidArgument, "wrinkle_maps[0].opposes: a map cannot"},
    {"min_cutoff", [](Rig* r) { r->filter.min_cutoff_hz = 0.0f; }, StatusCode::kInvalidArgument,
     "filter.min_cutoff_hz"},
    {"filter_beta", [](Rig* r) { r->filter.beta = -1.0f; }, StatusCode::kInvalidArgument,
     "filter.beta"},
    {"derivative_cutoff", [](Rig* r) { r->filter.derivative_cutoff_hz = kNan; },
     StatusCode::kNonFinite, "filter.derivative_cutoff_hz"},
    {"slew", [](Rig* r) { r->filter.slew_per_second = -1.0f; }, StatusCode::kInvalidArgument,
     "filter.slew_per_second"},
    {"hold", [](Rig* r) { r->filter.hold_seconds = -1.0f; }, StatusCode::kInvalidArgument,
     "filter.hold_seconds"},
    {"decay", [](Rig* r) { r->filter.decay_seconds = kNan; }, StatusCode::kNonFinite,
     "filter.decay_seconds"},
};

StrainDriver& Patch(Rig* rig) { return DriverNamed(rig, "cheek_patch").strain; }

const Fault kPatchFaults[] = {
    {"patch_joint", [](Rig* r) { Patch(r).joint = "skull"; }, StatusCode::kNotFound,
     "driver 'cheek_patch': joint names joint 'skull'"},
    {"patch_joints", [](Rig* r) { Patch(r).joints[1] = "jowl"; }, StatusCode::kNotFound,
     "driver 'cheek_patch': joints names joint 'jowl'"},
    {"patch_joint_twice", [](Rig* r) { Patch(r).joints[1] = "head"; }, StatusCode::kInvalidArgument,
     "drivers[7].strain.joints[1]: the name 'head' is given twice"},
    {"patch_vertex_joint",
     [](Rig* r) {
       Patch(r).vertices[4].joints = {0, 2};
     },
     StatusCode::kInvalidArgument, "drivers[7].strain.vertices[4].joints: there is no such joint"},
    {"patch_vertex_still",
     [](Rig* r) {
       Patch(r).vertices[4].joints.clear();
       Patch(r).vertices[4].skin_weights.clear();
     },
     StatusCode::kInvalidArgument, "vertices[4].joints: no joint moves the vertex"},
    {"patch_too_many_influences",
     [](Rig* r) {
       Patch(r).vertices[0].joints = {0, 1, 0, 1, 0};
     },
     StatusCode::kLimit, "vertices[0].joints"},
    {"patch_weight_missing", [](Rig* r) { Patch(r).vertices[3].skin_weights.pop_back(); },
     StatusCode::kInvalidArgument, "vertices[3].skin_weights: the lists of joints"},
    {"patch_weights_sum",
     [](Rig* r) {
       Patch(r).vertices[3].skin_weights = {0.5f, 0.6f};
     },
     StatusCode::kInvalidArgument, "vertices[3].skin_weights: the skin weights do not sum to 1"},
    {"patch_position", [](Rig* r) { Patch(r).vertices[8].position.z = kNan; },
     StatusCode::kNonFinite, "vertices[8].position"},
    {"patch_triangle", [](Rig* r) { Patch(r).triangles.back() = 9; }, StatusCode::kInvalidArgument,
     "strain.triangles: an index is not"},
    {"patch_two_corners", [](Rig* r) { Patch(r).triangles.pop_back(); },
     StatusCode::kInvalidArgument, "strain.triangles: a triangle has three"},
    {"patch_empty", [](Rig* r) { Patch(r).triangles.clear(); }, StatusCode::kInvalidArgument,
     "strain.triangles: no triangle has an area"},
    {"patch_degenerate", [](Rig* r) { Patch(r).triangles = {0, 1, 2, 3, 3, 3}; },
     StatusCode::kInvalidArgument, "strain.triangles: no triangle has an area"},
    {"patch_too_large", [](Rig* r) { Patch(r).vertices.resize(kMaxPatchVertices + 1); },
     StatusCode::kLimit, "strain.vertices"},
    {"patch_direction", [](Rig* r) { Patch(r).direction = {}; }, StatusCode::kInvalidArgument,
     "strain.direction"},
    {"patch_full", [](Rig* r) { Patch(r).full_compression = 0.0f; }, StatusCode::kInvalidArgument,
     "strain.full_compression"},
    {"patch_size", [](Rig* r) { Patch(r).size = -1.0f; }, StatusCode::kInvalidArgument,
     "strain.size"},
};

const auto kFaultName = [](const testing::TestParamInfo<Fault>& info) {
  return std::string(info.param.name);
};
INSTANTIATE_TEST_SUITE_P(References, RigFaults, testing::ValuesIn(kReferenceFaults), kFaultName);
INSTANTIATE_TEST_SUITE_P(Numbers, RigFaults, testing::ValuesIn(kNumberFaults), kFaultName);
INSTANTIATE_TEST_SUITE_P(Patches, RigFaults, testing::ValuesIn(kPatchFaults), kFaultName);

TEST(RigBinding, RefusesMoreRegionsThanItCounts) {
  Rig rig = MakeRig();
  while (rig.regions.size() < kMaxRegions) {
    rig.regions.push_back(rig.regions[3]);
    rig.regions.back().name = "r" + std::to_string(rig.regions.size());
  }
  EXPECT_TRUE(BindRig(rig).ok());
  rig.regions.push_back(rig.regions[3]);
  rig.regions.back().name = "one_more";
  EXPECT_EQ(BindRig(rig).status().code(), StatusCode::kLimit);
}

// The unfiltered driver values of a pose.
std::vector<float> DriverValues(const RigBinding& binding, const LocalPose& pose) {
  SubjectSolver solver(std::shared_ptr<const RigBinding>(std::shared_ptr<void>(), &binding), false);
  EXPECT_EQ(solver.Update(pose, 0.0), JobStatus::kOk);
  return {solver.driver_values().begin(), solver.driver_values().end()};
}

TEST(RigBinding, ListsWhatIsMissingOnceWhereThatIsAllowed) {
  const Skeleton half = MakeSkeleton({{"hips", "", {0, 1, 0}, {}},
                                      {"thigh_l", "hips", {0.1f, 0.95f, 0}, {}},
                                      {"shin_l", "thigh_l", {0.1f, 0.5f, 0}, {}}});
  const Result<RigBinding> binding =
      RigBinding::Create(MakeRig(), half, {}, {.allow_missing = true});
  ASSERT_TRUE(binding.ok()) << binding.status().ToString();
  EXPECT_THAT(binding->missing_joints(),
              ElementsAre("head", "brow_l", "brow_r", "cheek_l", "spine", "neck", "neck_upper"));
  EXPECT_THAT(binding->missing_blend_shapes(), ElementsAre("jawOpen"));

  LocalPose pose = RestPose(half);
  Turn(half, "shin_l", AngleAxis(90.0f, {1, 0, 0}), &pose);
  const std::vector<float> values = DriverValues(*binding, pose);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string& name = binding->driver_value_names()[i];
    if (name == "knee_l.flexed") {
      EXPECT_NEAR(values[i], 0.536f, 1e-3f);
    } else if (name == "knee_l.extended") {
      EXPECT_NEAR(values[i], 0.464f, 1e-3f);
    } else {
      EXPECT_EQ(values[i], 0.0f) << name;
    }
  }
}

TEST(RigBinding, WarnsOfADriverThatMakesNoSenseWhereThingsMayBeMissing) {
  Rig rig = MakeRig();
  DriverNamed(&rig, "knee_l").hinge.parent = "foot_l";
  const Result<RigBinding> binding = BindRig(rig, true);
  ASSERT_TRUE(binding.ok());
  EXPECT_THAT(binding->warnings(), ElementsAre(HasSubstr("driver 'knee_l': parent 'foot_l'")));
}

TEST(RigBinding, WarnsOfAReferencePoseThatMovesNothing) {
  Rig rig = MakeRig();
  rig.drivers[0].pose.values[1].reference_pose = "smile";  // moves the cheek, not the brow
  const Result<RigBinding> binding = BindRig(rig);
  ASSERT_TRUE(binding.ok());
  EXPECT_THAT(binding->warnings(), ElementsAre(HasSubstr("value 'squash' stays 0")));
}

TEST(RigBinding, WarnsOfAPointThatDoesNotHangFromTheAnchor) {
  Rig rig = MakeRig();
  rig.reference_poses[0].joints.push_back({"hand_l", AngleAxis(10.0f, {1, 1, 0})});
  rig.drivers[0].pose.points.push_back({.joint = "hand_l"});
  const Result<RigBinding> binding = BindRig(rig);
  ASSERT_TRUE(binding.ok());
  EXPECT_THAT(binding->warnings(), ElementsAre(HasSubstr("does not hang from the anchor")));
}

TEST(RigBinding, IgnoresJointsThatAReferencePoseLeavesAtRest) {
  Rig rig = MakeRig();
  rig.reference_poses[0].joints.push_back({.joint = "third_leg"});
  EXPECT_TRUE(BindRig(rig).ok());
}

TEST(RigBinding, MatchesBlendShapesWithoutCase) {
  const Result<RigBinding> binding = BindRig(MakeRig());
  ASSERT_TRUE(binding.ok());
  LocalPose pose = RestPose(binding->skeleton());
  pose.blend_shapes = {0.9f, 0.25f};
  EXPECT_EQ(DriverValues(*binding, pose).back(), 0.25f);
  pose.blend_shapes.pop_back();  // shorter than bound
  EXPECT_EQ(DriverValues(*binding, pose).back(), 0.0f);
}

TEST(RigBinding, NeedsNoSkeletonForBlendShapesAlone) {
  Rig rig;
  rig.drivers = {MakeRig().drivers.back()};
  rig.regions = {MakeRig().regions[3]};
  const Result<RigBinding> binding = RigBinding::Create(rig, Skeleton(), kBlendShapes);
  ASSERT_TRUE(binding.ok()) << binding.status().ToString();
  EXPECT_THAT(binding->weight_names(), ElementsAre("mouth.stretch"));
}

TEST(RigBinding, NeedsNoAnchorWherePosesAreNotMeasured) {
  Rig rig = MakeRig();
  rig.anchor = "skull";
  rig.drivers = {DriverNamed(&rig, "knee_l")};
  rig.regions = {rig.regions[4]};
  const Status status = BindRig(rig).status();
  EXPECT_TRUE(status.ok()) << status.ToString();
}

TEST(RigBinding, NeedsNoAnchorOfTheRigWhereDriversHaveTheirOwn) {
  Rig rig = MakeRig();
  rig.anchor = "skull";
  std::erase_if(rig.drivers,
                [](const Driver& driver) { return driver.kind == Driver::Kind::kStrain; });
  for (Driver& driver : rig.drivers) driver.pose.anchor = "head";
  const Result<RigBinding> binding = BindRig(rig);
  ASSERT_TRUE(binding.ok()) << binding.status().ToString();
  // One driver without its own anchor needs the rig's, and rests without it.
  DriverNamed(&rig, "brow_r").pose.anchor.clear();
  EXPECT_EQ(BindRig(rig).status().code(), StatusCode::kNotFound);
  const Result<RigBinding> partial = BindRig(rig, true);
  ASSERT_TRUE(partial.ok()) << partial.status().ToString();
  EXPECT_THAT(partial->missing_joints(), ElementsAre("skull"));
  LocalPose pose = RestPose(partial->skeleton());
  Turn(partial->skeleton(), "brow_l", AngleAxis(-25.0f, {1, 0, 0}), &pose);
  Turn(partial->skeleton(), "brow_r", AngleAxis(-25.0f, {1, 0, 0}), &pose);
  const std::vector<float> values = DriverValues(*partial, pose);
  EXPECT_NEAR(values[0], 1.0f, 1e-5f);
  EXPECT_EQ(values[2], 0.0f);
}

}  // namespace
}  // namespace furrow::wrinkle
