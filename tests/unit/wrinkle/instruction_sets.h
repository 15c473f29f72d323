// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/targets.h>

namespace furrow::wrinkle {

// Tests of the SIMD code run once per instruction set of this processor: derive the fixture from
// this class, and instantiate it with FURROW_FOR_INSTRUCTION_SETS().
class InstructionSetTest : public testing::TestWithParam<std::int64_t> {
 protected:
  InstructionSetTest() {
    hwy::SetSupportedTargetsForTest(GetParam());
    hwy::GetChosenTarget().DeInit();
  }
  ~InstructionSetTest() override {
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().DeInit();
  }
};

inline std::vector<std::int64_t> InstructionSets() {
  std::vector<std::int64_t> targets = {HWY_SCALAR};
  for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
    const std::int64_t lowest = left & -left;
    if (lowest != HWY_SCALAR) targets.push_back(lowest);
  }
  return targets;
}

#define FURROW_FOR_INSTRUCTION_SETS(Fixture)                                        \
  INSTANTIATE_TEST_SUITE_P(                                                         \
      Instructions, Fixture, testing::ValuesIn(furrow::wrinkle::InstructionSets()), \
      [](const auto& target) { return std::string(hwy::TargetName(target.param)); })

}  // namespace furrow::wrinkle
