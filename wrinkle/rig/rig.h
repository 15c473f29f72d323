// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wrinkle/skeleton/transform.h"

// The wrinkle rig as data: what a rig file says, by name, before it is bound to a skeleton.
// rig/rig_file.h reads it from JSON; wrinkle/solver/solver.h binds it (RigBinding) and evaluates
// it.
namespace furrow::wrinkle {

// A joint's departure from its rest pose, in model axes, so that a reference pose made on one
// skeleton can be applied to another whose joints have other local frames.
//
// With rest-pose model rotation G of the joint and G_p of its parent (identity for a root):
//   local rotation    = rest.rotation * inverse(G) * rotation * G
//   local translation = rest.translation + inverse(G_p) * translation * bound_size / source_size
// For a skeleton whose rest rotations are all identity
// (BVH), `rotation` is the local rotation itself.
struct JointDelta {
  std::string joint;
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
  glm::vec3 translation{0.0f};  // in units of the source skeleton; see ReferencePose::source_size
};

struct ReferencePose {
  std::string name;
  std::vector<JointDelta> joints;  // joints not named rest
  float source_size = 0.0f;  // SkeletonSize() of the source; 0: same units as the bound skeleton
};

// Where on a joint a pose driver looks (4.1's B).
struct ControlPoint {
  enum class Kind { kTail, kOrigin, kOffset };
  std::string joint;
  Kind kind = Kind::kTail;
  glm::vec3 offset{0.0f};    // kOffset: in the joint's space, as a fraction of `offset_size`
  float offset_size = 0.0f;  // SkeletonSize() the offset was measured on; 0: bound skeleton's units
};

enum class PoseSolve { kProjection, kNnls };
enum class BallMode { kSmooth, kThesis };

// 4.1: one or several control points against named reference poses. Several points are stacked into
// one long vector, so that a group of joints is fitted at once.
struct PoseDriver {
  struct Value {
    std::string name;
    std::string reference_pose;
  };  // driver value <- reference pose
  std::vector<ControlPoint> points;
  std::vector<Value> values;
  PoseSolve solve = PoseSolve::kProjection;
  float falloff = 0.0f;  // s of exp(-|perp|^2 / (2 s^2 |d|^2)); 0: none
};

// 4.6: values "flexed" and "extended".
struct HingeDriver {
  std::string parent;             // upper bone: from parent's origin to joint's origin
  std::string joint;              // lower bone: joint's origin to its tail (or to `end`)
  std::string end;                // optional joint whose origin ends the lower bone
  std::optional<glm::vec3> axis;  // model axes in the rest pose, right-handed about it flexes
                                  // (+); none: unsigned, as printed
  float beta_degrees = 30.0f;     // angle between the bones when fully flexed, [0, 179]
};

// Clothing at ball joints: values "front", "back", "left", "right" (the subject's left and right).
struct BallDriver {
  std::string parent;  // upper bone's joint: its direction and its frame
  std::string joint;
  std::string end;       // as HingeDriver
  glm::vec3 bone{0.0f};  // the direction that counts as straight, model axes at rest;
                         // zero: the parent bone's own direction
  glm::vec3 forward{0.0f, 0.0f, 1.0f};  // model axes in the rest pose
  float beta_degrees = 30.0f;
  BallMode mode = BallMode::kSmooth;
};

// Swing-twist about the bone: values "twist_left" and "twist_right" (positive angle: left).
struct TwistDriver {
  std::string joint;
  std::optional<glm::vec3> axis;     // model axes in the rest pose; none: along the joint's tail
  float full_degrees = 90.0f;        // (0, 180]: the angle that gives 1
  std::vector<std::string> through;  // further joints whose twists add up (neck01..03)
};

// A tracker's coefficient: value "value".
struct BlendShapeDriver {
  std::string blend_shape;  // matched without case
  float neutral = 0.0f;
  float full = 1.0f;
};

// How strongly a patch of the skinned surface is compressed, and whither: values "along", "across",
// "diagonal_left" and "diagonal_right" of a direction in the surface, so that one place can fold
// along or across. Together they are the principal compression over `full_compression` (strain.h).
//
// The patch is data of the rig, as points and skin weights, so that a rig needs no mesh;
// `furrow rig patch` cuts one out of a character.
struct StrainDriver {
  static constexpr int kMaxInfluences = 4;
  struct Vertex {
    glm::vec3 position{0.0f};         // rest pose, model axes, from the origin of `joint`
    std::vector<int> joints;          // into `joints` below, at most kMaxInfluences
    std::vector<float> skin_weights;  // one each, > 0, sum 1
  };
  std::string joint;                // positions are measured from it
  std::vector<std::string> joints;  // those that move the patch
  std::vector<Vertex> vertices;
  std::vector<int> triangles;             // three vertices each, counter-clockwise from outside
  glm::vec3 direction{1.0f, 0.0f, 0.0f};  // model axes, rest pose: projected into the surface
  float full_compression = 0.25f;         // the compression that gives 1, [0.01, 1]
  float size = 0.0f;  // SkeletonSize() the positions were measured on; 0: bound skeleton's units
};

struct Driver {
  enum class Kind { kPose, kHinge, kBall, kTwist, kBlendShape, kStrain };
  std::string name;
  Kind kind = Kind::kPose;
  // Only the one that `kind` names is read.
  PoseDriver pose;
  HingeDriver hinge;
  BallDriver ball;
  TwistDriver twist;
  BlendShapeDriver blend_shape;
  StrainDriver strain;
};

enum class Modulation { kLinear, kCosine, kCubic };   // 4.3, 4.4
enum class Combine { kMax, kSum, kMean };             // sum is clamped; mean is weighted by gain
enum class LambdaMode { kSmooth, kBinary, kLinear };  // 4.2

// Which driver values feed one wrinkle map of a region.
struct Feed {
  struct Source {
    std::string driver;
    std::string value;
    float gain = 1.0f;
  };
  std::string map;  // a WrinkleMap's name; with the region's it names the wrinkle weight
  std::vector<Source> sources;
};

struct Mask {
  // Painted; the vertices that the driving joints move; about a ball joint, on the side to which it
  // bends (sliding_mask.h).
  enum class Kind { kTexture, kSkinning, kSliding };
  Kind kind = Kind::kTexture;
  std::string texture;  // file, or empty for one embedded in the character by this name
  int channel = 0;      // 0..3 = r, g, b, a
  LambdaMode lambda = LambdaMode::kSmooth;
  float smooth_width = 0.25f;  // w0 of smoothstep(0, w0, skin_weight)
  // Of kSliding. Lengths are in those of the bone below the joint.
  std::string ball;               // the ball driver that it slides with
  float spread_degrees = 100.0f;  // (0, 180]: how far to either side of the bend it reaches
  float above = 0.15f;            // [0, 10]: how far beyond the joint, towards the parent ...
  float below = 0.4f;             // ... and along the bone; together > 0
  float radius = 0.5f;            // (0, 10]: from the bone's axis
};

struct Region {
  std::string name;
  Mask mask;
  std::vector<Feed> feeds;
  Combine combine = Combine::kMax;
  Modulation modulation = Modulation::kCosine;
  std::vector<std::string> neighbours;  // adjacent regions: incongruence is resolved with them
};

struct WrinkleMap {
  // What a map is drawn on. Eyes and hair never wrinkle.
  enum class Surface { kAny, kSkin, kCloth };

