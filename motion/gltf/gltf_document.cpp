// SPDX-License-Identifier: Apache-2.0
#include "motion/gltf/gltf_document.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <exception>
#include <utility>

#include "base/status.h"
#include "motion/clip/limits.h"
#include "motion/gltf/gltf_json.h"

namespace furrow::motion {
namespace {

constexpr std::size_t kMaxFloats = 128'000'000;  // handed out by one document
constexpr std::size_t kMaxNodes = 65'536;
constexpr std::size_t kMaxChannels = 65'536;
constexpr std::size_t kMaxStride = 252;  // glTF's own bound

std::string Field(const char* list, std::size_t index, const char* member = "") {
  return list + ("[" + std::to_string(index) + "]") + member;
}

bool InRange(int index, std::size_t size) {
  return index >= 0 && static_cast<std::size_t>(index) < size;
}

// One component as a float, integers normalised as glTF prescribes.
float ReadComponent(const unsigned char* at, int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return std::fmax(static_cast<float>(static_cast<signed char>(*at)) / 127.0f, -1.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return static_cast<float>(*at) / 255.0f;
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
      std::int16_t value;
      std::memcpy(&value, at, sizeof(value));
      return std::fmax(static_cast<float>(value) / 32767.0f, -1.0f);
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
      std::uint16_t value;
      std::memcpy(&value, at, sizeof(value));
      return static_cast<float>(value) / 65535.0f;
    }
    default: {
      float value;
      std::memcpy(&value, at, sizeof(value));
      return value;
    }
  }
}

std::size_t ComponentBytes(const tinygltf::Accessor& accessor) {
  switch (accessor.componentType) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT: return 4;
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return accessor.normalized ? 1 : 0;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return accessor.normalized ? 2 : 0;
    default: return 0;
  }
}

bool IsVector(const std::vector<double>& values, std::size_t size) {
  if (values.empty()) return true;
  if (values.size() != size) return false;
  for (const double value : values) {
    if (!std::isfinite(static_cast<float>(value))) return false;
  }
  return true;
}

}  // namespace

Status GltfDocument::Error(StatusCode code, const std::string& field, std::string what) const {
  return {code, std::move(what), source_name_ + ": " + field};
}

Result<GltfDocument> GltfDocument::Open(std::string_view bytes, std::string_view source_name,
                                        const std::filesystem::path& folder) {
  const Result<gltf::Glb> chunks = SplitGlb(bytes, source_name);
  FURROW_RETURN_IF_ERROR(chunks);
  Result<ReducedGltf> reduced = ReduceGltf(*chunks, source_name, folder);
  FURROW_RETURN_IF_ERROR(reduced);

  GltfDocument document;
  document.source_name_ = source_name;
  std::string error;
  std::string warning;
  bool parsed = false;
  try {  // tinygltf throws where a member has a type it does not expect
    parsed = tinygltf::TinyGLTF().LoadASCIIFromString(
        &document.model_, &error, &warning, reduced->json.data(),
        static_cast<unsigned int>(reduced->json.size()), "", tinygltf::REQUIRE_VERSION);
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  if (!parsed) {
    while (!error.empty() && error.back() == '\n') error.pop_back();
    return document.Error(StatusCode::kSchema, "JSON", error.empty() ? "is not glTF" : error);
  }
  document.morph_targets_ = std::move(reduced->morph_targets);
  for (std::vector<unsigned char>& buffer : reduced->buffers) {
    document.model_.buffers.emplace_back().data = std::move(buffer);
  }
  FURROW_RETURN_IF_ERROR(document.LinkNodes());
  FURROW_RETURN_IF_ERROR(document.CheckNodes());
  FURROW_RETURN_IF_ERROR(document.CheckAnimations());
  return document;
}

Status GltfDocument::LinkNodes() {
  const std::vector<tinygltf::Node>& nodes = model_.nodes;
  if (nodes.size() > kMaxNodes) return Error(StatusCode::kLimit, "nodes", "more than 65536");
  parents_.assign(nodes.size(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const int child : nodes[i].children) {
      const std::string field = Field("nodes", i, ".children");
      if (!InRange(child, nodes.size()))
        return Error(StatusCode::kSchema, field, "is out of range");
      int& parent = parents_[static_cast<std::size_t>(child)];
      if (parent != -1) {
        return Error(StatusCode::kCyclic, field,
                     "node " + std::to_string(child) + " has two parents");
      }
      parent = static_cast<int>(i);
    }
  }
  std::vector<int> open;
  for (std::size_t i = nodes.size(); i-- > 0;) {
    if (parents_[i] == -1) open.push_back(static_cast<int>(i));
  }
  while (!open.empty()) {
    const int node = open.back();
    open.pop_back();
    order_.push_back(node);
    const std::vector<int>& children = nodes[static_cast<std::size_t>(node)].children;
    open.insert(open.end(), children.rbegin(), children.rend());
  }
  // With one parent each, a node that no root reaches hangs in a ring.
  if (order_.size() == nodes.size()) return {};
  return Error(StatusCode::kCyclic, "nodes", "the hierarchy is not a tree");
}

Status GltfDocument::CheckNodes() const {
  for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
    const tinygltf::Node& node = model_.nodes[i];
    if (!IsVector(node.translation, 3) || !IsVector(node.rotation, 4) || !IsVector(node.scale, 3) ||
        !IsVector(node.matrix, 16)) {
      return Error(StatusCode::kSchema, Field("nodes", i),
                   "its transform has the wrong size, or a number beyond a float");
    }
    if (node.mesh != -1 && !InRange(node.mesh, morph_targets_.size())) {
      return Error(StatusCode::kSchema, Field("nodes", i, ".mesh"), "is out of range");
    }
  }
  for (std::size_t i = 0; i < model_.skins.size(); ++i) {
    for (const int joint : model_.skins[i].joints) {
      if (!InRange(joint, model_.nodes.size())) {
        return Error(StatusCode::kSchema, Field("skins", i, ".joints"), "is out of range");
      }
    }
  }
  return {};
}

