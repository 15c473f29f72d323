// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/saved_parts.h"

#include <algorithm>
#include <array>
#include <string>

#include <gtest/gtest.h>

#include "authoring/import/makehuman/face/skin_paint.h"
#include "authoring/import/makehuman/makehuman.h"
#include "authoring/import/makehuman/picture_fit.h"
#include "character/pictures/picture_file.h"
#include "toy_folder.h"

namespace furrow::authoring {
namespace {

std::string Png(int size, int channels, std::vector<std::uint8_t> texel) {
  character::Picture picture;
  picture.width = picture.height = size;
  picture.channels = channels;
  for (int i = 0; i < size * size; ++i)
    picture.pixels.insert(picture.pixels.end(), texel.begin(), texel.end());
  const Result<std::string> png = character::EncodePng(picture);
  EXPECT_TRUE(png.ok());
  return png.ok() ? *png : std::string();
}

// A folder with one target, hair and two garments.
class SaveFolder : public ToyFolder {
 public:
  SaveFolder() {
    Write("targets/macrodetails/caucasian-female-young.target", "0 0 1 0\n1 0 1 0\n");
    Write("hair/bob/bob.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    Write("hair/bob/bob.mhclo",
          "name bob\nuuid b0b\nobj_file bob.obj\nmaterial bob.mhmat\nverts 0\n0\n8\n16\n");
    Write("hair/bob/bob.mhmat", "name bob\ntransparent True\ndiffuseTexture bob.png\n");
    Write("hair/bob/bob.png", Png(8, 4, {200, 100, 50, 255}));
    Write("save.mhm",
          "version v1.2.0\nname Ada\nmodifier macrodetails/Gender 0\nhair bob b0b\n"
          "clothes cap c\nclothesHideFaces True\n");
  }

  ImportOptions Options() const {
    ImportOptions options;
    options.rig = rig();
    options.texture_size = 128;
    options.save = path() / "save.mhm";
    return options;
  }

