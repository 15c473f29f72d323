// SPDX-License-Identifier: Apache-2.0
#include "authoring/draco/draco_wire.h"

#include <algorithm>
#include <cstring>

#include "gltf/limits.h"

namespace furrow::authoring {
namespace {

void Put(std::uint64_t value, std::string* to) {
  to->append(reinterpret_cast<const char*>(&value), sizeof(value));
}

template <class T>
void PutAll(std::span<const T> values, std::string* to) {
  const auto bytes = std::as_bytes(values);
  to->append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

// Reads numbers and runs of bytes until one is missing.
class Source {
 public:
  explicit Source(std::string_view bytes) : bytes_(bytes) {}

  // At most `limit`; more is damage.
  std::size_t Number(std::size_t limit) {
    std::uint64_t value = 0;
    const std::string_view from = Bytes(sizeof(value));
    if (failed_) return 0;
    std::memcpy(&value, from.data(), sizeof(value));
    failed_ |= value > limit;
    return failed_ ? 0 : static_cast<std::size_t>(value);
  }
  std::string_view Bytes(std::size_t count) {
    failed_ |= count > bytes_.size();
    if (failed_) return {};
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }
  [[nodiscard]] bool failed() const { return failed_; }
  [[nodiscard]] bool empty() const { return bytes_.empty(); }

 private:
  std::string_view bytes_;
  bool failed_ = false;
};

Status Damaged() { return {StatusCode::kParse, "the helper's data is damaged"}; }

gltf::DracoAttribute ReadAttribute(std::size_t num_points, Source* source) {
  gltf::DracoAttribute attribute;
  attribute.id = static_cast<std::uint32_t>(source->Number(UINT32_MAX));
  attribute.component_type = static_cast<int>(source->Number(UINT16_MAX));
  attribute.components = static_cast<int>(source->Number(4));
  const std::size_t element =
      ComponentBytes(attribute.component_type) * static_cast<std::size_t>(attribute.components);
  // An element of no bytes fails, because its type is unknown.
  const std::string_view values = source->Bytes(element == 0 ? SIZE_MAX : num_points * element);
  attribute.values.assign(values.begin(), values.end());
  return attribute;
}

}  // namespace

std::size_t ComponentBytes(int component_type) {
  switch (component_type) {
    case 5120:
    case 5121: return 1;  // bytes
    case 5122:
    case 5123: return 2;  // shorts
    case 5125:
    case 5126: return 4;  // unsigned int, float
    default: return 0;
  }
}

std::string EncodeDracoCall(std::span<const std::span<const std::uint8_t>> compressed) {
  std::string bytes;
  Put(compressed.size(), &bytes);
  for (const auto& mesh : compressed) {
    Put(mesh.size(), &bytes);
    PutAll(mesh, &bytes);
  }
  return bytes;
}

Result<std::vector<std::string_view>> DecodeDracoCall(std::string_view bytes) {
  Source source(bytes);
  std::vector<std::string_view> meshes(source.Number(gltf::kMaxDracoMeshes));
  for (std::string_view& mesh : meshes) mesh = source.Bytes(source.Number(gltf::kMaxFileBytes));
  if (source.failed() || !source.empty()) return Damaged();
  return meshes;
}

std::string EncodeDracoMeshes(std::span<const gltf::DracoMesh> meshes) {
  std::string bytes;
  Put(meshes.size(), &bytes);
  for (const gltf::DracoMesh& mesh : meshes) {
    Put(mesh.num_points, &bytes);
    Put(mesh.indices.size(), &bytes);
    PutAll(std::span<const std::uint32_t>(mesh.indices), &bytes);
    Put(mesh.attributes.size(), &bytes);
    for (const gltf::DracoAttribute& attribute : mesh.attributes) {
      Put(attribute.id, &bytes);
      Put(static_cast<std::uint64_t>(attribute.component_type), &bytes);
      Put(static_cast<std::uint64_t>(attribute.components), &bytes);
      PutAll(std::span<const std::uint8_t>(attribute.values), &bytes);
    }
  }
  return bytes;
}

Result<std::vector<gltf::DracoMesh>> DecodeDracoMeshes(std::string_view bytes) {
  Source source(bytes);
  std::vector<gltf::DracoMesh> meshes(source.Number(gltf::kMaxDracoMeshes));
  for (gltf::DracoMesh& mesh : meshes) {
    mesh.num_points = source.Number(gltf::kMaxVertices);
    const std::string_view indices =
        source.Bytes(source.Number(gltf::kMaxIndices) * sizeof(std::uint32_t));
    mesh.indices.resize(indices.size() / sizeof(std::uint32_t));
    if (!indices.empty()) std::memcpy(mesh.indices.data(), indices.data(), indices.size());
    const auto is_outside = [&](std::uint32_t index) { return index >= mesh.num_points; };
    if (std::ranges::any_of(mesh.indices, is_outside)) return Damaged();
    const std::size_t num_attributes = source.Number(UINT8_MAX);
    for (std::size_t i = 0; i < num_attributes && !source.failed(); ++i) {
      mesh.attributes.push_back(ReadAttribute(mesh.num_points, &source));
    }
    if (source.failed()) return Damaged();
  }
  if (source.failed() || !source.empty()) return Damaged();
  return meshes;
}

}  // namespace furrow::authoring
