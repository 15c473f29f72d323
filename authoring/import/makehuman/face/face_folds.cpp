// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/face/face_folds.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/paint/noise.h"

namespace furrow::authoring {
namespace {

// Sizes in millimetres for a face of average size.
struct FoldSize {
  float width;
  float depth;
  float ridge = 0.35f;
  float taper = 0.6f;
};

// Collects strokes. Points are displaced by a small repeatable random amount, since evenly spaced
// folds look like stripes.
class FoldDrawing {
 public:
  FoldDrawing(const FaceLandmarks& face, const char* map) : face_(face), map_(map) {}

  // Sets the name and the muscle of the following strokes.
  void Begin(const char* name, const char* muscle) {
    name_ = name;
    muscle_ = muscle;
  }

  void Add(std::vector<glm::vec3> points, FoldSize size) {
    BakeStroke stroke;
    stroke.name = name_;
    stroke.muscle = muscle_;
    stroke.maps = {map_};
    const int serial = static_cast<int>(strokes_.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const int n = static_cast<int>(i);
      points[i] += face_.Millimetres(0.9f) * glm::vec3(HashLattice(serial, n, 1) - 0.5f,
                                                       HashLattice(serial, n, 2) - 0.5f, 0.0f);
    }
    stroke.points = std::move(points);
    const float vary = 0.8f + 0.4f * HashLattice(serial, 7, 3);
    stroke.width_mm = size.width * face_.scale;
    stroke.depth_mm = size.depth * face_.scale * vary;
    stroke.ridge = size.ridge;
    stroke.taper = size.taper;
    strokes_.push_back(std::move(stroke));
  }

  // Prevents strain folds within `reach` millimetres of a line.
  void Exclude(std::vector<glm::vec3> points, float reach) {
    BakeStroke stroke;
    stroke.name = name_;
    stroke.kind = BakeStroke::Kind::kExclude;
    stroke.muscle = muscle_;
    stroke.maps = {map_};
    stroke.points = std::move(points);
    stroke.width_mm = reach * face_.scale;
    strokes_.push_back(std::move(stroke));
  }

  // A point relative to a landmark, in millimetres: `out` is away from the middle of the face.
  [[nodiscard]] glm::vec3 From(const glm::vec3& landmark, int side, float out, float up) const {
    return landmark + face_.Millimetres(1.0f) * glm::vec3(side == 0 ? out : -out, up, 0.0f);
  }

  [[nodiscard]] std::vector<BakeStroke> Take() { return std::move(strokes_); }

