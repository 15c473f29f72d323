// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow {

// Sanitizers need address space, so memory cannot be limited under them.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kLimitsMemory = false;
#else
inline constexpr bool kLimitsMemory = true;
#endif

}  // namespace furrow
