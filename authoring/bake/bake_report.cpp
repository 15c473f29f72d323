// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/bake_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace furrow::authoring {
namespace {

constexpr int kLargestPreview = 1024;
constexpr float kFewWidened = 0.05f;  // fraction of the folded texels; fewer give no warning

std::string Number(double value, int digits = 2) {
  char text[48];
  std::snprintf(text, sizeof(text), "%.*f", digits, value);
  return text;
}

// Names come from files and must not become markup.
std::string Escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '<': safe += "&lt;"; break;
      case '>': safe += "&gt;"; break;
      case '&': safe += "&amp;"; break;
      case '"': safe += "&quot;"; break;
      default: safe += c;
    }
  }
  return safe;
}

// 0 if the whole is empty.
float Share(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<float>(part) / static_cast<float>(whole) : 0.0f;
}

// Samples every `step`-th texel of a map with `colour(index)`. Texels outside triangles are grey.
character::Picture Preview(const BakedMap& map, std::string name,
                           const std::function<glm::vec3(std::size_t)>& colour) {
  const int step =
      std::max(1, (std::max(map.width, map.height) + kLargestPreview - 1) / kLargestPreview);
  character::Picture picture;
  picture.name = std::move(name);
  picture.width = map.width / step;
  picture.height = map.height / step;
  picture.channels = 3;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const std::size_t i =
          static_cast<std::size_t>(y) * step * map.width + static_cast<std::size_t>(x) * step;
      const glm::vec3 c = map.covered[i] != 0 ? colour(i) : glm::vec3(0.18f);
      for (int k = 0; k < 3; ++k) {
        const float value = std::clamp(c[k], 0.0f, 1.0f);
        picture.pixels.push_back(static_cast<std::uint8_t>(std::lround(255.0f * value)));
      }
    }
  }
  return picture;
}

// The relief as it would look on a flat surface, in the light of one lamp.
character::Picture Lit(const BakedMap& map) {
  const glm::vec3 light = glm::normalize(glm::vec3(-0.5f, 0.6f, 0.62f));
  return Preview(map, "report/" + map.map + "_lit.png", [&, light](std::size_t i) {
    const glm::vec3 n =
        glm::normalize(glm::vec3(map.derivative[2 * i], map.derivative[2 * i + 1], 1.0f));
    return glm::vec3(0.15f + 0.75f * std::max(glm::dot(n, light), 0.0f) * map.cavity[i]);
  });
}

// Blue valleys and red ridges, scaled to the largest height of this map.
character::Picture Heights(const BakedMap& map) {
  const float scale = std::max({map.statistics.deepest_mm, map.statistics.highest_mm, 1e-3f});
  return Preview(map, "report/" + map.map + "_height.png", [&, scale](std::size_t i) {
    const float h = map.height_mm[i] / scale;
    const glm::vec3 flat(0.93f);
    return h < 0.0f ? glm::mix(flat, glm::vec3(0.05f, 0.2f, 0.6f), std::min(-h, 1.0f))
                    : glm::mix(flat, glm::vec3(0.75f, 0.1f, 0.05f), std::min(h, 1.0f));
  });
}

// A distinct colour per region. Hues are a golden ratio apart.
glm::vec3 Hue(std::size_t index) {
  const float turn = std::fmod(0.61803399f * static_cast<float>(index), 1.0f);
  const auto channel = [&](float shift) {
    return std::clamp(std::abs(std::fmod(turn + shift, 1.0f) * 6.0f - 3.0f) - 1.0f, 0.0f, 1.0f);
  };
  return {channel(0.0f), channel(2.0f / 3.0f), channel(1.0f / 3.0f)};
}

// Masks are smaller than the map, so coordinates are scaled. Overlapping regions add their colours.
character::Picture Masks(const BakedMap& map) {
  return Preview(map, "report/" + map.map + "_masks.png", [&](std::size_t i) {
    glm::vec3 sum(0.05f);
    const std::size_t x = i % static_cast<std::size_t>(map.width);
    const std::size_t y = i / static_cast<std::size_t>(map.width);
    for (std::size_t m = 0; m < map.masks.size(); ++m) {
      const BakedMask& mask = map.masks[m];
      const std::size_t column = x * static_cast<std::size_t>(mask.width) / map.width;
      const std::size_t row = y * static_cast<std::size_t>(mask.height) / map.height;
      sum += mask.texels[row * static_cast<std::size_t>(mask.width) + column] * Hue(m);
    }
    return sum;
  });
}

std::string List(const char* title, std::span<const std::string> sentences) {
  if (sentences.empty()) return {};
  std::string html = "<h2>" + std::string(title) + "</h2>\n<ul>\n";
  for (const std::string& sentence : sentences) html += "<li>" + Escaped(sentence) + "</li>\n";
  return html + "</ul>\n";
}

std::string Row(const std::string& what, const std::string& value) {
  return "<tr><td>" + what + "</td><td>" + value + "</td></tr>\n";
}

