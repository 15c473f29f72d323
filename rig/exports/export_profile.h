// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "wrinkle/rig/rig.h"

namespace furrow::rig {

// What another system calls wrinkles: its names, and the wrinkle weights that give them a value.
struct ExportProfile {
  struct Name {
    std::string name;                  // "head_wm2_normal_head_wm2_browsDown_L"
    std::vector<std::string> weights;  // "brow_l.squash"; the largest counts. Empty: none fits
  };
  std::string name;   // "metahuman"
  std::string title;  // "MetaHuman animated maps"
  std::vector<Name> names;
};

// Reads a profile (docs/ENGINES.md describes the format). The text is untrusted: at most 1 MiB,
// 4096 names and 16 weights per name. `source_name` is the file, for messages. Errors: kParse,
// kSchema (an unknown, missing or malformed field), kLimit, kUnsupported (another version), with
// file and field.
[[nodiscard]] Result<ExportProfile> ParseExportProfile(std::string_view json,
                                                       std::string_view source_name);

// The profile in a file, or the shipped profile of that name. Errors: those of ParseExportProfile()
// and ReadFile(), and kNotFound (the text lists the shipped profiles).
[[nodiscard]] Result<ExportProfile> LoadExportProfile(const std::string& name_or_file);

// All shipped profiles, in the order of their names. Errors: as above.
[[nodiscard]] Result<std::vector<ExportProfile>> ShippedExportProfiles();

// The names of a profile for one rig.
struct ExportCoverage {
  std::string profile;
  std::string title;
  // In the order of the profile. `weights` are weights of the rig; empty: the name is not covered.
  std::vector<ExportProfile::Name> names;
  std::vector<std::string> unnamed;  // weights of the rig that no name takes
  [[nodiscard]] std::size_t covered() const;
};

// Finds the rig's weights for each name. Names that the rig's own `export` lists for this profile
// take the rig's weights, and names that only the rig has follow those of the profile.
[[nodiscard]] ExportCoverage CoverExports(const wrinkle::Rig& rig, const ExportProfile& profile);

// Formats a coverage for a terminal, one name per line.
[[nodiscard]] std::string ToText(const ExportCoverage& coverage);

}  // namespace furrow::rig
