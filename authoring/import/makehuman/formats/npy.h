// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"

namespace furrow::authoring {

// An array in NumPy's .npy format (numpy.lib.format, versions 1 to 3): a text header that states
// type and shape, then the values.
struct NpyArray {
  std::string type;                // NumPy's name: "<i2" is int16, little endian
  std::vector<std::size_t> shape;  // 1 or 2 extents; the last one varies fastest
  std::string_view data;           // num_values() values of item_size() bytes; part of the input

  [[nodiscard]] std::size_t item_size() const { return static_cast<std::size_t>(type[2] - '0'); }
  [[nodiscard]] std::size_t num_values() const {
    return shape.size() == 1 ? shape[0] : shape[0] * shape[1];
  }
  // The value at `index` < num_values().
  [[nodiscard]] long At(std::size_t index) const;
};

// Parses a .npy file of little-endian integers: "<u2" and "<i2", which MakeHuman writes. `bytes`
// must outlive the result. `source`: the file name in errors.
//
// Errors name the source: kParse (no .npy file, a faulty header, more or fewer values than the
// shape states), kUnsupported (other types, Fortran order, more than 2 extents), kLimit (an extent
// above 1,000,000).
[[nodiscard]] Result<NpyArray> ParseNpy(std::string_view bytes, std::string_view source);

}  // namespace furrow::authoring
