// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

// The SVG elements of charts. Lengths in pixels, y downwards.
namespace furrow::report::svg {

// `anchor`: start, middle or end.
[[nodiscard]] std::string Text(double x, double y, const std::string& anchor,
                               const std::string& text);
[[nodiscard]] std::string Rect(double x, double y, double width, double height, const char* colour);
[[nodiscard]] std::string Line(double x1, double y1, double x2, double y2, const char* colour);
[[nodiscard]] std::string Polyline(const std::vector<std::pair<double, double>>& points,
                                   const char* colour);

// Returns a complete picture with a white background.
[[nodiscard]] std::string Document(double width, double height, const std::string& body);

// Colour of a series, by its index. Colours repeat after four series.
[[nodiscard]] const char* Colour(std::size_t series);

// Formats a number with about three significant digits.
[[nodiscard]] std::string Short(double value);

}  // namespace furrow::report::svg
