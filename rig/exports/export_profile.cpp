// SPDX-License-Identifier: Apache-2.0
#include "rig/exports/export_profile.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/data_dir.h"
#include "base/files.h"
#include "base/joined.h"
#include "base/text.h"
#include "rig/json/map_file.h"
#include "rig/rig_check.h"
#include "rig/shipped_maps.h"
#include "wrinkle/fields/field_check.h"

namespace furrow::rig {
namespace {

using Json = nlohmann::ordered_json;  // names keep the order of the file

constexpr const char* kFolder = "export_profiles";
constexpr std::size_t kMaxWeights = 16;  // of one name
constexpr std::size_t kMaxText = 255;

// Reads one file. Every error names the file and the field.
class ProfileReader : private MapErrors {
 public:
  using MapErrors::MapErrors;

  Status Read(const Json& root, ExportProfile* profile) {
    FURROW_RETURN_IF_ERROR(CheckRoot(root, "names", {"title", "sides"}));
    FURROW_RETURN_IF_ERROR(ReadText(root["name"], "name", &profile->name));
    if (root.contains("title")) {
      FURROW_RETURN_IF_ERROR(ReadText(root["title"], "title", &profile->title));
    }
    FURROW_RETURN_IF_ERROR(ReadSides(root));
    const Json& names = root["names"];
    if (!names.is_object() || names.empty()) {
      return Error("names", "expected an object with one field per name");
    }
    for (const auto& [key, value] : names.items()) {
      FURROW_RETURN_IF_ERROR(ReadName(key, value, profile));
    }
    return {};
  }

 private:
  Status ReadText(const Json& value, const std::string& field, std::string* text) const {
    if (!value.is_string()) return Error(field, "expected a string");
    *text = value.get<std::string>();
    if (text->empty()) return Error(field, "is empty");
    if (text->size() > kMaxText) {
      return Error(field, "is longer than 255 bytes", StatusCode::kLimit);
    }
    return CheckPrintable(*text, field);
  }

  // Names are printed in a terminal.
  Status CheckPrintable(const std::string& text, const std::string& field) const {
    if (wrinkle::CheckLabel(text, field).ok()) return {};
    return Error(field, "holds a control byte");
  }

  Status ReadSides(const Json& root) {
    if (!root.contains("sides")) return {};
    const Json& sides = root["sides"];
    if (!sides.is_object() || sides.size() != 2 || !sides.contains("left") ||
        !sides.contains("right")) {
      return Error("sides", "expected {\"left\": ..., \"right\": ...}");
    }
    FURROW_RETURN_IF_ERROR(ReadText(sides["left"], "sides.left", &left_));
    FURROW_RETURN_IF_ERROR(ReadText(sides["right"], "sides.right", &right_));
    if (left_ == right_) return Error("sides", "left and right must differ");
    return {};
  }

  // "browsDown_*" stands for the name on both sides, and '*' in its weights for "l" and "r".
  Status ReadName(const std::string& key, const Json& value, ExportProfile* profile) {
    const std::string field = "names." + Quoted(key);
    if (key.find('*') == std::string::npos) return AddName(key, value, "", field, profile);
    if (left_.empty()) return Error(field, "a '*' in a name requires \"sides\"");
    FURROW_RETURN_IF_ERROR(AddName(WithSide(key, left_), value, "l", field, profile));
    return AddName(WithSide(key, right_), value, "r", field, profile);
  }

  Status AddName(const std::string& name, const Json& value, const std::string& side,
                 const std::string& field, ExportProfile* profile) {
    if (name.empty() || name.size() > kMaxText)
      return Error(field, "the name is empty or too long");
    FURROW_RETURN_IF_ERROR(CheckPrintable(name, field));
    if (!seen_.insert(name).second) return Error(field, "duplicate name " + Quoted(name));
    if (profile->names.size() == kMaxExports) {
      return Error("names", "has more than 4096 names", StatusCode::kLimit);
    }
    ExportProfile::Name entry{name, {}};
    if (!value.is_array()) {
      FURROW_RETURN_IF_ERROR(AddWeight(value, side, field, &entry));
    } else if (value.size() > kMaxWeights) {
      return Error(field, "has more than 16 weights", StatusCode::kLimit);
    } else {
      for (const Json& item : value) {
        FURROW_RETURN_IF_ERROR(AddWeight(item, side, field, &entry));
      }
    }
    profile->names.push_back(std::move(entry));
    return {};
  }

  Status AddWeight(const Json& value, const std::string& side, const std::string& field,
                   ExportProfile::Name* entry) const {
    std::string text;
    FURROW_RETURN_IF_ERROR(ReadText(value, field, &text));
    if (text.find('*') != std::string::npos && side.empty()) {
      return Error(field, "a '*' in a weight requires a '*' in its name");
    }
    entry->weights.push_back(WithSide(text, side));
    return {};
  }

