// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/default_character.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "authoring/bake/strokes_file.h"
#include "authoring/generator/body/body_skeleton.h"
#include "authoring/generator/recordings/recording_bvh.h"
#include "authoring/generator/recordings/recordings.h"
#include "authoring/generator/textures/wrinkle_maps.h"
#include "authoring/paint/surface_texels.h"
#include "base/files.h"
#include "character/package/package.h"
#include "motion/bvh/bvh.h"
#include "rig/rig_file.h"
#include "wrinkle/solver/solver.h"

namespace furrow::authoring {
namespace {

wrinkle::Rig DefaultRig() {
  Result<wrinkle::Rig> rig =
      rig::LoadRig(std::filesystem::path(FURROW_SOURCE_DIR) / "rig/rigs/default.json");
  EXPECT_TRUE(rig.ok()) << rig.status().ToString();
  return rig.ok() ? std::move(rig).value() : wrinkle::Rig();
}

// The default character with small wrinkle maps.
character::Character WholeCharacter(int maps = 256) {
  const std::filesystem::path file =
      std::filesystem::path(FURROW_SOURCE_DIR) / "rig/rigs/default.strokes.json";
  character::Character character = MakeDefaultCharacter(DefaultRig(), {.texture_size = 256});
  Result<std::vector<BakeStroke>> strokes = LoadStrokes(file, character.rig);
  EXPECT_TRUE(strokes.ok()) << strokes.status().ToString();
  if (!strokes.ok()) return character;
  const Status status = AddWrinkleMaps(strokes.value(), maps, 1.0f, &character);
  EXPECT_TRUE(status.ok()) << status.ToString();
  return character;
}

// Solves poses of the default skeleton with its rig, without the filter.
class DefaultRigTest : public ::testing::Test {
 protected:
  void SetUp() override {
    Result<wrinkle::RigBinding> binding = wrinkle::RigBinding::Create(rig_, skeleton_, {});
    ASSERT_TRUE(binding.ok()) << binding.status().ToString();  // every joint of the rig exists
    binding_ = std::make_shared<const wrinkle::RigBinding>(std::move(binding).value());
    solver_ = std::make_unique<wrinkle::SubjectSolver>(binding_, false);
  }

  void Solve(const std::vector<wrinkle::Transform>& joints) {
    wrinkle::LocalPose pose;
    pose.joints = joints;
    ASSERT_EQ(solver_->Update(pose, 1.0 / kFramesPerSecond), wrinkle::JobStatus::kOk);
  }

  std::vector<wrinkle::Transform> Rest() const {
    return {skeleton_.rest_pose().begin(), skeleton_.rest_pose().end()};
  }

  std::vector<wrinkle::Transform> Posed(const std::string& name) const {
    std::vector<wrinkle::Transform> joints = Rest();
    const auto pose = std::find_if(rig_.reference_poses.begin(), rig_.reference_poses.end(),
                                   [&](const auto& p) { return p.name == name; });
    for (const wrinkle::JointDelta& delta : pose->joints) {
      const int joint = skeleton_.Find(delta.joint);
      joints[joint].translation += delta.translation;
      joints[joint].rotation = joints[joint].rotation * delta.rotation;
    }
    return joints;
  }

  float Driver(const std::string& name) const {
    const auto names = binding_->driver_value_names();
    const auto found = std::find(names.begin(), names.end(), name);
    EXPECT_NE(found, names.end()) << name;
    return found == names.end() ? -1.0f : solver_->driver_values()[found - names.begin()];
  }

  // The wrinkle weight named `name`, "<region>.<map>".
  float Weight(const std::string& name) const {
    const auto names = binding_->weight_names();
    const auto found = std::find(names.begin(), names.end(), name);
    EXPECT_NE(found, names.end()) << name;
    return found == names.end() ? -1.0f : solver_->wrinkle_weights()[found - names.begin()];
  }

