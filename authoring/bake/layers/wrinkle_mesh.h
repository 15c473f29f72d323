// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "authoring/bake/request/fabric.h"
#include "authoring/bake/surface/fine_mesh.h"
#include "authoring/bake/surface/posed_surface.h"

namespace furrow::authoring {

// Cloth on a moving surface: a fine mesh that keeps the lengths of its edges, while the surface
// below is compressed and stretched (Mueller and Chentanez, Wrinkle Meshes, 2010).
//
// - Compressed cloth buckles into folds across the compression; where two compressions meet, into
//   diamonds. Cloth that is pulled one way slips, is too wide the other way, and forms drag lines.
// - A vertex stays near its place on the surface: it slides, rises and sinks by limited lengths.
//   The body limits how far it sinks, and friction how far it slides.
// - Bending stiffness B and a weak pull K towards the surface decide how wide folds are: the
//   buckling sheet on a foundation, lambda = 2 pi (B / K)^(1/4).
// - The surface is where the cloth lies on average. So a stronger pull holds the mean over a few
//   folds near the surface. Otherwise a sleeve or a leg would spend its ease on growing rounder or
//   on hanging off the limb as a whole, and stay as smooth as a pipe.
// - Hanging cloth is pulled straight by its weight, so most of its ease lies across gravity.
// - Sharply bent cloth creases: beyond a curvature, its resistance stops growing.
// - Seams, wear and the body below make cloth uneven: over about three wavelengths, its ease varies
//   between the least and as much beyond the mean, and its wavelength by up to half. Otherwise
//   folds would be rings.
// - Step() moves the surface a little and lets the cloth settle. Folds keep their identity from
//   step to step: they deepen, travel and merge.
class WrinkleMesh {
 public:
  struct Options {
    float wavelength = 0.04f;  // from fold to fold, metres, > 0
    float ease = 0.15f;        // how much wider the cloth is than the surface it was cut for, >= 0
    float hang = 0.6f;         // share of the ease that is left along gravity, [0, 1]; see below
    float sink = 0.002f;       // metres
    float rise = 0.45f;        // in wavelengths
    float slide = 0.37f;       // in wavelengths
    float weight = 0.03e-3f;   // how far gravity moves a vertex per iteration, metres
    float dents = 0.6e-3f;     // height of random dents, where the first folds begin, metres
    float variation = 1.0f;    // local differences of ease and wavelength, [0, 1]; see below
    std::uint32_t seed = 1;    // of the dents and the variation
    // Per vertex of the mesh: a multiplier for the wavelength, > 0. Empty: 1.
    std::span<const float> wider;
    // Per vertex of the mesh. Empty: as `ease` says, with tight places.
    std::span<const ClothEase> eases;
    // Per vertex of the mesh: the length that cloth gains in the last pose, because a bend pushes
    // it there; see SlippedLength(). Empty: none.
    std::span<const glm::mat3> slipped;
  };

  // `room`: per vertex of the mesh, a multiplier for the lengths by which it may leave its place,
  // [0, 1]. Vertices with 0 are fixed to the surface. `mesh` must outlive this object.
  WrinkleMesh(const FineMesh& mesh, std::span<const float> room, const Options& options);

  // Moves the surface to a pose, one entry per welded vertex, and lets the cloth settle. The cloth
  // is cut for the first pose: its lengths are measured there. `way`: the part of
  // Options::slipped that has arrived, [0, 1].
  void Step(std::span<const PosedVertex> surface, int iterations, float way = 1.0f);

  // The cloth at a vertex in the last pose, as seen from the surface.
  struct Fold {
    float height = 0.0f;       // above the surface, metres
    glm::vec3 gradient{0.0f};  // slope of the height, tangent to the surface; model axes at rest
  };
  // One per vertex of the mesh; 0 where there is no room.
  [[nodiscard]] std::vector<Fold> Folds() const;

 private:
  // An edge between two active vertices.
  struct Link {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    float ease = 0.0f;     // how much longer the cloth is than the surface, if it lies level
    float cut = 0.0f;      // the cloth's length, metres
    float gain = 0.0f;     // the length that it gains in the last pose, as a share of `cut`
    float length = 0.0f;   // length that it keeps in this pose, metres
    float share_a = 0.0f;  // part of a correction that each end takes; 0 for a fixed end
    float share_b = 0.0f;
  };
  // The vertices with room, and those beside them.
  struct Active {
    std::uint32_t vertex = 0;  // of the mesh
    float room = 0.0f;
    float bending = 0.0f;  // share of the second Laplacian that it loses per iteration
    float support = 0.0f;  // share of its height that it loses per iteration, without a pull
    float yield = 0.0f;    // the Laplacian of the height where cloth creases, metres
    float pressed = 0.0f;  // `support` with the pull of this pose
    float follow = 0.0f;   // share of its height's difference that its level takes over
    glm::vec3 rest_normal{0.0f};
    glm::vec3 base{0.0f};    // its place on the surface
    glm::mat3 turn{1.0f};    // rotates from the rest pose to the pose
    glm::vec3 normal{0.0f};  // of the surface
    glm::vec3 cloth{0.0f};   // its position
    glm::mat3 tension{0.0f};
  };

  // What an iteration of Step() reads of an active vertex and of a link.
  struct Held {
    glm::vec3 base{0.0f};
    glm::vec3 normal{0.0f};
    float room = 0.0f;
    float bending = 0.0f;
    float support = 0.0f;
    float pressed = 0.0f;
    float yield = 0.0f;
    float follow = 0.0f;
    glm::vec3 weight{0.0f};  // how far gravity moves it per iteration, metres
  };
  struct Spring {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    float length = 0.0f;
    float share_a = 0.0f;
    float share_b = 0.0f;
  };

  void Activate(std::span<const float> room);
  void MakeLinks();
  void Cut();
  void Carry(std::span<const PosedVertex> surface, float way);
  [[nodiscard]] float EaseOf(const FineMesh::Edge& edge) const;
  [[nodiscard]] float GainOf(const FineMesh::Edge& edge) const;
  [[nodiscard]] float NoiseAt(std::uint32_t vertex, int stream) const;
  void MeasureTension();
  void SetLength(float way, Link* link) const;
  void Gather();
  void KeepLengths();
  void Bend();
  void FollowLevels();
  void StayNear();
  template <class T>
  void Laplacian(const std::vector<T>& values, std::vector<T>* result) const;
  [[nodiscard]] std::vector<glm::vec3> Normals(const glm::vec3 Active::*position) const;

  const FineMesh& mesh_;
  Options options_;
  std::vector<Active> active_;
  std::vector<std::uint32_t> index_;  // per vertex of the mesh: its place in active_
  std::vector<Link> links_;
  std::vector<std::uint32_t> rings_;  // the active neighbours of the active vertices
  std::vector<std::size_t> ring_starts_;
  // During a step, per active vertex and per link; see Gather().
  std::vector<glm::vec3> cloth_;
  std::vector<Held> held_;
  std::vector<Spring> springs_;
  std::vector<float> levels_;  // per active vertex: the mean height over a few folds
  // Per active vertex, scratch.
  std::vector<float> heights_, bends_, changes_, level_changes_;
  std::vector<glm::vec3> slides_, slide_changes_;
  bool started_ = false;
};

}  // namespace furrow::authoring
