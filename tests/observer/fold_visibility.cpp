// SPDX-License-Identifier: Apache-2.0
#include "tests/observer/fold_visibility.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace furrow::observer {
namespace {

constexpr double kSigmas[] = {1.0, 2.0, 4.0};
constexpr double kBackgroundDegrees = 0.2;
constexpr float kDarkLight = 0.02f;  // light of the room on the screen, relative to white
constexpr double kPlaceSquareCycles = 4.0;
constexpr double kMaskWavelengths = 0.25;
// What the bands together read of a grating at the centre of one band, relative to the formula: the
// mean over the bands. A finer band has more square cycles in a region, but not in a place.
constexpr double kBandOverlap = 1.2;
constexpr double kPlaceBandOverlap = 1.07;
constexpr double kReach = 4.0;  // of a sampled Gaussian, in sigmas
static_assert(kReach * 2.0 * kSigmas[2] <= kFoldReach);

// exp(-u) - exp(-4 u), u = 2 pi^2 sigma^2 f^2, is largest at u = ln(4) / 3.
const double kPeak = std::log(4.0) / 3.0;
const double kBandGain = 1.0 / (std::exp(-kPeak) - std::exp(-4.0 * kPeak));
const double kWavelengthPerSigma = std::numbers::pi * std::sqrt(2.0 / kPeak);

struct Rect {
  int left = 0, top = 0, right = 0, bottom = 0;  // pixels; right and bottom are exclusive
};

Rect BoundsOf(const Plane& region) {
  Rect bounds{region.width, region.height, 0, 0};
  for (int y = 0; y < region.height; ++y) {
    for (int x = 0; x < region.width; ++x) {
      if (region.at(x, y) < 0.5f) continue;
      bounds = {std::min(bounds.left, x), std::min(bounds.top, y), std::max(bounds.right, x + 1),
                std::max(bounds.bottom, y + 1)};
    }
  }
  return bounds;
}

Plane Crop(const Plane& plane, const Rect& rect) {
  Plane crop{rect.right - rect.left, rect.bottom - rect.top, {}};
  for (int y = rect.top; y < rect.bottom; ++y) {
    for (int x = rect.left; x < rect.right; ++x) crop.values.push_back(plane.at(x, y));
  }
  return crop;
}

std::vector<float> GaussianTaps(double sigma) {
  const int reach = static_cast<int>(std::ceil(kReach * sigma));
  std::vector<float> taps;
  for (int i = -reach; i <= reach; ++i) {
    taps.push_back(static_cast<float>(std::exp(-0.5 * i * i / (sigma * sigma))));
  }
  return taps;
}

// Convolves along x and writes the transpose. The plane is 0 beyond its edges.
Plane ConvolvedTranspose(const Plane& plane, const std::vector<float>& taps) {
  const int reach = static_cast<int>(taps.size() / 2);
  Plane out{plane.height, plane.width, std::vector<float>(plane.values.size())};
  for (int y = 0; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) {
      const int first = std::max(0, x - reach);
      const int last = std::min(plane.width - 1, x + reach);
      const float* const value = &plane.values[static_cast<std::size_t>(y * plane.width + first)];
      const float* const tap = &taps[static_cast<std::size_t>(first - x + reach)];
      float sum = 0.0f;
      for (int i = 0; i <= last - first; ++i) sum += tap[i] * value[i];
      out.values[static_cast<std::size_t>(x * plane.height + y)] = sum;
    }
  }
  return out;
}

// The sum of the plane's values around each pixel. The weights are `taps` in x times `taps` in y.
Plane Convolved(const Plane& plane, const std::vector<float>& taps) {
  return ConvolvedTranspose(ConvolvedTranspose(plane, taps), taps);
}

Plane Blurred(const Plane& plane, double sigma) {
  std::vector<float> taps = GaussianTaps(sigma);
  float sum = 0.0f;
  for (const float tap : taps) sum += tap;
  for (float& tap : taps) tap /= sum;
  return Convolved(plane, taps);
}

Plane BandOf(const Plane& plane, double sigma) {
  Plane band = Blurred(plane, sigma);
  const Plane wide = Blurred(plane, 2.0 * sigma);
  for (std::size_t i = 0; i < band.values.size(); ++i) {
    band.values[i] = static_cast<float>(kBandGain) * (band.values[i] - wide.values[i]);
  }
  return band;
}

