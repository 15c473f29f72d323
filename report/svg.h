// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

// Functions that return the SVG elements of charts. Lengths are in pixels; y points down. Colours
// are CSS colours such as "#2f6f9f".
namespace furrow::report::svg {

// A line of text at the baseline point (x, y). `anchor`: the end of the text that lies at x,
// "start", "middle" or "end". '&' and '<' in `text` are escaped.
[[nodiscard]] std::string Text(double x, double y, const std::string& anchor,
                               const std::string& text);
// A filled rectangle with its upper left corner at (x, y).
[[nodiscard]] std::string Rect(double x, double y, double width, double height, const char* colour);
// A line from (x1, y1) to (x2, y2), 1 pixel wide.
[[nodiscard]] std::string Line(double x1, double y1, double x2, double y2, const char* colour);
// A line through `points`, 1.5 pixels wide.
[[nodiscard]] std::string Polyline(const std::vector<std::pair<double, double>>& points,
                                   const char* colour);

// A complete picture with a white background. `body`: its elements, concatenated.
[[nodiscard]] std::string Document(double width, double height, const std::string& body);

// The colour of the series with this index. Colours repeat after four series.
[[nodiscard]] const char* Colour(std::size_t series);

// Formats a number: 3 decimals below 1, 1 decimal below 100, none above.
[[nodiscard]] std::string Short(double value);

}  // namespace furrow::report::svg
