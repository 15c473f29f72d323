// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/save/target_library.h"

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "authoring/import/makehuman/save/person.h"
#include "authoring/import/makehuman/save/target_store.h"
#include "tests/temporary_folder.h"

namespace furrow::authoring {
namespace {

namespace fs = std::filesystem;

class Targets {
 public:
  explicit Targets(const std::vector<std::string>& names) {
    for (const std::string& name : names) Write(name, "0 1 0 0\n");
  }

  void Write(const std::string& name, const std::string& text) const {
    const fs::path file = folder_ / "targets" / (name + ".target");
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }

  // The chosen weights by file name.
  std::map<std::string, float> Choose(const MhmSave& save,
                                      std::vector<std::string>* warnings = nullptr) const {
    const Result<TargetStore> store = TargetStore::Open(folder_.path());
    EXPECT_TRUE(store.ok()) << store.status().ToString();
    const TargetChoice choice = ChooseTargets(save, store->library());
    if (warnings != nullptr) *warnings = choice.warnings;
    std::map<std::string, float> weights;
    for (const ChosenTarget& chosen : choice.targets)
      weights[chosen.path.stem().string()] += chosen.weight;
    return weights;
  }

  [[nodiscard]] const fs::path& path() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

std::vector<std::string> AllRaces() {
  std::vector<std::string> names;
  for (const char* race : {"caucasian", "asian", "african"}) {
    for (const char* gender : {"male", "female"}) {
      for (const char* age : {"baby", "child", "young", "old"})
        names.push_back(std::string("macrodetails/") + race + "-" + gender + "-" + age);
    }
  }
  return names;
}

TEST(ChooseTargets, WeightIsTheProductOfTheShares) {
  const Targets targets(AllRaces());
  MhmSave save;
  save.modifiers = {{"macrodetails/Gender", 0.25f},
                    {"macrodetails/Age", 0.75f},
                    {"macrodetails/Caucasian", 1.0f},
                    {"macrodetails/Asian", 0.0f},
                    {"macrodetails/African", 0.0f}};
  std::vector<std::string> warnings;
  const auto weights = targets.Choose(save, &warnings);
  EXPECT_TRUE(warnings.empty());
  ASSERT_EQ(weights.size(), 4u);
  EXPECT_FLOAT_EQ(weights.at("caucasian-male-young"), 0.125f);
  EXPECT_FLOAT_EQ(weights.at("caucasian-male-old"), 0.125f);
  EXPECT_FLOAT_EQ(weights.at("caucasian-female-young"), 0.375f);
  EXPECT_FLOAT_EQ(weights.at("caucasian-female-old"), 0.375f);
}

// Folders of the group are part of the name; the macro words may be in any order.
TEST(ChooseTargets, GroupsFollowFromThePath) {
  const Targets targets({"macrodetails/universal-male-young-maxmuscle-averageweight",
                         "macrodetails/universal-male-young-averagemuscle-maxweight",
                         "macrodetails/height/male-young-averagemuscle-maxweight-maxheight",
                         "breast/female-young-averagemuscle-maxweight-maxcup-averagefirmness"});
  MhmSave save;
  save.modifiers = {{"macrodetails/Gender", 1.0f},
                    {"macrodetails-universal/Weight", 0.9f},
                    {"macrodetails-height/Height", 1.0f},
                    {"breast/BreastSize", 1.0f}};
  const auto weights = targets.Choose(save);
  ASSERT_EQ(weights.size(), 2u);
  EXPECT_FLOAT_EQ(weights.at("universal-male-young-averagemuscle-maxweight"), 0.8f);
  EXPECT_FLOAT_EQ(weights.at("male-young-averagemuscle-maxweight-maxheight"), 0.8f);
}

TEST(ChooseTargets, TheSignSelectsTheSideOfAModifier) {
  const Targets targets({"nose/nose-hump-decr", "nose/nose-hump-incr", "head/head-oval",
                         "armslegs/l-hand-scale-decr", "armslegs/r-hand-scale-decr"});
  MhmSave save;
  save.modifiers = {{"nose/nose-hump-decr|incr", -0.5f},
                    {"head/head-oval", 0.3f},
                    {"armslegs/l-hand-scale-decr|incr", -1.0f},
                    {"armslegs/r-hand-scale-decr|incr", 0.0f}};
  auto weights = targets.Choose(save);
  ASSERT_EQ(weights.size(), 3u);
  EXPECT_FLOAT_EQ(weights.at("nose-hump-decr"), 0.5f);
  EXPECT_FLOAT_EQ(weights.at("head-oval"), 0.3f);
  EXPECT_FLOAT_EQ(weights.at("l-hand-scale-decr"), 1.0f);
  save.modifiers = {{"nose/nose-hump-decr|incr", 0.5f}};
  weights = targets.Choose(save);
  ASSERT_EQ(weights.size(), 1u);
  EXPECT_FLOAT_EQ(weights.at("nose-hump-incr"), 0.5f);
}

TEST(ChooseTargets, OneSidedModifiersBeginAtZero) {
  const Targets targets({"head/head-oval"});
  MhmSave save;
  save.modifiers = {{"head/head-oval", -0.5f}};
  std::vector<std::string> warnings;
  EXPECT_TRUE(targets.Choose(save, &warnings).empty());
  EXPECT_TRUE(warnings.empty());
}

// A detail may depend on macros, too.
TEST(ChooseTargets, MacroWordsScaleDetails) {
  const Targets targets({"stomach/female-young-stomach-tone-incr"});
  MhmSave save;
  save.modifiers = {{"stomach/stomach-tone-decr|incr", 0.5f}, {"macrodetails/Gender", 0.25f}};
  EXPECT_FLOAT_EQ(targets.Choose(save).at("female-young-stomach-tone-incr"), 0.375f);
}

TEST(ChooseTargets, MissingSharesGoToThosePresent) {
  const Targets targets({"macrodetails/caucasian-female-young", "macrodetails/caucasian-male-young",
                         "macrodetails/caucasian-female-old", "macrodetails/caucasian-male-old"});
  MhmSave save;
  save.modifiers = {{"macrodetails/Gender", 0.0f}, {"macrodetails/Age", 0.1875f}};
  std::vector<std::string> warnings;
  const auto weights = targets.Choose(save, &warnings);
  ASSERT_EQ(weights.size(), 1u);
  EXPECT_FLOAT_EQ(weights.at("caucasian-female-young"), 1.0f);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0],
            "the data folder has no targets for asian, african; 67 % of the person become "
            "caucasian");
  EXPECT_NE(warnings[1].find("child; 100 %"), std::string::npos) << warnings[1];
}

TEST(ChooseTargets, NamesWhatTheFolderLacks) {
  const Targets targets(AllRaces());
  MhmSave save;
  save.modifiers = {{"macrodetails-universal/Weight", 1.0f},
                    {"nose/nose-hump-decr|incr", 0.5f},
                    {"a/b-c|d", 0.5f},
                    {"x|y", 1.0f}};
  std::vector<std::string> warnings;
  EXPECT_FALSE(targets.Choose(save, &warnings).empty());
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].find("maxweight"), std::string::npos);
  EXPECT_EQ(warnings[1].rfind("3 modifiers without a target", 0), 0u) << warnings[1];
  EXPECT_NE(warnings[1].find("nose/nose-hump-decr|incr"), std::string::npos);
}

