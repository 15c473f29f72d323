// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/simd/row_gather.h"

#include <cstdint>
#include <numeric>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

namespace furrow::wrinkle {
namespace {

// What a step brings to `out` from `list`, lane by lane.
void Take(const RowGather::Step& step, const std::vector<float>& list, float* out) {
  for (std::size_t lane = 0; lane < kRowLanes; ++lane) {
    const std::int32_t from = step.lanes.at[lane];
    if (from < 0) continue;
    const auto place = static_cast<std::uint32_t>(from) % kRowLanes;
    const bool is_second = static_cast<std::size_t>(from) >= kRowLanes;
    out[lane] = list[(is_second ? step.second : step.first) + place];
  }
}

std::vector<float> Gather(const RowGather& gather, const std::vector<float>& list) {
  std::vector<float> out(gather.num_rows() * kRowLanes, -1.0f);
  for (std::size_t row = 0; row < gather.num_rows(); ++row) {
    const RowGather::Step& first = gather.first_steps()[row];
    Take(first, list, &out[row * kRowLanes]);
    for (std::uint32_t i = 0; i < first.num_more; ++i) {
      Take(gather.more()[first.first_more + i], list, &out[row * kRowLanes]);
    }
  }
  return out;
}

std::vector<float> Numbers(std::size_t count) {
  std::vector<float> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0.0f);
  return numbers;
}

TEST(RowGather, BringsEveryNumberToItsPlace) {
  constexpr std::uint32_t kCount = 7 * kRowLanes;
  const std::vector<float> list = Numbers(kCount);
  std::mt19937 random(5);
  for (std::size_t size = 1; size < 70; ++size) {
    std::vector<std::uint32_t> indices(size);
    for (std::uint32_t& index : indices) index = static_cast<std::uint32_t>(random() % kCount);
    const std::vector<float> out = Gather(RowGather(indices, 3), list);
    ASSERT_EQ(out.size(), NumRows(size) * kRowLanes);
    for (std::size_t i = 0; i < out.size(); ++i) {
      EXPECT_EQ(out[i], i < size ? static_cast<float>(indices[i]) : 3.0f);
    }
  }
}

TEST(RowGather, TwoRowsTakeOneStep) {
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < kRowLanes; ++i) {
    indices.push_back(i % 2 * 4 * kRowLanes + i / 2);  // of rows 0 and 4 by turns
  }
  const RowGather gather(indices, 0);
  EXPECT_EQ(gather.first_steps()[0].num_more, 0u);
  EXPECT_EQ(Gather(gather, Numbers(5 * kRowLanes))[3], 65.0f);
}

TEST(RowGather, OfNothingHasNoRows) {
  EXPECT_EQ(RowGather(std::span<const std::uint32_t>(), 0).num_rows(), 0u);
}

}  // namespace
}  // namespace furrow::wrinkle
