// SPDX-License-Identifier: Apache-2.0
// How visible the folds of the shipped characters are: every map of each face, and every bend of a
// clothed joint. And whether folds of the faces look like scars. With FURROW_UPDATE_GOLDEN=1, the
// tables of docs/VISIBILITY.md become what is measured.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "authoring/bake/strokes_file.h"
#include "authoring/generator/blend_shapes/blend_shape_face.h"
#include "character/package/package.h"
#include "motion/pose_source.h"
#include "tests/observer/fold_cases.h"
#include "tests/observer/fold_patches.h"
#include "tests/observer/fold_scars.h"
#include "tests/observer/fold_sitter.h"
#include "tests/observer/fold_visibility.h"
#include "tests/observer/visibility_page.h"

namespace furrow::observer {
namespace {

// Pixels. A head or a body fills the picture.
constexpr int kPictureHeight = 512;
constexpr double kPlain = 10.0;     // JND
constexpr double kPlainHalf = 5.0;  // JND, at half the size
constexpr double kLeastShare = 0.3;
constexpr double kUnseen = 1.0;  // JND: the most that folds may change the picture elsewhere
// Wavelengths of folds. Skin: from crow's feet to nasolabial folds. Cloth: from the hollow of an
// elbow to the large forms of trousers.
constexpr double kSkinMm[] = {2.5, 20.0};
constexpr double kClothMm[] = {30.0, 100.0};
constexpr const char* kBodyViews[][2] = {
    {"front", "body"}, {"side", "body_side"}, {"three-quarter", "body_three_quarter"}};

std::string Text(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

// One bend from one view.
struct BendView {
  std::string bend;
  std::string view;
  // Less than one square cycle of the finest band is visible, in which no observer finds a fold.
  bool hidden = false;
  double visibility[2] = {};  // JND, over the visible area, at full and half size
  double share[2] = {};       // of the visible area with kPlain, and with kPlainHalf at half size
};

// The columns of the face's table.
constexpr const char* kFaces[] = {"Default", "Elder", "Blend shapes"};

struct Measurements {
  // For each case of a face, in the rig's order: the visibility on each of kFaces, JND. -1: the
  // face has no such case.
  std::vector<std::pair<std::string, std::vector<double>>> face;
  std::map<std::string, double> face_control;  // visibility of the fold-free patch, the largest
  std::vector<BendView> bends;
  double bend_control = 0.0;  // the largest of all bends and views
  // By case and face.
  std::vector<std::pair<PageRow, ScarMeasures>> scars;
  std::vector<std::string> unfolded;  // BendCases()
  // Visibility with all weights 0; the largest of all cases.
  double without_weights = 0.0;
};

class ShippedFolds : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const std::filesystem::path share =
        std::filesystem::path(FURROW_BINARY_DIR) / "share" / "furrow";
    for (const char* glb : {"default.glb", "elder.glb"}) {
      if (!std::filesystem::exists(share / glb)) return;
    }
    measured_ = std::make_unique<Measurements>();
    const character::Character person = Load(share / "default.glb");
    const character::Character elder = Load(share / "elder.glb");
    MeasureForms(0, person);
    MeasureForms(1, elder);
    MeasureFaces(0, person);
    MeasureFaces(1, elder);
    character::Character shapes = person;
    ASSERT_TRUE(authoring::MakeBlendShapeFace(&shapes).ok());
    MeasureFaces(2, shapes);
    MeasureBends(person);
  }
  static void TearDownTestSuite() { measured_.reset(); }

  void SetUp() override {
    if (!measured_)
      GTEST_SKIP() << "no default.glb or elder.glb: build furrow_share and furrow_elder";
  }

  inline static std::unique_ptr<Measurements> measured_;

 private:
  static character::Character Load(const std::filesystem::path& glb) {
    return render::test::Expect(character::LoadCharacter(glb, {}, motion::CachedPoseSource()));
  }

  // `face`: an index into kFaces.
  static void MeasureFaces(std::size_t face, const character::Character& character) {
    FoldSitter sitter(character);
    for (const FoldCase& fold_case : render::test::Expect(FaceCases(character))) {
      const double visibility = MeasureFace(fold_case, &sitter);
      auto row = std::ranges::find(measured_->face, fold_case.name,
                                   [](const auto& one) { return one.first; });
      if (row == measured_->face.end()) {
        row = measured_->face.insert(row, {fold_case.name, std::vector(std::size(kFaces), -1.0)});
      }
      row->second[face] = visibility;
    }
  }

