// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace furrow::cli {

enum class TableFormat { kTable, kCsv, kJsonl };

// Rows of named numbers on standard output, the same for `solve` and `watch`.
//
// - CSV: header "frame,time,<names...>", one row a frame, %.6f.
// - JSON lines: {"frame":0,"time":0.0,"weights":{name: value}}.
// - Table: for people: the eight largest weights of a frame as bars.
class WeightWriter {
 public:
  static std::unique_ptr<WeightWriter> Create(TableFormat format);
  virtual ~WeightWriter() = default;

  // Called once before the first row, and again when the names change (a new rig or skeleton).
  virtual void Names(std::span<const std::string> names) = 0;
  // False when standard output is closed: the caller stops.
  [[nodiscard]] virtual bool Row(std::int64_t frame, double seconds,
                                 std::span<const float> values) = 0;
};

}  // namespace furrow::cli
