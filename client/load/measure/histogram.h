// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <vector>

namespace furrow::load {

// Counts of values in log-linear cells, as HdrHistogram's with three significant digits: exact
// below 2,048, then 1,024 cells for each doubling, so a value is known to one part in 1,024.
//
// Values are whole numbers (we use nanoseconds); negative ones count as 0. Memory grows with the
// largest value, to 440 KB at most; recording does not allocate once it has been that large.
class Histogram {
 public:
  void Record(std::int64_t value);
  // Adds all of the other's values.
  void Add(const Histogram& other);

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] std::int64_t max() const { return max_; }  // exact; 0 when empty
  [[nodiscard]] std::int64_t min() const { return count_ == 0 ? 0 : min_; }
  [[nodiscard]] double Mean() const;
  [[nodiscard]] double StandardDeviation() const;

  // The smallest recorded value that `percentile` percent of all do not exceed, to the upper end of
  // its cell and never above max(). 0 when empty. `percentile` in [0, 100].
  [[nodiscard]] std::int64_t Percentile(double percentile) const;

  // The percentile distribution in HdrHistogram's text format (.hgrm), which its plotters read.
  // Values are divided by `unit`.
  void WriteHgrm(std::ostream& out, double unit) const;

  // Where a value is counted, and the largest value that is counted there.
  [[nodiscard]] static std::size_t Cell(std::uint64_t value);
  [[nodiscard]] static std::uint64_t UpperEnd(std::size_t cell);

 private:
  std::vector<std::uint64_t> cells_;
  std::uint64_t count_ = 0;
  std::int64_t min_ = 0;
  std::int64_t max_ = 0;
};

}  // namespace furrow::load