  wrinkle::Rig rig_ = DefaultRig();
  wrinkle::Skeleton skeleton_ = MakeSkeleton();
  std::shared_ptr<const wrinkle::RigBinding> binding_;
  std::unique_ptr<wrinkle::SubjectSolver> solver_;
};

TEST_F(DefaultRigTest, BindsWithoutWarnings) {
  EXPECT_THAT(binding_->warnings(), testing::IsEmpty());
}

TEST_F(DefaultRigTest, MovingTheHeadFoldsNoFace) {
  const int head = skeleton_.Find("head");
  for (const glm::vec3 degrees : {glm::vec3(30, 0, 0), {-25, 0, 0}, {0, 45, 0}, {0, 0, -20}}) {
    std::vector<wrinkle::Transform> joints = Rest();
    joints[head].rotation = joints[head].rotation * glm::quat(glm::radians(degrees));
    Solve(joints);
    for (const std::string& name : binding_->weight_names()) {
      if (!name.ends_with(".stretch") && !name.ends_with(".squash")) continue;  // cloth
      EXPECT_LT(Weight(name), 0.02f)
          << name << " at " << degrees.x << " " << degrees.y << " " << degrees.z;
    }
  }
}

TEST_F(DefaultRigTest, NeutralFaceHasNoWrinkles) {
  Solve(Rest());
  for (std::size_t i = 0; i < binding_->weight_names().size(); ++i) {
    const std::string& name = binding_->weight_names()[i];
    // Cloth is slack at straight limbs, and arms that are raised to the sides fold it.
    if (!name.ends_with(".stretch") && !name.ends_with(".squash")) continue;
    EXPECT_LT(solver_->wrinkle_weights()[i], 0.02f) << name;
  }
}

TEST_F(DefaultRigTest, ReferencePosesReachTheirDrivers) {
  int checked = 0;
  for (const wrinkle::Driver& driver : rig_.drivers) {
    if (driver.kind != wrinkle::Driver::Kind::kPose) continue;
    for (const auto& value : driver.pose.values) {
      Solve(Posed(value.reference_pose));
      EXPECT_NEAR(Driver(driver.name + "." + value.name), 1.0f, 1e-3f) << value.reference_pose;
      ++checked;
    }
  }
  EXPECT_GT(checked, 20);
}

TEST_F(DefaultRigTest, ReferencePosesMoveOnlyExistingJoints) {
  for (const wrinkle::ReferencePose& pose : rig_.reference_poses) {
    EXPECT_FALSE(pose.joints.empty()) << pose.name;
    for (const wrinkle::JointDelta& delta : pose.joints) {
      EXPECT_NE(skeleton_.Find(delta.joint), wrinkle::kNoJoint) << pose.name << ": " << delta.joint;
    }
  }
}

TEST_F(DefaultRigTest, EmotionsRaiseTheExpectedWeights) {
  const struct {
    const char* recording;
    int frame;
    std::vector<const char*> strong;
    std::vector<const char*> absent;
  } kCases[] = {
      {"happiness", 150, {"mouth_l.squash", "eye_l.squash", "mouth_r.squash"}, {"glabella.squash"}},
      {"anger", 150, {"glabella.squash", "brow_l.squash"}, {"brow_l.stretch", "mouth_l.squash"}},
      {"sadness", 150, {"brow_l.stretch", "mouth_l.stretch", "mouth_r.stretch"}, {"nose.squash"}},
      {"disgust", 150, {"nose.squash", "glabella.squash"}, {"brow_l.stretch"}},
  };
  for (const auto& c : kCases) {
    SCOPED_TRACE(c.recording);
    Result<Recording> recording = MakeRecording(c.recording, rig_, skeleton_);
    ASSERT_TRUE(recording.ok()) << recording.status().ToString();
    Solve(recording.value().frames[c.frame]);
    for (const char* name : c.strong) EXPECT_GT(Weight(name), 0.5f) << name;
    for (const char* name : c.absent) EXPECT_LT(Weight(name), 0.1f) << name;
    // The first frame has a neutral face and lowered arms.
    Solve(recording.value().frames[0]);
    for (const char* name : c.strong) EXPECT_LT(Weight(name), 0.02f) << name;
  }
}

TEST_F(DefaultRigTest, WalkBendsKneesAlternately) {
  Result<Recording> walk = MakeRecording("walk", rig_, skeleton_);
  ASSERT_TRUE(walk.ok());
  float most_left = 0.0f, most_right = 0.0f, both = 0.0f;
  for (const auto& frame : walk.value().frames) {
    Solve(frame);
    const float left = Driver("knee_l.flexed");
    const float right = Driver("knee_r.flexed");
    most_left = std::max(most_left, left);
    most_right = std::max(most_right, right);
    both = std::max(both, std::min(left, right));
  }
  EXPECT_GT(most_left, 0.1f);
  EXPECT_GT(most_right, 0.1f);
  EXPECT_LT(both, 0.5f * std::min(most_left, most_right));
}

TEST(GeneratorRecordings, BvhReadsBackEqual) {
  const wrinkle::Rig rig = DefaultRig();
  const wrinkle::Skeleton skeleton = MakeSkeleton();
  for (const std::string& name : RecordingNames()) {
    SCOPED_TRACE(name);
    Result<Recording> recording = MakeRecording(name, rig, skeleton);
    ASSERT_TRUE(recording.ok()) << recording.status().ToString();
    Result<motion::Clip> clip =
        motion::ParseBvh(RecordingToBvh(recording.value(), skeleton), name + ".bvh");
    ASSERT_TRUE(clip.ok()) << clip.status().ToString();
    const motion::Clip& read = clip.value();
    ASSERT_EQ(read.num_frames(), static_cast<int>(recording.value().frames.size()));
    ASSERT_GE(read.num_frames(), 10 * kFramesPerSecond);
    ASSERT_EQ(read.skeleton.num_joints(), skeleton.num_joints());
    const int frame = read.num_frames() / 2;
    wrinkle::LocalPose pose;
    read.GetPose(frame, &pose);
    for (int j = 0; j < skeleton.num_joints(); ++j) {
      const int there = read.skeleton.Find(skeleton.joint_names()[j]);
      ASSERT_NE(there, wrinkle::kNoJoint);
      const wrinkle::Transform& want = recording.value().frames[frame][j];
      EXPECT_LT(glm::distance(pose.joints[there].translation, want.translation), 2e-6f);
      EXPECT_GT(std::abs(glm::dot(pose.joints[there].rotation, want.rotation)), 0.999999f);
    }
  }
}

// Joints never jump. Blinks are the fastest movements.
TEST(GeneratorRecordings, MoveSmoothly) {
  const wrinkle::Rig rig = DefaultRig();
  const wrinkle::Skeleton skeleton = MakeSkeleton();
  for (const std::string& name : RecordingNames()) {
    Result<Recording> recording = MakeRecording(name, rig, skeleton);
    ASSERT_TRUE(recording.ok());
    const auto& frames = recording.value().frames;
    for (std::size_t f = 1; f < frames.size(); ++f) {
      for (int j = 1; j < skeleton.num_joints(); ++j) {
        ASSERT_LT(glm::distance(frames[f][j].translation, frames[f - 1][j].translation), 0.002f)
            << name << " " << skeleton.joint_names()[j] << " frame " << f;
      }
    }
  }
}

TEST(GeneratorRecordings, UnknownNameIsNotFound) {
  EXPECT_EQ(MakeRecording("rage", DefaultRig(), MakeSkeleton()).status().code(),
            StatusCode::kNotFound);
  EXPECT_EQ(MakeRecording("anger", wrinkle::Rig(), MakeSkeleton()).status().code(),
            StatusCode::kNotFound);
}

class PackageTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { character_ = new character::Character(WholeCharacter()); }
  static void TearDownTestSuite() { delete character_; }
  static character::Character* character_;
};
character::Character* PackageTest::character_ = nullptr;

TEST_F(PackageTest, ContainsEveryPictureOfTheRig) {
  const character::Character& c = *character_;
  for (const wrinkle::Region& region : c.rig.regions) {
    if (region.mask.kind != wrinkle::Mask::Kind::kTexture) continue;
    EXPECT_GE(c.FindRigPicture(region.mask.texture), 0) << region.name;
  }
  for (const wrinkle::WrinkleMap& map : c.rig.wrinkle_maps) {
    EXPECT_GE(c.FindRigPicture(map.normal), 0) << map.name;
    EXPECT_GE(c.FindRigPicture(map.height), 0) << map.name;
    // Twists have none, because engines have few textures.
    EXPECT_EQ(c.FindRigPicture(map.cavity) < 0, map.name.starts_with("twist_")) << map.name;
    const bool skin = map.surface == wrinkle::WrinkleMap::Surface::kSkin;
    EXPECT_EQ(c.FindRigPicture(map.colour) >= 0, skin) << map.name;
  }
}

// Skin becomes paler and redder, but keeps its colour where it does not move (back of the head).
TEST_F(PackageTest, SkinPalesAndReddens) {
  for (const char* name : {"face_stretch_colour", "face_squash_colour"}) {
    const character::Picture& colour = character_->pictures[character_->FindRigPicture(name)];
    int least = 255, most = 0, still = 0;
    for (std::size_t i = 0; i < colour.pixels.size(); i += 3) {
      least = std::min<int>(least, colour.pixels[i + 1]);
      most = std::max<int>(most, colour.pixels[i + 1]);
      still += colour.pixels[i + 1] == 230 ? 1 : 0;
    }
    EXPECT_LT(least, 215) << name;
    EXPECT_GT(most, 236) << name;
    EXPECT_GT(still, 256 * 256 / 4) << name;
  }
}

// The normals and heights of a map. Heights are in millimetres.
struct Relief {
  const character::Picture& normals;
  const character::Picture& heights;
  float height_mm;