 private:
  const FaceLandmarks& face_;
  const char* map_;
  const char* name_ = "";
  const char* muscle_ = "";
  std::vector<BakeStroke> strokes_;
};

// Irregular furrows across the forehead. The lowest crosses the middle and sags there, the second
// is broken and overlaps itself, and the upper ones are on one side each and fade out.
void Forehead(const FaceLandmarks& face, FoldDrawing* drawing) {
  drawing->Begin("forehead furrow", "frontalis");
  const FaceLandmarks::Side& left = face.sides[0];
  const FaceLandmarks::Side& right = face.sides[1];
  drawing->Add({drawing->From(right.brow_middle, 1, 17.0f, 9.0f),
                drawing->From(right.brow_middle, 1, 3.0f, 15.0f),
                drawing->From(right.brow_inner, 1, 3.0f, 13.5f),
                drawing->From(left.brow_inner, 0, -2.0f, 10.5f),
                drawing->From(left.brow_inner, 0, 9.0f, 13.0f),
                drawing->From(left.brow_middle, 0, 4.0f, 14.0f),
                drawing->From(left.brow_middle, 0, 14.0f, 8.0f)},
               {4.4f, 1.25f, 0.35f, 0.55f});
  drawing->Add({drawing->From(right.brow_middle, 1, 12.0f, 22.0f),
                drawing->From(right.brow_middle, 1, -4.0f, 25.5f),
                drawing->From(right.brow_inner, 1, -1.0f, 22.0f),
                drawing->From(left.brow_inner, 0, -10.0f, 19.0f)},
               {4.6f, 1.15f, 0.35f, 0.7f});
  drawing->Add({drawing->From(left.brow_inner, 0, -13.0f, 25.0f),
                drawing->From(left.brow_inner, 0, 5.0f, 22.5f),
                drawing->From(left.brow_middle, 0, 2.0f, 25.0f),
                drawing->From(left.brow_middle, 0, 18.0f, 19.5f)},
               {4.2f, 1.3f, 0.35f, 0.6f});
  drawing->Add({drawing->From(right.brow_middle, 1, 5.0f, 35.0f),
                drawing->From(right.brow_inner, 1, 6.0f, 33.0f),
                drawing->From(left.brow_inner, 0, -6.0f, 30.5f),
                drawing->From(left.brow_inner, 0, 8.0f, 34.0f)},
               {4.8f, 0.8f, 0.35f, 0.9f});
  drawing->Add({drawing->From(left.brow_inner, 0, 8.0f, 44.0f),
                drawing->From(left.brow_middle, 0, -3.0f, 42.5f),
                drawing->From(left.brow_middle, 0, 9.0f, 38.0f)},
               {4.0f, 0.5f, 0.35f, 1.0f});
}

void Glabella(const FaceLandmarks& face, FoldDrawing* drawing) {
  drawing->Begin("glabella", "corrugator supercilii, procerus");
  for (int s = 0; s < 2; ++s) {
    const glm::vec3& brow = face.sides[s].brow_inner;
    // One line is longer than the other, since faces are not symmetric.
    const float top = s == 0 ? 17.0f : 12.0f;
    drawing->Add({drawing->From(brow, s, -6.0f, top), drawing->From(brow, s, -6.5f, 0.5f * top),
                  drawing->From(brow, s, -8.0f, -1.0f), drawing->From(brow, s, -8.5f, -10.0f)},
                 {4.6f, s == 0 ? 1.25f : 1.0f, 0.4f, 0.9f});
    // The roll of the brow: skin that is pushed up over its inner end.
    drawing->Add({drawing->From(brow, s, 1.5f, 5.0f), drawing->From(brow, s, 7.0f, 9.0f),
                  drawing->From(brow, s, 16.0f, 10.0f)},
                 {5.0f, 0.3f, 0.35f, 1.0f});
  }
  const glm::vec3 root = glm::mix(face.sides[0].brow_inner, face.sides[1].brow_inner, 0.5f);
  drawing->Add({drawing->From(root, 0, -8.5f, -14.0f), drawing->From(root, 0, 0.5f, -16.5f),
                drawing->From(root, 0, 7.5f, -14.5f)},
               {3.2f, 0.85f, 0.35f, 0.95f});
  drawing->Add({drawing->From(root, 0, -4.5f, -20.5f), drawing->From(root, 0, 1.0f, -21.5f),
                drawing->From(root, 0, 6.0f, -20.0f)},
               {2.6f, 0.4f, 0.35f, 1.0f});
}

void BunnyLines(const FaceLandmarks& face, FoldDrawing* drawing) {
  drawing->Begin("bunny line", "nasalis");
  for (int s = 0; s < 2; ++s) {
    // {start, fall, length}: the lines slant down and outward and all differ.
    constexpr std::array<std::array<float, 3>, 3> kLines{
        {{5.0f, 4.0f, 11.0f}, {0.0f, 6.5f, 14.0f}, {-6.0f, 6.0f, 12.0f}}};
    for (const auto& [up, fall, length] : kLines) {
      drawing->Add({drawing->From(face.nose_bridge, s, 4.0f, up),
                    drawing->From(face.nose_bridge, s, 4.0f + 0.5f * length, up - 0.35f * fall),
                    drawing->From(face.nose_bridge, s, 4.0f + length, up - fall)},
                   {3.2f, 1.2f, 0.4f, 0.8f});
    }
  }
}

// A fan at the outer corner of the eye, and lines along the lower lid.
void EyeFolds(const FaceLandmarks& face, FoldDrawing* drawing) {
  drawing->Begin("crow's foot", "orbicularis oculi");
  // {out, up, depth}: the middle lines are long and deep.
  constexpr std::array<std::array<float, 3>, 5> kFan{{{4.5f, 9.0f, 0.28f},
                                                      {8.5f, 4.0f, 0.45f},
                                                      {10.0f, -3.0f, 0.50f},
                                                      {7.0f, -9.0f, 0.38f},
                                                      {4.0f, -14.0f, 0.22f}}};
  for (int s = 0; s < 2; ++s) {
    const FaceLandmarks::Side& side = face.sides[s];
    for (const auto& [out, up, depth] : kFan) {
      drawing->Add({drawing->From(side.eye, s, 16.5f + 0.15f * out, 0.4f * up - 1.0f),
                    drawing->From(side.eye, s, 18.0f + 0.7f * out, 0.8f * up - 1.5f),
                    drawing->From(side.eye, s, 19.0f + 1.3f * out, 1.25f * up - 2.5f)},
                   {2.6f, depth, 0.3f, 0.95f});
    }
    for (int line = 0; line < 2; ++line) {
      const float down = 1.0f + 4.5f * static_cast<float>(line);
      drawing->Add({drawing->From(side.lower_lid, s, -11.0f, 2.0f - down),
                    drawing->From(side.lower_lid, s, 0.0f, -1.0f - down),
                    drawing->From(side.lower_lid, s, 12.0f, 1.5f - down)},
                   {2.9f, line == 0 ? 0.5f : 0.28f, 0.35f, 0.95f});
    }
    // The pouch below must stay smooth, although the joint of the lower lid would crumple it.
    drawing->Exclude({drawing->From(side.lower_lid, s, -14.0f, -6.0f),
                      drawing->From(side.lower_lid, s, 0.0f, -10.0f),
                      drawing->From(side.lower_lid, s, 16.0f, -8.0f),
                      drawing->From(side.lower_lid, s, 26.0f, 2.0f)},
                     19.0f);
  }
}

void Nasolabial(const FaceLandmarks& face, FoldDrawing* drawing) {
  drawing->Begin("nasolabial fold", "levator labii, zygomaticus");
  for (int s = 0; s < 2; ++s) {
    const FaceLandmarks::Side& side = face.sides[s];
    drawing->Add(
        {drawing->From(side.fold_top, s, -2.0f, 6.0f), drawing->From(side.fold_top, s, 0.5f, -4.0f),
         drawing->From(side.fold_middle, s, 2.0f, -2.0f),
         drawing->From(side.fold_bottom, s, 3.5f, -1.0f),
         drawing->From(side.mouth_corner, s, 7.0f, -6.0f)},
        {5.4f, 1.8f, 0.5f, 0.8f});
    // The arc of the dimple, outside the lower end of the fold.
    drawing->Add({drawing->From(side.fold_bottom, s, 11.0f, 7.0f),
                  drawing->From(side.fold_bottom, s, 13.0f, -1.0f),
                  drawing->From(side.fold_bottom, s, 11.0f, -9.0f)},
                 {3.8f, 0.5f, 0.35f, 0.9f});
  }
}

void Marionette(const FaceLandmarks& face, FoldDrawing* drawing) {
  drawing->Begin("marionette line", "depressor anguli oris");
  for (int s = 0; s < 2; ++s) {
    const FaceLandmarks::Side& side = face.sides[s];
    drawing->Add({drawing->From(side.mouth_corner, s, 4.0f, 1.0f),
                  drawing->From(side.mouth_corner, s, 6.5f, -9.0f),
                  drawing->From(side.mouth_corner, s, 6.0f, -20.0f)},
                 {3.8f, 1.5f});
    drawing->Add({drawing->From(side.fold_bottom, s, 8.0f, 9.0f),
                  drawing->From(side.fold_bottom, s, 11.0f, -3.0f)},
                 {3.2f, 0.68f});
  }
}

void Chin(const FaceLandmarks& face, FoldDrawing* drawing) {
  drawing->Begin("chin", "mentalis");
  const glm::vec3& under = face.lower_lip_bottom;
  drawing->Add({drawing->From(under, 0, -14.0f, -4.0f), drawing->From(under, 0, 0.0f, -1.5f),
                drawing->From(under, 0, 14.0f, -4.0f)},
               {3.8f, 1.35f});
  // A pebbled chin: short dents over the mentalis.
  for (int i = 0; i < 16; ++i) {
    const float out = (HashLattice(i, 11, 5) - 0.5f) * 24.0f;
    const float up = -6.0f - 14.0f * HashLattice(i, 12, 5);
    const float turn = (HashLattice(i, 13, 5) - 0.5f) * 4.0f;
    drawing->Add(
        {drawing->From(under, 0, out - 1.6f, up), drawing->From(under, 0, out + 1.6f, up + turn)},
        {3.2f, 0.3f});
  }
}

// A raised cheek bulges without folds, although its joints compress it.
void Cheeks(const FaceLandmarks& face, FoldDrawing* drawing) {
  drawing->Begin("smooth cheek", "malar fat");
  for (int s = 0; s < 2; ++s) {
    const FaceLandmarks::Side& side = face.sides[s];
    drawing->Exclude({drawing->From(side.cheek, s, -14.0f, -2.0f), side.cheek,
                      drawing->From(side.mouth_corner, s, 30.0f, 0.0f),
                      drawing->From(side.chin_side, s, 22.0f, 2.0f)},
                     22.0f);
  }
}

// Projects a point onto the plane of the nearest texel. Using the texel itself would make lines
// jagged.
glm::vec3 OntoSurface(const std::vector<const SurfaceTexel*>& surface, const glm::vec3& p) {
  float nearest = std::numeric_limits<float>::max();
  const SurfaceTexel* found = nullptr;
  for (const SurfaceTexel* texel : surface) {
    const glm::vec3 away = texel->position - p;
    const float distance = glm::dot(away, away);
    if (distance >= nearest) continue;
    nearest = distance;
    found = texel;
  }
  if (found == nullptr) return p;
  return p + found->normal * glm::dot(found->position - p, found->normal);
}

}  // namespace

std::vector<BakeStroke> FaceStrokes(const FaceLandmarks& face,
                                    const std::vector<SurfaceTexel>& texels) {
  FoldDrawing stretch(face, "stretch");
  Forehead(face, &stretch);
  Marionette(face, &stretch);
  Chin(face, &stretch);
  Cheeks(face, &stretch);
  FoldDrawing squash(face, "squash");
  Glabella(face, &squash);
  BunnyLines(face, &squash);
  EyeFolds(face, &squash);
  Nasolabial(face, &squash);
  Cheeks(face, &squash);
  std::vector<BakeStroke> strokes = stretch.Take();
  for (BakeStroke& stroke : squash.Take()) strokes.push_back(std::move(stroke));

  // One texel in three is dense enough. Only texels that face forward count, since the inside of
  // the mouth is nearer to some landmarks than the cheek.
  std::vector<const SurfaceTexel*> surface;
  for (std::size_t i = 0; i < texels.size(); i += 3) {
    if (texels[i].normal.z > -0.2f) surface.push_back(&texels[i]);
  }
  for (BakeStroke& stroke : strokes) {
    for (glm::vec3& point : stroke.points) point = OntoSurface(surface, point);
  }
  return strokes;
}

}  // namespace furrow::authoring
