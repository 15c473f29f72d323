// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "base/status.h"

// A machine observer: how visible the folds of a picture are, as a number.
//
// It compares two pictures of the same pose, with and without folds, inside the pixels of a region.
// The result V is in JND (just noticeable differences): 1 JND is the contrast threshold of the eye.
// Folds of 3 JND are found if looked for. Folds of 10 JND are plain.
//
// The model, band by band:
//
//   background  B = Gaussian blur of `off` by 0.2 degrees, over the pixels of the subject only
//   folds       d = (on - off) / (B + 0.02), 0 outside the subject
//   base        c = (off - B) / (B + 0.02), 0 outside the subject
//   band        Gaussian of sigma minus Gaussian of 2 sigma, times 2.117: the peak gain is 1, at a
//               wavelength of 6.54 sigma. sigma is 1, 2 or 4 pixels
//   eye         S = 100 A(f), f in cycles per degree (ContrastSensitivity())
//   masking     C_t = max(1, (C_m S)^0.7) / S at each pixel. C_m is the contrast of a sine grating
//               with the RMS of the base's band around the pixel: a Gaussian of a quarter
//               wavelength, the least in which a grating reads the same everywhere
//   pooling     V_b = (sum of (d_b / C_t)^4 / pixels per square cycle)^(1/4), over the region
//   together    V = (sum of V_b^4)^(1/4) / 1.2, because neighbouring bands see the same folds
//
// - Sensitivity: Mannos and Sakrison 1974, The Effects of a Visual Fidelity Criterion on the
//   Encoding of Images, IEEE Transactions on Information Theory 20 (4). Its A is relative; 100 A
//   puts the threshold of 8 cycles per degree at a Michelson contrast of 1%.
// - Masking: Legge and Foley 1980, Contrast Masking in Human Vision, JOSA 70 (12). The base masks
//   folds only where it lies: the line of a mouth does not hide the folds of the cheek.
// - Pooling with the exponent 4 over space and bands is probability summation: Robson and Graham
//   1981, Probability Summation and Regional Variation in Contrast Sensitivity Across the Visual
//   Field, Vision Research 21 (3). N square cycles of a sine grating of contrast C therefore read
//   C (0.375 N)^(1/4) / C_t.
// - The finest band (sigma 0.5) is left out: it shows the weave of cloth and the noise of sampling.
//   The outermost pixel of the region is left out, because it may be half covered.
// - The divisor 1.2 is the mean over the bands. A grating between or at the ends of the bands reads
//   up to 20% more or less than the formula. For places (below), the divisor is 1.07.
namespace furrow::observer {

// One number per pixel, rows from the top.
struct Plane {
  int width = 0;   // pixels
  int height = 0;  // pixels
  std::vector<float> values;

  [[nodiscard]] float at(int x, int y) const {
    return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

// The inputs of a measurement. All planes have one size.
struct FoldPictures {
  Plane on;       // linear luminance, 1: white; finite, >= 0
  Plane off;      // the same pose without the folds
  Plane region;   // 1: a visible pixel of the region; 0: any other pixel
  Plane subject;  // 1: any surface; 0: background
  // 1: a surface that has no folds, so far from those of the region that no band reaches them
  // (kFoldReach). Optional: MeasureFolds() measures it if it takes the place of `region`.
  Plane control = {};
};

// What the coarsest band reads around a pixel, pixels.
inline constexpr int kFoldReach = 32;

struct Viewing {
  double millimetres_per_pixel = 1.0;  // at the distance of the region, > 0
  // Wavelengths that count as folds, in millimetres. Only bands with a centre in this range count.
  double shortest_mm = 0.0;
  double longest_mm = 1e6;
  double pixels_per_degree = 40.0;  // 96 pixels per inch, seen from 60 cm; > 0
};

// One band of the observer, of one picture.
struct BandVisibility {
  double sigma = 0.0;              // pixels
  double wavelength_px = 0.0;      // of the peak gain
  double cycles_per_degree = 0.0;  // of the peak gain
  double base_contrast = 0.0;      // mean C_m of the region, [0, inf)
  double threshold = 0.0;          // mean C_t of the region, a Michelson contrast
  double visibility = 0.0;         // V_b over the region, JND
};

struct FoldVisibility {
  double visibility = 0.0;  // V over the region, JND; exactly 0 if `on` equals `off`
  // V of each place: pooled over 4 square cycles, two wavelengths across, around each pixel of the
  // region. The pixels weigh like a Gaussian, and pixels outside the region do not count. JND; 0
  // outside the region. A fold that fills a large region reads less here than over the region.
  Plane places;
  std::vector<std::size_t> pixels;  // indices into places.values: the region without its rim
  std::vector<BandVisibility> bands;

  // The share of the region's pixels with at least `jnd` at their place, [0, 1]; 0 for an empty
  // region.
  [[nodiscard]] double ShareAtLeast(double jnd) const;
};

// S: 1 / the contrast threshold of a grating without masking, by the formula of Mannos and
// Sakrison, 100 * 2.6 (0.0192 + 0.114 f) exp(-(0.114 f)^1.1). f >= 0, cycles per degree.
[[nodiscard]] double ContrastSensitivity(double cycles_per_degree);

// C_t: the Michelson contrast of 1 JND over a base with `base_contrast` (>= 0) in the same band.
[[nodiscard]] double ContrastThreshold(double cycles_per_degree, double base_contrast);

// The bands with a centre in the viewing's range, finest first, with wavelength and frequency. May
// be empty.
[[nodiscard]] std::vector<BandVisibility> FoldBands(const Viewing& viewing);

// Measures the folds. An empty region has visibility 0. Errors: kInvalidArgument (planes of
// different sizes, or a viewing without a band), kNonFinite (a luminance).
[[nodiscard]] Result<FoldVisibility> MeasureFolds(const FoldPictures& pictures,
                                                  const Viewing& viewing);

}  // namespace furrow::observer
