// SPDX-License-Identifier: Apache-2.0
#include "rig/rig_file.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/json_index.h"
#include "tests/temporary_folder.h"

namespace furrow::rig {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

// One field per line, so that tests can predict the line of an error.
constexpr char kSmallRig[] = R"({
  "name": "small",
  "anchor": "head",
  "reference_poses": [
    {"name": "up",
     "joints": [{"joint": "brow",
                 "euler_degrees": [-20, 0, 0]}]}
  ],
  "drivers": [
    {"name": "brow", "pose": {
      "points": [{"joint": "brow"}],
      "values": [{"name": "stretch", "reference_pose": "up"}]}},
    {"name": "knee_l", "hinge": {
      "parent": "thigh", "joint": "shin",
      "axis": [1, 0, 0]}}
  ],
  "regions": [
    {"name": "brow_l",
     "mask": {"texture": "mask.png", "channel": "b"},
     "neighbours": ["knee"],
     "feeds": [{"map": "folds",
                "sources": [{"from": "brow.stretch"}]}]},
    {"name": "knee", "mask": {"kind": "skinning"},
     "feeds": [{"map": "folds", "sources": [{"from": "knee_l.flexed", "gain": 0.5}]}]}
  ],
  "wrinkle_maps": [{"name": "folds", "normal": "folds.png"}],
  "export": [{"profile": "mine", "names": [{"weight": "knee.folds", "name": "Knee"}]}]
}
)";

Result<wrinkle::Rig> Parse(std::string_view json) { return ParseRig(json, "a.rig.json", "."); }

std::string Replaced(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// A source with two joints. Frame n turns the second joint by n degrees.
Result<wrinkle::PoseFrame> TurningSource(const std::filesystem::path& path, int frame) {
  if (frame > 10) return Status(StatusCode::kInvalidArgument, "11 frames", path.string());
  wrinkle::PoseFrame result;
  result.skeleton = *wrinkle::Skeleton::Create(
      {{"root", -1, {}, {}}, {"brow", 0, {{0, 1, 0}}, glm::vec3(0, 0, 1)}});
  result.pose.SetRest(result.skeleton);
  result.pose.joints[1].rotation =
      glm::angleAxis(glm::radians(static_cast<float>(frame)), glm::vec3(1, 0, 0));
  return result;
}

TEST(RigFile, ReadsEveryPart) {
  const auto rig = Parse(kSmallRig);
  ASSERT_TRUE(rig.ok()) << rig.status().ToString();
  EXPECT_EQ(rig->name, "small");
  EXPECT_EQ(rig->anchor, "head");
  ASSERT_EQ(rig->reference_poses.size(), 1u);
  EXPECT_NEAR(rig->reference_poses[0].joints[0].rotation.x, -0.17364818, 1e-6);  // sin(-10 deg)
  ASSERT_EQ(rig->drivers.size(), 2u);
  EXPECT_EQ(rig->drivers[1].kind, wrinkle::Driver::Kind::kHinge);
  EXPECT_EQ(rig->drivers[1].hinge.axis, glm::vec3(1, 0, 0));
  EXPECT_EQ(rig->drivers[1].hinge.beta_degrees, 30.0f);
  ASSERT_EQ(rig->regions.size(), 2u);
  EXPECT_EQ(rig->regions[0].mask.channel, 2);
  EXPECT_EQ(rig->regions[1].mask.kind, wrinkle::Mask::Kind::kSkinning);
  EXPECT_EQ(rig->regions[1].feeds[0].sources[0].driver, "knee_l");
  EXPECT_EQ(rig->regions[1].feeds[0].sources[0].value, "flexed");
  EXPECT_EQ(rig->regions[1].feeds[0].sources[0].gain, 0.5f);
  EXPECT_EQ(rig->exports[0].name, "Knee");
}

TEST(RigFile, WrittenRigsReadBackEqual) {
  for (const char* file : {"arkit.json", "cmu.json"}) {
    const auto rig = LoadRig(std::string(FURROW_SOURCE_DIR "/rig/rigs/") + file);
    ASSERT_TRUE(rig.ok()) << rig.status().ToString();
    const std::string json = RigToJson(*rig);
    const auto again = Parse(json);
    ASSERT_TRUE(again.ok()) << again.status().ToString();
    EXPECT_EQ(RigToJson(*again), json) << file;
    EXPECT_EQ(again->drivers.size(), rig->drivers.size());
    EXPECT_EQ(again->exports.size(), rig->exports.size());
  }
}

TEST(RigFile, WritesFloatsThatReadBackEqual) {
  auto rig = *Parse(kSmallRig);
  rig.filter.beta = 1.0f / 3.0f;
  rig.reference_poses[0].source_size = 0.1f;
  rig.reference_poses[0].joints[0].translation = {1e-7f, -123456.789f, 1.0f / 7.0f};
  const auto again = Parse(RigToJson(rig));
  ASSERT_TRUE(again.ok()) << again.status().ToString();
  EXPECT_EQ(again->filter.beta, rig.filter.beta);
  EXPECT_EQ(again->reference_poses[0].source_size, 0.1f);
  EXPECT_EQ(again->reference_poses[0].joints[0].translation,
            rig.reference_poses[0].joints[0].translation);
  EXPECT_EQ(again->reference_poses[0].joints[0].rotation,
            rig.reference_poses[0].joints[0].rotation);
}

TEST(RigFile, ReadsAndWritesTheSizeReference) {
  EXPECT_EQ(Parse(kSmallRig)->size_reference, nullptr);
  const std::string json = Replaced(kSmallRig, R"("anchor": "head",)", R"("anchor": "head",
  "size_reference": {"size": 9.5, "joints": [
    {"joint": "head", "position": [0, 1.5, 0]}, {"joint": "brow", "position": [0.1, 1.6, 0.2]}]},)");
  const auto rig = Parse(json);
  ASSERT_TRUE(rig.ok()) << rig.status().ToString();
  ASSERT_NE(rig->size_reference, nullptr);
  EXPECT_EQ(rig->size_reference->size, 9.5f);
  ASSERT_EQ(rig->size_reference->joints.size(), 2u);
  EXPECT_EQ(rig->size_reference->joints[1].name, "brow");
  EXPECT_EQ(rig->size_reference->joints[1].position, glm::vec3(0.1f, 1.6f, 0.2f));
  EXPECT_EQ(rig->reference_poses[0].size_reference, rig->size_reference);
  const std::string written = RigToJson(*rig);
  const auto again = Parse(written);
  ASSERT_TRUE(again.ok()) << again.status().ToString();
  EXPECT_EQ(RigToJson(*again), written);
  EXPECT_NE(written.find("size_reference"), std::string::npos);
}

TEST(RigFile, RejectsSizeReferencesThatSayNothing) {
  const auto with = [](const char* reference) {
    return Parse(Replaced(kSmallRig, R"("anchor": "head",)",
                          std::string(R"("anchor": "head", "size_reference": )") + reference + ","))
        .status();
  };
  EXPECT_EQ(with(R"({"joints": [{"joint": "a", "position": [0, 0, 0]},
                                {"joint": "b", "position": [0, 1, 0]}]})")
                .code(),
            StatusCode::kInvalidArgument);
  EXPECT_EQ(with(R"({"size": 1, "joints": [{"joint": "a", "position": [0, 0, 0]}]})").code(),
            StatusCode::kInvalidArgument);
  EXPECT_EQ(with(R"({"size": 1, "joints": [{"joint": "a", "position": [0, 0, 0]},
                                           {"joint": "a", "position": [0, 1, 0]}]})")
                .code(),
            StatusCode::kInvalidArgument);
  EXPECT_EQ(with(R"({"size": 1, "joints": [{"joint": "a"}]})").code(), StatusCode::kSchema);
}

