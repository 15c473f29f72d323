// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/formats/mhskel.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <nlohmann/json.hpp>

#include "base/status.h"
#include "base/text.h"

namespace furrow::authoring {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxJointVertices = 65'536;
constexpr std::size_t kMaxWeights = 8'000'000;

// The library throws; all of its errors become a status with the line.
Result<Json> ParseJson(std::string_view text, std::string_view source) {
  try {
    return Json::parse(text.begin(), text.end());
  } catch (const Json::parse_error& error) {
    const std::size_t line = LineOf(text, error.byte == 0 ? 0 : error.byte - 1);
    return Status(StatusCode::kParse, "invalid JSON", Where(source, line));
  } catch (const Json::exception&) {  // number out of range
    return Status(StatusCode::kParse, "the JSON has a number that is too large",
                  std::string(source));
  }
}

Status SchemaError(std::string_view source, const std::string& field, const std::string& what) {
  return Status(StatusCode::kSchema, what, std::string(source) + ": " + field);
}

// A member of the required type. The pointer is valid as long as `object`.
Result<const Json*> Member(const Json& object, const char* name, Json::value_t type,
                           std::string_view source, const std::string& field) {
  const auto it = object.find(name);
  if (it == object.end()) return SchemaError(source, field, "is missing");
  if (it->type() != type)
    return SchemaError(source, field,
                       std::string("must be of type ") + Json(type).type_name() +
                           ", but is of type " + it->type_name());
  return &*it;
}

// Indices are checked against the mesh later, because this file does not know its size.
Status ReadVertices(const Json& list, std::string_view source, const std::string& field,
                    std::vector<std::uint32_t>* vertices) {
  if (!list.is_array() || list.empty())
    return SchemaError(source, field, "must be a list of at least one vertex index");
  if (list.size() > kMaxJointVertices)
    return Status(StatusCode::kLimit,
                  "lists " + std::to_string(list.size()) + " vertices; the limit is 65536",
                  std::string(source) + ": " + field);
  for (const Json& item : list) {
    if (!item.is_number_unsigned() || item.get<std::uint64_t>() > UINT32_MAX)
      return SchemaError(source, field,
                         "contains " + Quoted(item.dump()) + ", which is not a vertex index");
    vertices->push_back(item.get<std::uint32_t>());
  }
  return {};
}

// Reads the vertices at one end of a bone. Ends name an entry of "joints".
Status ReadEnd(const Json& bone, const char* end, const Json& positions, std::string_view source,
               const std::string& field, std::vector<std::uint32_t>* vertices) {
  const Result<const Json*> name =
      Member(bone, end, Json::value_t::string, source, field + "." + end);
  FURROW_RETURN_IF_ERROR(name);
  const std::string& key = (*name)->get_ref<const std::string&>();
  const auto list = positions.find(key);
  if (list == positions.end())
    return Status(StatusCode::kNotFound, Quoted(key) + " is not in \"joints\"",
                  std::string(source) + ": " + field + "." + end);
  return ReadVertices(*list, source, "joints." + key, vertices);
}

// A joint lies at the mean of its vertices, so it follows the body's shape.
Result<glm::vec3> MeanOf(std::span<const std::uint32_t> vertices,
                         std::span<const glm::vec3> positions, const std::string& joint,
                         std::string_view source) {
  glm::dvec3 sum(0.0);
  for (const std::uint32_t vertex : vertices) {
    if (vertex >= positions.size())
      return Status(StatusCode::kInvalidArgument,
                    "vertex index " + std::to_string(vertex) + " is out of range; the mesh has " +
                        Counted(positions.size(), "vertex", "vertices"),
                    std::string(source) + ": " + joint, "use the skeleton of this base mesh");
    sum += glm::dvec3(positions[vertex]);
  }
  return glm::vec3(sum / static_cast<double>(vertices.size()));
}

Status ReadWeight(const Json& item, std::string_view source, const std::string& field,
                  std::pair<std::uint32_t, float>* out) {
  if (!item.is_array() || item.size() != 2 || !item[0].is_number_unsigned() ||
      !item[1].is_number() || item[0].get<std::uint64_t>() > UINT32_MAX)
    return SchemaError(source, field,
                       "contains " + Quoted(item.dump()) + ", which is not [vertex index, weight]");
  const double weight = item[1].get<double>();
  if (!(weight >= 0.0 && weight <= 1.0))
    return Status(StatusCode::kInvalidArgument,
                  "contains the weight " + item[1].dump() + ", which is not in [0, 1]",
                  std::string(source) + ": " + field);
  *out = {item[0].get<std::uint32_t>(), static_cast<float>(weight)};
  return {};
}

}  // namespace

