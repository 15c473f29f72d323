// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/status.h"

namespace furrow::character {

// A .glb in the making: its JSON, which the caller fills, and its one buffer. Equal calls give
// equal bytes.
class GltfBuilder {
 public:
  using Json = nlohmann::ordered_json;
  enum Target { kNoTarget = 0, kArrayBuffer = 34962, kElementBuffer = 34963 };
  enum Component {
    kUnsignedByte = 5121,
    kUnsignedShort = 5123,
    kUnsignedInt = 5125,
    kFloat = 5126
  };

  GltfBuilder();

  [[nodiscard]] Json& root() { return root_; }

  // Bytes into the buffer, on a border of four; the view's index.
  int AddView(const void* bytes, std::size_t size, Target target);

  // A list of tightly packed values; `type` is glTF's ("VEC3"). The accessor's index.
  template <class T>
  int AddAccessor(const std::vector<T>& values, Component component, const char* type,
                  Target target) {
    return DescribeAccessor(AddView(values.data(), values.size() * sizeof(T), target), component,
                            values.size(), type);
  }
  [[nodiscard]] Json& accessor(int index) { return accessors_[static_cast<std::size_t>(index)]; }

  // The whole file; the builder is spent. Errors: kLimit (4 GiB), kInvalidArgument (a name that is
  // not UTF-8).
  [[nodiscard]] Result<std::string> Finish();

 private:
  int DescribeAccessor(int view, Component component, std::size_t count, const char* type);

  Json root_;
  Json accessors_ = Json::array();
  Json views_ = Json::array();
  std::string binary_;
};

}  // namespace furrow::character
