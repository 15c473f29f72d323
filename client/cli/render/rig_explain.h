// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>

#include "wrinkle/solver/explain.h"

namespace furrow::cli {

// Prints how a pose came to its weights, the strongest first: which drivers, how far towards which
// reference pose. Weights below `threshold` are counted, not listed.
void PrintExplanation(const wrinkle::Explanation& explanation, float threshold, std::FILE* out);

}  // namespace furrow::cli
