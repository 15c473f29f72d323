// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/status.h"
#include "rig/json/rig_tables.h"
#include "wrinkle/drivers/driver.h"

// Reads and writes the fields of each driver kind. <kind>_json.cpp defines both functions; the
// table of the kind is in rig.fbs.
namespace furrow::rig {

// ReadFields() reads the schema's table. `at` is the path of the fields: "drivers[3].hinge".
// FieldsToJson() writes the fields that differ from their defaults.
#define FURROW_KIND_JSON(Name, field)                                                      \
  [[nodiscard]] Status ReadFields(const schema::Name##Driver& from, const std::string& at, \
                                  wrinkle::Name##Driver* to);                              \
  [[nodiscard]] std::string FieldsToJson(const wrinkle::Name##Driver& driver);
FURROW_DRIVER_KINDS(FURROW_KIND_JSON)
#undef FURROW_KIND_JSON

}  // namespace furrow::rig