  std::string left_;
  std::string right_;
  std::set<std::string> seen_;
};

Result<ExportProfile> ReadProfileFile(const std::filesystem::path& file) {
  const auto text = ReadFile(file, kMaxMapBytes);
  FURROW_RETURN_IF_ERROR(text);
  return ParseExportProfile(*text, file.string());
}

// "arkit, metahuman", for messages; empty if the data is missing.
std::string ListProfiles() {
  const auto files = ListDataFiles(kFolder, ".json");
  if (!files.ok()) return {};
  return Joined(*files, [](const auto& file) { return file.stem().string(); });
}

}  // namespace

Result<ExportProfile> ParseExportProfile(std::string_view json, std::string_view source_name) {
  Json root;
  FURROW_RETURN_IF_ERROR(ParseMapText(json, source_name, &root));
  ExportProfile profile;
  FURROW_RETURN_IF_ERROR(ProfileReader(source_name).Read(root, &profile));
  return profile;
}

Result<ExportProfile> LoadExportProfile(const std::string& name_or_file) {
  const auto file = FindMap(kFolder, name_or_file);
  if (!file.ok()) {
    return Status(StatusCode::kNotFound, "there is no export profile '" + name_or_file + "'", "",
                  "shipped profiles: " + ListProfiles() + "; or name a file");
  }
  return ReadProfileFile(*file);
}

Result<std::vector<ExportProfile>> ShippedExportProfiles() {
  const auto files = ListDataFiles(kFolder, ".json");
  FURROW_RETURN_IF_ERROR(files);
  std::vector<ExportProfile> profiles;
  for (const auto& file : *files) {
    auto profile = ReadProfileFile(file);
    FURROW_RETURN_IF_ERROR(profile);
    profiles.push_back(std::move(*profile));
  }
  return profiles;
}

std::size_t ExportCoverage::covered() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      names, [](const ExportProfile::Name& name) { return !name.weights.empty(); }));
}

ExportCoverage CoverExports(const wrinkle::Rig& rig, const ExportProfile& profile) {
  ExportCoverage coverage{profile.name, profile.title, {}, {}};
  std::vector<std::string> weights;
  for (const wrinkle::Region& region : rig.regions) {
    for (const wrinkle::Feed& feed : region.feeds) {
      weights.push_back(region.name + "." + feed.map);
    }
  }
  const auto own = [&](const std::string& name) {
    std::vector<std::string> found;
    for (const wrinkle::Export& entry : rig.exports) {
      if (entry.profile == profile.name && entry.name == name) found.push_back(entry.weight);
    }
    return found;
  };
  std::set<std::string> listed;
  for (const ExportProfile::Name& name : profile.names) {
    ExportProfile::Name entry{name.name, own(name.name)};
    if (entry.weights.empty()) entry.weights = name.weights;
    std::erase_if(entry.weights, [&](const std::string& weight) {
      return std::ranges::find(weights, weight) == weights.end();
    });
    listed.insert(name.name);
    coverage.names.push_back(std::move(entry));
  }
  for (const wrinkle::Export& entry : rig.exports) {
    if (entry.profile != profile.name || !listed.insert(entry.name).second) continue;
    coverage.names.push_back({entry.name, own(entry.name)});
  }
  std::set<std::string> used;
  for (const ExportProfile::Name& name : coverage.names) {
    used.insert(name.weights.begin(), name.weights.end());
  }
  std::ranges::copy_if(weights, std::back_inserter(coverage.unnamed),
                       [&](const std::string& weight) { return !used.contains(weight); });
  return coverage;
}

std::string ToText(const ExportCoverage& coverage) {
  std::string text = "export profile '" + coverage.profile + "'";
  if (!coverage.title.empty()) text += ", " + coverage.title;
  text += ": " + std::to_string(coverage.covered()) + " of " +
          Counted(coverage.names.size(), "name") + " covered\n";
  for (const ExportProfile::Name& name : coverage.names) {
    if (name.weights.empty()) continue;
    text += "  " + name.name + " <-";
    for (const std::string& weight : name.weights) text += " " + weight;
    text += "\n";
  }
  const auto list = [&](const char* title, const auto& names, const auto& has) {
    std::string lines;
    for (const auto& name : names) {
      if (const std::string line = has(name); !line.empty()) lines += "  " + line + "\n";
    }
    if (!lines.empty()) text += std::string(title) + ":\n" + lines;
  };
  list("names without a weight", coverage.names, [](const ExportProfile::Name& name) {
    return name.weights.empty() ? name.name : std::string();
  });
  list("weights without a name", coverage.unnamed, [](const std::string& name) { return name; });
  return text;
}

}  // namespace furrow::rig