  static void MeasureForms(std::size_t face, const character::Character& character) {
    const std::filesystem::path strokes =
        std::filesystem::path(FURROW_SOURCE_DIR) / "rig" / "rigs" / "default.strokes.json";
    const auto drawn = render::test::Expect(authoring::LoadStrokes(strokes, character.rig));
    for (const auto& [name, patch] : render::test::Expect(SkinPatches(character, drawn))) {
      const ScarMeasures scars = MeasureScars(patch);
      measured_->scars.emplace_back(PageRow{{"`" + name + "`", kFaces[face]}, {}}, scars);
      std::printf(
          "%-26s %-14s against %.3f, drawn %.3f, disordered %.3f, isolated %.3f, short %.3f, hard "
          "%.3f\n",
          name.c_str(), kFaces[face], scars.against, scars.drawn_against, scars.disordered,
          scars.isolated, scars.short_deep, scars.hard);
    }
  }

  static void MeasureBends(const character::Character& character) {
    FoldSitter sitter(character);
    for (const FoldCase& bend : render::test::Expect(BendCases(character, &measured_->unfolded))) {
      MeasureBend(bend, &sitter);
    }
  }

  // The visibility of the case's folds.
  static double MeasureFace(const FoldCase& face, FoldSitter* sitter) {
    sitter->Hold(face);
    const FoldSitter::Shot shot{"face", kPictureHeight};
    const Viewing viewing{.millimetres_per_pixel = sitter->MillimetresPerPixel(shot),
                          .shortest_mm = kSkinMm[0],
                          .longest_mm = kSkinMm[1]};
    FoldPictures pictures = sitter->Draw(shot);
    const auto found = render::test::Expect(MeasureFolds(pictures, viewing));
    Print(face.name, "face", found);
    double& control = measured_->face_control[face.name];
    control = std::max(control, MeasureControl(face.name, viewing, pictures));
    MeasureWithoutWeights(shot, viewing, std::move(pictures), sitter);
    return found.visibility;
  }

  static void MeasureBend(const FoldCase& bend, FoldSitter* sitter) {
    sitter->Hold(bend);
    for (const auto& [view, camera] : kBodyViews) {
      BendView seen{.bend = bend.name, .view = view};
      for (int half = 0; half < 2; ++half) {
        const FoldSitter::Shot shot{camera, half == 0 ? kPictureHeight : kPictureHeight / 2};
        const Viewing viewing{.millimetres_per_pixel = sitter->MillimetresPerPixel(shot),
                              .shortest_mm = kClothMm[0],
                              .longest_mm = kClothMm[1]};
        FoldPictures pictures = sitter->Draw(shot);
        const auto found = render::test::Expect(MeasureFolds(pictures, viewing));
        const double cycle = found.bands.front().wavelength_px;
        seen.hidden = seen.hidden || static_cast<double>(found.pixels.size()) < cycle * cycle;
        seen.visibility[half] = found.visibility;
        seen.share[half] = found.ShareAtLeast(half == 0 ? kPlain : kPlainHalf);
        Print(bend.name, view, found);
        if (half == 0) {
          measured_->bend_control =
              std::max(measured_->bend_control, MeasureControl(bend.name, viewing, pictures));
        } else {
          MeasureWithoutWeights(shot, viewing, std::move(pictures), sitter);
        }
      }
      measured_->bends.push_back(seen);
    }
  }

  // The visibility of the folds where there are none.
  static double MeasureControl(const std::string& name, const Viewing& viewing,
                               FoldPictures pictures) {
    pictures.region = std::move(pictures.control);
    const auto found = render::test::Expect(MeasureFolds(pictures, viewing));
    Print(name, "control", found);
    return found.visibility;
  }

  // The picture with all weights 0 must be the one without wrinkles.
  static void MeasureWithoutWeights(const FoldSitter::Shot& shot, const Viewing& viewing,
                                    FoldPictures pictures, FoldSitter* sitter) {
    pictures.on = std::move(pictures.off);
    pictures.off = sitter->DrawWithoutWrinkles(shot);
    const auto found = render::test::Expect(MeasureFolds(pictures, viewing));
    measured_->without_weights = std::max(measured_->without_weights, found.visibility);
  }

