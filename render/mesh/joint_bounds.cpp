// SPDX-License-Identifier: Apache-2.0
#include "render/mesh/joint_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>

#include "render/mesh/mesh_morphs.h"

namespace furrow::render {

JointBounds::JointBounds(const character::Character& character,
                         const std::function<bool(const character::Material&)>& accept) {
  for (const character::Mesh& mesh : character.meshes) {
    if (accept(character.materials[static_cast<std::size_t>(mesh.material)])) {
      Add(mesh, character.inverse_bind_matrices);
    }
  }
}

JointBounds::JointBounds(const character::Mesh& mesh,
                         std::span<const glm::mat4> inverse_bind_matrices) {
  Add(mesh, inverse_bind_matrices);
}

JointBounds::JointBounds(const character::Mesh& mesh, std::span<const std::uint32_t> vertices,
                         std::span<const glm::mat4> inverse_bind_matrices) {
  AddBoxes(
      vertices.size(),
      [&](std::size_t i) -> const character::Vertex& { return mesh.vertices[vertices[i]]; },
      inverse_bind_matrices);
}

void JointBounds::Add(const character::Mesh& mesh,
                      std::span<const glm::mat4> inverse_bind_matrices) {
  const std::size_t first_box = boxes_.size();
  AddBoxes(
      mesh.vertices.size(),
      [&](std::size_t i) -> const character::Vertex& { return mesh.vertices[i]; },
      inverse_bind_matrices);
  AddMoves(mesh, inverse_bind_matrices, first_box);
}

template <class VertexOf>
void JointBounds::AddBoxes(std::size_t count, const VertexOf& vertex_of,
                           std::span<const glm::mat4> inverse_bind_matrices) {
  // A map keeps the boxes in joint order, which makes the result independent of the vertex order.
  std::map<int, Box> boxes;
  for (std::size_t number = 0; number < count; ++number) {
    const character::Vertex& vertex = vertex_of(number);
    for (int i = 0; i < 4; ++i) {
      // Boxes are in the joint's bind space. They rotate with the joint and stay valid in every
      // pose.
      if (!(vertex.skin_weights[i] > 0.0f)) continue;
      const int joint = vertex.joints[i];
      const glm::vec3 place(inverse_bind_matrices[static_cast<std::size_t>(joint)] *
                            glm::vec4(vertex.position, 1.0f));
      const auto [found, is_new] = boxes.try_emplace(joint, Box{joint, place, place});
      if (is_new) continue;
      found->second.low = glm::min(found->second.low, place);
      found->second.high = glm::max(found->second.high, place);
    }
  }
  for (const auto& [joint, box] : boxes) boxes_.push_back(box);
}

void JointBounds::AddMoves(const character::Mesh& mesh,
                           std::span<const glm::mat4> inverse_bind_matrices,
                           std::size_t first_box) {
  std::map<int, std::size_t> box_of_joint;
  for (std::size_t box = first_box; box < boxes_.size(); ++box) {
    box_of_joint[boxes_[box].joint] = box;
  }
  for (const character::MorphTarget& target : mesh.morph_targets) {
    std::map<std::size_t, Move> moves;  // by box
    for (const character::MorphDelta& delta : target.deltas) {
      const character::Vertex& vertex = mesh.vertices[delta.vertex];
      for (int i = 0; i < 4; ++i) {
        if (!(vertex.skin_weights[i] > 0.0f)) continue;
        const std::size_t box = box_of_joint.at(vertex.joints[i]);
        // A delta is a direction: the joint's translation does not apply.
        const glm::vec3 way = glm::mat3(inverse_bind_matrices[vertex.joints[i]]) * delta.position;
        Move& move =
            moves.try_emplace(box, Move{box, static_cast<std::size_t>(target.shape)}).first->second;
        move.low = glm::min(move.low, way);
        move.high = glm::max(move.high, way);
      }
    }
    for (const auto& [box, move] : moves) moves_.push_back(move);
  }
}

std::vector<JointBounds::Box> JointBounds::MovedBoxes(std::span<const float> shapes) const {
  std::vector<Box> boxes = boxes_;
  for (const Move& move : moves_) {
    const float weight = move.shape < shapes.size() ? DrawnShapeWeight(shapes[move.shape]) : 0.0f;
    Box& box = boxes[move.box];
    box.low += weight * (weight > 0.0f ? move.low : move.high);
    box.high += weight * (weight > 0.0f ? move.high : move.low);
  }
  return boxes;
}

JointBounds::Extent JointBounds::Look(const Pose& pose, const glm::mat4& view_projection,
                                      float reach) const {
  Extent extent{glm::vec2(std::numeric_limits<float>::max()),
                glm::vec2(std::numeric_limits<float>::lowest()), std::numeric_limits<float>::max()};
  const std::vector<Box> moved = moves_.empty() ? std::vector<Box>() : MovedBoxes(pose.shapes);
  for (const Box& box : moves_.empty() ? boxes_ : moved) {
    const glm::mat4 to_clip = view_projection * pose.model[static_cast<std::size_t>(box.joint)];
    const glm::vec3 low_corner = box.low - reach;
    const glm::vec3 high_corner = box.high + reach;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 place((corner & 1) != 0 ? high_corner.x : low_corner.x,
                            (corner & 2) != 0 ? high_corner.y : low_corner.y,
                            (corner & 4) != 0 ? high_corner.z : low_corner.z);
      const glm::vec4 clip = to_clip * glm::vec4(place, 1.0f);
      // A corner behind the camera has no projection, so the boxes may cover the whole picture.
      if (!(clip.w > 1e-6f)) return {glm::vec2(-1.0f), glm::vec2(1.0f), 0.0f};
      const glm::vec2 screen = glm::vec2(clip) / clip.w;
      extent.low = glm::min(extent.low, screen);
      extent.high = glm::max(extent.high, screen);
      extent.nearest = std::min(extent.nearest, clip.w);
    }
  }
  return extent;
}

bool JointBounds::IsBeyond(const ViewSides& sides, float reach) const {
  for (std::size_t side = 0; side < std::tuple_size_v<ViewSides::Planes>; ++side) {
    const bool is_beyond = std::ranges::all_of(boxes_, [&](const Box& box) {
      const glm::vec4& plane = sides.of(box.joint)[side];
      const glm::vec3 normal(plane);
      const glm::vec3 middle = 0.5f * (box.low + box.high);
      const glm::vec3 half = 0.5f * (box.high - box.low) + reach;
      // The nearest corner to the inside.
      return glm::dot(normal, middle) + plane.w + glm::dot(glm::abs(normal), half) < 0.0f;
    });
    if (is_beyond) return true;
  }
  return false;
}

ScreenRect JointBounds::Extent::Pixels(int width, int height) const {
  if (nearest <= 0.0f) return {0, 0, width, height};
  const glm::vec2 size(width, height);
  const auto pixel = [&](const glm::vec2& place) { return (place * 0.5f + 0.5f) * size; };
  // Rounded outwards, so that partly covered pixels count.
  const glm::vec2 first = glm::clamp(glm::floor(pixel(low)), glm::vec2(0), size);
  const glm::vec2 last = glm::clamp(glm::ceil(pixel(high)), glm::vec2(0), size);
  return {static_cast<int>(first.x), static_cast<int>(first.y), static_cast<int>(last.x),
          static_cast<int>(last.y)};
}

ScreenRect JointBounds::Project(const Pose& pose, const glm::mat4& view_projection, int width,
                                int height, float reach) const {
  return Look(pose, view_projection, reach).Pixels(width, height);
}

}  // namespace furrow::render
