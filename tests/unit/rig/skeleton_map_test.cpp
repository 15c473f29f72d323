// SPDX-License-Identifier: Apache-2.0
#include "rig/skeleton_map.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/data_dir.h"
#include "tests/temporary_folder.h"

namespace furrow::rig {
namespace {

namespace fs = std::filesystem;
using wrinkle::JointRole;
using enum JointRole;
using Names = std::vector<std::string>;

constexpr char kToy[] = R"({
  // a comment
  "version": 1, "name": "toy", "title": "Toys", "prefixes": ["toy_", "*#"],
  "sides": {"left": "L", "right": "R"},
  "joints": {"hips": "Root|Pelvis", "neck": ["N1", "N2"], "*Hand": "Hand.*"}
})";

SkeletonMap Toy() { return ParseSkeletonMap(kToy, "toy.json").value(); }

// The shipped maps, read from the source tree.
SkeletonMaps Shipped() {
  std::vector<SkeletonMap> maps;
  for (const auto& file :
       fs::directory_iterator(fs::path(FURROW_SOURCE_DIR) / "rig/skeleton_maps")) {
    std::ifstream in(file.path());
    const std::string text((std::istreambuf_iterator<char>(in)), {});
    auto map = ParseSkeletonMap(text, file.path().string());
    EXPECT_TRUE(map.ok()) << map.status().ToString();
    if (map.ok()) maps.push_back(*std::move(map));
  }
  return SkeletonMaps(std::move(maps));
}

TEST(JointRole, NamesParentsAndMirrorsAreConsistent) {
  std::set<std::string_view> names;
  for (int i = 1; i < wrinkle::kNumJointRoles; ++i) {
    const auto role = static_cast<JointRole>(i);
    names.insert(ToString(role));
    EXPECT_EQ(wrinkle::ParseJointRole(ToString(role)), role);
    EXPECT_EQ(MirrorOf(MirrorOf(role)), role);
    EXPECT_EQ(ParentOf(MirrorOf(role)), MirrorOf(ParentOf(role)));
    JointRole above = role;
    for (int step = 0; step < 12 && above != kHips; ++step) above = ParentOf(above);
    EXPECT_EQ(above, kHips) << ToString(role);
  }
  EXPECT_EQ(names.size(), 55u);
  EXPECT_EQ(wrinkle::ParseJointRole("none"), std::nullopt);
  EXPECT_EQ(MirrorOf(kLeftLittleDistal), kRightLittleDistal);
  EXPECT_EQ(ParentOf(kRightHand), kRightLowerArm);
}

TEST(SkeletonMap, FindsRolesChainsAndMissingRoles) {
  const Names names = {"root", "n2", "Hand.L", "tail", "n1"};
  const SkeletonRoles found = ApplySkeletonMap(Toy(), names);
  EXPECT_EQ(found.map, "toy");
  EXPECT_THAT(found.roles, testing::ElementsAre(kHips, kNeck, kLeftHand, kNone, kNeck));
  EXPECT_EQ(found.num_roles, 3);
  EXPECT_EQ(found.num_joints, 4);
  EXPECT_THAT(found.missing, testing::ElementsAre(kRightHand));
  EXPECT_EQ(JoinRoles(found.missing), "rightHand");
}

TEST(SkeletonMap, TheFirstAlternativeAndTheFirstJointWin) {
  EXPECT_THAT(ApplySkeletonMap(Toy(), Names{"Pelvis", "Root", "ROOT"}).roles,
              testing::ElementsAre(kNone, kHips, kNone));
  EXPECT_THAT(ApplySkeletonMap(Toy(), Names{"Pelvis"}).roles, testing::ElementsAre(kHips));
}

TEST(SkeletonMap, IgnoresNamespacesAndPrefixes) {
  for (const char* prefix : {"", "any:", "a:b:", "toy_", "x:TOY_", "Take#1#"}) {
    const Names names = {prefix + std::string("Root"), prefix + std::string("Hand.R")};
    EXPECT_THAT(ApplySkeletonMap(Toy(), names).roles, testing::ElementsAre(kHips, kRightHand))
        << prefix;
  }
  EXPECT_EQ(ApplySkeletonMap(Toy(), Names{"toyRoot"}).num_roles, 0);
}

