// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace furrow::cli {

// The formats of rows of weights.
enum class TableFormat { kTable, kCsv, kJsonl };

// Writes rows of named numbers to standard output; used by `solve` and `watch`.
//
// - CSV: a header "frame,time,<names...>", then one row per frame, %.6f.
// - JSON lines: {"frame":0,"time":0.0,"weights":{name: value}}; each value is the shortest number
//   that reads back as the same float.
// - Table, for people: the eight largest weights of each frame as bars.
class WeightWriter {
 public:
  // Never returns null.
  static std::unique_ptr<WeightWriter> Create(TableFormat format);
  virtual ~WeightWriter() = default;

  // Sets the names. Call it before the first row, and again when a new rig or skeleton changes
  // them.
  virtual void Names(std::span<const std::string> names) = 0;
  // Writes a row: `values` has one value per name, `seconds` is the column "time". Returns false if
  // standard output is closed; the caller then stops.
  [[nodiscard]] virtual bool Row(std::int64_t frame, double seconds,
                                 std::span<const float> values) = 0;
};

}  // namespace furrow::cli
