// SPDX-License-Identifier: Apache-2.0
// Export profiles: an accepted profile has unique names within the limits, and covers any rig.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>
#include <string_view>

#include "rig/exports/export_profile.h"
#include "rig/rig_check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto profile = rig::ParseExportProfile(text, "fuzz.json");
  if (!profile.ok()) {
    if (!profile.status().where().starts_with("fuzz.json")) std::abort();
    return 0;
  }
  if (profile->names.size() > rig::kMaxExports) std::abort();
  std::set<std::string> names;
  for (const rig::ExportProfile::Name& name : profile->names) {
    if (name.name.empty() || !names.insert(name.name).second) std::abort();
  }
  const rig::ExportCoverage coverage = rig::CoverExports({}, *profile);
  if (coverage.covered() != 0 || coverage.names.size() != profile->names.size()) std::abort();
  return 0;
}