TEST(RigFile, KeepsEveryFieldOfAMap) {
  auto rig = *Parse(kSmallRig);
  EXPECT_EQ(rig.wrinkle_maps[0].surface, wrinkle::WrinkleMap::Surface::kAny);
  rig.wrinkle_maps[0] = {.name = "folds",
                         .derivative = "d.exr",
                         .derivative_scale = 2.5f,
                         .height = "h.png",
                         .height_mm = 3.25f,
                         .colour = "c.png",
                         .colour_scale = 1.5f,
                         .cavity = "v.png",
                         .amplitude = 0.5f,
                         .surface = wrinkle::WrinkleMap::Surface::kCloth};
  const auto again = Parse(RigToJson(rig));
  ASSERT_TRUE(again.ok()) << again.status().ToString();
  const wrinkle::WrinkleMap& map = again->wrinkle_maps[0];
  EXPECT_EQ(map.derivative, "d.exr");
  EXPECT_EQ(map.derivative_scale, 2.5f);
  EXPECT_EQ(map.height, "h.png");
  EXPECT_EQ(map.height_mm, 3.25f);
  EXPECT_EQ(map.colour, "c.png");
  EXPECT_EQ(map.colour_scale, 1.5f);
  EXPECT_EQ(map.cavity, "v.png");
  EXPECT_EQ(map.surface, wrinkle::WrinkleMap::Surface::kCloth);
}

