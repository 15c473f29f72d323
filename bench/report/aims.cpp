// SPDX-License-Identifier: Apache-2.0
#include "bench/report/aims.h"

#include <utility>

#include <nlohmann/json.hpp>

#include "report/table.h"

namespace furrow::bench {

std::string Between(double median, double low, double high, int digits) {
  return report::Fixed(median, digits) + " (" + report::Fixed(low, digits) + " to " +
         report::Fixed(high, digits) + ")";
}

std::string ToMarkdown(const std::vector<Aim>& aims, const std::string& control,
                       const std::string& title) {
  report::Table table{title, {"figure", "against", "reached (middle half)"}, {}};
  if (!control.empty()) table.header.push_back(control);
  table.header.insert(table.header.end(), {"aim", "met"});
  for (const Aim& aim : aims) {
    std::vector<std::string> row{aim.what, aim.baseline, aim.reached};
    if (!control.empty()) row.push_back(aim.control);
    row.insert(row.end(), {aim.aim, aim.met ? "yes" : "no"});
    table.rows.push_back(std::move(row));
  }
  return report::ToMarkdown(table);
}

nlohmann::json ToJson(const std::vector<Aim>& aims) {
  nlohmann::json json = nlohmann::json::array();
  for (const Aim& aim : aims) {
    json.push_back({{"figure", aim.what},
                    {"against", aim.baseline},
                    {"reached", aim.reached},
                    {"control", aim.control},
                    {"aim", aim.aim},
                    {"met", aim.met}});
  }
  return json;
}

Result<std::vector<Aim>> AimsFromJson(const nlohmann::json& json) {
  std::vector<Aim> aims;
  try {
    for (const nlohmann::json& aim : json) {
      aims.push_back({.what = aim.at("figure"),
                      .baseline = aim.at("against"),
                      .reached = aim.at("reached"),
                      .control = aim.at("control"),
                      .aim = aim.at("aim"),
                      .met = aim.at("met")});
    }
  } catch (const nlohmann::json::exception& error) {
    return Status(StatusCode::kInvalidArgument, std::string("not a list of aims: ") + error.what());
  }
  return aims;
}

}  // namespace furrow::bench
