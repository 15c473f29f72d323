// SPDX-License-Identifier: Apache-2.0
#include "authoring/shapes/region_masks.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>

#include "authoring/paint/canvas.h"
#include "authoring/paint/surface_texels.h"
#include "authoring/shapes/face_measures.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec3;
using Values = std::vector<float>;

constexpr int kSmoothingSteps = 4;
constexpr float kSideRamp = 0.08f;  // half the width of the border between the halves, in eye
                                    // distances: 5 mm

enum Index { kBrowL, kBrowR, kGlabella, kNose, kEyeL, kEyeR, kMouthL, kMouthR };

float Fade(float from, float to, float x) {
  return from < to ? Smoothstep(from, to, x) : 1.0f - Smoothstep(to, from, x);
}

class MaskMaker {
 public:
  MaskMaker(const FaceSkin& skin, const ShapeLandmarks& landmarks)
      : skin_(skin), face_(MeasureFace(skin, landmarks)) {
    const float ramp = kSideRamp * face_.eye_distance;
    for (const vec3& p : skin.positions()) {
      left_.push_back(Smoothstep(-ramp, ramp, p.x - skin.middle()));
    }
  }

  FaceMasks Make() const {
    FaceMasks masks;
    for (const bool left : {true, false}) {
      masks[left ? kBrowL : kBrowR] = Brow(left);
      masks[left ? kEyeL : kEyeR] = Eye(left);
      masks[left ? kMouthL : kMouthR] = Mouth(left);
    }
    masks[kGlabella] = Glabella();
    masks[kNose] = Nose();
    for (Values& mask : masks) Smooth(&mask);
    Normalise(&masks);
    return masks;
  }

 private:
  static std::string Sided(const char* shape, bool left) {
    return std::string(shape) + (left ? "Left" : "Right");
  }
  [[nodiscard]] float Side(std::size_t v, bool left) const {
    return left ? left_[v] : 1.0f - left_[v];
  }

  // A window per vertex: `at(x from the middle, y)`, [0, 1].
  template <class At>
  Values Window(const At& at) const {
    Values window;
    for (const vec3& p : skin_.positions()) window.push_back(at(p.x - skin_.middle(), p.y));
    return window;
  }

