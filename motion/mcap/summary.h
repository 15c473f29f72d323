// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "motion/mcap/index.h"
#include "motion/mcap/record_file.h"
#include "motion/mcap/warnings.h"

namespace furrow::motion::mcap {

enum class Summary {
  kRead,
  kNone,  // the file is whole, but the summary lists too little to find its messages
  // The file was cut off, or the summary is wrong. One that refers to the same bytes twice is, too:
  // a small file could otherwise make its reader read one record millions of times.
  kDamaged,
};

// Reads the summary at the end of a file into `index`, which holds what was read before the fault
// unless the result is kRead.
[[nodiscard]] Summary ReadSummary(const RecordFile& file, Index* index, Warnings* warnings);

}  // namespace furrow::motion::mcap
