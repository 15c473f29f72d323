// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/simd/row_gather.h"

#include <algorithm>
#include <limits>

namespace furrow::wrinkle {
namespace {

constexpr std::uint32_t kLane =
    kRowLanes - 1;  // mask for the lane of an index; the other bits are the start of its row
constexpr auto kSecond = static_cast<std::int32_t>(kRowLanes);
constexpr auto kOther = std::numeric_limits<std::int32_t>::min();

// One step from two rows of the list, in the codes of RowGather::Step.
RowGather::Step MakeStep(std::span<const std::uint32_t> wanted, std::uint32_t first,
                         std::uint32_t second) {
  RowGather::Step step{.first = first, .second = second};
  for (std::size_t lane = 0; lane < kRowLanes; ++lane) {
    const std::uint32_t row = wanted[lane] & ~kLane;
    const auto from = static_cast<std::int32_t>(wanted[lane] & kLane);
    step.lanes.at[lane] = row == first ? from : row == second ? from + kSecond : kOther;
  }
  return step;
}

}  // namespace

RowGather::RowGather(std::span<const std::uint32_t> indices, std::uint32_t filler)
    : indices_(indices.begin(), indices.end()) {
  indices_.resize(NumRows(indices.size()) * kRowLanes, filler);
  for (std::size_t i = 0; i < indices_.size(); i += kRowLanes) {
    AddRow(std::span(indices_).subspan(i, kRowLanes));
  }
}

void RowGather::AddRow(std::span<const std::uint32_t> wanted) {
  // The rows that the output needs, taken two per step.
  std::vector<std::uint32_t> rows;
  for (const std::uint32_t index : wanted) rows.push_back(index & ~kLane);
  std::ranges::sort(rows);
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  if (rows.size() % 2 != 0) rows.push_back(rows.back());
  Step& first = first_steps_.emplace_back(MakeStep(wanted, rows[0], rows[1]));
  first.first_more = static_cast<std::uint32_t>(more_.size());
  for (std::size_t i = 2; i < rows.size(); i += 2) {
    more_.push_back(MakeStep(wanted, rows[i], rows[i + 1]));
  }
  first.num_more = static_cast<std::uint32_t>(more_.size()) - first.first_more;
}

}  // namespace furrow::wrinkle