TEST(ShapePerson, AddsTheTargets) {
  const Targets targets({"macrodetails/caucasian-female-young"});
  targets.Write("head/head-oval", "1 0 2 0\n");
  MhmSave save;
  save.modifiers = {{"macrodetails/Gender", 0.0f}, {"head/head-oval", 0.25f}};
  std::vector<glm::vec3> positions(2, glm::vec3(0.0f));
  const Result<PersonShape> shape = ShapePerson(targets.path(), save, positions);
  ASSERT_TRUE(shape.ok()) << shape.status().ToString();
  EXPECT_EQ(shape->targets, 2);
  EXPECT_EQ(shape->modifiers, 1);
  EXPECT_EQ(positions[0], glm::vec3(1.0f, 0.0f, 0.0f));
  EXPECT_EQ(positions[1], glm::vec3(0.0f, 0.5f, 0.0f));
}

TEST(ShapePerson, RejectsBadFolders) {
  const Targets empty({});
  std::vector<glm::vec3> positions(1, glm::vec3(0.0f));
  MhmSave save;
  EXPECT_EQ(ShapePerson(empty.path(), save, positions).status().code(), StatusCode::kNotFound);
  const Targets damaged({});
  damaged.Write("macrodetails/caucasian-female-young", "0 0 0\n");
  const Status status = ShapePerson(damaged.path(), save, positions).status();
  EXPECT_EQ(status.code(), StatusCode::kParse);
  EXPECT_NE(status.where().find("caucasian-female-young.target:1"), std::string::npos);
  const Targets far({});
  far.Write("head/head-oval", "0 999 0 0\n");
  far.Write("head/head-round", "0 999 0 0\n");
  save.modifiers = {{"head/head-oval", 1.0f}, {"head/head-round", 1.0f}};
  EXPECT_EQ(ShapePerson(far.path(), save, positions).status().code(), StatusCode::kLimit);
}

}  // namespace
}  // namespace furrow::authoring
