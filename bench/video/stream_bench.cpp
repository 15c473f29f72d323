// SPDX-License-Identifier: Apache-2.0
// How close moving pictures that are drawn with fewer pixels come to exact ones: completed from
// former pictures (render/temporal/), and only enlarged.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "bench/report/command_line.h"
#include "bench/report/results.h"
#include "bench/report/value_or_exit.h"
#include "bench/video/scenes.h"
#include "render/request/image_codec.h"
#include "report/table.h"

namespace furrow::bench {
namespace {

using Images = std::vector<render::Image>;

constexpr int kWidth = 640;
constexpr int kHeight = 400;
constexpr int kFirst = 8;         // picture that is compared: by then, a stream is complete
constexpr int kExactSamples = 4;  // per pixel, as in a still

struct Options {
  std::filesystem::path out = "bench-out";
  int pictures = 40;
  bool keep = false;
  std::vector<float> scales = {0.75f, 0.6f, 0.5f};
  std::vector<int> scenes = {0, 1, 2};
};

// The picture at another size, bilinear.
render::Image Enlarged(const render::Image& image, int width, int height) {
  render::Image large{width, height, {}, 0};
  const auto at = [&](int x, int y, int c) {
    const int column = std::clamp(x, 0, image.width - 1);
    const int row = std::clamp(y, 0, image.height - 1);
    return static_cast<float>(
        image.rgb[static_cast<std::size_t>(3 * (row * image.width + column) + c)]);
  };
  for (int y = 0; y < height; ++y) {
    const float v = (static_cast<float>(y) + 0.5f) * static_cast<float>(image.height) /
                        static_cast<float>(height) -
                    0.5f;
    for (int x = 0; x < width; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) * static_cast<float>(image.width) /
                          static_cast<float>(width) -
                      0.5f;
      const int column = static_cast<int>(std::floor(u));
      const int row = static_cast<int>(std::floor(v));
      const float right = u - std::floor(u);
      const float below = v - std::floor(v);
      for (int c = 0; c < 3; ++c) {
        const float above = std::lerp(at(column, row, c), at(column + 1, row, c), right);
        const float under = std::lerp(at(column, row + 1, c), at(column + 1, row + 1, c), right);
        large.rgb.push_back(static_cast<std::uint8_t>(std::lround(std::lerp(above, under, below))));
      }
    }
  }
  return large;
}

// Root mean square error over the pixels that show skin. `material`: pictures of View::kMaterial,
// which show skin red.
double SkinError(const Images& images, const Images& exact, const Images& material) {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = kFirst; i < images.size(); ++i) {
    for (std::size_t at = 0; at < images[i].rgb.size(); at += 3) {
      const std::uint8_t* kind = &material[i].rgb[at];
      if (kind[0] < 128 || kind[1] > 96 || kind[2] > 96) continue;
      for (std::size_t c = at; c < at + 3; ++c) {
        const double error = static_cast<double>(images[i].rgb[c]) - exact[i].rgb[c];
        sum += error * error;
      }
      count += 3.0;
    }
  }
  return std::sqrt(sum / std::max(count, 1.0));
}

class Comparison {
 public:
  Comparison(SceneDrawer* drawer, Scene scene, const Options& options)
      : drawer_(drawer), scene_(scene), options_(options) {
    exact_ = Draw(1.0f, [](render::FrameRequest* request) {
      request->settings.anti_aliasing.samples = kExactSamples;
    });
    material_ = Draw(1.0f, [](render::FrameRequest* request) {
      request->settings.view = render::View::kMaterial;
    });
    Keep(exact_, "exact");
  }
  // As the daemon draws it without a stream.
  [[nodiscard]] double Alone() const {
    const Images images =
        Draw(1.0f, [](render::FrameRequest* request) { request->is_moving = true; });
    Keep(images, "alone");
    return SkinError(images, exact_, material_);
  }
  [[nodiscard]] double Enlarged(float scale) const {
    Images images = Draw(scale, [](render::FrameRequest* request) { request->is_moving = true; });
    for (render::Image& image : images) image = bench::Enlarged(image, kWidth, kHeight);
    Keep(images, "enlarged" + report::Fixed(scale, 2));
    return SkinError(images, exact_, material_);
  }
  [[nodiscard]] double Stream(float scale) const {
    static std::uint64_t stream = 0;
    ++stream;
    const Images images = Draw(1.0f, [scale](render::FrameRequest* request) {
      request->is_moving = true;
      request->stream = stream;
      request->scale = scale;
    });
    Keep(images, "stream" + report::Fixed(scale, 2));
    return SkinError(images, exact_, material_);
  }

 private:
  [[nodiscard]] Images Draw(float size, const Adjust& adjust) const {
    return ValueOrExit(drawer_->Draw(scene_, static_cast<int>(std::lround(kWidth * size)),
                                     static_cast<int>(std::lround(kHeight * size)),
                                     options_.pictures, adjust));
  }
  void Keep(const Images& images, const std::string& name) const {
    if (!options_.keep) return;
    for (std::size_t i = 0; i < images.size(); ++i) {
      char number[24];
      std::snprintf(number, sizeof number, "%03zu", i);
      const auto png = ValueOrExit(render::EncodeImage(images[i], render::ImageFormat::kPng));
      WriteResult(options_.out / (NameOf(scene_) + " " + name + " " + number + ".png"),
                  std::string(png.begin(), png.end()));
    }
  }

  SceneDrawer* drawer_;
  Scene scene_;
  const Options& options_;
  Images exact_;
  Images material_;
};

void Run(const Options& options) {
  std::string table = "| Scene | Drawn | Enlarged | Completed |\n|---|---|---|---|\n";
  const auto drawer = ValueOrExit(SceneDrawer::Create());
  for (const int number : options.scenes) {
    const auto scene = static_cast<Scene>(number);
    const Comparison comparison(drawer.get(), scene, options);
    table += "| " + NameOf(scene) + " | 640x400 | " + report::Fixed(comparison.Alone(), 2) +
             " (not enlarged) | |\n";
    for (const float scale : options.scales) {
      table += "| " + NameOf(scene) + " | " + report::Fixed(kWidth * scale, 0) + "x" +
               report::Fixed(kHeight * scale, 0) + " | " +
               report::Fixed(comparison.Enlarged(scale), 2) + " | " +
               report::Fixed(comparison.Stream(scale), 2) + " |\n";
    }
  }
  std::printf("%s", table.c_str());
  WriteResult(options.out / "stream.md", table);
}

}  // namespace
}  // namespace furrow::bench

int main(int argc, char** argv) {
  furrow::bench::Options options;
  CLI::App app{
      "Compare moving pictures that are drawn with fewer pixels with exact ones: error on the skin "
      "(RMSE of 255)"};
  app.add_option("--out", options.out, "Folder for stream.md")->capture_default_str();
  app.add_option("--pictures", options.pictures, "Pictures per scene")
      ->check(CLI::Range(10, 1'000))
      ->capture_default_str();
  app.add_option("--scales", options.scales, "Shares of the width and height that are drawn")
      ->check(CLI::Range(0.5, 0.99))
      ->capture_default_str();
  app.add_option("--scenes", options.scenes, "0: calm face, 1: turning face, 2: turning camera")
      ->check(CLI::Range(0, 2))
      ->capture_default_str();
  app.add_flag("--keep", options.keep, "Also write the pictures as PNG files");
  furrow::bench::ReadCommandLine(app, argc, argv);
  furrow::bench::MakeResultFolder(options.out);
  furrow::bench::Run(options);
  return 0;
}