template <class Function>
Plane Mapped(const Plane& like, const Function& function) {
  Plane out{like.width, like.height, std::vector<float>(like.values.size())};
  for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] = function(i);
  return out;
}

// The background that the eye adapts to. Only the subject's pixels count, so that a limb in front
// of a dark backdrop does not brighten at its outlines.
Plane BackgroundOf(const Plane& off, const Plane& subject, double sigma) {
  const Plane light =
      Mapped(off, [&](std::size_t i) { return subject.values[i] > 0.5f ? off.values[i] : 0.0f; });
  const Plane sum = Blurred(light, sigma);
  const Plane share = Blurred(subject, sigma);
  return Mapped(off, [&](std::size_t i) {
    return share.values[i] > 1e-4f ? sum.values[i] / share.values[i] : 0.0f;
  });
}

// Indices of the region's pixels with eight neighbours in the region.
std::vector<std::size_t> WithoutRim(const Plane& region) {
  std::vector<std::size_t> pixels;
  for (int y = 1; y + 1 < region.height; ++y) {
    for (int x = 1; x + 1 < region.width; ++x) {
      bool inside = true;
      for (int i = 0; i < 9; ++i) inside &= region.at(x + i % 3 - 1, y + i / 3 - 1) > 0.5f;
      if (inside) pixels.push_back(static_cast<std::size_t>(y * region.width + x));
    }
  }
  return pixels;
}

double Root4(double x) { return std::sqrt(std::sqrt(x)); }
double Power4(double x) { return x * x * x * x; }

Status CheckPictures(const FoldPictures& pictures) {
  for (const Plane* plane : {&pictures.on, &pictures.off, &pictures.region, &pictures.subject}) {
    const std::size_t area =
        static_cast<std::size_t>(plane->width) * static_cast<std::size_t>(plane->height);
    if (plane->width != pictures.on.width || plane->height != pictures.on.height ||
        plane->values.size() != area) {
      return {StatusCode::kInvalidArgument, "the pictures differ in size", "observer"};
    }
    if (!std::ranges::all_of(plane->values, [](float x) { return std::isfinite(x); })) {
      return {StatusCode::kNonFinite, "a picture has a value that is not finite", "observer"};
    }
  }
  return {};
}

// The cropped pictures and what is derived from them once for all bands.
struct Scene {
  Plane folds;  // d
  Plane base;   // c
  std::vector<std::size_t> pixels;
};

Scene MakeScene(const FoldPictures& pictures, const Viewing& viewing, const Rect& rect) {
  const Plane on = Crop(pictures.on, rect);
  const Plane off = Crop(pictures.off, rect);
  const Plane subject = Crop(pictures.subject, rect);
  const Plane background =
      BackgroundOf(off, subject, kBackgroundDegrees * viewing.pixels_per_degree);
  const auto contrast = [&](const Plane& a, const Plane& b) {
    return Mapped(off, [&](std::size_t i) {
      if (subject.values[i] < 0.5f) return 0.0f;
      return (a.values[i] - b.values[i]) / (background.values[i] + kDarkLight);
    });
  };
  return {contrast(on, off), contrast(off, background), WithoutRim(Crop(pictures.region, rect))};
}

// C_m of each pixel in one band.
Plane BaseContrastOf(const Plane& base, const BandVisibility& band) {
  Plane squares = BandOf(base, band.sigma);
  for (float& value : squares.values) value *= value;
  squares = Blurred(squares, kMaskWavelengths * band.wavelength_px);
  return Mapped(squares, [&](std::size_t i) { return std::sqrt(2.0f * squares.values[i]); });
}

