// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/weights/modulation_curve.h"

#include <algorithm>
#include <cmath>

#include "base/scalar.h"
#include "wrinkle/rig/driver_values.h"

namespace furrow::wrinkle {
namespace {

// The steps between neighbouring points: width and slope of the chord.
struct Chord {
  double width = 0.0;
  double slope = 0.0;
};

// The slope at the first point, where `first` begins: that of the parabola through three points,
// limited such that the curve does not turn back before the second point. The last point is the
// mirror image.
double EndSlope(const Chord& first, const Chord& second) {
  const double slope = ((2.0 * first.width + second.width) * first.slope -  //
                        first.width * second.slope) /
                       (first.width + second.width);
  if (slope * first.slope <= 0.0) return 0.0;
  const bool turns = first.slope * second.slope < 0.0;
  if (turns && std::abs(slope) > 3.0 * std::abs(first.slope)) return 3.0 * first.slope;
  return slope;
}

// The weighted harmonic mean of the slopes on both sides; 0 at a peak, a valley or a level piece.
double InnerSlope(const Chord& before, const Chord& after) {
  if (before.slope * after.slope <= 0.0) return 0.0;
  const double w_before = before.width + 2.0 * after.width;
  const double w_after = 2.0 * before.width + after.width;
  return (w_before + w_after) / (w_before / before.slope + w_after / after.slope);
}

std::vector<Chord> ChordsOf(std::span<const CurvePoint> points) {
  std::vector<Chord> chords;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double width = double{points[i + 1].x} - double{points[i].x};
    chords.push_back({width, (double{points[i + 1].y} - double{points[i].y}) / width});
  }
  return chords;
}

double SlopeAt(std::span<const Chord> chords, std::size_t point) {
  const std::size_t last = chords.size();
  if (last == 1) return chords[0].slope;
  if (point == 0) return EndSlope(chords[0], chords[1]);
  if (point == last) return EndSlope(chords[last - 1], chords[last - 2]);
  return InnerSlope(chords[point - 1], chords[point]);
}

// Points closer than this are one point: where a value is clamped, several angles give the same.
constexpr float kSameValue = 1e-4f;

// The mean of values weighted by gain is the value, if all sources agree, and kSumModulated
// modulates each value by itself.
float GainOf(const Region& region, const Feed::Source& source) {
  return region.combine == Combine::kMax || region.combine == Combine::kSum ? source.gain : 1.0f;
}

std::vector<CurvePoint> ValuesOfAngles(const Rig& rig, const Region& region, const Feed& feed) {
  const Feed::Source& source = feed.sources.front();
  const auto driver = std::ranges::find(rig.drivers, source.driver, &Driver::name);
  if (driver == rig.drivers.end()) return {};
  std::vector<CurvePoint> points;
  for (const CurvePoint& point : feed.angles) {
    const float value = DriverValueAtAngle(*driver, source.value, point.x).value_or(0.0f);
    points.push_back({Saturate(GainOf(region, source) * value), point.y});
  }
  // "extended" falls with the angle.
  if (points.front().x > points.back().x) std::ranges::reverse(points);
  // Of points at one value, which is clamped there, the one nearest to the range that moves counts:
  // the last at 0, and the first at 1.
  std::vector<CurvePoint> rising;
  for (const CurvePoint& point : points) {
    if (!rising.empty() && point.x - rising.back().x <= kSameValue) {
      if (point.x <= kSameValue) rising.back().y = point.y;
      continue;
    }
    rising.push_back(point);
  }
  // A curve has at least two points.
  if (rising.size() == 1) rising.push_back({rising[0].x + 1.0f, rising[0].y});
  return rising;
}

}  // namespace

FeedModulation ModulationOf(const Rig& rig, const Region& region, const Feed& feed) {
  if (!feed.angles.empty()) return {.curve = ValuesOfAngles(rig, region, feed)};
  if (!feed.curve.empty()) return {.curve = feed.curve};
  if (feed.modulation) return {.modulation = *feed.modulation, .curve = {}};
  return {.modulation = region.modulation, .curve = region.curve};
}

std::string_view ModulationName(const FeedModulation& modulation) {
  if (!modulation.curve.empty()) return "curve";
  switch (modulation.modulation) {
    case Modulation::kLinear: return "linear";
    case Modulation::kCosine: return "cosine";
    case Modulation::kCubic: return "cubic";
  }
  return "";
}

std::vector<CurvePiece> CurvePieces(std::span<const CurvePoint> points) {
  std::vector<CurvePiece> pieces;
  if (points.empty()) return pieces;
  if (points.front().x > 0.0f) pieces.push_back({.from = 0.0f, .c = {points.front().y}});
  const std::vector<Chord> chords = ChordsOf(points);
  for (std::size_t i = 0; i < chords.size(); ++i) {
    const auto [width, slope] = chords[i];
    const double begin = SlopeAt(chords, i);
    const double end = SlopeAt(chords, i + 1);
    // Hermite's cubic in powers of t.
    pieces.push_back({.from = points[i].x,
                      .c = {points[i].y, static_cast<float>(begin),
                            static_cast<float>((3.0 * slope - 2.0 * begin - end) / width),
                            static_cast<float>((begin + end - 2.0 * slope) / (width * width))}});
  }
  pieces.push_back({.from = points.back().x, .c = {points.back().y}});
  return pieces;
}

}  // namespace furrow::wrinkle
