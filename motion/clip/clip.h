// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/status.h"
#include "wrinkle/skeleton/pose.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::motion {

// A recorded performance of one subject, sampled: what every
// reader of this folder yields and every writer takes.
struct Clip {
  std::string name;
  wrinkle::Skeleton skeleton;  // may be empty (0 joints): blend shapes alone
  std::vector<std::string> blend_shape_names;
  std::vector<double> times;               // seconds, increasing, one a frame
  std::vector<wrinkle::Transform> locals;  // num_frames x num_joints, frame-major
  std::vector<float> blend_shapes;         // num_frames x num names, frame-major

  [[nodiscard]] int num_frames() const { return static_cast<int>(times.size()); }
  [[nodiscard]] double duration() const {
    return times.empty() ? 0.0 : times.back() - times.front();
  }
  // Frame `frame` in [0, num_frames) as a pose.
  void GetPose(int frame, wrinkle::LocalPose* pose) const;
};

// What a BVH joint's position channels do to its OFFSET: the format does not say. Most tools
// replace the offset; some add to it. A channel that is not there leaves its axis of the offset
// alone in both. Either way LoadClip() lets a root that is at the origin in every frame stay at its
// offset (MakeHuman's files).
enum class BvhPositions { kReplace, kAdd };

// Which axis points up in a BVH file, which does not say (motion/clip/up_axis.h tells how kAuto
// finds out). Whatever it is, a loaded clip is Y up and faces +Z.
enum class UpAxis { kAuto, kY, kZ };

struct LoadOptions {
  float scale = 1.0f;        // multiplies every length (BVH has no unit)
  double sample_rate = 0.0;  // Hz for formats made of curves (glTF); 0: the file's own keys
  BvhPositions bvh_positions = BvhPositions::kReplace;
  UpAxis up_axis = UpAxis::kAuto;  // BVH alone
  double timecode_rate = 0.0;  // frames a second of a Live Link Face CSV's timecode; 0: inferred
};

// What a reader put up with, or a writer could not say in the format: one sentence each, with the
// place ("take.bvh:186: states 100 frames, holds 99").
struct ClipReport {
  std::vector<std::string> warnings;
};

// Reads a clip by its extension: .bvh, .glb/.gltf/.vrma, .csv (Live Link Face); without case.
//
// Errors: kNotFound, kIo, kParse, kSchema, kLimit, kNonFinite, kUnsupported, with file and line
// (or field) in `where`.
[[nodiscard]] Result<Clip> LoadClip(const std::filesystem::path& path,
                                    const LoadOptions& options = {}, ClipReport* report = nullptr);

// Writes a clip by its extension: .bvh, .glb, .csv. Nothing is left behind on failure.
//
// BVH has no blend shapes and the CSV has no joints: what is dropped is told in `report`; a clip of
// which nothing would be left is kUnsupported.
[[nodiscard]] Status SaveClip(const Clip& clip, const std::filesystem::path& path,
                              ClipReport* report = nullptr);

}  // namespace furrow::motion
