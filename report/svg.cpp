// SPDX-License-Identifier: Apache-2.0
#include "report/svg.h"

#include <iterator>

#include "report/table.h"

namespace furrow::report::svg {
namespace {

constexpr const char* kColours[] = {"#2f6f9f", "#c8793a", "#5d8a4a", "#8a5a9a"};

// Titles and names may contain markup. Text is never used in an attribute, so quotes may stay.
std::string Escape(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&') {
      escaped += "&amp;";
    } else if (c == '<') {
      escaped += "&lt;";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

// An attribute value with one decimal, a tenth of a pixel.
std::string Number(double value) { return "\"" + Fixed(value, 1) + "\""; }

}  // namespace

std::string Text(double x, double y, const std::string& anchor, const std::string& text) {
  return "<text x=" + Number(x) + " y=" + Number(y) + " text-anchor=\"" + anchor + "\">" +
         Escape(text) + "</text>\n";
}

std::string Rect(double x, double y, double width, double height, const char* colour) {
  return "<rect x=" + Number(x) + " y=" + Number(y) + " width=" + Number(width) +
         " height=" + Number(height) + " fill=\"" + colour + "\"/>\n";
}

std::string Line(double x1, double y1, double x2, double y2, const char* colour) {
  return "<line x1=" + Number(x1) + " y1=" + Number(y1) + " x2=" + Number(x2) +
         " y2=" + Number(y2) + " stroke=\"" + colour + "\"/>\n";
}

std::string Polyline(const std::vector<std::pair<double, double>>& points, const char* colour) {
  std::string svg = "<polyline fill=\"none\" stroke-width=\"1.5\" stroke=\"";
  svg += colour + std::string("\" points=\"");
  for (const auto& [x, y] : points) svg += Fixed(x, 1) + "," + Fixed(y, 1) + " ";
  return svg + "\"/>\n";
}

std::string Document(double width, double height, const std::string& body) {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + Fixed(width, 0) + "\" height=\"" +
         Fixed(height, 0) + "\" font-family=\"sans-serif\" font-size=\"12\">\n" +
         "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n" + body + "</svg>\n";
}

const char* Colour(std::size_t series) { return kColours[series % std::size(kColours)]; }

std::string Short(double value) { return Fixed(value, value < 1.0 ? 3 : (value < 100.0 ? 1 : 0)); }

}  // namespace furrow::report::svg