TEST(RigFile, KeepsEveryFieldOfAStrainDriver) {
  auto rig = *Parse(kSmallRig);
  wrinkle::Driver& driver = rig.drivers.emplace_back();
  driver.name = "cheek";
  driver.kind = wrinkle::Driver::Kind::kStrain;
  driver.strain = {.joint = "head",
                   .joints = {"head", "brow"},
                   .vertices = {{{0, 0, 0}, {0}, {1.0f}},
                                {{1, 0, 0}, {0, 1}, {0.25f, 0.75f}},
                                {{0, 1.0f / 3.0f, 0}, {1}, {1.0f}}},
                   .triangles = {0, 1, 2},
                   .shapes = {{"puff", {0, 2}, {0.1f, 0, 0, 0, 0.2f, 0}}, {"Suck", {}, {}}},
                   .direction = {0, 1, 0},
                   .full_compression = 0.125f,
                   .size = 1.7f};
  const auto again = Parse(RigToJson(rig));
  ASSERT_TRUE(again.ok()) << again.status().ToString();
  const wrinkle::StrainDriver& strain = again->drivers.back().strain;
  EXPECT_EQ(again->drivers.back().kind, wrinkle::Driver::Kind::kStrain);
  EXPECT_EQ(strain.joint, "head");
  EXPECT_EQ(strain.joints, driver.strain.joints);
  ASSERT_EQ(strain.vertices.size(), 3u);
  EXPECT_EQ(strain.vertices[2].position.y, 1.0f / 3.0f);
  EXPECT_EQ(strain.vertices[1].joints, (std::vector<int>{0, 1}));
  EXPECT_EQ(strain.vertices[1].skin_weights, (std::vector<float>{0.25f, 0.75f}));
  EXPECT_EQ(strain.triangles, (std::vector<int>{0, 1, 2}));
  ASSERT_EQ(strain.shapes.size(), 2u);
  EXPECT_EQ(strain.shapes[0].blend_shape, "puff");
  EXPECT_EQ(strain.shapes[0].vertices, (std::vector<int>{0, 2}));
  EXPECT_EQ(strain.shapes[0].deltas, (std::vector<float>{0.1f, 0, 0, 0, 0.2f, 0}));
  EXPECT_EQ(strain.shapes[1].blend_shape, "Suck");
  EXPECT_EQ(strain.direction, glm::vec3(0, 1, 0));
  EXPECT_EQ(strain.full_compression, 0.125f);
  EXPECT_EQ(strain.size, 1.7f);
}

// One change to kSmallRig, and the code, line and field of the expected error.
struct WrongRig {
  const char* from;
  const char* to;
  StatusCode code;
  const char* where;
};

class RigFileErrors : public ::testing::TestWithParam<WrongRig> {};

TEST_P(RigFileErrors, NameFileLineAndField) {
  const WrongRig& wrong = GetParam();
  const auto rig = Parse(Replaced(kSmallRig, wrong.from, wrong.to));
  ASSERT_FALSE(rig.ok());
  EXPECT_EQ(rig.status().code(), wrong.code) << rig.status().ToString();
  EXPECT_EQ(rig.status().where(), std::string("a.rig.json:") + wrong.where)
      << rig.status().ToString();
  EXPECT_FALSE(rig.status().what().empty());
}

