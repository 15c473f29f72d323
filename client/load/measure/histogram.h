// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <vector>

namespace furrow::load {

// A log-linear histogram, as HdrHistogram with three significant digits: exact below 2,048, then
// 1,024 cells per doubling. The relative error of a value is at most 1/1,024.
//
// Values are integers, here nanoseconds; negative values count as 0. Memory grows with the largest
// value, up to 440 KB. Record() allocates only when a value exceeds all previous values.
class Histogram {
 public:
  // Adds one value.
  void Record(std::int64_t value);
  // Adds all values of `other`.
  void Add(const Histogram& other);

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] std::int64_t max() const { return max_; }  // exact; 0 when empty
  [[nodiscard]] std::int64_t min() const { return count_ == 0 ? 0 : min_; }
  // Both from the middles of the cells; 0 when empty.
  [[nodiscard]] double Mean() const;
  [[nodiscard]] double StandardDeviation() const;

  // The smallest recorded value that `percentile` percent of all values do not exceed, rounded up
  // to the end of its cell and limited to max(). `percentile` in [0, 100]. Returns 0 if empty.
  [[nodiscard]] std::int64_t Percentile(double percentile) const;

  // Writes the percentile distribution in HdrHistogram's text format (.hgrm). Values are divided by
  // `unit`.
  void WriteHgrm(std::ostream& out, double unit) const;

  // The index of the cell that counts `value`, and the largest value that a cell counts.
  [[nodiscard]] static std::size_t Cell(std::uint64_t value);
  [[nodiscard]] static std::uint64_t UpperEnd(std::size_t cell);

 private:
  std::vector<std::uint64_t> cells_;
  std::uint64_t count_ = 0;
  std::int64_t min_ = 0;
  std::int64_t max_ = 0;
};

}  // namespace furrow::load
