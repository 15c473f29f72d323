// SPDX-License-Identifier: Apache-2.0
#include "sitter.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <utility>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>

namespace furrow::render::golden {
namespace {

constexpr int kSize = 96;
constexpr float kSmall = 6.0f / 255.0f;      // largest difference of a pixel by another driver's
                                             // rounding
constexpr double kMaxFailShare = 0.01;       // share of pixels, at edges, that may differ more
constexpr double kMaxMeanError = 1.5 / 255;  // of all pixels: nothing has moved or changed its tone

void Save(const Image& image, const std::filesystem::path& path) {
  const auto bytes = EncodeImage(image, ImageFormat::kPng);
  ASSERT_TRUE(bytes.ok()) << bytes.status().ToString();
  std::filesystem::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes->data()),
             static_cast<std::streamsize>(bytes->size()));
  ASSERT_TRUE(file.good()) << path;
}

}  // namespace

void PrintTo(const Shot& shot, std::ostream* out) { *out << shot.name; }

Sitter::Sitter(character::Character character)
    : character_(std::move(character)),
      subject_(character_),
      renderer_(test::Expect(Renderer::Create(character_))) {}

Image Sitter::Draw(const Shot& shot) {
  FrameRequest request;
  request.model = subject_.model;
  request.binding = &subject_.binding;
  request.wrinkle_weights = subject_.weights;
  request.filtered_values = subject_.driver_values;
  request.settings.view = shot.view;
  request.settings.normal_blend = shot.blend;
  request.settings.shading = shot.shading;
  request.settings.anti_aliasing.samples = shot.samples;
  request.settings.bloom.threshold = shot.bloom_threshold;
  request.camera = *renderer_->Preset(shot.camera);
  request.width = request.height = kSize;
  return test::Expect(renderer_->Render(request));
}

void ExpectLooksLike(Image drawn, const std::string& name) {
  const std::filesystem::path file = std::filesystem::path(name + ".png");
  const std::filesystem::path expected_path =
      std::filesystem::path(FURROW_SOURCE_DIR) / "tests" / "golden" / "images" / file;
  if (std::getenv("FURROW_UPDATE_GOLDEN") != nullptr) {
    Save(drawn, expected_path);
    GTEST_SKIP() << "wrote " << expected_path;
  }
  const OIIO::ImageBuf expected(expected_path.string());
  ASSERT_TRUE(expected.has_error() == false && expected.spec().width == kSize)
      << expected_path << ": " << expected.geterror();
  const OIIO::ImageSpec spec(kSize, kSize, 3, OIIO::TypeDesc::UINT8);
  const OIIO::ImageBuf actual(spec, drawn.rgb.data());
  const auto difference = OIIO::ImageBufAlgo::compare(actual, expected, kSmall, kSmall);
  const bool close =
      difference.nfail <= kMaxFailShare * kSize * kSize && difference.meanerror <= kMaxMeanError;
  const std::filesystem::path wrong = std::filesystem::path(FURROW_BINARY_DIR) / "golden" / file;
  if (!close) Save(drawn, wrong);
  EXPECT_TRUE(close) << difference.nfail << " pixels differ, mean " << difference.meanerror
                     << ", at most " << difference.maxerror << " at " << difference.maxx << ", "
                     << difference.maxy << "; the picture is " << wrong;
}

}  // namespace furrow::render::golden
