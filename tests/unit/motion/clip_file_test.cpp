// SPDX-License-Identifier: Apache-2.0
#include "motion/clip_file.h"

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "motion/bvh/bvh.h"
#include "tests/unit/motion/clip_testing.h"

namespace furrow::motion {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using wrinkle::kNoJoint;

Clip MakeClip() {
  Clip clip;
  clip.skeleton = *wrinkle::Skeleton::Create(
      {{"hips", kNoJoint, {}, {}}, {"Head", 0, {{0, 1, 0}}, {{0, 0.2f, 0}}}});
  clip.blend_shape_names = {"jawOpen"};
  for (int f = 0; f < 5; ++f) {
    clip.times.push_back(f / 30.0);
    clip.locals.push_back({{0.1f * static_cast<float>(f), 0.0f, 0.0f}});
    clip.locals.push_back({{0.0f, 1.0f, 0.0f}});
    clip.blend_shapes.push_back(0.2f * static_cast<float>(f));
  }
  return clip;
}

int CountFiles(const std::filesystem::path& folder) {
  return static_cast<int>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(Clip, GetPoseCopiesOneFrame) {
  const Clip clip = MakeClip();
  wrinkle::LocalPose pose;
  clip.GetPose(3, &pose);
  ASSERT_EQ(pose.joints.size(), 2u);
  EXPECT_FLOAT_EQ(pose.joints[0].translation.x, 0.3f);
  EXPECT_THAT(pose.blend_shapes, ElementsAre(0.6f));
}

// All bones along +X at rest, as in LaFAN1; frame 1 stands.
TEST(LoadClip, TakesTheRestPoseFromAFrame) {
  const TemporaryFolder folder;
  const auto path = folder / "flat.bvh";
  std::ofstream(path) << "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition "
                         "Zposition Zrotation Yrotation Xrotation\nJOINT Spine\n{\nOFFSET 2 0 0\n"
                         "CHANNELS 3 Zrotation Yrotation Xrotation\nEnd Site\n{\nOFFSET 1 0 0\n}\n"
                         "}\n}\nMOTION\nFrames: 2\nFrame Time: 0.1\n0 5 0 0 0 0 0 0 0\n"
                         "0 5 0 90 0 0 0 0 0\n";
  LoadOptions options;
  options.rest_frame = 1;
  const auto clip = LoadClip(path, options);
  ASSERT_TRUE(clip.ok()) << clip.status().ToString();
  const glm::vec3 spine(clip->skeleton.rest_model()[1][3]);
  EXPECT_NEAR(spine.x, 0.0f, 1e-5f);
  EXPECT_NEAR(spine.y, 7.0f, 1e-5f);
  EXPECT_EQ(clip->locals[3].rotation, clip->skeleton.rest_pose()[1].rotation);
  options.rest_frame = 2;
  EXPECT_EQ(LoadClip(path, options).status().code(), StatusCode::kInvalidArgument);
}

TEST(SplitClipPath, SplitsAfterTheExtensionOfARecording) {
  TemporaryFolder folder;
  const auto split = [](const std::filesystem::path& path) {
    std::filesystem::path file;
    std::string animation;
    SplitClipPath(path, &file, &animation);
    return file.string() + "|" + animation;
  };
  EXPECT_EQ(split("walk.fbx#Run"), "walk.fbx|Run");
  EXPECT_EQ(split("walk.FBX#Armature|a.b/c#1"), "walk.FBX|Armature|a.b/c#1");
  EXPECT_EQ(split("take#2.dae#0"), "take#2.dae|0");
  EXPECT_EQ(split("walk.fbx"), "walk.fbx|");
  EXPECT_EQ(split("walk.txt#Run"), "walk.txt#Run|");
  const std::filesystem::path odd = folder.path() / "walk.fbx#Run";
  std::ofstream(odd) << "x";
  EXPECT_EQ(split(odd), odd.string() + "|");
}

TEST(LoadClip, AnimationsOfOtherFormatsCannotBeChosen) {
  TemporaryFolder folder;
  ASSERT_TRUE(SaveClip(MakeClip(), folder.path() / "a.bvh").ok());
  const Result<Clip> clip = LoadClip(folder.path() / "a.bvh#0");
  EXPECT_EQ(clip.status().code(), StatusCode::kUnsupported);
}

TEST(SaveClip, WritesWhatLoadClipReadsByExtension) {
  TemporaryFolder folder;
  const Clip clip = MakeClip();
  for (const char* name : {"a.bvh", "a.GLB", "a.csv"}) {
    const std::filesystem::path path = folder.path() / name;
    ClipReport report;
    ASSERT_TRUE(SaveClip(clip, path, &report).ok()) << name;
    const Result<Clip> read = LoadClip(path);
    ASSERT_TRUE(read.ok()) << read.status().ToString();
    EXPECT_EQ(read->num_frames(), 5) << name;
    const bool has_joints = path.extension() != ".csv";
    const bool has_shapes = path.extension() != ".bvh";
    EXPECT_EQ(read->skeleton.num_joints(), has_joints ? 2 : 0);
    EXPECT_EQ(read->blend_shapes, has_shapes ? clip.blend_shapes : std::vector<float>());
    EXPECT_EQ(report.warnings.size(), has_joints && has_shapes ? 0u : 1u) << name;
    EXPECT_EQ(read->name, "a");
  }
  EXPECT_EQ(CountFiles(folder.path()), 3);  // no temporary files
}

TEST(SaveClip, KeepsTheOldFileOnFailure) {
  TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.bvh";
  ASSERT_TRUE(SaveClip(MakeClip(), path).ok());
  const std::string before = ReadAll(path);
  Clip broken = MakeClip();
  broken.locals.pop_back();
  EXPECT_EQ(SaveClip(broken, path).code(), StatusCode::kInvalidArgument);
  Clip unordered = MakeClip();
  unordered.times[2] = unordered.times[1];
  EXPECT_EQ(SaveClip(unordered, path).code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(ReadAll(path), before);
  EXPECT_EQ(SaveClip(MakeClip(), folder.path() / "none" / "a.bvh").code(), StatusCode::kIo);
  std::filesystem::create_directory(folder.path() / "folder.bvh");
  EXPECT_EQ(SaveClip(MakeClip(), folder.path() / "folder.bvh").code(), StatusCode::kIo);
  EXPECT_EQ(CountFiles(folder.path()), 2);
}

TEST(ParseClip, ReadsTheSameFromBytes) {
  TemporaryFolder folder;
  for (const char* name : {"a.bvh", "a.glb", "a.csv"}) {
    ASSERT_TRUE(SaveClip(MakeClip(), folder / name).ok());
    const Result<Clip> loaded = LoadClip(folder / name);
    const Result<Clip> parsed = ParseClip(ReadAll(folder / name), name);
    ASSERT_TRUE(parsed.ok()) << parsed.status().ToString();
    EXPECT_EQ(parsed->name, "a");
    EXPECT_EQ(parsed->times, loaded->times);
    EXPECT_EQ(parsed->blend_shapes, loaded->blend_shapes);
    ASSERT_EQ(parsed->locals.size(), loaded->locals.size());
    EXPECT_NEAR(WorstDistance(*parsed, *loaded), 0.0f, 1e-6f) << name;
  }
}

TEST(ParseClip, OpensNoFile) {
  TemporaryFolder folder;
  std::ofstream(folder / "a.bin", std::ios::binary) << std::string(64, '\0');
  constexpr char kWithBuffer[] =
      R"({"asset":{"version":"2.0"},"buffers":[{"uri":"a.bin","byteLength":64}]})";
  const std::string name = (folder / "a.gltf").string();
  const Status status = ParseClip(kWithBuffer, name).status();
  EXPECT_EQ(status.code(), StatusCode::kUnsupported) << status.ToString();
  EXPECT_THAT(status.ToString(), HasSubstr("a.bin"));
  const Status expression = ParseClip("name smile", "smile.mhpose").status();
  EXPECT_EQ(expression.code(), StatusCode::kUnsupported);
  EXPECT_THAT(expression.ToString(), HasSubstr("furrow convert"));
  const Status picture = ParseClip("\x89PNG", "a.png").status();
  EXPECT_THAT(picture.ToString(), HasSubstr("unknown recording format '.png'"));
  EXPECT_THAT(picture.ToString(), HasSubstr(".mcap"));
}

TEST(ParseClip, KnowsWhichFilesNeedAHelperProgram) {
  EXPECT_TRUE(NeedsHelperProgram("", "a.fbx"));
  EXPECT_TRUE(NeedsHelperProgram("", "a.DAE"));
  EXPECT_TRUE(NeedsHelperProgram("Kaydara FBX Binary", "a.bvh"));  // the content decides
  EXPECT_FALSE(NeedsHelperProgram("glTF", "a.fbx"));
  EXPECT_FALSE(NeedsHelperProgram("HIERARCHY", "a.bvh"));
}

TEST(LoadClip, ReportsWhatIsWrongWithTheFile) {
  TemporaryFolder folder;
  const auto write = [&folder](const std::string& name, const std::string& bytes) {
    std::ofstream(folder.path() / name, std::ios::binary) << bytes;
    return folder.path() / name;
  };
  EXPECT_EQ(LoadClip(folder.path() / "none.bvh").status().code(), StatusCode::kNotFound);
  EXPECT_EQ(LoadClip(folder.path()).status().code(), StatusCode::kUnsupported);
  std::filesystem::create_directory(folder.path() / "folder.bvh");
  EXPECT_EQ(LoadClip(folder.path() / "folder.bvh").status().code(), StatusCode::kInvalidArgument);
  for (const char* name : {"a.bvh", "a.glb", "a.gltf", "a.vrma", "a.csv"}) {
    const Result<Clip> empty = LoadClip(write(name, ""));
    EXPECT_EQ(empty.status().code(), StatusCode::kParse) << name;
    EXPECT_THAT(empty.status().ToString(), HasSubstr(name));
    EXPECT_THAT(empty.status().ToString(), HasSubstr("empty"));
  }
  const Status unknown = LoadClip(write("a.usd", "x")).status();
  EXPECT_EQ(unknown.code(), StatusCode::kUnsupported);
  EXPECT_THAT(unknown.ToString(), HasSubstr(".bvh"));
  EXPECT_EQ(LoadClip(write("plain", "x")).status().code(), StatusCode::kUnsupported);
  // A .vrma needs the roles of its joints, which a clip does not have. A .gltf would need a second
  // file for its buffer.
  for (const char* name : {"a.fbx", "a.vrma", "a.gltf"}) {
    EXPECT_EQ(SaveClip(MakeClip(), folder.path() / name).code(), StatusCode::kUnsupported) << name;
  }
}

}  // namespace
}  // namespace furrow::motion