  Result<character::Character> Import(ImportReport* report = nullptr) const {
    return ImportMakeHuman(path(), Options(), report);
  }
};

const character::Mesh* FindMesh(const character::Character& character, const std::string& name) {
  const auto found = std::find_if(character.meshes.begin(), character.meshes.end(),
                                  [&](const character::Mesh& mesh) { return mesh.name == name; });
  return found == character.meshes.end() ? nullptr : &*found;
}

bool Mentions(const std::vector<std::string>& texts, const std::string& text) {
  return std::any_of(texts.begin(), texts.end(),
                     [&](const std::string& t) { return t.find(text) != std::string::npos; });
}

TEST(ImportSave, MakesThePersonOfTheSave) {
  const SaveFolder folder;
  ImportReport report;
  const Result<character::Character> ada = folder.Import(&report);
  ASSERT_TRUE(ada.ok()) << ada.status().ToString();
  EXPECT_EQ(ada->name, "Ada");
  EXPECT_TRUE(Mentions(report.notes, "shape: 1 target,"));
  const character::Mesh* hair = FindMesh(*ada, "bob");
  ASSERT_NE(hair, nullptr);
  EXPECT_EQ(FindMesh(*ada, "hair"), nullptr);  // Furrow's own
  const character::Material& look = ada->materials[static_cast<std::size_t>(hair->material)];
  EXPECT_EQ(look.kind, character::Material::Kind::kHair);
  EXPECT_GT(look.alpha_cutoff, 0.0f);
  EXPECT_EQ(ada->pictures[static_cast<std::size_t>(look.base_colour_texture)].channels, 4);
  // The hair is fitted to vertex 0, which the target raised by 1 dm.
  float top = 0.0f, head = 0.0f;
  for (const character::Vertex& v : hair->vertices) top = std::max(top, v.position.y);
  for (const character::Vertex& v : ada->meshes[0].vertices) head = std::max(head, v.position.y);
  ImportOptions plain = folder.Options();
  plain.save.clear();
  const Result<character::Character> base = ImportMakeHuman(folder.path(), plain);
  ASSERT_TRUE(base.ok());
  EXPECT_EQ(base->name, "makehuman");
  float before = 0.0f;
  for (const character::Vertex& v : base->meshes[0].vertices)
    before = std::max(before, v.position.y);
  EXPECT_GT(top, before + 0.09f);
  EXPECT_GT(top, head - 0.02f);
}

TEST(ImportSave, GoesOnWithoutPictures) {
  const SaveFolder folder;
  folder.Write("hair/bob/bob.png", "version https://git-lfs.github.com/spec/v1\noid sha256:0\n");
  ImportReport report;
  const Result<character::Character> ada = folder.Import(&report);
  ASSERT_TRUE(ada.ok()) << ada.status().ToString();
  const character::Mesh* hair = FindMesh(*ada, "bob");
  ASSERT_NE(hair, nullptr);  // with painted strands
  const character::Material& look = ada->materials[static_cast<std::size_t>(hair->material)];
  EXPECT_GT(look.alpha_cutoff, 0.0f);
  EXPECT_EQ(ada->pictures[static_cast<std::size_t>(look.base_colour_texture)].channels, 4);
  EXPECT_TRUE(Mentions(report.warnings, "the picture of hair 'bob' is painted"));
  EXPECT_TRUE(Mentions(report.warnings, "git lfs pull"));
  EXPECT_TRUE(Mentions(report.warnings, "the picture of clothes 'cap' is painted"));
}

TEST(ImportSave, RepeatedPartsCountOnce) {
  const SaveFolder folder;
  folder.Write("hair/long/bob.obj", folder.Read("hair/bob/bob.obj"));
  folder.Write("hair/long/bob.png", folder.Read("hair/bob/bob.png"));
  folder.Write("hair/long/bob.mhmat", folder.Read("hair/bob/bob.mhmat"));
  folder.Write("hair/long/long.mhclo",
               "name long\nobj_file bob.obj\nmaterial bob.mhmat\nverts 0\n0\n8\n16\n");
  folder.Write("save.mhm", folder.Read("save.mhm") + "hair long x\nclothes cap c\n");
  const Result<character::Character> ada = folder.Import();
  ASSERT_TRUE(ada.ok()) << ada.status().ToString();
  EXPECT_EQ(FindMesh(*ada, "bob"), nullptr);
  EXPECT_NE(FindMesh(*ada, "long"), nullptr);
  EXPECT_EQ(std::count_if(ada->meshes.begin(), ada->meshes.end(),
                          [](const character::Mesh& mesh) { return mesh.name == "cap"; }),
            1);
}

TEST(ImportSave, OwnPartsReplaceThoseThatTheFolderLacks) {
  const SaveFolder folder;
  folder.Remove("hair/bob/bob.obj");
  folder.Write("save.mhm", folder.Read("save.mhm") + "eyes round none\n");
  ImportReport report;
  const Result<character::Character> ada = folder.Import(&report);
  ASSERT_TRUE(ada.ok()) << ada.status().ToString();
  EXPECT_EQ(FindMesh(*ada, "bob"), nullptr);
  EXPECT_NE(FindMesh(*ada, "hair"), nullptr);
  EXPECT_NE(FindMesh(*ada, "helper-l-eye"), nullptr);
  EXPECT_TRUE(Mentions(report.warnings, "hair 'bob' is not readable"));
  EXPECT_TRUE(Mentions(report.warnings, "eyes 'round' is not in the data folder"));
}

TEST(ImportSave, PartsThatTheSaveLacksAreNotMade) {
  const SaveFolder folder;
  folder.Write("save.mhm", "version v1.2.0\nmodifier macrodetails/Gender 0\n");
  ImportReport report;
  const Result<character::Character> bald = folder.Import(&report);
  ASSERT_TRUE(bald.ok()) << bald.status().ToString();
  EXPECT_EQ(bald->name, "save");
  EXPECT_EQ(FindMesh(*bald, "hair"), nullptr);
  EXPECT_EQ(FindMesh(*bald, "cap"), nullptr);
  EXPECT_NE(FindMesh(*bald, "helper-l-eye"), nullptr);
  EXPECT_EQ(report.hidden_faces, 0);
}

// The mean colour of the painted skin, and of the hair, for a save with these lines.
std::array<glm::vec3, 2> PaintedColours(const SaveFolder& folder, const std::string& lines) {
  folder.Write("save.mhm", "version v1.2.0\nhair none x\n" + lines);
  const Result<character::Character> person = folder.Import();
  EXPECT_TRUE(person.ok()) << person.status().ToString();
  std::array<glm::vec3, 2> means{glm::vec3(0.0f), glm::vec3(0.0f)};
  if (!person.ok()) return means;
  for (const character::Picture& picture : person->pictures) {
    if (picture.name != "skin_colour" && picture.name != "hair_colour") continue;
    glm::vec3& mean = means[picture.name == "skin_colour" ? 0 : 1];
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
      mean[static_cast<int>(i % 3)] += static_cast<float>(picture.pixels[i]);
    mean /= static_cast<float>(picture.pixels.size() / 3);
  }
  return means;
}

TEST(ImportSave, PaintedSkinAndHairFollowRaceAndAge) {
  const SaveFolder folder;
  const std::string race = "modifier macrodetails/African 0\nmodifier macrodetails/Asian 0\n";
  const auto young = PaintedColours(folder, race);
  const auto old = PaintedColours(folder, race + "modifier macrodetails/Age 1\n");
  const auto african =
      PaintedColours(folder, "modifier macrodetails/Caucasian 0\nmodifier macrodetails/Asian 0\n");
  EXPECT_LT(african[0].r, 0.7f * young[0].r);
  EXPECT_LT(african[1].r, 0.6f * young[1].r);
  EXPECT_GT(old[1].b, 2.0f * young[1].b);
  EXPECT_LT(old[1].r - old[1].b, 0.2f * old[1].r);  // grey
}

TEST(AddRestFolds, AddsSlopes) {
  character::Picture flat, folds;
  flat.width = flat.height = folds.width = folds.height = 1;
  flat.channels = folds.channels = 3;
  flat.pixels = {128, 128, 255};
  folds.pixels = {217, 128, 217};  // slope 1 along x
  AddRestFolds(folds, 0.5f, &flat);
  EXPECT_NEAR(flat.pixels[0] / 127.5f - 1.0f, 0.447f, 0.02f);
  EXPECT_NEAR(flat.pixels[2] / 127.5f - 1.0f, 0.894f, 0.02f);
  folds.pixels = {128, 128, 255};
  const auto before = flat.pixels;
  AddRestFolds(folds, 0.5f, &flat);
  EXPECT_EQ(flat.pixels, before);
}

TEST(ImportSave, ClothesHideWhatIsUnderThem) {
  const SaveFolder folder;
  // An undershirt below the cap, on vertices that the cap hides, and a scarf on others.
  folder.Write("clothes/under/under.obj", folder.Read("clothes/cap/cap.obj"));
  folder.Write("clothes/under/under.mhclo",
               "name under\nz_depth 10\nobj_file under.obj\nverts 0\n0\n1\n2\n");
  folder.Write("clothes/scarf/scarf.obj", folder.Read("clothes/cap/cap.obj"));
  folder.Write("clothes/scarf/scarf.mhclo",
               "name scarf\nz_depth 10\nobj_file scarf.obj\nverts 0\n100\n101\n102\n");
  const std::string save = folder.Read("save.mhm");
  folder.Write("save.mhm", save + "clothes under u\nclothes scarf s\n");
  ImportReport report;
  Result<character::Character> ada = folder.Import(&report);
  ASSERT_TRUE(ada.ok()) << ada.status().ToString();
  EXPECT_EQ(FindMesh(*ada, "under"), nullptr);
  EXPECT_NE(FindMesh(*ada, "scarf"), nullptr);
  EXPECT_NE(FindMesh(*ada, "cap"), nullptr);
  EXPECT_EQ(report.hidden_faces, 2 * 24);
  // One garment has the folds of cloth.
  int wrinkled = 0;
  for (const character::Material& material : ada->materials)
    wrinkled += material.kind == character::Material::Kind::kCloth && material.wrinkles ? 1 : 0;
  EXPECT_EQ(wrinkled, 1);

  folder.Write("save.mhm", save + "clothes under u\nclothesHideFaces False\n");
  ada = folder.Import(&report);
  ASSERT_TRUE(ada.ok());
  EXPECT_NE(FindMesh(*ada, "under"), nullptr);
  EXPECT_EQ(report.hidden_faces, 0);
}

TEST(ImportSave, UsesThePictureOfTheSkin) {
  const SaveFolder folder;
  folder.Write("skins/red/red.mhmat", "name red\ndiffuseTexture red.png\n");
  folder.Write("skins/red/red.png", Png(16, 3, {250, 10, 20}));
  folder.Write("save.mhm", folder.Read("save.mhm") + "skinMaterial skins/red/red.mhmat\n");
  ImportReport report;
  const Result<character::Character> ada = folder.Import(&report);
  ASSERT_TRUE(ada.ok()) << ada.status().ToString();
  const character::Material& skin =
      ada->materials[static_cast<std::size_t>(ada->meshes[0].material)];
  const character::Picture& picture =
      ada->pictures[static_cast<std::size_t>(skin.base_colour_texture)];
  for (const SurfaceTexel& texel :
       RasterizeSurface(ada->meshes[0], picture.width, picture.height)) {
    const std::uint8_t* p =
        &picture.pixels[static_cast<std::size_t>(texel.y * picture.width + texel.x) * 3];
    ASSERT_EQ(p[0], 250);
    ASSERT_EQ(p[1], 10);
  }
  EXPECT_TRUE(Mentions(report.notes, "skins/red/red.mhmat"));
}

// Texels come from the place that the UV had before BuildSkin() moved the islands.
TEST(MoveSkinPicture, FollowsTheMoves) {
  character::Picture ramp;
  ramp.width = ramp.height = 256;
  ramp.channels = 3;
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      ramp.pixels.push_back(static_cast<std::uint8_t>(x));
      ramp.pixels.push_back(static_cast<std::uint8_t>(y));
      ramp.pixels.push_back(0);
    }
  }
  const UvMove moves[] = {{{0.5f, 0.25f}, {1.0f, 0.75f}, {0.0f, 0.0f}, {0.5f, 1.0f}},
                          {{0.0f, 0.0f}, {0.25f, 1.0f}, {0.75f, 0.0f}, {1.0f, 1.0f}}};
  std::vector<SurfaceTexel> texels(2);
  texels[0].x = 16;  // u 0.2578, v up 0.7422
  texels[0].y = 16;
  texels[1].x = 56;  // u 0.8828
  texels[1].y = 16;
  const character::Picture moved = MoveSkinPicture(ramp, texels, moves, 64);
  const auto at = [&](int x, int y, int c) {
    return static_cast<int>(
        moved.pixels[static_cast<std::size_t>(y * 64 + x) * 3 + static_cast<std::size_t>(c)]);
  };
  EXPECT_NEAR(at(16, 16, 0), 256.0f * (0.5f + 0.2578f), 2.0f);
  EXPECT_NEAR(at(16, 16, 1), 256.0f * (1.0f - (0.25f + 0.5f * 0.7422f)), 2.0f);
  EXPECT_NEAR(at(56, 16, 0), 256.0f * 0.1328f, 2.0f);
  EXPECT_NEAR(at(56, 16, 1), 256.0f * (1.0f - 0.7422f), 2.0f);
}

TEST(FitPicture, HalvesAndKeepsEdgesClean) {
  character::Picture picture;
  picture.width = 4;
  picture.height = 2;
  picture.channels = 4;
  // Green behind transparent texels must not bleed into the red ones.
  for (int i = 0; i < 8; ++i) {
    const bool clear = i % 2 == 1;
    for (const int v : {clear ? 0 : 200, clear ? 255 : 0, 0, clear ? 0 : 255})
      picture.pixels.push_back(static_cast<std::uint8_t>(v));
  }
  const character::Picture half = FitPicture(picture, 2);
  EXPECT_EQ(half.width, 2);
  EXPECT_EQ(half.height, 1);
  EXPECT_EQ(half.pixels, (std::vector<std::uint8_t>{200, 0, 0, 128, 200, 0, 0, 128}));
  picture.channels = 1;
  picture.pixels = {0, 1, 2, 3, 4, 5, 6, 7};
  const character::Picture grey = FitPicture(picture, 4);
  EXPECT_EQ(grey.channels, 3);
  EXPECT_EQ(grey.pixels[3], 1);
  EXPECT_EQ(grey.pixels[5], 1);
}

}  // namespace
}  // namespace furrow::authoring