  [[nodiscard]] std::size_t At(const SurfaceTexel& t) const {
    return static_cast<std::size_t>(t.y) * static_cast<std::size_t>(heights.width) +
           static_cast<std::size_t>(t.x);
  }
  [[nodiscard]] float Height(const SurfaceTexel& t) const {
    return height_mm * (2.0f * static_cast<float>(heights.pixels16[At(t)]) / 65535.0f - 1.0f);
  }
  // The change of height over `step`, computed from the normal.
  [[nodiscard]] float Rise(const SurfaceTexel& t, const glm::vec3& step) const {
    glm::vec3 n;
    for (int c = 0; c < 3; ++c) n[c] = 2.0f * normals.pixels16[3 * At(t) + c] / 65535.0f - 1.0f;
    return -(n.x * glm::dot(step, t.tangent) + n.y * glm::dot(step, t.bitangent)) / n.z;
  }
};

// Height differences between texels correlate with the slopes of both texels. The ratio is not
// exactly 1, because the finest folds are only three texels wide.
TEST(WrinkleMaps, HeightsMatchNormals) {
  constexpr int kSize = 512;
  const character::Character character = WholeCharacter(kSize);
  const character::Mesh& skin = character.meshes[0];
  ASSERT_EQ(character.materials[skin.material].kind, character::Material::Kind::kSkin);
  const std::vector<SurfaceTexel> texels = RasterizeSurface(skin, kSize, kSize);
  for (const int map : {0, 1}) {
    const wrinkle::WrinkleMap& named = character.rig.wrinkle_maps[map];
    const Relief relief{character.pictures[character.FindRigPicture(named.normal)],
                        character.pictures[character.FindRigPicture(named.height)],
                        named.height_mm};
    ASSERT_EQ(relief.heights.width, kSize);
    double steps = 0.0, slopes = 0.0, both = 0.0;
    for (std::size_t i = 0; i + 1 < texels.size(); ++i) {
      const SurfaceTexel &left = texels[i], &right = texels[i + 1];
      const glm::vec3 step = 1000.0f * (right.position - left.position);
      if (right.y != left.y || right.x != left.x + 1 || glm::length(step) > 1.5f) continue;
      const double rise = relief.Height(right) - relief.Height(left);
      const double told = 0.5 * (relief.Rise(left, step) + relief.Rise(right, step));
      steps += rise * rise;
      slopes += told * told;
      both += rise * told;
    }
    EXPECT_GT(steps, 1.0) << named.name;
    EXPECT_GT(both / std::sqrt(steps * slopes), 0.85) << named.name;
    EXPECT_GT(both / slopes, 0.9) << named.name;
    EXPECT_LT(both / slopes, 1.2) << named.name;
  }
}

TEST_F(PackageTest, MasksAreSoftAndNotEmpty) {
  for (const char* name : {"face_masks_a", "face_masks_b"}) {
    const character::Picture& mask = character_->pictures[character_->FindRigPicture(name)];
    ASSERT_EQ(mask.channels, 4);
    for (int channel = 0; channel < 4; ++channel) {
      std::set<int> levels;
      for (std::size_t i = channel; i < mask.pixels.size(); i += 4) levels.insert(mask.pixels[i]);
      EXPECT_EQ(*levels.begin(), 0) << name << " " << channel;
      EXPECT_GT(*levels.rbegin(), 200) << name << " " << channel;
      EXPECT_GT(levels.size(), 20u) << name << " " << channel;
    }
  }
}

TEST_F(PackageTest, IsReproducible) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "furrow_package";
  std::filesystem::create_directories(folder);
  const character::Character again = WholeCharacter();
  ASSERT_TRUE(character::SaveCharacterGlb(*character_, folder / "a.glb").ok());
  ASSERT_TRUE(character::SaveCharacterGlb(again, folder / "b.glb").ok());
  constexpr std::size_t kMax = 64u << 20;
  Result<std::string> a = ReadFile(folder / "a.glb", kMax);
  Result<std::string> b = ReadFile(folder / "b.glb", kMax);
  ASSERT_TRUE(a.ok() && b.ok());
  EXPECT_TRUE(a.value() == b.value());
  std::filesystem::remove_all(folder);
}

TEST_F(PackageTest, ReadsBackEqual) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "furrow_share";
  std::filesystem::create_directories(folder);
  ASSERT_TRUE(character::SaveCharacterGlb(*character_, folder / "c.glb").ok());
  ASSERT_TRUE(rig::SaveRig(character_->rig, folder / "c.rig.json").ok());
  Result<character::Character> read = character::LoadCharacter(folder / "c.glb");
  ASSERT_TRUE(read.ok()) << read.status().ToString();
  ASSERT_EQ(read.value().meshes.size(), character_->meshes.size());
  EXPECT_EQ(read.value().skeleton.hash(), character_->skeleton.hash());
  for (std::size_t m = 0; m < character_->meshes.size(); ++m) {
    EXPECT_EQ(read.value().meshes[m].indices, character_->meshes[m].indices);
    const int material = read.value().meshes[m].material;
    EXPECT_EQ(read.value().materials[material].kind,
              character_->materials[character_->meshes[m].material].kind);
  }
  EXPECT_GE(read.value().FindRigPicture("face_squash"), 0);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace furrow::authoring