constexpr StatusCode kSchema = StatusCode::kSchema;
constexpr StatusCode kInvalid = StatusCode::kInvalidArgument;
INSTANTIATE_TEST_SUITE_P(
    All, RigFileErrors,
    ::testing::Values(
        WrongRig{"\"anchor\"", "\"ancor\"", kSchema, "3: ancor"},
        WrongRig{"\"name\": \"small\",", "", kSchema, "1: name"},
        WrongRig{"\"axis\": [1, 0, 0]", "\"axis\": \"x\"", kSchema, "15: drivers[1].hinge.axis"},
        WrongRig{"\"axis\": [1, 0, 0]", "\"axis\": [1, 0]", kSchema, "15: drivers[1].hinge.axis"},
        WrongRig{"\"parent\": \"thigh\", ", "", kSchema, "13: drivers[1].hinge.parent"},
        WrongRig{"\"channel\": \"b\"", "\"channel\": \"x\"", kSchema,
                 "19: regions[0].mask.channel"},
        WrongRig{"[{\"joint\": \"brow\"}]", "7", kSchema, "11: drivers[0].pose.points"},
        WrongRig{"\"axis\": [1, 0, 0]", "\"axis\": [0, 0, 0]", kInvalid,
                 "15: drivers[1].hinge.axis"},
        WrongRig{"\"axis\": [1, 0, 0]", "\"axis\": [1, 0, 0], \"beta_degrees\": 180", kInvalid,
                 "15: drivers[1].hinge.beta_degrees"},
        WrongRig{"\"reference_pose\": \"up\"", "\"reference_pose\": \"down\"", kInvalid,
                 "12: drivers[0].pose.values[0].reference_pose"},
        WrongRig{"\"from\": \"brow.stretch\"", "\"from\": \"brow.squash\"", kInvalid,
                 "22: regions[0].feeds[0].sources[0].from"},
        WrongRig{"\"from\": \"brow.stretch\"", "\"from\": \"nobody.stretch\"", kInvalid,
                 "22: regions[0].feeds[0].sources[0].from"},
        WrongRig{"\"from\": \"brow.stretch\"", "\"from\": \"brow\"", kInvalid,
                 "22: regions[0].feeds[0].sources[0].from"},
        WrongRig{"\"from\": \"brow.stretch\"", "\"from\": \"brow.stretch\", \"gain\": \"nan\"",
                 StatusCode::kNonFinite, "22: regions[0].feeds[0].sources[0].gain"},
        WrongRig{"\"map\": \"folds\",\n", "\"map\": \"creases\",\n", kInvalid,
                 "21: regions[0].feeds[0].map"},
        WrongRig{"\"neighbours\": [\"knee\"]", "\"neighbours\": [\"toe\"]", kInvalid,
                 "20: regions[0].neighbours[0]"},
        WrongRig{"\"texture\": \"mask.png\"", "\"texture\": \"../mask.png\"", kInvalid,
                 "19: regions[0].mask.texture"},
        WrongRig{"\"texture\": \"mask.png\", ", "", kInvalid, "19: regions[0].mask.texture"},
        WrongRig{"\"normal\": \"folds.png\"", "\"normal\": \"/etc/passwd\"", kInvalid,
                 "26: wrinkle_maps[0].normal"},
        WrongRig{"\"name\": \"knee_l\"", "\"name\": \"brow\"", kInvalid, "13: drivers[1].name"},
        WrongRig{"\"name\": \"knee_l\"", "\"name\": \"knee.l\"", kInvalid, "13: drivers[1].name"},
        WrongRig{"\"weight\": \"knee.folds\"", "\"weight\": \"knee.creases\"", kInvalid,
                 "27: export[0].names[0].weight"},
        WrongRig{"\"euler_degrees\": [-20, 0, 0]", "\"rotation\": [0, 0, 0, 2]", kInvalid,
                 "7: reference_poses[0].joints[0].rotation"},
        WrongRig{"\"euler_degrees\": [-20, 0, 0]",
                 "\"euler_degrees\": [0, 0, 0], \"rotation\": [0, 0, 0, 1]", kInvalid,
                 "7: reference_poses[0].joints[0].euler_degrees"},
        WrongRig{"{\"name\": \"up\",\n", "{\"name\": \"up\", \"mix\": [],\n", kInvalid,
                 "5: reference_poses[0]"},
        WrongRig{"\"hinge\": {", "\"twist\": {\"joint\": \"x\"}, \"hinge\": {", kInvalid,
                 "13: drivers[1]"},
        WrongRig{"\"anchor\": \"head\"", "\"version\": 2", StatusCode::kUnsupported, "3: version"},
        WrongRig{"\"anchor\": \"head\"", "\"name\": \"twice\"", kSchema, "3: name"},
        WrongRig{"\"anchor\": \"head\",", "\"anchor\": \"head\"", StatusCode::kParse, "4: anchor"},
        WrongRig{"-20", "-2x0", StatusCode::kParse,
                 "7: reference_poses[0].joints[0].euler_degrees[0]"},
        WrongRig{"-20", "1e39", StatusCode::kNonFinite,
                 "7: reference_poses[0].joints[0].euler_degrees[0]"},
        WrongRig{"\"normal\": \"folds.png\"", "\"surface\": \"hair\"", kSchema,
                 "26: wrinkle_maps[0].surface"},
        WrongRig{"\"normal\": \"folds.png\"", "\"surface\": 3", kInvalid,
                 "26: wrinkle_maps[0].surface"},
        WrongRig{"\"normal\": \"folds.png\"", "\"height\": \"../h.exr\"", kInvalid,
                 "26: wrinkle_maps[0].height"},
        WrongRig{"\"normal\": \"folds.png\"", "\"height_mm\": 0", kInvalid,
                 "26: wrinkle_maps[0].height_mm"},
        WrongRig{"\"normal\": \"folds.png\"", "\"colour_scale\": 11", kInvalid,
                 "26: wrinkle_maps[0].colour_scale"},
        WrongRig{"\"normal\": \"folds.png\"", "\"derivative_scale\": -1", kInvalid,
                 "26: wrinkle_maps[0].derivative_scale"},
        WrongRig{"\"axis\": [1, 0, 0]}}",
                 "\"axis\": [1, 0, 0]}}, {\"name\": \"s\", \"strain\": {}}", kSchema,
                 "15: drivers[2].strain.joint"},
        WrongRig{"\"axis\": [1, 0, 0]",
                 "\"axis\": [1, 0, 0]}}, {\"name\": \"b\", \"ball\": {"
                 "\"parent\": \"a\", \"joint\": \"b\", \"mode\": 2",
                 kInvalid, "15: drivers[2].ball.mode"},
        WrongRig{"[{\"joint\": \"brow\"}]",
                 "[{\"joint\": \"a\"}, {\"joint\": \"b\", \"kind\": -1}]", kInvalid,
                 "11: drivers[0].pose.points[1].kind"},
        WrongRig{"\"points\": [{", "\"solve\": 2, \"points\": [{", kInvalid,
                 "11: drivers[0].pose.solve"},
        WrongRig{"[{\"joint\": \"brow\"}]", "[{\"kind\": \"origin\"}]", kInvalid,
                 "11: drivers[0].pose.points[0].joint"},
        WrongRig{"[{\"joint\": \"brow\"}]", "[{\"joint\": \"brow\", \"kind\": \"blend_shape\"}]",
                 kInvalid, "11: drivers[0].pose.points[0].blend_shape"},
        WrongRig{"[{\"joint\": \"brow\"}]",
                 "[{\"joint\": \"b\", \"kind\": \"blend_shape\", \"blend_shape\": \"a\"}]",
                 kInvalid, "11: drivers[0].pose.points[0].joint"},
        WrongRig{"[{\"joint\": \"brow\"}]", "[{\"joint\": \"brow\", \"blend_shape\": \"a\"}]",
                 kInvalid, "11: drivers[0].pose.points[0].blend_shape"},
        WrongRig{"[{\"joint\": \"brow\"}]",
                 "[{\"kind\": \"blend_shape\", \"blend_shape\": \"a\"}, "
                 "{\"kind\": \"blend_shape\", \"blend_shape\": \"A\"}]",
                 kInvalid, "11: drivers[0].pose.points[1].blend_shape"},
        WrongRig{"{\"name\": \"up\",\n",
                 "{\"name\": \"up\", \"shapes\": [{\"blend_shape\": \"a\", \"value\": 1001}],\n",
                 kInvalid, "5: reference_poses[0].shapes[0].value"},
        WrongRig{"{\"name\": \"up\",\n",
                 "{\"name\": \"up\", \"shapes\": [{\"blend_shape\": \"a\", \"value\": \"nan\"}],\n",
                 StatusCode::kNonFinite, "5: reference_poses[0].shapes[0].value"},
        WrongRig{"{\"name\": \"up\",\n", "{\"name\": \"up\", \"shapes\": [{\"value\": 1}],\n",
                 kSchema, "5: reference_poses[0].shapes[0].blend_shape"},
        WrongRig{"{\"name\": \"up\",\n",
                 "{\"name\": \"up\", \"shapes\": [{\"blend_shape\": \"a\"}, {\"blend_shape\": "
                 "\"A\"}],\n",
                 kInvalid, "5: reference_poses[0].shapes[1].blend_shape"},
        WrongRig{"\"kind\": \"skinning\"", "\"kind\": 7", kInvalid, "23: regions[1].mask.kind"}));