  // Where a shape acts inside a window, relative to its strong motions there.
  Values Acts(const std::string& shape, const Values& window) const {
    Values mask(skin_.positions().size(), 0.0f);
    const std::vector<vec3> moves = skin_.Moves(shape);
    Values inside;
    for (std::size_t v = 0; v < moves.size(); ++v) {
      const float length = glm::length(moves[v]);
      if (window[v] > 0.5f && length > 0.0f) inside.push_back(length);
    }
    if (inside.empty()) return mask;
    const auto strong =
        inside.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(inside.size() - 1));
    std::nth_element(inside.begin(), strong, inside.end());
    const float full = *strong;
    for (std::size_t v = 0; v < moves.size(); ++v) {
      mask[v] = window[v] * Smoothstep(0.1f, 0.6f, glm::length(moves[v]) / full);
    }
    return mask;
  }

  Values Largest(std::initializer_list<std::string> shapes, const Values& window) const {
    Values largest(skin_.positions().size(), 0.0f);
    for (const std::string& shape : shapes) {
      const Values mask = Acts(shape, window);
      for (std::size_t v = 0; v < mask.size(); ++v) largest[v] = std::max(largest[v], mask[v]);
    }
    return largest;
  }

  void Cut(bool left, Values* mask) const {
    for (std::size_t v = 0; v < mask->size(); ++v) (*mask)[v] *= Side(v, left);
  }

  // Brow and forehead. The shapes of the brow also move the upper lid, which is the eye's.
  Values Brow(bool left) const {
    const Values above = Window([&](float, float y) {
      return Fade(face_.lid + 0.15f * (face_.brow - face_.lid),
                  face_.lid + 0.65f * (face_.brow - face_.lid), y);
    });
    Values mask =
        Largest({Sided("browDown", left), Sided("browOuterUp", left), "browInnerUp"}, above);
    Cut(left, &mask);
    return mask;
  }

  // Both corrugators reach it.
  Values Glabella() const {
    const Values everywhere(skin_.positions().size(), 1.0f);
    const Values left = Acts("browDownLeft", everywhere), right = Acts("browDownRight", everywhere);
    Values both(left.size());
    float most = 0.0f;
    for (std::size_t v = 0; v < left.size(); ++v) {
      both[v] = left[v] * right[v];
      most = std::max(most, both[v]);
    }
    // Shapes that end at the middle have no product, so the place decides.
    const float low = face_.brow - 0.25f * face_.eye_distance,
                high = face_.brow + 0.3f * face_.eye_distance;
    for (std::size_t v = 0; v < both.size(); ++v) {
      const vec3& p = skin_.positions()[v];
      // The forehead above is the brows'.
      both[v] *= Fade(face_.brow + 0.55f * face_.eye_distance,
                      face_.brow + 0.25f * face_.eye_distance, p.y);
      const float x = std::abs(p.x - skin_.middle()) / face_.eye_distance;
      const float place = Fade(0.32f, 0.1f, x) * Fade(low - 0.15f * face_.eye_distance, low, p.y) *
                          Fade(high + 0.25f * face_.eye_distance, high, p.y);
      const float near = std::max(left[v], right[v]);
      both[v] = std::max(most > 0.05f ? both[v] / most : 0.0f, place * near);
    }
    return both;
  }

  // The sneer moves the cheek farthest, so the nose has a window of its own.
  Values Nose() const {
    const Values window = Window([&](float x, float y) {
      return Fade(1.9f * face_.wing_x, 1.2f * face_.wing_x, std::abs(x)) *
             Fade(face_.wing - 0.2f * face_.eye_distance, face_.wing, y) *
             Fade(face_.lid + 0.15f * face_.eye_distance, face_.lid - 0.1f * face_.eye_distance, y);
    });
    return Largest({"noseSneerLeft", "noseSneerRight"}, window);
  }

  // Lower lid, pouch and crow's feet, without the rims of the lids.
  Values Eye(bool left) const {
    const Values window = Window([&](float, float y) {
      return Fade(face_.brow + 0.1f * face_.eye_distance, face_.brow - 0.1f * face_.eye_distance,
                  y) *
             Fade(face_.wing - 0.1f * face_.eye_distance, face_.wing + 0.2f * face_.eye_distance,
                  y);
    });
    Values mask = Largest({Sided("cheekSquint", left), Sided("eyeSquint", left)}, window);
    const Values lid = Acts(Sided("eyeBlink", left), Values(mask.size(), 1.0f));
    for (std::size_t v = 0; v < mask.size(); ++v) mask[v] *= 1.0f - 0.85f * lid[v];
    Cut(left, &mask);
    return mask;
  }

  Values Mouth(bool left) const {
    const Values window = Window([&](float, float y) {
      return Fade(face_.wing + 0.45f * face_.eye_distance, face_.wing + 0.1f * face_.eye_distance,
                  y);
    });
    Values mask =
        Largest({Sided("mouthSmile", left), Sided("mouthFrown", left), "mouthPucker"}, window);
    const Values fold = NasolabialFold(), nose = Nose();
    for (std::size_t v = 0; v < mask.size(); ++v) {
      mask[v] = std::max(mask[v], fold[v] * (1.0f - nose[v]));
    }
    Cut(left, &mask);
    return mask;
  }

  // The fold of a smile begins beside the wing of the nose, where the smile hardly moves the skin.
  Values NasolabialFold() const {
    constexpr float kHighest = 0.2f;             // above the wing, in eye distances
    constexpr float kAside = 0.2f;               // of the corner, likewise
    constexpr float kFull = 0.1f, kEnd = 0.26f;  // from the fold, likewise
    const float distance = face_.eye_distance;
    const glm::vec2 top(face_.wing_x, face_.wing + kHighest * distance);
    const glm::vec2 low(face_.corner_x + kAside * distance, face_.corner);
    const glm::vec2 along = low - top;
    Values mask;
    for (const vec3& p : skin_.positions()) {
      const glm::vec2 from = glm::vec2(std::abs(p.x - skin_.middle()), p.y) - top;
      const float t = std::clamp(glm::dot(from, along) / glm::dot(along, along), 0.0f, 1.0f);
      const float near = Fade(kEnd, kFull, glm::distance(from, t * along) / distance);
      // The back of the head lies behind the cheeks.
      mask.push_back(p.z > face_.corner_z - 0.7f * distance ? near : 0.0f);
    }
    return mask;
  }

  void Smooth(Values* mask) const {
    for (int step = 0; step < kSmoothingSteps; ++step) {
      const Values from = *mask;
      for (std::size_t v = 0; v < from.size(); ++v) {
        const auto around = skin_.Around(v);
        if (around.empty()) continue;
        float sum = 0.0f;
        for (const std::uint32_t other : around) sum += from[other];
        (*mask)[v] = 0.5f * (from[v] + sum / static_cast<float>(around.size()));
      }
    }
  }

  static void Normalise(FaceMasks* masks) {
    for (std::size_t v = 0; v < masks->front().size(); ++v) {
      float sum = 0.0f;
      for (const Values& mask : *masks) sum += mask[v];
      for (Values& mask : *masks) mask[v] /= std::max(sum, 1.0f);
    }
  }

  const FaceSkin& skin_;
  FaceMeasures face_;
  Values left_;
};