std::string Statistics(const BakedMap& map, std::span<const BakePose> poses) {
  const BakedMap::Statistics& s = map.statistics;
  const auto feeds = [&](const BakePose& pose) { return pose.map == map.map; };
  const std::string wavelengths =
      Number(s.finest_mm, 1) + " to " + Number(s.coarsest_mm, 1) + " mm";
  return "<table>\n" + Row("surface", map.cloth ? "cloth" : "skin") +
         Row("poses", std::to_string(std::count_if(poses.begin(), poses.end(), feeds))) +
         Row("strokes", std::to_string(s.strokes)) +
         Row("folded",
             Number(100.0 * Share(s.folded_texels, s.covered_texels), 1) + "% of the surface") +
         Row("compression, worst triangle", Number(s.worst_compression)) +
         Row("compression, mean where folded", Number(s.mean_compression)) +
         Row("valleys", Number(s.deepest_mm) + " mm deep") +
         Row("ridges", Number(s.highest_mm) + " mm high") +
         Row("steepest slope", Number(s.steepest)) + Row("wavelength", wavelengths) +
         Row("texel size", Number(s.texel_mm) + " mm where it folds") +
         Row("overlapping", Number(100.0 * Share(s.overlapping_texels, s.covered_texels), 2) +
                                "% of the texels, where triangles overlap in the atlas") +
         "</table>\n";
}

std::string Figure(const std::string& file, const char* caption) {
  const std::string name = Escaped(file);
  return "<figure><a href=\"" + name + "\"><img src=\"" + name + "\" alt=\"" + caption +
         "\"></a><figcaption>" + caption + "</figcaption></figure>\n";
}

constexpr char kHead[] = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Wrinkle maps</title><style>
body{font:15px/1.5 system-ui,sans-serif;max-width:78rem;margin:2rem auto;padding:0 1rem;color:#222}
h2{margin-top:2.5rem} td{padding:0 1.5rem 0 0;vertical-align:top} td:first-child{color:#666}
figure{display:inline-block;margin:1rem 1rem 0 0;width:24rem} img{width:100%}
figcaption{color:#666;font-size:.9em}
</style></head><body>
)";

// Warns about what a user can change: poses, skinning or the size of the maps.
void AddMapWarnings(const BakedMap& map, const BakeOptions& options,
                    std::vector<std::string>* doubts) {
  const BakedMap::Statistics& s = map.statistics;
  const auto say = [&](const std::string& what) {
    doubts->push_back("map '" + map.map + "' " + what);
  };
  const BakeMaterial& material = MaterialOf(options, map.cloth);
  if (s.folded_texels == 0) {
    say("has no folds: its poses compress nothing and it has no strokes");
    return;
  }
  if (!map.cloth && s.worst_compression > material.max_compression) {
    say("has a compression of " + Number(s.worst_compression) + ", limited to " +
        Number(material.max_compression) + ": check the skinning there");
  }
  if (Share(s.widened_texels, s.folded_texels) > kFewWidened) {
    say("has folds that are widened from " + Number(s.widened_from_mm, 1) + " to " +
        Number(s.widened_to_mm, 1) + " mm, " + Number(kTexelsPerWave, 0) + " texels: raise --size");
  }
}

}  // namespace

std::vector<std::string> BakeWarnings(const BakedMaps& maps, const BakeOptions& options) {
  std::vector<std::string> doubts;
  for (const BakedMap& map : maps.maps) AddMapWarnings(map, options, &doubts);
  return doubts;
}

std::vector<character::Picture> ReportPictures(const BakedMaps& maps) {
  std::vector<character::Picture> pictures;
  for (const BakedMap& map : maps.maps) {
    pictures.push_back(Lit(map));
    pictures.push_back(Heights(map));
    pictures.push_back(Masks(map));
  }
  return pictures;
}

std::string ReportHtml(const BakedMaps& maps, const ReportDetails& facts) {
  std::string html = kHead;
  html += "<h1>Wrinkle maps of " + Escaped(facts.character) + "</h1>\n<p>Rig " +
          Escaped(facts.rig) +
          (facts.strokes.empty() ? ", no strokes" : ", strokes " + Escaped(facts.strokes)) + ", " +
          std::to_string(facts.options.size) + " texels per side, depth " +
          Number(facts.options.depth) + "; baked in " + Number(facts.seconds, 1) + " s.</p>\n";
  const std::vector<std::string> doubts = BakeWarnings(maps, facts.options);
  html += List("Check", doubts) + List("Warnings", facts.warnings) + List("Not baked", facts.notes);
  for (const BakedMap& map : maps.maps) {
    const std::string stem = "report/" + map.map;
    html += "<h2>" + Escaped(map.map) + "</h2>\n" + Statistics(map, facts.poses) +
            Figure(stem + "_lit.png", "relief, lit from the upper left") +
            Figure(stem + "_height.png", "height: blue valleys, red ridges") +
            Figure(stem + "_masks.png", "suggested masks");
    html += "<p>";
    for (std::size_t m = 0; m < map.masks.size(); ++m) {
      const glm::vec3 c = 255.0f * Hue(m);
      html += "<span style=\"color:rgb(" + Number(c.r, 0) + "," + Number(c.g, 0) + "," +
              Number(c.b, 0) + ")\">&#9632;</span> " + Escaped(map.masks[m].region) + " ";
    }
    html += "</p>\n";
  }
  return html + "</body></html>\n";
}

}  // namespace furrow::authoring
