// SPDX-License-Identifier: Apache-2.0
#include "gltf/document/draco_primitives.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/text.h"
#include "gltf/limits.h"

namespace furrow::gltf {
namespace {

using Json = nlohmann::json;

constexpr const char* kDraco = "KHR_draco_mesh_compression";
constexpr int kUnsignedInt = 5125;
constexpr std::array<const char*, 4> kTypes = {"SCALAR", "VEC2", "VEC3", "VEC4"};

std::string FieldOf(std::size_t mesh, std::size_t primitive) {
  return "meshes[" + std::to_string(mesh) + "].primitives[" + std::to_string(primitive) + "]";
}

// The member if `object` is an object that has it, else null.
Json* Member(Json* object, const char* key) {
  if (object == nullptr || !object->is_object()) return nullptr;
  const auto found = object->find(key);
  return found == object->end() ? nullptr : &*found;
}

// The entry that a member indexes, or null.
Json* EntryAt(Json* list, const Json* index) {
  if (list == nullptr || !list->is_array() || index == nullptr || !index->is_number_unsigned()) {
    return nullptr;
  }
  const auto at = index->get<std::uint64_t>();
  return at < list->size() ? &(*list)[at] : nullptr;
}

class Decoding {
 public:
  Decoding(Json* json, BufferViews* views)
      : json_(json), views_(views), num_views_(views->views.size()) {}

  Status Run(const DracoDecoder& decode) {
    FURROW_RETURN_IF_ERROR(FindPrimitives());
    if (found_.empty()) return {};
    const Json* accessors = Member(json_, "accessors");
    if (accessors == nullptr || !accessors->is_array()) {
      return {StatusCode::kSchema, "expected an array", "accessors"};
    }
    std::vector<std::span<const std::uint8_t>> compressed;
    for (auto& [view, index] : mesh_of_view_) {
      index = compressed.size();
      compressed.push_back(views_->views[view].bytes);
    }
    Result<std::vector<DracoMesh>> meshes = decode(compressed);
    if (!meshes.ok()) return meshes.status().At(found_.front().field);
    if (meshes->size() != compressed.size()) {
      return {StatusCode::kInternal, "the decoder has lost meshes", found_.front().field};
    }
    meshes_ = std::move(*meshes);
    for (const Found& primitive : found_) FURROW_RETURN_IF_ERROR(Replace(primitive));
    return {};
  }

 private:
  struct Found {
    Json* primitive;
    std::size_t view;
    std::string field;  // of the extension
  };

  Status FindPrimitives() {
    Json* meshes = Member(json_, "meshes");
    for (std::size_t m = 0; meshes != nullptr && meshes->is_array() && m < meshes->size(); ++m) {
      Json* primitives = Member(&(*meshes)[m], "primitives");
      if (primitives == nullptr || !primitives->is_array()) continue;
      for (std::size_t p = 0; p < primitives->size(); ++p) {
        Json* primitive = &(*primitives)[p];
        Json* draco = Member(Member(primitive, "extensions"), kDraco);
        if (draco == nullptr) continue;
        const std::string field = FieldOf(m, p) + ".extensions." + kDraco;
        const Json* view = Member(draco, "bufferView");
        if (view == nullptr || !view->is_number_unsigned() ||
            view->get<std::uint64_t>() >= num_views_) {
          return {StatusCode::kSchema, "the buffer view does not exist", field + ".bufferView"};
        }
        found_.push_back({primitive, view->get<std::size_t>(), field});
        mesh_of_view_[found_.back().view] = 0;
      }
    }
    if (mesh_of_view_.size() > kMaxDracoMeshes) {
      return {StatusCode::kLimit,
              "more than " + std::to_string(kMaxDracoMeshes) + " compressed meshes", "meshes"};
    }
    return {};
  }