TEST(SkeletonMap, RespectsIgnoreCase) {
  SkeletonMap map = Toy();
  map.ignore_case = false;
  EXPECT_EQ(ApplySkeletonMap(map, Names{"root"}).num_roles, 0);
  EXPECT_EQ(ApplySkeletonMap(map, Names{"Root"}).num_roles, 1);
}

struct Bad {
  const char* from;  // in kToy
  const char* to;
  StatusCode code;
};

TEST(SkeletonMap, ReportsEveryFault) {
  const Bad kBad[] = {
      {"\"version\": 1", "\"version\": 2", StatusCode::kUnsupported},
      {"\"version\": 1,", "", StatusCode::kSchema},
      {"\"name\": \"toy\"", "\"name\": \"\"", StatusCode::kSchema},
      {"\"name\": \"toy\"", "\"name\": 3", StatusCode::kSchema},
      {"\"title\"", "\"titel\"", StatusCode::kSchema},
      {"\"*#\"", "\"*\"", StatusCode::kSchema},
      {"[\"toy_\", \"*#\"]", "\"toy_\"", StatusCode::kSchema},
      {"\"right\": \"R\"", "\"right\": \"L\"", StatusCode::kSchema},
      {"\"right\"", "\"wrong\"", StatusCode::kSchema},
      {"\"sides\": {\"left\": \"L\", \"right\": \"R\"},", "", StatusCode::kSchema},
      {"\"hips\"", "\"hip\"", StatusCode::kSchema},
      {"\"hips\"", "\"none\"", StatusCode::kSchema},
      {"\"hips\"", "\"leftHand\"", StatusCode::kSchema},  // duplicate, because of "*Hand"
      {"Root|Pelvis", "Root|", StatusCode::kSchema},
      {"Root|Pelvis", "Ro*t", StatusCode::kSchema},
      {"[\"N1\", \"N2\"]", "[]", StatusCode::kSchema},
      {"[\"N1\", \"N2\"]", "[[\"N1\"]]", StatusCode::kSchema},
      {"\"sides\"", "\"toes_height\": true, \"sides\"", StatusCode::kSchema},
      {"\"sides\"", "\"toes_height\": 0.6, \"sides\"", StatusCode::kInvalidArgument},
      {"\"neck\"", "neck", StatusCode::kParse},
  };
  for (const Bad& bad : kBad) {
    std::string text = kToy;
    const std::size_t at = text.find(bad.from);
    ASSERT_NE(at, std::string::npos) << bad.from;
    text.replace(at, std::string(bad.from).size(), bad.to);
    const auto map = ParseSkeletonMap(text, "toy.json");
    ASSERT_FALSE(map.ok()) << bad.from << " -> " << bad.to;
    EXPECT_EQ(map.status().code(), bad.code) << map.status().ToString();
    EXPECT_THAT(map.status().where(), testing::StartsWith("toy.json"));
  }
}

TEST(SkeletonMap, RejectsTruncatedAndOversizedInput) {
  const std::string whole = kToy;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_FALSE(ParseSkeletonMap(whole.substr(0, length), "toy").ok()) << length;
  }
  EXPECT_EQ(ParseSkeletonMap(std::string((1 << 20) + 1, ' '), "toy").status().code(),
            StatusCode::kLimit);
  std::string many = whole;
  many.replace(many.find("\"N1\""), 4, "\"" + std::string(256, 'x') + "\"");
  EXPECT_EQ(ParseSkeletonMap(many, "toy").status().code(), StatusCode::kLimit);
  // Nested so deeply that recursion would overflow the stack. Tried at every value.
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  for (const char* value : {"1,", "\"toy\"", "\"Toys\"", "\"toy_\"", "\"L\"", "\"Root|Pelvis\"",
                            "[\"N1\", \"N2\"]", "\"N1\"", "\"Hand.*\""}) {
    std::string nested = whole;
    const std::string by = deep + (std::string_view(value).ends_with(',') ? "," : "");
    nested.replace(nested.find(value), std::string_view(value).size(), by);
    const Status status = ParseSkeletonMap(nested, "toy").status();
    EXPECT_TRUE(status.code() == StatusCode::kSchema || status.code() == StatusCode::kUnsupported)
        << value << ": " << status.ToString();
  }
}

