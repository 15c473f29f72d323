// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "protocol/mocap/osc_out.h"

namespace furrow::server {

// Reads a profile: the name of a shipped one (share/furrow/osc/NAME.toml), or a file, which has a
// slash in its name or ends with ".toml". Errors: kNotFound, with the names of the shipped
// profiles; kIo; those of ParseOscProfile().
[[nodiscard]] Result<protocol::mocap::OscProfile> LoadOscProfile(const std::string& name);
// True if `name` is that of a shipped profile and not a file.
[[nodiscard]] bool IsShippedOscProfile(const std::string& name);
// The names of the shipped profiles, sorted.
[[nodiscard]] std::vector<std::string> ShippedOscProfiles();

// Reads the text of a profile (docs/engines/osc.md). `source_name`: the file name in errors.
// Errors: kParse, kSchema (unknown key, wrong type, unknown argument or placeholder),
// kInvalidArgument; `where` is "file:line".
[[nodiscard]] Result<protocol::mocap::OscProfile> ParseOscProfile(std::string_view toml,
                                                                  std::string_view source_name);

}  // namespace furrow::server
