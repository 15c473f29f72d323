// SPDX-License-Identifier: Apache-2.0
#include "character/package/rig_report.h"

#include <algorithm>
#include <set>

#include "base/asset_path.h"
#include "base/text.h"
#include "character/package/package.h"
#include "wrinkle/rig/driver_values.h"
#include "wrinkle/rig/rig_joints.h"
#include "wrinkle/skeleton/retarget.h"
#include "wrinkle/solver/solver.h"

namespace furrow::character {
namespace {

using wrinkle::Driver;
using wrinkle::Rig;
using wrinkle::Skeleton;

std::string Quoted(const std::string& name) { return "'" + name + "'"; }

void Count(const Rig& rig, RigReport* report) {
  for (const wrinkle::Region& region : rig.regions) {
    for (const wrinkle::Feed& feed : region.feeds) {
      report->weight_names.push_back(region.name + "." + feed.map);
    }
  }
  for (const Driver& driver : rig.drivers) {
    for (const std::string& value : wrinkle::DriverValueNames(driver)) {
      report->driver_value_names.push_back(driver.name + "." + value);
    }
  }
  report->counts = {{"reference poses", rig.reference_poses.size()},
                    {"drivers", rig.drivers.size()},
                    {"driver values", report->driver_value_names.size()},
                    {"regions", rig.regions.size()},
                    {"wrinkle maps", rig.wrinkle_maps.size()},
                    {"wrinkle weights", report->weight_names.size()},
                    {"exported names", rig.exports.size()}};
}

// Warns about parts of the rig that nothing uses.
void WarnOfUnused(const Rig& rig, std::vector<std::string>* warnings) {
  std::set<std::string> poses, drivers, maps;
  for (const Driver& driver : rig.drivers) {
    for (const auto& value : driver.pose.values) poses.insert(value.reference_pose);
  }
  for (const wrinkle::Region& region : rig.regions) {
    for (const wrinkle::Feed& feed : region.feeds) {
      maps.insert(feed.map);
      for (const auto& source : feed.sources) drivers.insert(source.driver);
    }
  }
  for (const auto& pose : rig.reference_poses) {
    if (pose.name == wrinkle::kClothesFitPose) continue;  // for the bake
    if (poses.count(pose.name) == 0) {
      warnings->push_back("no driver uses reference pose " + Quoted(pose.name));
    } else if (pose.joints.empty()) {
      warnings->push_back("reference pose " + Quoted(pose.name) + " moves no joint");
    }
  }
  for (const Driver& driver : rig.drivers) {
    if (drivers.count(driver.name) == 0) {
      warnings->push_back("driver " + Quoted(driver.name) + " feeds no region");
    }
  }
  for (const auto& map : rig.wrinkle_maps) {
    if (maps.count(map.name) == 0) {
      warnings->push_back("no region uses wrinkle map " + Quoted(map.name));
    }
  }
}

void WarnOfPictures(const Rig& rig, const RigReportOptions& options,
                    std::vector<std::string>* warnings) {
  const auto& embedded = options.embedded_pictures;
  for (const std::string& name : RigPictureNames(rig)) {
    if (std::find(embedded.begin(), embedded.end(), name) != embedded.end()) continue;
    if (FindAsset(name, options.folder).ok()) continue;
    warnings->push_back("picture " + Quoted(name) +
                        " is not a file here: it must be inside the character, or what needs it is "
                        "not drawn");
  }
}

void TryBinding(const Rig& rig, const RigReportOptions& options, RigReport* report) {
  report->skeleton_size = wrinkle::SkeletonSize(*options.skeleton);
  const auto bind = [&](bool allow_missing) {
    wrinkle::BindOptions how;
    how.allow_missing = allow_missing;
    how.aliases = options.aliases;
    how.role_chains = options.role_chains;
    how.turn = options.turn;
    return wrinkle::RigBinding::Create(rig, *options.skeleton, options.blend_shape_names, how);
  };
  // Strict first, to say whether the rig fits. Lenient second, to list everything that is missing
  // at once.
  report->binding = bind(false).status();
  const auto lenient = bind(true);
  if (!lenient.ok()) return;
  for (const std::string& joint : lenient->missing_joints()) {
    report->warnings.push_back("the skeleton has no joint " + Quoted(joint) +
                               ": drivers that need it rest at 0");
  }
  for (const std::string& shape : lenient->missing_blend_shapes()) {
    report->warnings.push_back("no blend shape " + Quoted(shape) + " comes with the skeleton");
  }
  report->warnings.insert(report->warnings.end(), lenient->warnings().begin(),
                          lenient->warnings().end());
}

}  // namespace

RigReport ReportOnRig(const Rig& rig, const RigReportOptions& options) {
  RigReport report;
  report.name = rig.name;
  Count(rig, &report);
  WarnOfUnused(rig, &report.warnings);
  WarnOfPictures(rig, options, &report.warnings);
  if (options.skeleton != nullptr) {
    TryBinding(rig, options, &report);
  } else if (std::string warning = wrinkle::WarningOfModelSpace(rig); !warning.empty()) {
    report.warnings.push_back(std::move(warning));  // binding would say so
  }
  return report;
}

std::string ToText(const RigReport& report) {
  std::string text = "rig " + Quoted(report.name) + "\n";
  for (const auto& [what, count] : report.counts) {
    text += "  " + std::to_string(count) + " " + what + "\n";
  }
  const auto list = [&](const char* title, const std::vector<std::string>& names) {
    if (names.empty()) return;
    text += std::string(title) + ":\n";
    for (const std::string& name : names) text += "  " + name + "\n";
  };
  list("driver values", report.driver_value_names);
  list("wrinkle weights", report.weight_names);
  if (report.skeleton_size > 0.0f) {
    text += "skeleton size: " + std::to_string(report.skeleton_size) + "\n";
    text += report.binding.ok() ? "binds to the skeleton\n"
                                : "does not bind: " + report.binding.ToString() + "\n";
  }
  list("warnings", report.warnings);
  return text;
}

}  // namespace furrow::character
