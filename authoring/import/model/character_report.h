// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "authoring/import/model/character_check.h"

namespace furrow::authoring {

// Returns the report as text for a terminal.
[[nodiscard]] std::string ToText(const CharacterReport& report);
// Returns the report as one JSON object with the fields of CharacterReport.
[[nodiscard]] std::string ToJson(const CharacterReport& report);

}  // namespace furrow::authoring