  Status Replace(const Found& found) {
    const std::size_t index = mesh_of_view_.at(found.view);
    const DracoMesh& mesh = meshes_[index];
    Json* ids = Member(Member(Member(found.primitive, "extensions"), kDraco), "attributes");
    Json* attributes = Member(found.primitive, "attributes");
    if (ids == nullptr || !ids->is_object() || attributes == nullptr) {
      return {StatusCode::kSchema, "expected an object", found.field + ".attributes"};
    }
    for (const auto& entry : ids->items()) {
      const std::string& name = entry.key();
      const Json& id = entry.value();
      const std::string field = found.field + ".attributes." + name;
      const auto has_id = [&](const DracoAttribute& attribute) {
        return id.is_number_unsigned() && id.get<std::uint64_t>() == attribute.id;
      };
      const auto attribute = std::ranges::find_if(mesh.attributes, has_id);
      if (attribute == mesh.attributes.end()) {
        return {StatusCode::kSchema, "the compressed mesh has no attribute of this id", field};
      }
      Json* place = Member(attributes, name.c_str());
      Json accessor;
      FURROW_RETURN_IF_ERROR(CopyAccessor(place, mesh.num_points, "vertex", field, &accessor));
      const auto type = accessor.find("type");
      if (type == accessor.end() ||
          *type != kTypes[static_cast<std::size_t>(std::clamp(attribute->components, 1, 4) - 1)]) {
        return {StatusCode::kSchema, "the accessor has another type than the compressed mesh",
                field};
      }
      accessor["componentType"] = attribute->component_type;
      const auto number = static_cast<std::size_t>(attribute - mesh.attributes.begin());
      FURROW_RETURN_IF_ERROR(Attach({index, number + 1}, attribute->values, field, &accessor));
      *place = AddAccessor(std::move(accessor));
    }
    FURROW_RETURN_IF_ERROR(ReplaceIndices(found, index));
    found.primitive->erase("extensions");
    return {};
  }

  Status ReplaceIndices(const Found& found, std::size_t index) {
    const std::vector<std::uint32_t>& indices = meshes_[index].indices;
    Json* place = Member(found.primitive, "indices");
    Json accessor = {{"type", "SCALAR"}, {"count", indices.size()}};
    if (place != nullptr) {
      FURROW_RETURN_IF_ERROR(CopyAccessor(place, indices.size(), "index", found.field, &accessor));
    }
    accessor["componentType"] = kUnsignedInt;
    accessor.erase("normalized");
    const auto bytes = std::as_bytes(std::span(indices));
    const auto* first = reinterpret_cast<const std::uint8_t*>(bytes.data());
    FURROW_RETURN_IF_ERROR(
        Attach({index, 0}, {first, first + bytes.size()}, found.field, &accessor));
    (*found.primitive)["indices"] = AddAccessor(std::move(accessor));
    found.primitive->erase("mode");  // strips are decoded to triangles
    return {};
  }

  // `what`: an element, for the error.
  Status CopyAccessor(Json* place, std::size_t count, const std::string& what,
                      const std::string& field, Json* accessor) {
    const Json* from = EntryAt(Member(json_, "accessors"), place);
    if (from == nullptr || !from->is_object()) {
      return {StatusCode::kSchema, "the primitive has no accessor for it", field};
    }
    const auto stated = from->find("count");
    if (stated == from->end() || *stated != count) {
      return {
          StatusCode::kSchema,
          "the accessor states another count than the compressed mesh has, " + Counted(count, what),
          field};
    }
    *accessor = *from;
    accessor->erase("byteOffset");
    accessor->erase("sparse");
    return {};
  }

  // Lets the accessor refer to the values. Primitives that share a compressed mesh share them.
  Status Attach(std::pair<std::size_t, std::size_t> key, std::vector<std::uint8_t> values,
                const std::string& field, Json* accessor) {
    auto [known, is_new] = view_of_.try_emplace(key, views_->views.size());
    if (is_new) {
      decoded_bytes_ += values.size();
      if (decoded_bytes_ > kMaxFileBytes) {
        return {StatusCode::kLimit, "the decoded meshes are larger than 1 GiB together", field};
      }
      views_->owned_buffers.push_back(std::move(values));
      views_->views.push_back({views_->owned_buffers.back(), 0});
    }
    (*accessor)["bufferView"] = known->second;
    return {};
  }

  std::size_t AddAccessor(Json accessor) {
    Json& accessors = (*json_)["accessors"];
    accessors.push_back(std::move(accessor));
    return accessors.size() - 1;
  }

  Json* json_;
  BufferViews* views_;
  std::size_t num_views_;  // of the file
  std::vector<Found> found_;
  std::map<std::size_t, std::size_t> mesh_of_view_;  // index in meshes_ by buffer view
  std::vector<DracoMesh> meshes_;
  // By mesh and attribute + 1, or 0 for the indices.
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> view_of_;
  std::uint64_t decoded_bytes_ = 0;
};

}  // namespace

Status DecodeDracoPrimitives(const DracoDecoder& decode, Json* json, BufferViews* views) {
  return Decoding(json, views).Run(decode);
}

}  // namespace furrow::gltf