TEST(RigFile, RejectsTooManyValuesForNnls) {
  std::string values = "\"solve\": \"nnls\", \"values\": [";
  for (int i = 0; i < 17; ++i) {
    values += (i == 0 ? "" : ", ") + std::string("{\"name\": \"v") + std::to_string(i) +
              "\", \"reference_pose\": \"up\"}";
  }
  const auto rig = Parse(Replaced(
      kSmallRig, "\"values\": [{\"name\": \"stretch\", \"reference_pose\": \"up\"}", values));
  EXPECT_EQ(rig.status().code(), StatusCode::kLimit);
  EXPECT_EQ(rig.status().where(), "a.rig.json:12: drivers[0].pose.values");
}

TEST(RigFile, RejectsEveryTruncation) {
  const std::string whole(kSmallRig, std::string_view(kSmallRig).find_last_of('}'));
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    const std::string part(whole.data(), length);  // exact size, for the sanitizers
    const auto rig = Parse(part);
    ASSERT_FALSE(rig.ok()) << length;
    EXPECT_EQ(rig.status().code(), StatusCode::kParse) << length << rig.status().ToString();
    EXPECT_THAT(rig.status().where(), StartsWith("a.rig.json:"));
  }
}

TEST(RigFile, RejectsInputOverTheLimits) {
  EXPECT_EQ(Parse(std::string(JsonIndex::kMaxBytes + 1, ' ')).status().code(), StatusCode::kLimit);
  const std::string deep = "{\"name\": " + std::string(1000, '[');
  EXPECT_EQ(Parse(deep).status().code(), StatusCode::kLimit);
  std::string many = "{\"name\": [";
  for (std::size_t i = 0; i < JsonIndex::kMaxElements; ++i) many += "1,";
  EXPECT_EQ(Parse(many).status().code(), StatusCode::kLimit);
  std::string shapes = R"({"name": "a", "reference_poses": [{"name": "p", "shapes": [)";
  for (int i = 0; i <= 2048; ++i) {
    shapes += (i == 0 ? "" : ",") + (R"({"blend_shape": "s)" + std::to_string(i) + "\"}");
  }
  const Status status = Parse(shapes + "]}]}").status();
  EXPECT_EQ(status.code(), StatusCode::kLimit) << status.ToString();
  EXPECT_THAT(status.where(), testing::EndsWith("reference_poses[0].shapes"));
}