// Measures one band and adds the fourth power of its visibility at each place to `places`.
void MeasureBand(const Scene& scene, BandVisibility* band, Plane* places) {
  const Plane folds = BandOf(scene.folds, band->sigma);
  const Plane base = BaseContrastOf(scene.base, *band);
  const double square_cycle = band->wavelength_px * band->wavelength_px;  // pixels
  double energy = 0.0;
  Plane energies{folds.width, folds.height, std::vector<float>(folds.values.size())};
  for (const std::size_t i : scene.pixels) {
    const double threshold = ContrastThreshold(band->cycles_per_degree, base.values[i]);
    band->base_contrast += base.values[i] / static_cast<double>(scene.pixels.size());
    band->threshold += threshold / static_cast<double>(scene.pixels.size());
    const double fourth = Power4(folds.values[i] / threshold) / square_cycle;
    energy += fourth;
    energies.values[i] = static_cast<float>(fourth);
  }
  band->visibility = Root4(energy);
  // A Gaussian of height 1 covers 2 pi sigma^2 pixels.
  const double sigma = band->wavelength_px * std::sqrt(kPlaceSquareCycles / (2 * std::numbers::pi));
  const Plane sums = Convolved(energies, GaussianTaps(sigma));
  for (const std::size_t i : scene.pixels) places->values[i] += sums.values[i];
}

}  // namespace

double FoldVisibility::ShareAtLeast(double jnd) const {
  if (pixels.empty()) return 0.0;
  const auto count =
      std::ranges::count_if(pixels, [&](std::size_t i) { return double{places.values[i]} >= jnd; });
  return static_cast<double>(count) / static_cast<double>(pixels.size());
}

double ContrastSensitivity(double cycles_per_degree) {
  const double x = 0.114 * cycles_per_degree;
  return 100.0 * 2.6 * (0.0192 + x) * std::exp(-std::pow(x, 1.1));
}

double ContrastThreshold(double cycles_per_degree, double base_contrast) {
  const double sensitivity = ContrastSensitivity(cycles_per_degree);
  return std::max(1.0, std::pow(base_contrast * sensitivity, 0.7)) / sensitivity;
}

std::vector<BandVisibility> FoldBands(const Viewing& viewing) {
  std::vector<BandVisibility> bands;
  for (const double sigma : kSigmas) {
    const double wavelength = kWavelengthPerSigma * sigma;
    const double millimetres = wavelength * viewing.millimetres_per_pixel;
    if (millimetres < viewing.shortest_mm || millimetres > viewing.longest_mm) continue;
    bands.push_back({.sigma = sigma,
                     .wavelength_px = wavelength,
                     .cycles_per_degree = viewing.pixels_per_degree / wavelength});
  }
  return bands;
}

Result<FoldVisibility> MeasureFolds(const FoldPictures& pictures, const Viewing& viewing) {
  FURROW_RETURN_IF_ERROR(CheckPictures(pictures));
  FoldVisibility found;
  found.bands = FoldBands(viewing);
  if (found.bands.empty()) {
    return Status(StatusCode::kInvalidArgument, "no band lies between the two wavelengths",
                  "observer", "use a wider range or another size of picture");
  }
  const int width = pictures.on.width;
  const int height = pictures.on.height;
  found.places = {width, height, std::vector<float>(pictures.on.values.size())};
  const Rect region = BoundsOf(pictures.region);
  if (region.left >= region.right) return found;
  // No pixel beyond this margin reaches the region through the background, a band and its mask.
  const int margin = static_cast<int>(
      std::ceil(kReach * (kBackgroundDegrees * viewing.pixels_per_degree + 2.0 * kSigmas[2] +
                          kMaskWavelengths * kWavelengthPerSigma * kSigmas[2])));
  const Rect rect{std::max(0, region.left - margin), std::max(0, region.top - margin),
                  std::min(width, region.right + margin), std::min(height, region.bottom + margin)};
  const Scene scene = MakeScene(pictures, viewing, rect);
  if (scene.pixels.empty()) return found;
  Plane places{scene.folds.width, scene.folds.height,
               std::vector<float>(scene.folds.values.size())};
  double sum = 0.0;
  for (BandVisibility& band : found.bands) {
    MeasureBand(scene, &band, &places);
    sum += Power4(band.visibility);
  }
  found.visibility = Root4(sum) / kBandOverlap;
  for (const std::size_t i : scene.pixels) {
    const std::size_t columns = static_cast<std::size_t>(places.width);
    const std::size_t x = i % columns + static_cast<std::size_t>(rect.left);
    const std::size_t y = i / columns + static_cast<std::size_t>(rect.top);
    found.pixels.push_back(y * static_cast<std::size_t>(width) + x);
    found.places.values[found.pixels.back()] =
        static_cast<float>(Root4(places.values[i]) / kPlaceBandOverlap);
  }
  return found;
}

}  // namespace furrow::observer
