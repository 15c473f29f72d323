// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace furrow::report {

// Returns "1 pose", "2 poses", "0 poses". `many` is the plural if it is not `one` with an s.
[[nodiscard]] std::string Counted(std::uint64_t count, const std::string& one,
                                  const std::string& many = {});

}  // namespace furrow::report
