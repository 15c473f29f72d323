// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>

#include "wrinkle/solver/explain.h"

namespace furrow::cli {

// Prints how the weights of a pose were computed, the largest weight first: its drivers, and how
// far each moved towards its reference pose. Weights below `threshold` are counted and not listed.
void PrintExplanation(const wrinkle::Explanation& explanation, float threshold, std::FILE* out);

}  // namespace furrow::cli
