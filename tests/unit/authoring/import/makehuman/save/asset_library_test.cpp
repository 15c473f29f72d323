// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/save/asset_library.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "authoring/import/makehuman/save/data_folders.h"
#include "character/pictures/picture_file.h"
#include "tests/temporary_folder.h"

namespace furrow::authoring {
namespace {

namespace fs = std::filesystem;

void WriteAsset(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

constexpr const char* kUuid = "79ced554-1d8a-4c14-a6a8-e1de90b09c32";

TEST(AssetLibrary, FindsPartsByUuidThenByName) {
  const TemporaryFolder program, user;
  WriteAsset(program / "clothes/a/a.mhclo",
             std::string("uuid ") + kUuid + "\nname Red shirt\nverts 0\n");
  WriteAsset(program / "clothes/b/b.mhclo", "uuid 0\nname Blue\nverts 0\nname Wrong\n");
  WriteAsset(user / "clothes/deep/er/c.mhclo", "uuid 1\nname Blue\nverts 0\n");
  WriteAsset(user / "hair/h/h.mhclo", "name Blue\n");
  AssetLibrary library({program.path(), user.path()});
  const auto find = [&](const char* kind, const char* name, const char* uuid) {
    const auto file = library.FindPart({kind, name, uuid});
    return file ? file->filename().string() : std::string();
  };
  EXPECT_EQ(find("clothes", "renamed", "79CED554-1d8a-4c14-a6a8-e1de90b09c32"), "a.mhclo");
  EXPECT_EQ(find("clothes", "red SHIRT", "other"), "a.mhclo");
  EXPECT_EQ(find("clothes", "Blue", ""), "b.mhclo");  // the first folder wins
  EXPECT_EQ(find("clothes", "c", ""), "c.mhclo");     // by file name
  EXPECT_EQ(find("hair", "blue", "0"), "h.mhclo");    // of its kind only
  EXPECT_EQ(find("clothes", "Wrong", ""), "");        // names end where vertices begin
  EXPECT_EQ(find("eyes", "Blue", "0"), "");
}

TEST(AssetLibrary, LoadsMaterialsAndTheirPictures) {
  const TemporaryFolder program, user;
  character::Picture white;
  white.width = white.height = 2;
  white.channels = 3;
  white.pixels.assign(12, 255);
  const Result<std::string> png = character::EncodePng(white);
  ASSERT_TRUE(png.ok());
  WriteAsset(program / "eyes/materials/brown.mhmat", "name brown\ndiffuseTexture brown.png\n");
  WriteAsset(program / "eyes/materials/brown.png", *png);
  WriteAsset(user / "skins/me/me.mhmat", "name me\ndiffuseTexture lfs.png\n");
  WriteAsset(user / "skins/me/lfs.png",
             "version https://git-lfs.github.com/spec/v1\noid sha256:0\n");
  const AssetLibrary library({program.path(), user.path()});

  const auto brown = library.LoadMaterial("../materials/brown.mhmat", program / "eyes/high-poly");
  ASSERT_TRUE(brown.ok()) << brown.status().ToString();
  EXPECT_TRUE(library.LoadMaterial("eyes/materials/brown.mhmat", user / "eyes/x").ok());
  EXPECT_TRUE(library.LoadMaterial("data/eyes/materials/brown.mhmat", {}).ok());
  const auto picture = library.LoadMaterialPicture(*brown, "brown.png", "eye");
  ASSERT_TRUE(picture.ok()) << picture.status().ToString();
  EXPECT_EQ(picture->name, "eye");
  EXPECT_EQ(picture->width, 2);

  const auto skin = library.LoadMaterial("skins/me/me.mhmat", {});
  ASSERT_TRUE(skin.ok());
  const Status pointer = library.LoadMaterialPicture(*skin, "lfs.png", "skin").status();
  EXPECT_EQ(pointer.code(), StatusCode::kUnsupported);
  EXPECT_NE(pointer.ToString().find("Git LFS pointer"), std::string::npos);
  EXPECT_EQ(library.LoadMaterialPicture(*skin, "absent.png", "skin").status().code(),
            StatusCode::kNotFound);
}

// A downloaded asset must not read other files of its user.
TEST(AssetLibrary, PathsStayInTheDataFolders) {
  const TemporaryFolder folder;
  WriteAsset(folder / "secret.mhmat", "name secret\n");
  WriteAsset(folder / "data/hair/h/h.mhclo", "name h\n");
  const AssetLibrary library({folder / "data"});
  for (const std::string& path :
       {std::string("../../../secret.mhmat"), (folder / "secret.mhmat").string(), std::string()}) {
    EXPECT_EQ(library.LoadMaterial(path, folder / "data/hair/h").status().code(),
              StatusCode::kInvalidArgument)
        << path;
  }
  EXPECT_EQ(library.LoadMaterial("../none.mhmat", folder / "data/hair/h").status().code(),
            StatusCode::kNotFound);
}

TEST(FindDataFolders, SearchesNearTheSave) {
  const TemporaryFolder folder;
  WriteAsset(folder / "program/3dobjs/base.obj", "");
  WriteAsset(folder / "user/models/me.mhm", "");
  WriteAsset(folder / "user/data/clothes/a", "");
  const fs::path save = folder / "user/models/me.mhm";
  EXPECT_EQ(FindDataFolders(save, {}).status().code(), StatusCode::kNotFound);

  const fs::path given[] = {folder / "user/data/clothes", folder / "program"};
  Result<DataFolders> found = FindDataFolders(save, given);
  ASSERT_TRUE(found.ok()) << found.status().ToString();
  EXPECT_EQ(found->base, folder / "program");
  ASSERT_EQ(found->assets.size(), 2u);
  EXPECT_EQ(found->assets[0], given[0]);
  EXPECT_EQ(found->assets[1], folder / "user/data");

  WriteAsset(folder / "user/data/3dobjs/base.obj", "");
  found = FindDataFolders(save, {});
  ASSERT_TRUE(found.ok()) << found.status().ToString();
  EXPECT_TRUE(fs::equivalent(found->base, folder / "user/data"));
  EXPECT_TRUE(found->assets.empty());

  const fs::path absent[] = {folder / "absent"};
  EXPECT_EQ(FindDataFolders(save, absent).status().where(), absent[0].string());
}

}  // namespace
}  // namespace furrow::authoring
