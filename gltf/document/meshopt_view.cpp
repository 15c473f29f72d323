// SPDX-License-Identifier: Apache-2.0
#include "gltf/document/meshopt_view.h"

#include <meshoptimizer.h>

namespace furrow::gltf {
namespace {

constexpr std::uint64_t kMaxExpansion = 64;  // decoded bytes per encoded byte
constexpr std::uint64_t kMaxStride = 256;

bool IsFilter(const std::string& filter, std::uint64_t stride) {
  if (filter.empty() || filter == "NONE") return true;
  if (filter == "OCTAHEDRAL") return stride == 4 || stride == 8;
  if (filter == "QUATERNION") return stride == 8;
  return filter == "EXPONENTIAL";  // needs a multiple of 4, as all attributes do
}

// The library asserts these conditions, so they must hold before it is called.
Status Check(const MeshoptView& view, const std::string& field) {
  const auto schema_error = [&](const char* what) {
    return Status(StatusCode::kSchema, what, field);
  };
  const bool attributes = view.mode == "ATTRIBUTES";
  if (!attributes && view.mode != "TRIANGLES" && view.mode != "INDICES") {
    return schema_error("the mode must be ATTRIBUTES, TRIANGLES or INDICES");
  }
  if (attributes && (view.stride == 0 || view.stride % 4 != 0 || view.stride > kMaxStride)) {
    return schema_error("the stride of attributes must be a multiple of 4 up to 256");
  }
  if (!attributes && view.stride != 2 && view.stride != 4) {
    return schema_error("the stride of indices must be 2 or 4");
  }
  if (view.mode == "TRIANGLES" && view.count % 3 != 0) {
    return schema_error("the number of indices is not a multiple of 3");
  }
  if (attributes ? !IsFilter(view.filter, view.stride)
                 : !view.filter.empty() && view.filter != "NONE") {
    return schema_error("the filter is unknown or does not fit the stride");
  }
  if (view.bytes.empty() || view.count == 0 ||
      view.count > kMaxExpansion * view.bytes.size() / view.stride) {
    return schema_error("the count does not fit the compressed bytes");
  }
  return {};
}

// The first byte states the codec and its version: 0xa0, 0xe0 or 0xe1, and 0xd0 or 0xd1.
bool IsNewerVersion(const MeshoptView& view) {
  const int version = view.bytes.front() & 0x0f;
  return version > (view.mode == "ATTRIBUTES" ? 0 : 1);
}

void ApplyFilter(const MeshoptView& view, std::uint8_t* values) {
  if (view.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(values, view.count, view.stride);
  if (view.filter == "QUATERNION") meshopt_decodeFilterQuat(values, view.count, view.stride);
  if (view.filter == "EXPONENTIAL") meshopt_decodeFilterExp(values, view.count, view.stride);
}

}  // namespace

Result<std::vector<std::uint8_t>> DecodeMeshopt(const MeshoptView& view, const std::string& field) {
  FURROW_RETURN_IF_ERROR(Check(view, field));
  std::vector<std::uint8_t> values(view.count * view.stride);
  const std::uint8_t* from = view.bytes.data();
  const std::size_t size = view.bytes.size();
  int failed = 0;
  if (view.mode == "ATTRIBUTES") {
    failed = meshopt_decodeVertexBuffer(values.data(), view.count, view.stride, from, size);
  } else if (view.mode == "TRIANGLES") {
    failed = meshopt_decodeIndexBuffer(values.data(), view.count, view.stride, from, size);
  } else {
    failed = meshopt_decodeIndexSequence(values.data(), view.count, view.stride, from, size);
  }
  if (failed != 0 && IsNewerVersion(view)) {
    return Status(StatusCode::kUnsupported, "a newer version of meshopt compressed the file", field,
                  "compress it for EXT_meshopt_compression (gltfpack -c -ce ext), or not at all");
  }
  if (failed != 0) return Status(StatusCode::kParse, "the compressed data is damaged", field);
  ApplyFilter(view, values.data());
  return values;
}

}  // namespace furrow::gltf
