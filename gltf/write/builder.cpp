// SPDX-License-Identifier: Apache-2.0
#include "gltf/write/builder.h"

#include <bit>
#include <cstdint>
#include <limits>
#include <utility>

namespace furrow::gltf {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian");

// The low 32 bits, little-endian.
void AppendWord(std::uint64_t word, std::string* bytes) {
  for (int shift = 0; shift < 32; shift += 8) *bytes += static_cast<char>((word >> shift) & 0xff);
}

}  // namespace

Builder::Builder() {
  root_["asset"] = {{"version", "2.0"}, {"generator", "furrow"}};
  root_["scene"] = 0;
}

int Builder::AddView(const void* bytes, std::size_t size, Target target) {
  // Accessors must begin at a multiple of their component's size, at most 4 bytes here.
  binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
  Json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", size}};
  if (target != kNoTarget) view["target"] = static_cast<int>(target);
  binary_.append(static_cast<const char*>(bytes), size);
  views_.push_back(std::move(view));
  return static_cast<int>(views_.size()) - 1;
}

int Builder::DescribeAccessor(int view, Component component, std::size_t count, const char* type) {
  accessors_.push_back({{"bufferView", view},
                        {"componentType", static_cast<int>(component)},
                        {"count", count},
                        {"type", type}});
  return static_cast<int>(accessors_.size()) - 1;
}

Builder::SparseIndices Builder::AddSparseIndices(const std::vector<std::uint32_t>& indices) {
  if (indices.back() > std::numeric_limits<std::uint16_t>::max()) {
    const int view = AddView(indices.data(), indices.size() * sizeof indices[0], kNoTarget);
    return {view, kUnsignedInt, indices.size()};
  }
  const std::vector<std::uint16_t> narrow(indices.begin(), indices.end());
  const int view = AddView(narrow.data(), narrow.size() * sizeof narrow[0], kNoTarget);
  return {view, kUnsignedShort, narrow.size()};
}

int Builder::DescribeSparse(const SparseIndices& indices, int values, const char* type,
                            std::size_t count) {
  accessors_.push_back(
      {{"componentType", static_cast<int>(kFloat)},
       {"count", count},
       {"type", type},
       {"sparse",
        {{"count", indices.count},
         {"indices",
          {{"bufferView", indices.view}, {"componentType", static_cast<int>(indices.component)}}},
         {"values", {{"bufferView", values}}}}}});
  return static_cast<int>(accessors_.size()) - 1;
}

Result<std::string> Builder::Finish() {
  root_["accessors"] = std::move(accessors_);
  root_["bufferViews"] = std::move(views_);
  root_["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
  std::string text = root_.dump(-1, ' ', false, Json::error_handler_t::replace);
  // GLB pads chunks to 4 bytes: JSON with spaces, binary data with zeros.
  text.resize((text.size() + 3) / 4 * 4, ' ');
  binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
  // The file's header, then the header and the bytes of each chunk.
  const std::uint64_t total = 12 + 8 + text.size() + 8 + binary_.size();
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    return Status(StatusCode::kLimit, "a GLB holds at most 4 GiB");
  }
  std::string glb = "glTF";
  AppendWord(2, &glb);
  AppendWord(total, &glb);
  AppendWord(text.size(), &glb);
  glb += "JSON" + text;
  AppendWord(binary_.size(), &glb);
  glb += std::string("BIN\0", 4) + binary_;
  return glb;
}

}  // namespace furrow::gltf
