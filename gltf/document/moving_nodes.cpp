// SPDX-License-Identifier: Apache-2.0
#include "gltf/document/moving_nodes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

#include <nlohmann/json.hpp>

#include "gltf/limits.h"

namespace furrow::gltf {
namespace {

using Json = nlohmann::json;

constexpr std::uint64_t kFloat = 5126;

// The member, or a null value. The file decides about types.
const Json& At(const Json& object, const char* key) {
  static const Json kNull;
  if (!object.is_object()) return kNull;
  const auto found = object.find(key);
  return found == object.end() ? kNull : *found;
}

const Json& At(const Json& list, std::uint64_t index) {
  static const Json kNull;
  return list.is_array() && index < list.size() ? list[static_cast<std::size_t>(index)] : kNull;
}

// Nothing if `value` is not an unsigned integer.
std::optional<std::uint64_t> Unsigned(const Json& value) {
  if (!value.is_number_unsigned()) return std::nullopt;
  return value.get<std::uint64_t>();
}

std::string_view Text(const Json& value) {
  return value.is_string() ? std::string_view(value.get_ref<const Json::string_t&>())
                           : std::string_view();
}

// A translation, rotation or scale of a node.
struct Value {
  std::array<float, 4> numbers{};
  std::size_t size = 3;
};

// The value of the node itself. Nothing: it is malformed.
std::optional<Value> RestOf(const Json& node, std::string_view path) {
  if (!node.is_object() || node.contains("matrix")) return std::nullopt;
  Value rest;
  if (path == "rotation") rest = {{0, 0, 0, 1}, 4};
  if (path == "scale") rest = {{1, 1, 1, 0}, 3};
  const auto stated = node.find(path);
  if (stated == node.end()) return rest;
  if (!stated->is_array() || stated->size() != rest.size) return std::nullopt;
  for (std::size_t i = 0; i < rest.size; ++i) {
    const Json& number = (*stated)[i];
    if (!number.is_number()) return std::nullopt;
    rest.numbers[i] = number.get<float>();
  }
  return rest;
}

// True if both are the same but for rounding. Both signs of a quaternion are the same rotation.
bool IsSame(const Value& a, const Value& b) {
  float dot = 0.0f;
  float square = 0.0f;
  float distance = 0.0f;
  for (std::size_t i = 0; i < a.size; ++i) {
    dot += a.numbers[i] * b.numbers[i];
    square += b.numbers[i] * b.numbers[i];
    distance += (a.numbers[i] - b.numbers[i]) * (a.numbers[i] - b.numbers[i]);
  }
  // The cosine of half of the angle: 0.16 degrees.
  if (a.size == 4) return std::abs(dot) >= 1.0f - 1e-6f;
  return distance <= 1e-8f * std::max(1.0f, square);
}

class Lister {
 public:
  Lister(const Json& json, std::span<const BufferView> views) : json_(json), views_(views) {}

  std::vector<int> Run() {
    std::vector<int> nodes;
    for (const Json& animation : ListAt(json_, "animations")) {
      for (const Json& channel : ListAt(animation, "channels")) {
        const Json& target = At(channel, "target");
        const std::string_view path = Text(At(target, "path"));
        const auto node = Unsigned(At(target, "node"));
        const bool moves = path == "translation" || path == "rotation" || path == "scale";
        if (!moves || !node || *node >= kMaxNodes) continue;
        const auto sampler = Unsigned(At(channel, "sampler"));
        if (sampler && IsAtRest(At(At(animation, "samplers"), *sampler), *node, path)) continue;
        nodes.push_back(static_cast<int>(*node));
      }
    }
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
  }

 private:
  static const Json& ListAt(const Json& object, const char* key) {
    static const Json kEmpty = Json::array();
    const Json& found = At(object, key);
    return found.is_array() ? found : kEmpty;
  }

  // True if all keys of the sampler repeat the node's own value.
  [[nodiscard]] bool IsAtRest(const Json& sampler, std::uint64_t node, std::string_view path) {
    const std::optional<Value> rest = RestOf(At(At(json_, "nodes"), node), path);
    const auto output = Unsigned(At(sampler, "output"));
    // Splines have tangents between the values.
    if (!rest || !output || Text(At(sampler, "interpolation")) == "CUBICSPLINE") return false;
    const Json& accessor = At(At(json_, "accessors"), *output);
    const auto view = Unsigned(At(accessor, "bufferView"));
    const auto count = Unsigned(At(accessor, "count"));
    const std::uint64_t offset = Unsigned(At(accessor, "byteOffset")).value_or(0);
    const bool is_plain = Unsigned(At(accessor, "componentType")) == kFloat &&
                          Text(At(accessor, "type")) == (rest->size == 4 ? "VEC4" : "VEC3") &&
                          At(accessor, "sparse").is_null();
    if (!is_plain || !view || *view >= views_.size() || !count) return false;
    return Repeats(views_[static_cast<std::size_t>(*view)], offset, *count, *rest);
  }

  bool Repeats(const BufferView& view, std::uint64_t offset, std::uint64_t count,
               const Value& rest) {
    const std::size_t bytes = rest.size * sizeof(float);
    const std::size_t stride = view.stride == 0 ? bytes : view.stride;
    for (std::uint64_t key = 0; key < count; ++key, offset += stride) {
      if (numbers_left_ < rest.size) return false;
      numbers_left_ -= rest.size;
      if (offset > view.bytes.size() || view.bytes.size() - offset < bytes) return false;
      Value value{.size = rest.size};
      std::memcpy(value.numbers.data(), view.bytes.data() + offset, bytes);
      if (!IsSame(value, rest)) return false;
    }
    return true;
  }

  const Json& json_;
  const std::span<const BufferView> views_;
  std::size_t numbers_left_ = kMaxAnimationNumbers;  // channels may share a long list of keys
};

}  // namespace

// Characters need no keys of animations, so faults in animations do no harm.
std::vector<int> ListMovingNodes(const Json& json, std::span<const BufferView> views) {
  return Lister(json, views).Run();
}

}  // namespace furrow::gltf