  // The bands behind each number, for work on the maps.
  static void Print(const std::string& name, const std::string& view, const FoldVisibility& found) {
    std::printf("%-26s %-14s V %6.2f, %6zu pixels;", name.c_str(), view.c_str(), found.visibility,
                found.pixels.size());
    for (const BandVisibility& band : found.bands) {
      std::printf("  %4.1f px: V %.1f, base %.1f%%, threshold %.2f%%", band.wavelength_px,
                  band.visibility, 100.0 * band.base_contrast, 100.0 * band.threshold);
    }
    std::printf("\n");
    std::fflush(stdout);
  }
};

TEST_F(ShippedFolds, AreFoundInTheRig) {
  EXPECT_FALSE(measured_->face.empty());
  EXPECT_FALSE(measured_->bends.empty());
  EXPECT_FALSE(measured_->scars.empty());
}

TEST_F(ShippedFolds, OfClothesAreSeenFromSomewhere) {
  for (const BendView& seen : measured_->bends) {
    const bool visible = std::ranges::any_of(measured_->bends, [&](const BendView& other) {
      return other.bend == seen.bend && !other.hidden;
    });
    EXPECT_TRUE(visible) << seen.bend << " is hidden from every view";
  }
}

TEST_F(ShippedFolds, AreExactlyZeroWithoutWeights) { EXPECT_EQ(measured_->without_weights, 0.0); }

TEST_F(ShippedFolds, DoNotShowElsewhere) {
  for (const auto& [name, control] : measured_->face_control) EXPECT_LT(control, kUnseen) << name;
  EXPECT_LT(measured_->bend_control, kUnseen);
}

TEST_F(ShippedFolds, AreNoScars) {
  for (const auto& [row, scars] : measured_->scars) {
    EXPECT_TRUE(IsWithin(scars, kScarLimits))
        << row.labels[0] << " of " << row.labels[1] << ": against " << scars.against
        << ", disordered " << scars.disordered << ", isolated " << scars.isolated
        << ", short and deep " << scars.short_deep << ", hard " << scars.hard;
  }
}

PageTable FaceTable(const Measurements& measured) {
  PageTable table{{"Wrinkle weight"}, {}};
  for (const char* face : kFaces) {
    table.header.emplace_back(face);
    table.header.emplace_back("Aim");
  }
  table.header.emplace_back("Control");
  for (const auto& [name, visibility] : measured.face) {
    PageRow row{{"`" + name + "`"}, {}};
    for (const double v : visibility) {
      row.cells.push_back(v < 0.0 ? "none" : Text("%.1f", v));
      row.cells.push_back(v < 0.0 ? "none" : v >= kPlain ? "yes" : "no");
    }
    row.cells.push_back(Text("%.2f", measured.face_control.at(name)));
    table.rows.push_back(row);
  }
  return table;
}

PageTable ScarTable(const Measurements& measured) {
  PageTable table{{"Wrinkle weight", "Face", "Against", "Drawn against", "Disordered", "Isolated",
                   "Short and deep", "Hard"},
                  {}};
  for (const auto& [labels, scars] : measured.scars) {
    PageRow row = labels;
    for (const double share : {scars.against, scars.drawn_against, scars.disordered, scars.isolated,
                               scars.short_deep, scars.hard}) {
      row.cells.push_back(Text("%.0f%%", 100.0 * share));
    }
    table.rows.push_back(row);
  }
  return table;
}

std::vector<PageTable> TablesOf(const Measurements& measured) {
  PageTable bends{{"Bend", "View", "V", "Share with V >= 10", "V at half size",
                   "Share with V >= 5 at half size", "Aim"},
                  {}};
  for (const BendView& seen : measured.bends) {
    PageRow row{{"`" + seen.bend + "`", seen.view}, {}};
    for (int half = 0; half < 2; ++half) {
      row.cells.push_back(seen.hidden ? "hidden" : Text("%.1f", seen.visibility[half]));
      row.cells.push_back(seen.hidden ? "hidden" : Text("%.0f%%", 100.0 * seen.share[half]));
    }
    const bool reached = seen.share[0] >= kLeastShare && seen.share[1] >= kLeastShare;
    row.cells.push_back(seen.hidden ? "hidden" : reached ? "yes" : "no");
    bends.rows.push_back(row);
  }
  for (const std::string& bend : measured.unfolded) {
    bends.rows.push_back({{"`" + bend + "`", "all"}, std::vector<std::string>(5, "no folds")});
  }
  return {FaceTable(measured), bends, ScarTable(measured)};
}

TEST_F(ShippedFolds, AreAsThePageSays) {
  const std::filesystem::path path =
      std::filesystem::path(FURROW_SOURCE_DIR) / "docs" / "VISIBILITY.md";
  std::ifstream file(path, std::ios::binary);
  const std::string page((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  ASSERT_FALSE(page.empty()) << path;
  const std::vector<PageTable> tables = TablesOf(*measured_);
  if (std::getenv("FURROW_UPDATE_GOLDEN") != nullptr) {
    std::ofstream out(path, std::ios::binary);
    out << PageWithTables(page, tables);
    ASSERT_TRUE(out.good()) << path;
    GTEST_SKIP() << "wrote " << path;
  }
  const std::vector<std::string> differences = DifferencesFromPage(page, tables);
  std::string list;
  for (const std::string& difference : differences) list += "  " + difference + "\n";
  EXPECT_TRUE(differences.empty())
      << list << "FURROW_UPDATE_GOLDEN=1 test_shipped_folds measures the page again";
}

}  // namespace
}  // namespace furrow::observer