TEST(RigFile, RejectsInvalidText) {
  EXPECT_EQ(Parse(std::string_view("{\0}", 3)).status().code(), StatusCode::kParse);
  EXPECT_FALSE(Parse("{\"name\": \"\xff\xfe\"}").ok());
  EXPECT_EQ(Parse("{\"name\": \"a\nb\"}").status().code(), StatusCode::kParse);
  EXPECT_EQ(Parse("[]").status().where(), "a.rig.json:1");
  // FlatBuffers' parser also reads schemas. A rig must not use that.
  EXPECT_EQ(Parse("include \"/etc/passwd\"; {}").status().code(), StatusCode::kParse);
}

TEST(RigFile, KeepsTheBlendShapesOfPosesAndPoints) {
  const std::string json =
      Replaced(kSmallRig, R"({"name": "up",
     "joints": [)",
               R"({"name": "grin", "shapes": [{"blend_shape": "mouthSmileLeft"}]},
    {"name": "half", "mix": [{"pose": "grin", "weight": 0.5}, {"pose": "rest"}]},
    {"name": "rest", "joints": []},
    {"name": "up", "shapes": [{"blend_shape": "browInnerUp", "value": 0.75},
                              {"blend_shape": "mouthSmileLeft", "value": -0.5}],
     "joints": [)");
  const auto rig = Parse(Replaced(json, R"("points": [{"joint": "brow"}])",
                                  R"("points": [{"joint": "brow"},
       {"kind": "blend_shape", "blend_shape": "browInnerUp"}])"));
  ASSERT_TRUE(rig.ok()) << rig.status().ToString();
  const auto again = Parse(RigToJson(*rig));
  ASSERT_TRUE(again.ok()) << again.status().ToString() << RigToJson(*rig);
  for (const wrinkle::Rig& one : {*rig, *again}) {
    ASSERT_EQ(one.reference_poses.size(), 2u) << "building blocks are omitted";
    EXPECT_TRUE(one.reference_poses[0].joints.empty());
    EXPECT_EQ(one.reference_poses[0].shapes,
              (std::vector<wrinkle::ShapeValue>{{"mouthSmileLeft", 0.5f}}));
    EXPECT_EQ(one.reference_poses[1].joints.size(), 1u);
    EXPECT_EQ(
        one.reference_poses[1].shapes,
        (std::vector<wrinkle::ShapeValue>{{"browInnerUp", 0.75f}, {"mouthSmileLeft", -0.5f}}));
    ASSERT_EQ(one.drivers[0].pose.points.size(), 2u);
    EXPECT_EQ(one.drivers[0].pose.points[1].kind, wrinkle::ControlPoint::Kind::kBlendShape);
    EXPECT_EQ(one.drivers[0].pose.points[1].blend_shape, "browInnerUp");
    EXPECT_TRUE(one.drivers[0].pose.points[1].joint.empty());
  }
  EXPECT_EQ(RigToJson(*rig).find("\"joints\": []"), std::string::npos);
}

TEST(RigFile, ReadsPosesFromFramesAndMixes) {
  const std::string json = Replaced(kSmallRig, R"({"name": "up",
     "joints": [{"joint": "brow",
                 "euler_degrees": [-20, 0, 0]}]})",
                                    R"({"name": "unit", "file": "rig_file_test.cpp", "frame": 10},
    {"name": "from_2", "file": "rig_file_test.cpp", "frame": 10, "rest_frame": 4},
    {"name": "up", "mix": [{"pose": "unit", "weight": 0.5}, {"pose": "from_2"}]})");
  const auto rig = ParseRig(Replaced(json, R"("anchor": "head")", R"("anchor": "root")"),
                            "a.rig.json", FURROW_SOURCE_DIR "/tests/unit/rig", TurningSource);
  ASSERT_TRUE(rig.ok()) << rig.status().ToString();
  ASSERT_EQ(rig->reference_poses.size(), 1u) << "building blocks are omitted";
  ASSERT_EQ(rig->reference_poses[0].joints.size(), 1u) << "the root does not move";
  EXPECT_EQ(rig->reference_poses[0].joints[0].joint, "brow");
  // 10 * 0.5 + (10 - 4) degrees about X.
  EXPECT_NEAR(rig->reference_poses[0].joints[0].rotation.x, std::sin(glm::radians(5.5)), 1e-6);
  EXPECT_GT(rig->reference_poses[0].source_size, 0.0f);
  // The recording's skeleton comes along, so streams with fewer joints have the same size.
  ASSERT_NE(rig->size_reference, nullptr);
  EXPECT_EQ(rig->size_reference->size, rig->reference_poses[0].source_size);
  EXPECT_EQ(rig->reference_poses[0].size_reference, rig->size_reference);
}