Result<MhSkeleton> ParseMhskel(std::string_view text, std::string_view source) {
  const Result<Json> json = ParseJson(text, source);
  FURROW_RETURN_IF_ERROR(json);
  if (!json->is_object()) return SchemaError(source, "(whole file)", "must be a JSON object");
  const auto bones = Member(*json, "bones", Json::value_t::object, source, "bones");
  FURROW_RETURN_IF_ERROR(bones);
  const auto positions = Member(*json, "joints", Json::value_t::object, source, "joints");
  FURROW_RETURN_IF_ERROR(positions);
  if ((*bones)->size() > wrinkle::kMaxJoints)
    return Status(StatusCode::kLimit,
                  "the file has " + std::to_string((*bones)->size()) + " bones; the limit is " +
                      std::to_string(wrinkle::kMaxJoints),
                  std::string(source));
  MhSkeleton skeleton;
  for (const auto& [name, bone] : (*bones)->items()) {
    const std::string field = "bones." + name;
    if (!bone.is_object()) return SchemaError(source, field, "must be a JSON object");
    MhSkeleton::Joint joint;
    joint.name = name;
    const auto parent = bone.find("parent");
    if (parent == bone.end() || !(parent->is_null() || parent->is_string()))
      return SchemaError(source, field + ".parent", "must be the name of a bone, or null");
    if (parent->is_string()) joint.parent = parent->get<std::string>();
    if (Status status = ReadEnd(bone, "head", **positions, source, field, &joint.head);
        !status.ok())
      return status;
    if (Status status = ReadEnd(bone, "tail", **positions, source, field, &joint.tail);
        !status.ok())
      return status;
    skeleton.joints.push_back(std::move(joint));
  }
  return skeleton;
}

Result<MhWeights> ParseMhw(std::string_view text, std::string_view source) {
  const Result<Json> json = ParseJson(text, source);
  FURROW_RETURN_IF_ERROR(json);
  if (!json->is_object()) return SchemaError(source, "(whole file)", "must be a JSON object");
  const auto lists = Member(*json, "weights", Json::value_t::object, source, "weights");
  FURROW_RETURN_IF_ERROR(lists);
  MhWeights weights;
  std::size_t total = 0;
  for (const auto& [name, list] : (*lists)->items()) {
    const std::string field = "weights." + name;
    if (!list.is_array()) return SchemaError(source, field, "must be a list");
    total += list.size();
    if (total > kMaxWeights)
      return Status(StatusCode::kLimit, "the file has more than 8000000 weights",
                    std::string(source));
    MhWeights::Joint joint;
    joint.name = name;
    joint.vertices.reserve(list.size());
    for (const Json& item : list) {
      std::pair<std::uint32_t, float> entry;
      FURROW_RETURN_IF_ERROR(ReadWeight(item, source, field, &entry));
      joint.vertices.push_back(entry);
    }
    weights.joints.push_back(std::move(joint));
  }
  return weights;
}

Result<wrinkle::Skeleton> BuildSkeleton(const MhSkeleton& skeleton,
                                        std::span<const glm::vec3> positions,
                                        std::string_view source) {
  // Bones may be listed before their parents, so all names are collected first.
  std::unordered_map<std::string_view, int> index;
  for (const MhSkeleton::Joint& joint : skeleton.joints)
    index.emplace(joint.name, static_cast<int>(index.size()));
  std::vector<glm::vec3> heads;
  for (const MhSkeleton::Joint& joint : skeleton.joints) {
    const Result<glm::vec3> head = MeanOf(joint.head, positions, joint.name, source);
    FURROW_RETURN_IF_ERROR(head);
    heads.push_back(*head);
  }
  std::vector<wrinkle::JointDesc> descs;
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const MhSkeleton::Joint& joint = skeleton.joints[i];
    wrinkle::JointDesc desc;
    desc.name = joint.name;
    desc.rest.translation = heads[i];
    if (!joint.parent.empty()) {
      const auto parent = index.find(joint.parent);
      if (parent == index.end())
        return Status(StatusCode::kNotFound, "parent " + Quoted(joint.parent) + " does not exist",
                      std::string(source) + ": " + joint.name);
      desc.parent = parent->second;
      desc.rest.translation -= heads[static_cast<std::size_t>(parent->second)];
    }
    const Result<glm::vec3> tail = MeanOf(joint.tail, positions, joint.name, source);
    FURROW_RETURN_IF_ERROR(tail);
    desc.tail = *tail - heads[i];
    descs.push_back(std::move(desc));
  }
  Result<wrinkle::Skeleton> built = wrinkle::Skeleton::Create(std::move(descs));
  if (!built.ok()) return built.status().At(source);
  return built;
}

}  // namespace furrow::authoring
