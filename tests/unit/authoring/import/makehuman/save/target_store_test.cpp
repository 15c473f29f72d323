// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/save/target_store.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "authoring/import/makehuman/save/person.h"
#include "tests/temporary_folder.h"

namespace furrow::authoring {
namespace {

namespace fs = std::filesystem;

// A data folder with targets.npz: nose/nose-hump-incr moves vertices 0 and 3, head/head-oval none.
class PackedFolder {
 public:
  PackedFolder() {
    fs::copy_file(FURROW_SOURCE_DIR "/tests/fuzz/seeds/npz/targets.npz", path() / "targets.npz");
  }
  void Write(const std::string& target, const std::string& text) const {
    const fs::path file = path() / "targets" / (target + ".target");
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
  [[nodiscard]] const fs::path& path() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

TEST(TargetStore, ReadsPackedTargets) {
  const PackedFolder folder;
  const Result<TargetStore> store = TargetStore::Open(folder.path());
  ASSERT_TRUE(store.ok()) << store.status().ToString();
  ASSERT_EQ(store->library().InGroup("nose-nose-hump-incr").size(), 1u);
  ASSERT_EQ(store->library().InGroup("head-head-oval").size(), 1u);
  EXPECT_TRUE(store->library().InGroup("targets").empty());  // the licence
  const auto target = store->Read("nose/nose-hump-incr.target", 4);
  ASSERT_TRUE(target.ok()) << target.status().ToString();
  EXPECT_EQ(target->offsets[0], 1e-3f * glm::vec3(1000.0f, -250.0f, 0.0f));
  const Status status = store->Read("nose/nose-hump-incr.target", 3).status();
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(status.where().find("targets.npz: targets/nose/nose-hump-incr"), std::string::npos);
}

TEST(TargetStore, PackedTargetsShapeAPerson) {
  const PackedFolder folder;
  MhmSave save;
  save.modifiers = {{"nose/nose-hump-decr|incr", 0.5f}, {"head/head-oval", 1.0f}};
  std::vector<glm::vec3> positions(4, glm::vec3(0.0f));
  const Result<PersonShape> shape = ShapePerson(folder.path(), save, positions);
  ASSERT_TRUE(shape.ok()) << shape.status().ToString();
  EXPECT_EQ(shape->targets, 1);
  EXPECT_EQ(shape->modifiers, 2);
  EXPECT_EQ(positions[0], glm::vec3(0.5f, -0.125f, 0.0f));
}

TEST(TargetStore, FilesTakePrecedenceOverTheArchive) {
  const PackedFolder folder;
  folder.Write("nose/nose-hump-incr", "1 0 0 2\n");
  folder.Write("chin/chin-width-incr", "2 1 0 0\n");
  const Result<TargetStore> store = TargetStore::Open(folder.path());
  ASSERT_TRUE(store.ok()) << store.status().ToString();
  ASSERT_EQ(store->library().InGroup("nose-nose-hump-incr").size(), 1u);
  EXPECT_EQ(store->library().InGroup("chin-chin-width-incr").size(), 1u);
  EXPECT_EQ(store->library().InGroup("head-head-oval").size(), 1u);
  const auto target = store->Read("nose/nose-hump-incr.target", 4);
  ASSERT_TRUE(target.ok()) << target.status().ToString();
  EXPECT_EQ(target->vertices, (std::vector<std::uint32_t>{1}));
}

TEST(TargetStore, NamesWhatIsWrongWithAFolder) {
  const TemporaryFolder folder;
  const Status empty = TargetStore::Open(folder.path()).status();
  EXPECT_EQ(empty.code(), StatusCode::kNotFound);
  EXPECT_NE(empty.todo().find("targets.npz"), std::string::npos);
  const auto with = [&](const std::string& bytes) {
    std::ofstream(folder / "targets.npz") << bytes;
    return TargetStore::Open(folder.path()).status();
  };
  EXPECT_EQ(with("PK").code(), StatusCode::kParse);
  EXPECT_NE(with("PK").where().find("targets.npz"), std::string::npos);
  EXPECT_NE(with("version https://git-lfs.github.com/spec/v1\n").todo().find("git lfs pull"),
            std::string::npos);
}

}  // namespace
}  // namespace furrow::authoring
