// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/character_report.h"

#include <cstdio>

#include <nlohmann/json.hpp>

namespace furrow::authoring {
namespace {

std::string RolesLine(const CharacterReport& report) {
  if (report.joints.num_roles == 0) return "joints:  " + Describe(report.joints) + "\n";
  return "joints:  " + Describe(report.joints) + ", " + std::to_string(report.face_joints) +
         " face joints\n";
}

}  // namespace

std::string ToText(const CharacterReport& report) {
  std::string text = "character '" + report.name + "'\n";
  text += "counts: ";
  for (const auto& [what, count] : report.counts) {
    text += " " + std::to_string(count) + " " + what +
            (what == report.counts.back().first ? "\n" : ",");
  }
  char space[128];
  std::snprintf(space, sizeof space, "stands:  %.2f m high%s%s\n",
                static_cast<double>(report.space.height), report.space.axes.empty() ? "" : ", ",
                report.space.axes.c_str());
  text += space + RolesLine(report);
  for (const Finding& finding : report.findings) {
    text += std::string(ToString(finding.severity)) + ": " +
            (finding.where.empty() ? "" : finding.where + ": ") + finding.what +
            (finding.todo.empty() ? "" : " (" + finding.todo + ")") + " [" + finding.code + "]\n";
  }
  text += std::to_string(report.Count(Severity::kError)) + " errors, " +
          std::to_string(report.Count(Severity::kWarning)) + " warnings, " +
          std::to_string(report.Count(Severity::kNote)) + " notes\n";
  return text;
}

std::string ToJson(const CharacterReport& report) {
  using Json = nlohmann::ordered_json;
  Json root;
  root["name"] = report.name;
  for (const auto& [what, count] : report.counts) root["counts"][what] = count;
  root["height"] = report.space.height;
  root["axes"] = report.space.axes;
  root["scale"] = report.space.scale;
  root["skeleton_map"] = report.joints.map;
  root["face_joints"] = report.face_joints;
  root["roles"] = report.joints.num_roles;
  root["findings"] = Json::array();
  for (const Finding& finding : report.findings) {
    root["findings"].push_back({{"severity", ToString(finding.severity)},
                                {"code", finding.code},
                                {"where", finding.where},
                                {"what", finding.what},
                                {"todo", finding.todo}});
  }
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace furrow::authoring
