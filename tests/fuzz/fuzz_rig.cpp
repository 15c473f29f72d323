// SPDX-License-Identifier: Apache-2.0
// Wrinkle rigs: an accepted rig passes all checks again after it was written and read back.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "character/package/rig_report.h"
#include "rig/rig_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto rig = rig::ParseRig(text, "fuzz.json", "no/such/folder");
  if (!rig.ok()) {
    if (!rig.status().where().starts_with("fuzz.json:")) std::abort();
    return 0;
  }
  const std::string written = rig::RigToJson(*rig);
  const auto again = rig::ParseRig(written, "written.json", "no/such/folder");
  if (!again.ok() || rig::RigToJson(*again) != written) std::abort();
  if (character::ReportOnRig(*rig).name != rig->name) std::abort();
  return 0;
}
