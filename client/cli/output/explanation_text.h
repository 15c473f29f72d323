// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>

#include "wrinkle/solver/explain.h"

namespace furrow::cli {

// Prints to `out` how the weights of a pose were computed, the largest weight first, with the
// drivers of each weight and how far each driver moved towards its reference pose. Weights below
// `threshold`
// ([0, 1]) are counted and not listed.
void PrintExplanation(const wrinkle::Explanation& explanation, float threshold, std::FILE* out);

}  // namespace furrow::cli
