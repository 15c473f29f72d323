// SPDX-License-Identifier: Apache-2.0
#include "client/cli/output/explanation_text.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

namespace furrow::cli {
namespace {

using wrinkle::Explanation;

// "knee_l" of "knee_l.flexed".
std::string_view DriverOf(std::string_view driver_value) {
  return driver_value.substr(0, driver_value.rfind('.'));
}

// "      browDownLeft 0.80, browDownRight 0.70 and 2 more": the blend shapes that a driver reads,
// strongest first.
void PrintShapes(const Explanation& explanation, std::string_view driver, std::FILE* out) {
  constexpr std::size_t kMost = 6;
  constexpr float kLeast = 0.005f;  // 0.00 when printed
  std::vector<const Explanation::Shape*> shapes = explanation.ShapesOf(driver);
  std::erase_if(shapes, [](const auto* shape) { return std::abs(shape->coefficient) < kLeast; });
  if (shapes.empty()) return;
  std::fprintf(out, "      ");
  for (std::size_t i = 0; i < std::min(shapes.size(), kMost); ++i) {
    std::fprintf(out, "%s%s %.2f", i == 0 ? "" : ", ", shapes[i]->blend_shape.c_str(),
                 double{shapes[i]->coefficient});
  }
  if (shapes.size() > kMost) std::fprintf(out, " and %zu more", shapes.size() - kMost);
  std::fputc('\n', out);
}

// How the driver came to its value. At most one of the first three lists has entries for a driver.
void PrintGeometry(const Explanation& explanation, std::string_view driver_value, std::FILE* out) {
  for (const auto& pose : explanation.pose_values) {
    if (pose.driver_value != driver_value) continue;
    std::fprintf(out, "      moved %.4g of %.4g; %.3f along the path, %.4g off the path",
                 double{pose.moved}, double{pose.displacement}, double{pose.along},
                 double{pose.perpendicular});
    if (pose.falloff != 1.0f) std::fprintf(out, ", falloff %.3f", double{pose.falloff});
    std::fputc('\n', out);
  }
  for (const auto& angle : explanation.angles) {
    if (angle.driver != DriverOf(driver_value)) continue;
    std::fprintf(out, "      %s %.1f degrees\n", angle.what.c_str(), double{angle.degrees});
  }
  for (const auto& strain : explanation.strains) {
    if (strain.driver != DriverOf(driver_value)) continue;
    std::fprintf(out, "      compressed to %.3f at %.1f degrees, %.3f across\n",
                 double{strain.smallest}, double{strain.degrees}, double{strain.largest});
  }
  PrintShapes(explanation, DriverOf(driver_value), out);
}

void PrintWeight(const Explanation& explanation, const Explanation::Weight& weight,
                 std::FILE* out) {
  std::fprintf(out, "%-28s %.3f  = combined %.3f, modulated %.3f (%.*s)\n", weight.name.c_str(),
               double{weight.result}, double{weight.combined}, double{weight.modulated},
               static_cast<int>(weight.modulation.size()), weight.modulation.data());
  for (const auto& part : weight.contributions) {
    std::fprintf(out, "    %-26s %.3f", part.driver_value.c_str(), double{part.value});
    if (part.modulated != part.value) std::fprintf(out, " modulated %.3f", double{part.modulated});
    std::fprintf(out, " x %.2f\n", double{part.gain});
    if (part.value > 0.0f) PrintGeometry(explanation, part.driver_value, out);
  }
  for (const auto& conflict : weight.conflicts) {
    // A factor of 1 changes nothing.
    if (conflict.factor == 1.0f) continue;
    std::fprintf(out, "    conflict with %s (%.3f): x %.3f\n", conflict.weight.c_str(),
                 double{conflict.other}, double{conflict.factor});
  }
}

}  // namespace

void PrintExplanation(const Explanation& explanation, float threshold, std::FILE* out) {
  std::vector<const Explanation::Weight*> order;
  for (const auto& weight : explanation.weights) {
    if (weight.result >= threshold) order.push_back(&weight);
  }
  // Equal weights stay in the order of the rig.
  std::stable_sort(order.begin(), order.end(),
                   [](const auto* a, const auto* b) { return a->result > b->result; });
  for (const auto* weight : order) PrintWeight(explanation, *weight, out);
  std::fprintf(out, "%zu more below %.3f\n", explanation.weights.size() - order.size(),
               double{threshold});
}

}  // namespace furrow::cli
