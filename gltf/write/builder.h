// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/status.h"

namespace furrow::gltf {

// Builds a GLB: one JSON chunk, which the caller fills through root(), and one buffer. Equal calls
// give equal bytes.
class Builder {
 public:
  using Json = nlohmann::ordered_json;
  enum Target { kNoTarget = 0, kArrayBuffer = 34962, kElementBuffer = 34963 };
  enum Component {
    kUnsignedByte = 5121,
    kUnsignedShort = 5123,
    kUnsignedInt = 5125,
    kFloat = 5126
  };

  Builder();

  // The JSON without accessors, buffer views and buffers, which Finish() adds.
  [[nodiscard]] Json& root() { return root_; }

  // Appends bytes to the buffer at a multiple of 4. Returns the index of the new buffer view.
  int AddView(const void* bytes, std::size_t size, Target target);

  // Appends a list of tightly packed values. `type` is glTF's ("VEC3"), and `count` the number of
  // elements of that type. Returns the index of the new accessor.
  template <class T>
  int AddAccessor(const std::vector<T>& values, Component component, const char* type,
                  Target target) {
    return AddAccessor(values, component, type, target, values.size());
  }
  template <class T>
  int AddAccessor(const std::vector<T>& values, Component component, const char* type,
                  Target target, std::size_t count) {
    return DescribeAccessor(AddView(values.data(), values.size() * sizeof(T), target), component,
                            count, type);
  }
  // Which elements a sparse accessor states. Several accessors may share it.
  struct SparseIndices {
    int view = -1;
    Component component = kUnsignedShort;
    std::size_t count = 0;
  };
  // `indices`: ascending, at least one. Shorts are written if all indices fit.
  [[nodiscard]] SparseIndices AddSparseIndices(const std::vector<std::uint32_t>& indices);
  // Appends an accessor of `count` elements that are zero except for the stated ones. `values`: one
  // element of floats per index.
  template <class T>
  int AddSparseAccessor(const SparseIndices& indices, const std::vector<T>& values,
                        const char* type, std::size_t count) {
    return DescribeSparse(indices, AddView(values.data(), values.size() * sizeof(T), kNoTarget),
                          type, count);
  }
  [[nodiscard]] Json& accessor(int index) { return accessors_[static_cast<std::size_t>(index)]; }

  // Returns the file. Call it once, last. Bytes of names that are not UTF-8 become U+FFFD. Errors:
  // kLimit (4 GiB).
  [[nodiscard]] Result<std::string> Finish();

 private:
  int DescribeAccessor(int view, Component component, std::size_t count, const char* type);
  int DescribeSparse(const SparseIndices& indices, int values, const char* type, std::size_t count);

  Json root_;
  Json accessors_ = Json::array();
  Json views_ = Json::array();
  std::string binary_;
};

}  // namespace furrow::gltf