TEST(SkeletonMaps, RequiresAMinimumNumberOfRoles) {
  const SkeletonMaps maps = Shipped();
  EXPECT_TRUE(maps.RolesOf(Names{"head", "neck", "jaw"}).map.empty());
  EXPECT_TRUE(maps.RolesOf(Names{"head", "neck", "jaw"}).roles.empty());
  std::vector<SkeletonMap> one = {maps.maps()[0]};
  const SkeletonMaps chosen(one, /*chosen=*/true);
  EXPECT_EQ(chosen.RolesOf(Names{"head"}).map, one[0].name);
}

// For every shipped map: a skeleton with the first name of each place matches that map completely.
TEST(SkeletonMaps, EveryShippedMapRecognisesItsOwnFamily) {
  const SkeletonMaps maps = Shipped();
  EXPECT_GE(maps.maps().size(), 11u);
  for (const SkeletonMap& map : maps.maps()) {
    Names names;
    for (const auto& entry : map.entries) {
      for (const auto& place : entry.chain) names.push_back(place.front());
    }
    EXPECT_EQ((std::set<std::string>(names.begin(), names.end()).size()), names.size()) << map.name;
    const SkeletonRoles found = maps.RolesOf(names);
    EXPECT_EQ(found.map, map.name);
    EXPECT_TRUE(found.missing.empty()) << map.name << ": " << JoinRoles(found.missing);
    for (const JointRole role : {kHips, kHead, kLeftHand, kRightHand, kLeftFoot}) {
      EXPECT_EQ(std::ranges::count(found.roles, role), 1) << map.name;
    }
  }
}

// CMU's database in the conversion that most people have, and in the one for MotionBuilder.
TEST(SkeletonMaps, RecognisesCmuByItsSpine) {
  const SkeletonMaps maps = Shipped();
  for (const char* finger : {"LFingers", "LeftHandIndex1"}) {
    Names names = {"Hips", "LHipJoint", "LowerBack", "Spine", "Spine1", "Neck", "Neck1", "Head"};
    for (const std::string side : {"Left", "Right"}) {
      for (const char* joint : {"UpLeg", "Leg", "Foot", "ToeBase", "Shoulder", "Arm", "ForeArm",
                                "Hand", "FingerBase"}) {
        names.push_back(side + joint);
      }
    }
    const bool friendly = std::string(finger) == "LeftHandIndex1";
    names.insert(names.end(),
                 {finger, friendly ? "RightHandIndex1" : "RFingers", "LThumb", "RThumb"});
    const SkeletonRoles found = maps.RolesOf(names);
    EXPECT_EQ(found.map, "cmu") << finger;
    EXPECT_EQ(found.roles[2], kSpine) << finger;
    EXPECT_EQ(found.roles[3], kChest) << finger;
  }
}