Status GltfDocument::CheckAnimations() const {
  if (model_.animations.empty()) return {};
  const tinygltf::Animation& animation = model_.animations.front();  // the one that is read
  if (animation.channels.size() > kMaxChannels) {
    return Error(StatusCode::kLimit, "animations[0].channels", "more than 65536");
  }
  for (std::size_t i = 0; i < animation.channels.size(); ++i) {
    const tinygltf::AnimationChannel& channel = animation.channels[i];
    const bool has_target = channel.target_node != -1;  // the specification: else ignore it
    if (!InRange(channel.sampler, animation.samplers.size()) ||
        (has_target && !InRange(channel.target_node, model_.nodes.size()))) {
      return Error(StatusCode::kSchema, Field("animations[0].channels", i),
                   "its sampler or node is out of range");
    }
  }
  return {};
}

const std::vector<std::string>& GltfDocument::MorphTargets(int mesh) const {
  static const std::vector<std::string> kNone;
  return InRange(mesh, morph_targets_.size()) ? morph_targets_[static_cast<std::size_t>(mesh)]
                                              : kNone;
}

Result<const unsigned char*> GltfDocument::Locate(const tinygltf::Accessor& accessor,
                                                  std::size_t element_bytes,
                                                  const std::string& field,
                                                  std::size_t* stride) const {
  const auto bad = [&](const char* what) { return Error(StatusCode::kSchema, field, what); };
  if (!InRange(accessor.bufferView, model_.bufferViews.size())) {
    return bad("its bufferView is out of range");
  }
  const tinygltf::BufferView& view =
      model_.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
  if (!InRange(view.buffer, model_.buffers.size())) return bad("its buffer is out of range");
  const std::vector<unsigned char>& data =
      model_.buffers[static_cast<std::size_t>(view.buffer)].data;
  if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
    return bad("its bufferView reaches beyond the buffer");
  }
  *stride = view.byteStride != 0 ? view.byteStride : element_bytes;
  if (*stride < element_bytes || *stride > kMaxStride) return bad("its byteStride is wrong");
  // count is bounded and stride is small: no overflow below.
  const std::size_t needed = (accessor.count - 1) * *stride + element_bytes;
  if (accessor.byteOffset > view.byteLength || needed > view.byteLength - accessor.byteOffset) {
    return bad("it reaches beyond its bufferView");
  }
  return data.data() + view.byteOffset + accessor.byteOffset;
}

Result<std::vector<float>> GltfDocument::ReadFloats(int index, int type, const std::string& field) {
  if (!InRange(index, model_.accessors.size())) {
    return Error(StatusCode::kSchema, field, "names an accessor that is not there");
  }
  const tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(index)];
  const std::string place = Field("accessors", static_cast<std::size_t>(index));
  if (accessor.sparse.isSparse) {
    return Error(StatusCode::kUnsupported, place, "sparse accessors are not read");
  }
  const std::size_t component_bytes = ComponentBytes(accessor);
  if (accessor.type != type || component_bytes == 0) {
    return Error(StatusCode::kSchema, place, "has the wrong type for " + field);
  }
  const auto components = static_cast<std::size_t>(tinygltf::GetNumComponentsInType(type));
  if (accessor.count == 0) return Error(StatusCode::kSchema, place, "is empty");
  if (accessor.count > (kMaxFloats - floats_read_) / components) {
    return Error(StatusCode::kLimit, place, "too many numbers");
  }
  std::size_t stride = 0;
  const Result<const unsigned char*> first =
      Locate(accessor, component_bytes * components, place, &stride);
  FURROW_RETURN_IF_ERROR(first);
  std::vector<float> values(accessor.count * components);
  floats_read_ += values.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = ReadComponent(*first + i / components * stride + i % components * component_bytes,
                              accessor.componentType);
    if (!std::isfinite(values[i])) {
      return Error(StatusCode::kNonFinite, place,
                   "element " + std::to_string(i / components) + " is not finite");
    }
  }
  return values;
}

}  // namespace furrow::motion
