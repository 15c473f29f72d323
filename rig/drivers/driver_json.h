// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/status.h"
#include "rig/json/rig_tables.h"
#include "wrinkle/drivers/driver.h"

// The JSON of each driver kind's fields. <kind>_json.cpp defines both functions; rig.fbs has the
// kind's table.
namespace furrow::character {

// From the schema's table. `at` is the path of the fields: "drivers[3].hinge".
// Writes all fields that differ from their defaults.
#define FURROW_KIND_JSON(Name, field)                                                      \
  [[nodiscard]] Status ReadFields(const schema::Name##Driver& from, const std::string& at, \
                                  wrinkle::Name##Driver* to);                              \
  [[nodiscard]] std::string FieldsToJson(const wrinkle::Name##Driver& driver);
FURROW_DRIVER_KINDS(FURROW_KIND_JSON)
#undef FURROW_KIND_JSON

}  // namespace furrow::character