// Joint names of published files.
TEST(SkeletonMaps, RecognisesFilesOfOtherFamilies) {
  const SkeletonMaps maps = Shipped();
  struct Family {
    const char* map;
    Names middle;
    std::vector<std::string> of_side;  // '*' stands for the side
    const char* left;
    const char* right;
    std::vector<JointRole> roles;  // of the left side
  };
  const std::vector<JointRole> arm = {kLeftShoulder, kLeftUpperArm, kLeftLowerArm, kLeftHand};
  const std::vector<JointRole> leg = {kLeftUpperLeg, kLeftLowerLeg, kLeftFoot};
  const auto both = [](std::vector<JointRole> a, const std::vector<JointRole>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  };
  const Family families[] = {
      {"biovision",
       {"Hips", "Chest", "Neck", "Head"},
       {"*Collar", "*Shoulder", "*Elbow", "*Wrist", "*Hip", "*Knee", "*Ankle"},
       "Left",
       "Right",
       both(arm, leg)},
      {"biovision",
       {"Hips", "Chest", "Chest2", "Neck", "Head"},
       {"*Collar", "*UpArm", "*LowArm", "*Hand", "*UpLeg", "*LowLeg", "*Foot"},
       "Left",
       "Right",
       both(arm, leg)},
      {"bandai_namco",
       {"joint_Root", "Hips", "Spine", "Chest", "Neck", "Head"},
       {"Shoulder_*", "UpperArm_*", "LowerArm_*", "Hand_*", "UpperLeg_*", "LowerLeg_*", "Foot_*"},
       "L",
       "R",
       both(arm, leg)},
      {"lafan1",
       {"Hips", "Spine", "Spine1", "Spine2", "Neck", "Head"},
       {"*Shoulder", "*Arm", "*ForeArm", "*Hand", "*UpLeg", "*Leg", "*Foot", "*Toe"},
       "Left",
       "Right",
       both(both(arm, leg), {kLeftToes})},
      {"makehuman_1_0",
       {"hips", "spine", "spine-1", "chest", "chest-1", "neck", "head", "jaw"},
       {"clavicle.*", "upper_arm.*", "forearm.*", "hand.*", "thigh.*", "shin.*", "foot.*"},
       "L",
       "R",
       both(arm, leg)},
      {"makehuman_mhx",
       {"Root", "Hips", "Spine1", "Spine2", "Spine3", "Neck", "Head"},
       {"Clavicle_*", "UpArm_*", "LoArm_*", "Hand_*", "UpLeg_*", "LoLeg_*", "Foot_*"},
       "L",
       "R",
       both(arm, leg)},
      {"cal3d",
       {"Bip01", "Bip01 Pelvis", "Bip01 Spine", "Bip01 Spine1", "Bip01 Neck", "Bip01 Head"},
       {"Bip01 * Clavicle", "Bip01 * UpperArm", "Bip01 * Forearm", "Bip01 * Hand", "Bip01 * Thigh",
        "Bip01 * Calf", "Bip01 * Foot"},
       "L",
       "R",
       both(arm, leg)},
      {"quaternius",
       {"Bone", "Body", "Hips", "Abdomen", "Torso", "Neck", "Head"},
       {"Shoulder.*", "UpperArm.*", "LowerArm.*", "Palm2.*", "UpperLeg.*", "LowerLeg.*", "Foot.*",
        "PoleTarget.*"},
       "L",
       "R",
       both(arm, leg)},
      {"quaternius",
       {"Rig", "root", "hips", "spine", "chest", "head"},
       {"upperarm.*", "lowerarm.*", "wrist.*", "upperleg.*", "lowerleg.*", "foot.*", "toes.*",
        "hand.*", "handslot.*", "kneeIK.*", "IK-foot.*", "handIK.*"},
       "l",
       "r",
       {kLeftUpperArm, kLeftLowerArm, kLeftHand, kLeftUpperLeg, kLeftLowerLeg, kLeftFoot,
        kLeftToes}},
      {"rigify",
       {"DEF-spine", "DEF-spine.001", "DEF-spine.002", "DEF-spine.003", "DEF-spine.004",
        "DEF-spine.006"},
       {"DEF-shoulder.*", "DEF-upper_arm.*", "DEF-forearm.*", "DEF-hand.*", "DEF-thigh.*",
        "DEF-shin.*", "DEF-foot.*", "DEF-toe.*", "DEF-pelvis.*"},
       "L",
       "R",
       both(both(arm, leg), {kLeftToes})},
      {"poser",
       {"hip", "abdomen", "chest", "neck", "head"},
       {"*Collar", "*Shldr", "*ForeArm", "*Hand", "*Thigh", "*Shin", "*Foot", "*Toe"},
       "l",
       "r",
       both(both(arm, leg), {kLeftToes})},
      {"cal3d",
       {"Bip001_Pelvis", "Bip001_Spine", "Bip001_Spine1", "Bip001_Neck", "Bip001_Head"},
       {"Bip001_*_Clavicle", "Bip001_*_UpperArm", "Bip001_*_Forearm", "Bip001_*_Hand",
        "Bip001_*_Thigh", "Bip001_*_Calf", "Bip001_*_Foot"},
       "L",
       "R",
       both(arm, leg)},
  };
  for (const Family& family : families) {
    Names names = family.middle;
    for (const char* side : {family.left, family.right}) {
      for (std::string name : family.of_side)
        names.push_back(name.replace(name.find('*'), 1, side));
    }
    const SkeletonRoles found = maps.RolesOf(names);
    EXPECT_EQ(found.map, family.map);
    if (found.map != family.map) continue;
    EXPECT_EQ(std::ranges::count(found.roles, kHips), 1) << family.map;
    for (std::size_t i = 0; i < family.roles.size(); ++i) {
      const std::size_t left = family.middle.size() + i;
      EXPECT_EQ(found.roles[left], family.roles[i]) << names[left];
      EXPECT_EQ(found.roles[left + family.of_side.size()], MirrorOf(family.roles[i]));
    }
  }
}