  std::string name;               // "stretch", "squash", "folds", ...
  std::string normal;             // tangent-space normal map; or
  std::string derivative;         // partial-derivative map (n.xy / n.z), green up
  float derivative_scale = 1.0f;  // what an integer texel of 1 stands for; see below
  std::string height;             // optional: for displacement, over the rest surface
  float height_mm = 1.0f;         // what an integer texel of 1 stands for, millimetres
  std::string colour;             // optional: sRGB, multiplies the surface's base colour
  float colour_scale = 1.0f;      // the factor that a full texel stands for, linear
  std::string cavity;             // optional: scales gloss and the light of the sky
  float amplitude = 1.0f;         // scales derivatives and heights
  std::string opposes;  // the map that must not meet this one over a shared border, if any
  Surface surface = Surface::kAny;
};
// A derivative or height in a picture of integers is signed about the middle: a texel t in [0, 1]
// is (2 t - 1) * scale. A picture of floats (EXR) holds the derivative or the millimetres as they
// are, and the scale is not looked at.

struct Filter {
  bool enabled = true;
  float min_cutoff_hz = 4.0f;  // One-Euro (Casiez, Roussel and Vogel 2012)
  float beta = 1.0f;           // One-Euro speed coefficient
  float derivative_cutoff_hz = 1.0f;
  float slew_per_second = 30.0f;  // largest change of a weight; 0: no limit
  float hold_seconds = 0.25f;     // on loss: keep, then
  float decay_seconds = 0.5f;     // time constant of the decay to neutral
};

struct Export {
  std::string profile;
  std::string weight;
  std::string name;
};  // metahuman, osc, ...

struct Rig {
  std::string name;
  std::string anchor;  // joint whose space facial positions are measured in; empty: model space
  std::vector<ReferencePose> reference_poses;
  std::vector<Driver> drivers;
  std::vector<Region> regions;
  std::vector<WrinkleMap> wrinkle_maps;
  Filter filter;
  std::vector<Export> exports;
};

}  // namespace furrow::wrinkle