// Frame 0: the head looks aside. Frame 1: it also raises a brow that does not hang from it.
Result<wrinkle::PoseFrame> FlatSource(const std::filesystem::path&, int frame) {
  wrinkle::PoseFrame result;
  result.skeleton = *wrinkle::Skeleton::Create(
      {{"head", -1, {{0, 1, 0}}, {}}, {"brow", -1, {{0, 1, 0.2f}}, glm::vec3(0, 0, 0.1f)}});
  result.pose.SetRest(result.skeleton);
  const glm::quat aside = glm::angleAxis(glm::radians(90.0f), glm::vec3(0, 1, 0));
  for (wrinkle::Transform& joint : result.pose.joints) joint.rotation = aside;
  const glm::vec3 raised(0.01f * static_cast<float>(frame), 0, 0.2f);
  result.pose.joints[1].translation = glm::vec3(0, 1, 0) + aside * raised;
  return result;
}

TEST(RigFile, FramesOfFlatSkeletonsAreMeasuredFromTheAnchor) {
  const std::string json = Replaced(kSmallRig, R"(     "joints": [{"joint": "brow",
                 "euler_degrees": [-20, 0, 0]}]})",
                                    R"("file": "rig_file_test.cpp", "frame": 1, "rest_frame": 0})");
  const std::string own =
      Replaced(Replaced(json, R"("anchor": "head",)", ""), R"("points": [{"joint": "brow"}])",
               R"("anchor": "head", "points": [{"joint": "brow"}])");
  for (const std::string& text : {json, own}) {
    const auto rig = ParseRig(text, "a.rig.json", FURROW_SOURCE_DIR "/tests/unit/rig", FlatSource);
    ASSERT_TRUE(rig.ok()) << rig.status().ToString();
    ASSERT_EQ(rig->reference_poses[0].joints.size(), 1u);
    EXPECT_LT(glm::distance(rig->reference_poses[0].joints[0].translation, {0.01f, 0, 0}), 1e-6f);
  }
}

// `furrow rig check` goes on without recordings that are not here.
TEST(RigFile, ListsMissingRecordingsOnRequest) {
  const std::string json = Replaced(kSmallRig, R"(     "joints": [{"joint": "brow",
                 "euler_degrees": [-20, 0, 0]}]})",
                                    R"("file": "nowhere.bvh", "frame": 3})");
  std::set<std::string> missing;
  const auto rig = ParseRig(json, "a.rig.json", ".", TurningSource, &missing);
  ASSERT_TRUE(rig.ok()) << rig.status().ToString();
  EXPECT_THAT(missing, testing::ElementsAre("nowhere.bvh"));
  EXPECT_TRUE(rig->reference_poses[0].joints.empty());
}

TEST(RigFile, FindsShippedRigsByName) {
  setenv("FURROW_DATA_DIR", (std::string(FURROW_SOURCE_DIR) + "/rig").c_str(), 1);
  const std::filesystem::path shipped = FURROW_SOURCE_DIR "/rig/rigs/arkit.json";
  EXPECT_EQ(FindRigFile("arkit"), shipped);
  EXPECT_EQ(FindRigFile("arkit.json"), shipped);
  EXPECT_EQ(FindRigFile(shipped.string()), shipped);
  EXPECT_EQ(FindRigFile("./arkit"), "./arkit");
  EXPECT_EQ(FindRigFile("nobody"), "nobody");
  unsetenv("FURROW_DATA_DIR");
}