// Two maps explain the same number of joints; one of them leaves a joint of the spine out.
TEST(SkeletonMaps, JointsLeftOutBetweenOthersCount) {
  const auto map = [](const char* name, const char* spine) {
    return ParseSkeletonMap(std::string(R"({"version": 1, "name": ")") + name +
                                R"(", "joints": {"hips": "a", "head": "d", "leftUpperLeg": "l1",
       "leftLowerLeg": "l2", "leftFoot": "l3", )" +
                                spine + "}}",
                            name)
        .value();
  };
  const SkeletonMaps maps({map("first", R"("leftToes": "l4")"), map("second", R"("spine": "b")")});
  const auto joint = [](const char* name, int parent) {
    wrinkle::JointDesc desc{name, parent, {}, {}};
    desc.rest.translation = {0.0f, 1.0f, 0.0f};
    return desc;
  };
  const auto skeleton =
      wrinkle::Skeleton::Create({joint("a", -1), joint("b", 0), joint("d", 1), joint("l1", 0),
                                 joint("l2", 3), joint("l3", 4), joint("l4", 5)});
  ASSERT_TRUE(skeleton.ok());
  EXPECT_EQ(maps.RolesOf(*skeleton).map, "second");
}

TEST(SkeletonMaps, TheMoreSpecificMapWinsATie) {
  const auto with = [](const char* name, const char* more) {
    return ParseSkeletonMap(std::string(R"({"version": 1, "name": ")") + name +
                                R"(", "joints": {"hips": "a", "spine": "b", "head": "c",
       "leftUpperLeg": "d", "leftLowerLeg": "e", "leftFoot": "f")" +
                                more + "}}",
                            name)
        .value();
  };
  const SkeletonMaps two({with("a_general", R"(, "neck": "g", "jaw": "h")"), with("specific", "")});
  EXPECT_EQ(two.RolesOf(Names{"a", "b", "c", "d", "e", "f"}).map, "specific");
}

// VMC's names are VRM's with capitals, and only their thumbs differ.
TEST(SkeletonMaps, TheCaseOfTheNamesDecidesATie) {
  const SkeletonMaps maps = Shipped();
  Names vrm = {"hips", "spine", "chest", "neck", "head", "leftUpperArm", "leftThumbProximal"};
  EXPECT_EQ(maps.RolesOf(vrm).map, "vrm");
  EXPECT_EQ(maps.RolesOf(vrm).roles.back(), kLeftThumbProximal);
  Names vmc = {"Hips", "Spine", "Chest", "Neck", "Head", "LeftUpperArm", "LeftThumbProximal"};
  EXPECT_EQ(maps.RolesOf(vmc).map, "vmc");
  EXPECT_EQ(maps.RolesOf(vmc).roles.back(), kLeftThumbMetacarpal);
}

// MakeHuman's older rig shares its trunk with other families. Its legs would stay stiff.
TEST(SkeletonMaps, ATrunkAloneIsNoMatch) {
  const SkeletonMaps maps = Shipped();
  const Names trunk = {"hips", "spine", "chest", "upperChest", "neck", "head"};
  Names body = trunk;
  for (const char* limb : {"bein_l", "knie_l", "fuss_l", "bein_r", "knie_r", "fuss_r"}) {
    body.push_back(limb);
  }
  EXPECT_TRUE(maps.RolesOf(body).map.empty());
  EXPECT_FALSE(maps.RolesOf(trunk).map.empty()) << "nothing is left unexplained";
  EXPECT_FALSE(maps.RolesOfRig(body).map.empty()) << "a rig names the joints that it needs";
}

