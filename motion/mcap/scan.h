// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/status.h"
#include "motion/mcap/index.h"
#include "motion/mcap/record_file.h"
#include "motion/mcap/warnings.h"

namespace furrow::motion::mcap {

// Fills an empty index by reading a file from its start. Damaged records are skipped with a
// warning, and so is what a limit leaves no room for. `is_whole`: the file ends with a footer, so
// nothing is missing after the data. Errors: kIo, kLimit (a record is too long).
[[nodiscard]] Status Scan(const RecordFile& file, bool is_whole, Index* index, Warnings* warnings);

}  // namespace furrow::motion::mcap