// The triangles of one half of a mesh. Mirrored halves then do not hide each other's texels.
character::Mesh HalfOf(const character::Mesh& mesh, float middle, bool left) {
  character::Mesh half;
  half.vertices = mesh.vertices;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    float x = 0.0f;
    for (std::size_t k = 0; k < 3; ++k) x += mesh.vertices[mesh.indices[i + k]].position.x - middle;
    if ((x >= 0.0f) != left) continue;
    half.indices.insert(half.indices.end(), mesh.indices.begin() + static_cast<std::ptrdiff_t>(i),
                        mesh.indices.begin() + static_cast<std::ptrdiff_t>(i + 3));
  }
  return half;
}

}  // namespace

FaceMasks ProposeFaceMasks(const FaceSkin& skin, const ShapeLandmarks& landmarks) {
  return MaskMaker(skin, landmarks).Make();
}

std::array<character::Picture, 2> PaintFaceMasks(const character::Character& character,
                                                 const FaceSkin& skin, const FaceMasks& masks,
                                                 int size) {
  constexpr std::size_t kRegions = kFaceRegions.size();
  const auto count = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  std::vector<std::array<float, kRegions>> texels(count, std::array<float, kRegions>{});
  std::vector<SurfaceTexel> painted;
  for (std::size_t m = 0; m < skin.meshes().size(); ++m) {
    const auto& mesh = character.meshes[static_cast<std::size_t>(skin.meshes()[m])];
    for (const bool left : {true, false}) {
      const character::Mesh half = HalfOf(mesh, skin.middle(), left);
      for (const SurfaceTexel& texel : RasterizeSurface(half, size, size)) {
        auto& values = texels[static_cast<std::size_t>(texel.y) * static_cast<std::size_t>(size) +
                              static_cast<std::size_t>(texel.x)];
        for (std::size_t r = 0; r < kRegions; ++r) {
          float value = 0.0f;
          for (int k = 0; k < 3; ++k) {
            const std::size_t corner = 3 * texel.triangle + static_cast<std::size_t>(k);
            value += texel.corners[k] * masks[r][skin.welded(m)[half.indices[corner]]];
          }
          values[r] = std::max(values[r], value);
        }
        painted.push_back(texel);
      }
    }
  }
  std::array<character::Picture, 2> pictures;
  for (std::size_t p = 0; p < 2; ++p) {
    pictures[p] = FillPicture(kFaceMaskNames[p], painted, size, 4, [&](const SurfaceTexel& at) {
      const auto& values = texels[static_cast<std::size_t>(at.y) * static_cast<std::size_t>(size) +
                                  static_cast<std::size_t>(at.x)];
      float sum = 0.0f;
      for (const float value : values) sum += value;
      const float scale = 1.0f / std::max(sum, 1.0f);
      return scale *
             glm::vec4(values[4 * p], values[4 * p + 1], values[4 * p + 2], values[4 * p + 3]);
    });
  }
  return pictures;
}

}  // namespace furrow::authoring