// A list of joints has one unit of length, so the writer splits what a mix of two units moves.
TEST(RigFile, WritesMixesOfTwoUnits) {
  const std::string json = Replaced(kSmallRig, R"({"name": "up",
     "joints": [{"joint": "brow",
                 "euler_degrees": [-20, 0, 0]}]})",
                                    R"({"name": "sized", "source_size": 3, "joints": [
      {"joint": "brow", "euler_degrees": [-20, 7, 3], "translation": [0, 0.3, 0.1]}]},
    {"name": "plain", "joints": [{"joint": "brow", "translation": [0.2, 0, 0]}]},
    {"name": "up", "mix": [{"pose": "plain", "weight": 0.7}, {"pose": "sized"}]})");
  const auto rig = Parse(json);
  ASSERT_TRUE(rig.ok()) << rig.status().ToString();
  const std::string written = RigToJson(*rig);
  const auto again = Parse(written);
  ASSERT_TRUE(again.ok()) << again.status().ToString();
  EXPECT_EQ(RigToJson(*again), written);
  ASSERT_EQ(again->reference_poses.size(), 1u);
  const wrinkle::ReferencePose& up = again->reference_poses[0];
  EXPECT_EQ(up.source_size, 3.0f);
  EXPECT_EQ(up.joints[0].rotation, rig->reference_poses[0].joints[0].rotation);
  EXPECT_EQ(up.joints[0].translation, glm::vec3(0, 0.3f, 0.1f));
  EXPECT_EQ(up.joints[0].unscaled_translation,
            rig->reference_poses[0].joints[0].unscaled_translation);
  EXPECT_NEAR(up.joints[0].unscaled_translation.x, 0.14f, 1e-7f);
}

TEST(RigFile, ReportsErrorsInFramesAndMixes) {
  const auto parse = [](const char* pose, const wrinkle::PoseSource& source) {
    return ParseRig(Replaced(kSmallRig, R"({"name": "up",
     "joints": [{"joint": "brow",
                 "euler_degrees": [-20, 0, 0]}]})",
                             pose),
                    "a.rig.json", FURROW_SOURCE_DIR "/tests/unit/rig", source)
        .status();
  };
  const Status no_reader = parse(R"({"name": "up", "file": "rig_file_test.cpp"})", {});
  EXPECT_EQ(no_reader.code(), StatusCode::kUnsupported);
  EXPECT_EQ(no_reader.where(), "a.rig.json:5: reference_poses[0].file");
  const Status no_file = parse(R"({"name": "up", "file": "none.bvh"})", TurningSource);
  EXPECT_EQ(no_file.code(), StatusCode::kNotFound);
  EXPECT_EQ(no_file.where(), "a.rig.json:5: reference_poses[0].file");
  const Status no_frame =
      parse(R"({"name": "up", "file": "rig_file_test.cpp", "frame": 11})", TurningSource);
  EXPECT_EQ(no_frame.code(), kInvalid);
  EXPECT_THAT(no_frame.what(), HasSubstr("11 frames"));
  EXPECT_EQ(no_frame.where(), "a.rig.json:5: reference_poses[0].frame");
  const Status cycle = parse(R"({"name": "up", "mix": [{"pose": "b"}]},
    {"name": "b", "mix": [{"pose": "up"}]})",
                             {});
  EXPECT_EQ(cycle.code(), StatusCode::kCyclic);
  EXPECT_EQ(cycle.where(), "a.rig.json:6: reference_poses[1].mix[0].pose");
}

TEST(RigFile, NamesTheMissingFile) {
  const Status status = LoadRig("no/such/rig.json").status();
  EXPECT_EQ(status.code(), StatusCode::kNotFound);
  EXPECT_EQ(status.where(), "no/such/rig.json");
}

TEST(RigFile, SavesAndLoads) {
  const TemporaryFolder folder;
  const auto path = folder / "test.rig.json";
  const auto rig = *Parse(kSmallRig);
  ASSERT_TRUE(SaveRig(rig, path).ok());
  const auto again = LoadRig(path);
  ASSERT_TRUE(again.ok()) << again.status().ToString();
  EXPECT_EQ(RigToJson(*again), RigToJson(rig));
  auto broken = rig;
  broken.regions[0].feeds[0].map = "creases";
  const auto nowhere = folder / "broken.rig.json";
  EXPECT_EQ(SaveRig(broken, nowhere).where(), nowhere.string() + ": regions[0].feeds[0].map");
  EXPECT_FALSE(std::filesystem::exists(nowhere));
}

TEST(RigFile, ReadsTheExampleInTheManual) {
  std::ifstream stream(FURROW_SOURCE_DIR "/docs/RIG.md");
  std::stringstream text;
  text << stream.rdbuf();
  const std::string manual = text.str();
  const std::size_t begin = manual.find("```json\n") + 8;
  ASSERT_LT(begin, manual.size());
  const auto rig = ParseRig(manual.substr(begin, manual.find("```", begin) - begin), "RIG.md", ".");
  ASSERT_TRUE(rig.ok()) << rig.status().ToString();
  EXPECT_EQ(rig->reference_poses.size(), 3u);
  EXPECT_EQ(rig->regions.size(), 3u);
}

}  // namespace
}  // namespace furrow::rig