TEST(SkeletonMaps, RecognisesMixamoWithAnyPrefix) {
  const SkeletonMaps maps = Shipped();
  for (const char* prefix : {"mixamorig:", "mixamorig12:", "mixamorig", "mixamorig_", "mixamorig1_",
                             "mixamorig7", "mixamorig12", "mixamorig12_", ""}) {
    Names names;
    for (const char* name : {"Hips", "Spine", "Spine1", "Spine2", "Neck", "Head", "LeftShoulder",
                             "LeftArm", "LeftForeArm", "LeftHand", "LeftHandThumb1"}) {
      names.push_back(prefix + std::string(name));
    }
    const SkeletonRoles found = maps.RolesOf(names);
    EXPECT_EQ(found.map, "mixamo") << prefix;
    EXPECT_THAT(found.roles, testing::ElementsAre(kHips, kSpine, kChest, kUpperChest, kNeck, kHead,
                                                  kLeftShoulder, kLeftUpperArm, kLeftLowerArm,
                                                  kLeftHand, kLeftThumbMetacarpal))
        << prefix;
  }
}

TEST(SkeletonMaps, CountersBehindAllNamesDoNotMatter) {
  const SkeletonMaps maps = Shipped();
  for (const char* counter : {"_0", "_012", ".001"}) {
    Names names;
    for (const char* name : {"Hips", "Spine", "Spine1", "Spine2", "Neck", "Head", "LeftShoulder",
                             "LeftArm", "LeftForeArm", "LeftHand", "LeftHandThumb1"}) {
      names.push_back("mixamorig:" + std::string(name) + counter);
    }
    const SkeletonRoles found = maps.RolesOf(names);
    EXPECT_EQ(found.map, "mixamo") << counter;
    EXPECT_EQ(found.num_joints, 11) << counter;
    names.back() = "tail";  // one name without a counter: they may be a part of the names
    EXPECT_EQ(maps.RolesOf(names).num_joints, 0) << counter;
  }
}

// Of a published file.
TEST(SkeletonMaps, CountersOfSketchfabDoNotMatter) {
  Names names = {"Sketchfab_model", "RootNode", "Object_2", "_rootJoint", "Bip001_Pelvis_05"};
  for (const char* joint : {"L_Thigh", "R_Thigh", "L_Calf", "R_Calf", "L_UpperArm", "R_UpperArm"}) {
    names.push_back("Bip001_" + std::string(joint) + "_0" + std::to_string(names.size()));
  }
  const SkeletonRoles found = Shipped().RolesOf(names);
  EXPECT_EQ(found.map, "cal3d");
  EXPECT_EQ(found.num_joints, 7);
}

TEST(SkeletonMaps, KnowsEyesOfAnyFamily) {
  const SkeletonMaps maps = Shipped();
  for (const char* name : {"LeftEye", "mixamorig:RightEye", "eye.L", "eye_r"}) {
    EXPECT_TRUE(maps.KnowEye(name)) << name;
  }
  for (const char* name : {"Head", "Eyebrow.L", "Eyes", "sword", ""}) {
    EXPECT_FALSE(maps.KnowEye(name)) << name;
  }
}

TEST(SkeletonMaps, LoadsByNameByFileOrAll) {
  setenv("FURROW_DATA_DIR", (std::string(FURROW_SOURCE_DIR) + "/rig").c_str(), 1);
  EXPECT_GE(SkeletonMaps::Load("").value().maps().size(), 11u);
  EXPECT_EQ(SkeletonMaps::Load("cmu").value().maps()[0].name, "cmu");
  const std::string file = std::string(FURROW_SOURCE_DIR) + "/rig/skeleton_maps/vrm.json";
  EXPECT_EQ(SkeletonMaps::Load(file).value().maps()[0].name, "vrm");
  // A folder with the name of a map does not hide the map.
  const fs::path before = fs::current_path();
  const TemporaryFolder folder;
  fs::create_directory(folder / "cmu");
  fs::current_path(folder.path());
  EXPECT_EQ(SkeletonMaps::Load("cmu").value().maps()[0].name, "cmu");
  fs::current_path(before);
  EXPECT_EQ(SkeletonMaps::Load("nobody").status().code(), StatusCode::kNotFound);
  EXPECT_EQ(SkeletonMaps::Load("no/such/file.json").status().code(), StatusCode::kNotFound);
  unsetenv("FURROW_DATA_DIR");
}

}  // namespace
}  // namespace furrow::rig
