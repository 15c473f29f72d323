// SPDX-License-Identifier: Apache-2.0
#include "client/load/measure/histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

namespace furrow::load {
namespace {

constexpr int kHalfBits = 10;  // log2 of the cells per doubling
constexpr std::uint64_t kHalf = std::uint64_t{1} << kHalfBits;
constexpr std::uint64_t kLinear = 2 * kHalf;  // each value below has its own cell

// The mean value of a cell. Mean and deviation assume it for all values of the cell.
double Middle(std::size_t cell) {
  const std::uint64_t low = cell == 0 ? 0 : Histogram::UpperEnd(cell - 1) + 1;
  return 0.5 * (static_cast<double>(low) + static_cast<double>(Histogram::UpperEnd(cell)));
}

}  // namespace

std::size_t Histogram::Cell(std::uint64_t value) {
  if (value < kLinear) return value;
  // Keeps the leading kHalfBits + 1 bits. The top one is always set, so each doubling has kHalf
  // cells.
  const int shift = std::bit_width(value) - (kHalfBits + 1);
  return static_cast<std::size_t>(kHalf * static_cast<std::uint64_t>(shift) + (value >> shift));
}

// The inverse of Cell().
std::uint64_t Histogram::UpperEnd(std::size_t cell) {
  if (cell < kLinear) return cell;
  const std::uint64_t shift = cell / kHalf - 1;
  const std::uint64_t top = cell - shift * kHalf;
  return ((top + 1) << shift) - 1;
}

void Histogram::Record(std::int64_t value) {
  value = std::max<std::int64_t>(value, 0);
  const std::size_t cell = Cell(static_cast<std::uint64_t>(value));
  if (cell >= cells_.size()) cells_.resize(cell + 1);
  ++cells_[cell];
  min_ = count_ == 0 ? value : std::min(min_, value);
  max_ = std::max(max_, value);
  ++count_;
}

void Histogram::Add(const Histogram& other) {
  if (other.count_ == 0) return;
  if (other.cells_.size() > cells_.size()) cells_.resize(other.cells_.size());
  for (std::size_t i = 0; i < other.cells_.size(); ++i) cells_[i] += other.cells_[i];
  min_ = count_ == 0 ? other.min_ : std::min(min_, other.min_);
  max_ = std::max(max_, other.max_);
  count_ += other.count_;
}

double Histogram::Mean() const {
  if (count_ == 0) return 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < cells_.size(); ++i) sum += static_cast<double>(cells_[i]) * Middle(i);
  return sum / static_cast<double>(count_);
}

double Histogram::StandardDeviation() const {
  if (count_ == 0) return 0.0;
  const double mean = Mean();
  double sum = 0.0;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const double off = Middle(i) - mean;
    sum += static_cast<double>(cells_[i]) * off * off;
  }
  return std::sqrt(sum / static_cast<double>(count_));
}

std::int64_t Histogram::Percentile(double percentile) const {
  if (count_ == 0) return 0;
  // In binary, 99.9% of 1,000 is 999.0000000000001. The factor keeps whole numbers whole.
  constexpr double kRounding = 1e-12;
  const double exact = percentile / 100.0 * static_cast<double>(count_);
  const double wanted = std::ceil(exact * (1.0 - kRounding));
  // Rank counts from 1: percentile 0 is the smallest value, 100 the largest.
  const auto rank = std::clamp<std::uint64_t>(static_cast<std::uint64_t>(wanted), 1, count_);
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    seen += cells_[i];
    // The end of a cell may lie above the largest value, which is known exactly.
    if (seen >= rank) return std::min(static_cast<std::int64_t>(UpperEnd(i)), max_);
  }
  return max_;
}

// Writes five rows per halving of the remaining share, as HdrHistogram's own tools do.
void Histogram::WriteHgrm(std::ostream& out, double unit) const {
  constexpr int kStepsPerHalving = 5;
  char line[128];
  out << "       Value     Percentile TotalCount 1/(1-Percentile)\n\n";
  std::uint64_t seen = 0;
  double next = 0.0;  // percentile of the next row
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (cells_[i] == 0) continue;
    seen += cells_[i];
    const double share = static_cast<double>(seen) / static_cast<double>(count_);
    if (seen < count_ && share * 100.0 < next) continue;
    const double value =
        static_cast<double>(std::min(static_cast<std::int64_t>(UpperEnd(i)), max_)) / unit;
    const auto total = static_cast<unsigned long long>(seen);
    if (seen == count_) {
      std::snprintf(line, sizeof(line), "%12.3f %2.12f %10llu\n", value, 1.0, total);
    } else {
      std::snprintf(line, sizeof(line), "%12.3f %2.12f %10llu %14.2f\n", value, share, total,
                    1.0 / (1.0 - share));
    }
    out << line;
    // Rows that fall into one cell are written once. Steps halve with the remaining share, so that
    // the tail has as many rows as the middle.
    while (seen < count_ && next <= share * 100.0) {
      const double halvings = std::floor(std::log2(100.0 / (100.0 - next))) + 1.0;
      next += 100.0 / (kStepsPerHalving * std::exp2(halvings));
    }
  }
  std::snprintf(line, sizeof(line), "#[Mean    = %12.3f, StdDeviation   = %12.3f]\n", Mean() / unit,
                StandardDeviation() / unit);
  out << line;
  std::snprintf(line, sizeof(line), "#[Max     = %12.3f, Total count    = %12llu]\n",
                static_cast<double>(max_) / unit, static_cast<unsigned long long>(count_));
  out << line;
  const std::size_t buckets = cells_.size() <= kLinear ? 1 : (cells_.size() - 1) / kHalf;
  std::snprintf(line, sizeof(line), "#[Buckets = %12zu, SubBuckets     = %12llu]\n", buckets,
                static_cast<unsigned long long>(kLinear));
  out << line;
}

}  // namespace furrow::load
