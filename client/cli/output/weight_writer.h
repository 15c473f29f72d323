// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/time/timecode.h"

namespace furrow::cli {

// The formats of rows of weights.
enum class TableFormat { kTable, kCsv, kJsonl };

// The pose of a row.
struct RowLabel {
  std::int64_t frame = 0;
  double seconds = 0.0;              // since the first row
  std::optional<Timecode> timecode;  // of its source
};

// Writes rows of named numbers to standard output; used by `solve` and `watch`.
//
// - CSV: a header "frame,time,<names...>", then one row per frame, %.6f. With a column of
//   timecodes, the last one is "timecode", empty in rows without one.
// - JSON lines: {"frame":0,"time":0.0,"weights":{name: value}}; each value is the shortest number
//   that reads back as the same float. Rows with a timecode have "timecode":"01:02:03:04", too.
// - Table, for people: the eight largest weights of each frame as bars.
class WeightWriter {
 public:
  // Never returns null. `timecodes`: CSV has a column of timecodes.
  static std::unique_ptr<WeightWriter> Create(TableFormat format, bool timecodes = false);
  virtual ~WeightWriter() = default;

  // Sets the names. Call it before the first row, and again when a new rig or skeleton changes
  // them.
  virtual void Names(std::span<const std::string> names) = 0;
  // Writes a row: `values` has one value per name. Returns false if standard output is closed; the
  // caller then stops.
  [[nodiscard]] virtual bool Row(const RowLabel& label, std::span<const float> values) = 0;
};

}  // namespace furrow::cli
